#include "collision/narrowphase/gjk.h"

#include <cmath>

#include "collision/narrowphase/simplex.h"

namespace taut::collision {
namespace {

// Each step adds a point; polytopes end after a few, curved surfaces when the bounds meet.
constexpr int kMaxSteps = 32;

}  // namespace

Difference::Difference(const Pair& pair, double shrink)
    : a_(pair.a),
      b_(pair.b),
      rotation_(pair.b_in_a.rotation.cast<double>()),
      position_(pair.b_in_a.position.cast<double>()),
      radius_a_(core_radius(pair.a)),
      radius_b_(core_radius(pair.b)),
      inset_a_(shrink * double(inner_radius(pair.a))),
      inset_b_(shrink * double(inner_radius(pair.b))) {}

DifferencePoint Difference::lowest(const Vec3& n) const {
    const Vec3 d = -(rotation_.transpose() * n);
    Vec3 on_a = furthest_point(a_, n) - radius_a_ * n;
    Vec3 on_b = furthest_point(b_, d) - radius_b_ * d;
    if (inset_a_ > 0) on_a = inset(a_, on_a, inset_a_);
    if (inset_b_ > 0) on_b = inset(b_, on_b, inset_b_);
    on_b = rotation_ * on_b + position_;
    return {on_b - on_a, on_a};
}

Distance gjk(const Difference& difference, const Vec3& shift, const Vec3& start, double gap) {
    Distance out;
    out.separation = -1e300;
    Simplex simplex;
    Vec3 n = start;
    Vec3 nearest = Vec3::Zero();
    double length = 1e300;
    double extent = 0;
    for (int step = 0; step < kMaxSteps; ++step) {
        DifferencePoint point = difference.lowest(n);
        point.at += shift;
        extent = std::max(extent, point.at.squaredNorm());
        const double separation = n.dot(point.at);
        if (separation > out.separation) {
            out.normal = n;
            out.separation = separation;
        }
        if (step > 0 && length - separation <= gap * length) break;
        simplex.points[simplex.count++] = point;
        if (!simplex.reduce(nearest)) return out;
        const double next = nearest.norm();
        if (next * next <= kTouchingCores * kTouchingCores * extent) return out;
        if (next >= length) break;  // rounding
        length = next;
        n = nearest / length;
    }
    return {true, n, length, simplex.on_a()};
}

}  // namespace taut::collision
