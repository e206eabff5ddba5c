// The lists of constraint and element types: a new type is its file and a line here.
#include "constraints/element.h"

namespace taut {

std::span<const ConstraintType* const> constraint_types() {
    static const ConstraintType* const types[] = {
        &kBall,   &kDistance,    &kBend,      &kContact,   &kSpanContact, &kFixed,   &kHinge,
        &kSlider, &kCylindrical, &kUniversal, &kConeTwist, &kSixDof,      &kRolling,
    };
    return types;
}

std::span<const ElementType* const> element_types() {
    static const ElementType* const types[] = {
        &kLinkElement,       &kBendElement,       &kGreenTri3,
        &kGreenQuad4,        &kGreenTet4,         &kGreenHex8,
        &kCorotatedTri3,     &kCorotatedQuad4,    &kCorotatedTet4,
        &kCorotatedHex8,     &kStretchTet4,       &kStretchHex8,
        &kStretchVolumeTet4, &kStretchVolumeHex8, &kNeoHookeanTet4,
        &kNeoHookeanHex8,    &kDihedralElement,   &kQuadraticBendElement,
        &kDragElement,
    };
    return types;
}

}  // namespace taut
