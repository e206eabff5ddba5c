// The lists of constraint and element types: a new type is its file and a line here.
#include "constraints/attachment.h"
#include "constraints/element.h"

namespace taut {

std::span<const ConstraintType* const> constraint_types() {
    static const ConstraintType* const types[] = {
        &kBall,      &kDistance,  &kBend,   &kContact, &kSpanContact, &kFixed, &kHinge,      &kSlider, &kCylindrical,
        &kUniversal, &kConeTwist, &kSixDof, &kRolling, &kWheel,       &kGear,  &kRackPinion, &kPulley,
    };
    return types;
}

std::span<const ElementType* const> element_types() {
    static const ElementType* const types[] = {
        &kLinkElement,
        &kBendElement,
        &kGreenTri3,
        &kGreenQuad4,
        &kGreenTet4,
        &kGreenHex8,
        &kCorotatedTri3,
        &kCorotatedQuad4,
        &kCorotatedTet4,
        &kCorotatedHex8,
        &kStretchTet4,
        &kStretchHex8,
        &kStretchVolumeTet4,
        &kStretchVolumeHex8,
        &kNeoHookeanTet4,
        &kNeoHookeanHex8,
        &kDihedralElement,
        &kQuadraticBendElement,
        &kDragElement,
        &point_attachment(1),
        &point_attachment(2),
        &point_attachment(3),
        &point_attachment(4),
        &point_attachment(5),
        &point_attachment(6),
        &point_attachment(7),
        &point_attachment(8),
        &distance_attachment(1),
        &distance_attachment(2),
        &distance_attachment(3),
        &distance_attachment(4),
        &distance_attachment(5),
        &distance_attachment(6),
        &distance_attachment(7),
        &distance_attachment(8),
    };
    return types;
}

}  // namespace taut
