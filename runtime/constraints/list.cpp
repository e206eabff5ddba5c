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
    static const ElementType* const types[] = {&kLinkElement, &kBendElement};
    return types;
}

}  // namespace taut
