// Motions that a step can go on from.
#pragma once

#include "state/nodes.h"

namespace taut {

// Speeds beyond this are an error, not motion [m/s, rad/s].
constexpr double kMaxSpeed = 1e6;

inline Divergence divergence_of(const NodeMotion& m) {
    if (!(m.x.allFinite() && m.q.coeffs().allFinite() && m.v.allFinite() && m.w.allFinite()))
        return Divergence::non_finite;
    const double most = kMaxSpeed * kMaxSpeed;
    return m.v.squaredNorm() <= most && m.w.squaredNorm() <= most ? Divergence::none : Divergence::too_fast;
}
inline bool sane(const NodeMotion& m) { return divergence_of(m) == Divergence::none; }

}  // namespace taut
