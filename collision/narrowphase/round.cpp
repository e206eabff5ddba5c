// Spheres and capsules against each other: the distance of their axes less the radii.
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/kernel.h"
#include "collision/narrowphase/rounds.h"

namespace taut::collision {
namespace {

// Capsules within 10 degrees (sine squared 0.03) of parallel touch along a line: two points.
constexpr float kAxisSine2 = 0.03f;
// The nearest points are a third contact if they are this much closer than the line's ends [m].
constexpr float kBetween = 5e-4f;

// Any unit vector across both axes, where they meet and distance has no direction.
Vec3f across(const Vec3f& p, const Vec3f& q) {
    const Vec3f both = p.cross(q);
    if (both.squaredNorm() > 1e-6f * p.squaredNorm() * q.squaredNorm()) return both.normalized();
    const Vec3f& along = p.squaredNorm() > q.squaredNorm() ? p : q;
    int k = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(along[i]) < std::fabs(along[k])) k = i;
    }
    const Vec3f cross = along.cross(Vec3f::Unit(k));
    return cross.squaredNorm() > 0 ? Vec3f(cross.normalized()) : Vec3f::Unit(1);
}

// The point between the surfaces at the axes' points s and t, if they are near enough.
void add_point(const Rounds& rounds, float s, float t, float margin, uint32_t feature, Manifold& out) {
    const Vec3f p = rounds.a.at(s);
    const Vec3f q = rounds.b.at(t);
    const float separation = (q - p).norm() - rounds.radius_a - rounds.radius_b;
    if (separation > margin) return;
    const Vec3f middle = 0.5f * (p + q) + out.normal * (0.5f * (rounds.radius_a - rounds.radius_b));
    out.points[out.count++] = {middle, separation, feature};
}

// Both ends of the stretch where the axes run side by side.
void add_ends(const Rounds& rounds, float margin, Manifold& out) {
    const float s0 = rounds.a.nearest(rounds.b.from);
    const float s1 = rounds.a.nearest(rounds.b.at(1));
    const float lo = std::min(s0, s1);
    const float hi = std::max(s0, s1);
    const float length = (hi - lo) * rounds.a.step.norm();
    if (length < 0.1f * std::min(rounds.radius_a, rounds.radius_b)) return;
    add_point(rounds, lo, rounds.b.nearest(rounds.a.at(lo)), margin, 2, out);
    add_point(rounds, hi, rounds.b.nearest(rounds.a.at(hi)), margin, 3, out);
}

// Inlined, so that what has just been transformed stays in registers.
[[gnu::always_inline]] inline float touch(const Rounds& rounds, float margin, Manifold& out) {
    const SegmentPair nearest = nearest_points(rounds.a, rounds.b);
    const Vec3f between = rounds.b.at(nearest.t) - rounds.a.at(nearest.s);
    const float squared = between.squaredNorm();
    const float reach = rounds.radius_a + rounds.radius_b + margin;
    if (squared > reach * reach) return std::sqrt(squared) - rounds.radius_a - rounds.radius_b;

    const float least = 1e-4f * rounds.radius_a;
    out.normal = squared > least * least ? Vec3f(between / std::sqrt(squared)) : across(rounds.a.step, rounds.b.step);
    const float aa = rounds.a.step.squaredNorm();
    const float bb = rounds.b.step.squaredNorm();
    if (rounds.a.step.cross(rounds.b.step).squaredNorm() < kAxisSine2 * aa * bb) {
        add_ends(rounds, margin, out);
        if (deepest(out) <= std::sqrt(squared) - rounds.radius_a - rounds.radius_b + kBetween) return 0;
    }
    add_point(rounds, nearest.s, nearest.t, margin, 1, out);
    return 0;
}

}  // namespace

float touch_rounds(const Rounds& rounds, float margin, Manifold& out) { return touch(rounds, margin, out); }

float round_round(const Pair& pair, Manifold& out) {
    const Segment axis = round_axis(pair.b);
    return touch({round_axis(pair.a),
                  {pair.b_in_a * axis.from, pair.b_in_a.rotation * axis.step},
                  round_radius(pair.a),
                  round_radius(pair.b)},
                 pair.wanted.margin, out);
}

}  // namespace taut::collision
