// Nearest points of a point and a triangle, and of two line segments, as weights of four points:
//   apart = sum w_i x_i, sum w_i = 0
#pragma once

#include <algorithm>

#include "base/math.h"

namespace taut {

struct Nearest {
    Vec3f apart;      // from the second feature to the first [m]
    float weight[4];  // of the first positive, of the second negative
    bool inside;      // within both features, not at the rim of one

    float distance() const { return apart.norm(); }
};

inline float clamped(float x) { return std::min(std::max(x, 0.0f), 1.0f); }

// Of point 0 and the edge from 1 to 2, corner 3 has no weight.
inline Nearest nearest_of_edge(const Vec3f (&x)[4], int from, int to) {
    const Vec3f along = x[to] - x[from];
    const float squared = along.squaredNorm();
    const float t = squared > 0 ? clamped((x[0] - x[from]).dot(along) / squared) : 0;
    Nearest out{x[0] - x[from] - t * along, {1, 0, 0, 0}, t > 0 && t < 1};
    out.weight[from] = t - 1;
    out.weight[to] = -t;
    return out;
}

// Of point 0 and the triangle of 1, 2, 3: within it by the heights of the three parts, else on the nearest edge.
inline Nearest nearest_of_face(const Vec3f (&x)[4]) {
    const Vec3f p = x[0] - x[1], a = x[2] - x[1], b = x[3] - x[1];
    const float aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm(), pa = p.dot(a), pb = p.dot(b);
    const float area = aa * bb - ab * ab;
    if (area > 1e-12f * aa * bb) {
        const float s = (bb * pa - ab * pb) / area, t = (aa * pb - ab * pa) / area;
        if (s > 0 && t > 0 && s + t < 1) return {p - s * a - t * b, {1, s + t - 1, -s, -t}, true};
    }
    Nearest best = nearest_of_edge(x, 1, 2);
    for (const Nearest& other : {nearest_of_edge(x, 2, 3), nearest_of_edge(x, 3, 1)})
        if (other.apart.squaredNorm() < best.apart.squaredNorm()) best = other;
    best.inside = false;
    return best;
}

// Of the segment from 0 to 1 and that from 2 to 3; of parallel ones at the middle of what they have in common.
inline Nearest nearest_of_segments(const Vec3f (&x)[4]) {
    const Vec3f a = x[1] - x[0], b = x[3] - x[2], r = x[0] - x[2];
    const float aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b), ar = a.dot(r), br = b.dot(r);
    const float per_aa = aa > 0 ? 1 / aa : 0, per_bb = bb > 0 ? 1 / bb : 0, area = aa * bb - ab * ab;
    float s;
    if (area > 1e-6f * aa * bb) {
        s = clamped((ab * br - bb * ar) / area);
    } else {  // ends of the second, along the first
        const float one = -ar * per_aa, other = one + ab * per_aa;
        s = 0.5f * (clamped(one) + clamped(other));
    }
    const float t = clamped((ab * s + br) * per_bb);
    s = clamped((ab * t - ar) * per_aa);
    return {r + s * a - t * b, {1 - s, s, t - 1, -t}, s > 0 && s < 1 && t > 0 && t < 1};
}

}  // namespace taut
