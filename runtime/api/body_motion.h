// How the parts of the interface set a body in motion.
#pragma once

#include "state/nodes.h"

namespace taut {

// The velocities of its centre of mass [m/s, rad/s], and the low-passed ones, which start from them.
inline void set_velocity(NodeMotion& motion, const Vec3& v, const Vec3& w) {
    motion.v = motion.slow_v = v;
    motion.w = motion.slow_w = w;
}

}  // namespace taut
