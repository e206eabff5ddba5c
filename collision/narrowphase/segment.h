// Line segments: capsule axes and polytope edges. A point is a segment of no length.
#pragma once

#include <algorithm>

#include "base/math.h"

namespace taut::collision {

struct Segment {
    Vec3f from, step;

    Vec3f at(float t) const { return from + step * t; }
    // Parameter of the point nearest to p.
    float nearest(const Vec3f& p) const {
        const float squared = step.squaredNorm();
        return squared > 0 ? std::clamp(step.dot(p - from) / squared, 0.0f, 1.0f) : 0.0f;
    }
};

struct SegmentPair {
    float s, t;  // parameters on the first and the second, in [0, 1]
};

// Nearest points: the free minimum over s with t eliminated, clamped, then each against the other.
// d/ds, d/dt |p + s a - q - t b|^2 = 0 give s (aa bb - ab^2) = ab br - bb ar with r = p - q.
inline SegmentPair nearest_points(const Segment& p, const Segment& q) {
    const Vec3f r = p.from - q.from;
    const float aa = p.step.squaredNorm();
    const float bb = q.step.squaredNorm();
    const float ab = p.step.dot(q.step);
    const float determinant = aa * bb - ab * ab;
    float s = 0.5f;  // parallel: any s will do, the middle moves least
    if (determinant > 1e-6f * aa * bb) {
        s = std::clamp((ab * q.step.dot(r) - bb * p.step.dot(r)) / determinant, 0.0f, 1.0f);
    }
    const float t = q.nearest(p.at(s));
    s = p.nearest(q.at(t));
    return {s, q.nearest(p.at(s))};
}

}  // namespace taut::collision
