// Gyroscopic torque of bodies that turn freely.
#pragma once

#include <span>

#include "state/nodes.h"

namespace taut {

// A body's angular velocity in its own axes, where its inertia is constant [rad/s].
struct FreeSpin {
    Vec3 w;
    const NodeMass* mass;
    bool damped;  // a link of a block, which whips about thin axes
};
constexpr size_t kSpins = 2;  // that are worked on side by side

// After time h by I dw/dt = -w x I w, of at most kSpins bodies, none of which depends on the others. Free bodies keep
// their energy and the size of their angular momentum, where a substep turns them by radians one of the two; damped
// ones lose some energy. At no speed does either rise of free bodies, nor the energy of damped ones.
void gyroscopic(std::span<FreeSpin> spins, double h);

}  // namespace taut
