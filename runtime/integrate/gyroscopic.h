// Gyroscopic torque where the midpoint rule of motion_kernels.h does not do.
#pragma once

namespace taut {

// A body's angular velocity in its own axes, where its inertia (xx, yy, zz, xy, xz, yz) is constant, after time h by
// I dw/dt = -w x I w. Of a free body, which a substep turns by radians, the energy or the size of the angular momentum
// stays; a damped one, a link of a block, which whips about thin axes, loses some energy. At no speed does either rise
// of free bodies, nor the energy of damped ones.
void gyroscopic_euler(double w[3], const double inertia[6], double h, bool damped);

}  // namespace taut
