// The list of constraint types: a new type is its file and a line here.
#include "constraints/constraint.h"

namespace taut {

std::span<const ConstraintType* const> constraint_types() {
    static const ConstraintType* const types[] = {
        &kBall,   &kDistance,    &kBend,      &kContact,   &kSpanContact, &kFixed,   &kHinge,
        &kSlider, &kCylindrical, &kUniversal, &kConeTwist, &kSixDof,      &kRolling,
    };
    return types;
}

}  // namespace taut
