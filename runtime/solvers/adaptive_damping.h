// Damping in the place of geometric stiffness that holds whichever way the force of the next step points: an option,
// after Andrews, Teichmann and Kry, Geometric Stiffness for Real-time Constrained Multibody Dynamics (2017).
#pragma once

#include "constraints/constraint.h"

namespace taut {

// |K| of a constraint's force: (6 nodes) x (6 nodes), symmetric, positive semi-definite, the same for force and -force.
void stiffness_magnitude(const ConstraintType& type, const void* data, const Pose* x, const double* force, double* k);

}  // namespace taut
