// Gyroscopic torque of a body that turns freely.
#pragma once

#include "state/nodes.h"

namespace taut {

// w after time h by I dw/dt = -w x I w, all in body axes, where the inertia is constant [rad/s]. Free bodies keep their
// energy and the size of their angular momentum, where a substep turns them by radians one of the two; damped ones,
// links of a block, which whip about thin axes, lose some energy. At no speed does either rise of free bodies, nor the
// energy of damped ones.
Vec3 gyroscopic(const Vec3& w, const NodeMass& mass, double h, bool damped);

}  // namespace taut
