// Line segments: capsule axes and polytope edges. A point is a segment of no length.
#pragma once

#include <algorithm>

#include "base/math.h"

namespace taut::collision {

// Clamped to [0, 1] without a branch, which would be mispredicted half the time.
inline float share(float x) {
    const float most = x < 1 ? x : 1;
    return most > 0 ? most : 0;
}

struct Segment {
    Vec3f from, step;

    Vec3f at(float t) const { return from + step * t; }
    // Parameter of the point nearest to p.
    float nearest(const Vec3f& p) const {
        const float squared = step.squaredNorm();
        return squared > 0 ? share(step.dot(p - from) / squared) : 0.0f;
    }
};

struct SegmentPair {
    float s, t;  // parameters on the first and the second, in [0, 1]
};

// Nearest points: the free minimum over s with t eliminated, clamped, then each against the other.
// d/ds, d/dt |p + s a - q - t b|^2 = 0 give s (aa bb - ab^2) = ab br - bb ar, s aa = ab t - ar and t bb = ab s + br
// with r = p - q.
inline SegmentPair nearest_points(const Segment& p, const Segment& q) {
    const Vec3f r = p.from - q.from;
    const float aa = p.step.squaredNorm();
    const float bb = q.step.squaredNorm();
    const float ab = p.step.dot(q.step);
    const float ar = p.step.dot(r), br = q.step.dot(r);
    const float per_aa = aa > 0 ? 1 / aa : 0, per_bb = bb > 0 ? 1 / bb : 0;
    const float determinant = aa * bb - ab * ab;
    float s = 0.5f;  // parallel: any s will do, the middle moves least
    if (determinant > 1e-6f * aa * bb) s = share((ab * br - bb * ar) / determinant);
    const float t = share((ab * s + br) * per_bb);
    s = share((ab * t - ar) * per_aa);
    return {s, share((ab * s + br) * per_bb)};
}

}  // namespace taut::collision
