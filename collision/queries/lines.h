// The cores of spheres and capsules, segments of a line, in double precision: what GJK finds by search is known here.
#pragma once

#include <algorithm>

#include "collision/narrowphase/gjk.h"

namespace taut::collision {

inline bool has_line(const Shape& shape) { return shape.kind == ShapeKind::sphere || shape.kind == ShapeKind::capsule; }

struct Line {
    Vec3 from, step;  // a sphere's has no length

    // Of a shape that has one, in its frame.
    static Line of(const Shape& shape) {
        const double half = shape.kind == ShapeKind::capsule ? double(shape.size.y()) : 0.0;
        return {Vec3(0, -half, 0), Vec3(0, 2 * half, 0)};
    }
    Vec3 at(double t) const { return from + t * step; }
    // The parameter of the point nearest to p.
    double nearest(const Vec3& p) const {
        const double squared = step.squaredNorm();
        return squared > 0 ? std::clamp(step.dot(p - from) / squared, 0.0, 1.0) : 0.0;
    }
};

// From a to b, both in one frame. The free minimum over the line of a, clamped, then each against the other (Ericson,
// Real-Time Collision Detection, 5.1.9). Of nearly parallel lines rounding may put it anywhere: the ends are asked too.
inline Distance line_distance(const Line& a, const Line& b) {
    constexpr double kParallel = 1e-8;  // sine of their angle, squared
    const Vec3 r = a.from - b.from;
    const double aa = a.step.squaredNorm(), bb = b.step.squaredNorm(), ab = a.step.dot(b.step);
    const double determinant = aa * bb - ab * ab;
    double s = 0;
    if (determinant > 0) s = std::clamp((ab * b.step.dot(r) - bb * a.step.dot(r)) / determinant, 0.0, 1.0);
    if (determinant <= kParallel * aa * bb) {
        const auto apart = [&](double t) { return (b.at(b.nearest(a.at(t))) - a.at(t)).squaredNorm(); };
        for (const double end : {0.0, 1.0, a.nearest(b.from), a.nearest(b.at(1))})
            if (apart(end) < apart(s)) s = end;
    }
    const Vec3 on_b = b.at(b.nearest(a.at(s)));
    const Vec3 on_a = a.at(a.nearest(on_b));
    const Vec3 between = b.at(b.nearest(on_a)) - on_a;
    const double squared = between.squaredNorm();
    if (squared <= kTouchingCores * kTouchingCores * (r.squaredNorm() + aa + bb)) return {};
    const double length = std::sqrt(squared);
    return {true, between / length, length, on_a};
}

}  // namespace taut::collision
