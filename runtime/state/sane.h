// Motions that a step can go on from.
#pragma once

#include "state/nodes.h"

namespace taut {

// Speeds beyond this are an error, not motion [m/s, rad/s].
constexpr double kMaxSpeed = 1e6;

inline bool sane(const NodeMotion& m) {
    return m.x.allFinite() && m.q.coeffs().allFinite() && m.v.squaredNorm() <= kMaxSpeed * kMaxSpeed &&
           m.w.squaredNorm() <= kMaxSpeed * kMaxSpeed;
}

}  // namespace taut
