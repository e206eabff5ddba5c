// Two convex shapes as queries see them: however far they are from each other, in double precision.
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "collision/narrowphase/least_push.h"
#include "collision/queries/lines.h"

namespace taut::collision {

// Of GJK in queries: distances are good to 1e-9 of themselves.
constexpr double kQueryGap = 1e-9;
// Where less than the distance will do, as what a plane across the normal proves.
constexpr double kBoundGap = 1e-3;

class Couple {
public:
    Couple(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b)
        : at_a_(at_a),
          at_b_(at_b),
          rotation_(at_a.rotation.cast<double>()),
          pair_{a, b, at_a, at_b, {at_a.rotation.transpose() * at_b.rotation, Vec3f::Zero()}, 0, cache_},
          difference_(pair_),
          radius_a_(core_radius(a)),
          radius_b_(core_radius(b)),
          lines_(has_line(a) && has_line(b)) {}
    Couple(const Couple&) = delete;
    Couple& operator=(const Couple&) = delete;

    // Of the cores, b moved by moved [m], in a's frame. Starts from the unit vector hint; gap as for gjk().
    Distance distance(const Vec3& moved, const Vec3& hint, double gap = kQueryGap) const {
        const Vec3 shift = to_a(at_b_.position + moved - at_a_.position);
        return lines_ ? distance_of_lines(shift) : gjk(difference_, shift, hint, gap);
    }
    // A plane that keeps the two as far apart as this [m], if that tells whether they are deeper in each other than
    // depth: what still overlaps when both are smaller by shares of depth is, and has no such plane: -infinity.
    struct Plane {
        double apart;
        Vec3 normal;  // unit, from a to b, a's frame
    };
    std::optional<Plane> bound(double depth) const {
        const double inner = double(inner_radius(pair_.a)) + double(inner_radius(pair_.b));
        const Difference smaller(pair_, depth / inner);
        const Vec3 apart = to_a(at_b_.position - at_a_.position);
        // A line is as long where its shape is smaller.
        const Distance distance = lines_ ? distance_of_lines(apart) : gjk(smaller, apart, hint(), kBoundGap);
        if (!distance.apart) return Plane{-std::numeric_limits<double>::infinity(), distance.normal};
        const double least = proven(Vec3::Zero(), distance.normal) - radii();
        return least >= -depth ? std::optional(Plane{least, distance.normal}) : std::nullopt;
    }
    // The plane that keeps the two furthest apart, or of which they are least beyond; its normal in world axes. hint:
    // likewise, a unit vector to start from.
    Plane parting(const Vec3& hint) const {
        const Distance cores = distance(Vec3::Zero(), to_a(hint), kBoundGap);
        if (cores.apart) return {proven(Vec3::Zero(), cores.normal) - radii(), to_world(cores.normal)};
        const Push least = push();
        return {least.separation, to_world(least.normal)};
    }
    // How far a plane across the normal keeps the cores apart: no more than their distance, however far GJK came.
    double proven(const Vec3& moved, const Vec3& normal) const {
        return difference_.separation(normal) + normal.dot(to_a(at_b_.position + moved - at_a_.position));
    }
    // In a's frame, from one's middle to the other's: where to start.
    Vec3 hint() const {
        const Vec3 apart = to_a(at_b_.position - at_a_.position);
        const double length = apart.norm();
        return length > 1e-6 ? Vec3(apart / length) : Vec3(Vec3::UnitY());
    }
    // Of the cores that overlap.
    Push push() const {
        PairCache cache;
        const Vec3f apart = to_a(at_b_.position - at_a_.position).cast<float>();
        const Pair near = {pair_.a, pair_.b, at_a_, at_b_, {pair_.b_in_a.rotation, apart}, 0, cache};
        return least_push(Solid(pair_.a), Solid(pair_.b), near, Vec3::Zero(), 0);
    }

    Vec3 to_a(const Vec3& vector) const { return rotation_.transpose() * vector; }
    Vec3 to_world(const Vec3& vector) const { return rotation_ * vector; }
    // a's surface over a point of its core.
    Vec3 surface_of_a(const Vec3& on_core, const Vec3& normal) const {
        return at_a_.position + to_world(on_core + radius_a_ * normal);
    }
    double radii() const { return radius_a_ + radius_b_; }
    double size() const { return double(std::min(inner_radius(pair_.a), inner_radius(pair_.b))); }

private:
    Distance distance_of_lines(const Vec3& shift) const {
        const Mat3 rotation = pair_.b_in_a.rotation.cast<double>();
        const Line b = Line::of(pair_.b);
        return line_distance(Line::of(pair_.a), {rotation * b.from + shift, rotation * b.step});
    }

    const Placement &at_a_, &at_b_;
    Mat3 rotation_;
    PairCache cache_;
    Pair pair_;
    Difference difference_;
    double radius_a_, radius_b_;
    bool lines_;  // both cores are
};

// Between two convex shapes; b, or what stays, may be a triangle.
bool convex_overlap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
Gap convex_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b);
bool cast_at_convex(const Shape& moving, const Placement& from, const Vec3& along, const Shape& still,
                    const Placement& at, double limit, Hit& out);

// When two convex shapes under way come as near as reach [m]: 0 at the start; limit [s] if they do not before.
double convex_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                      double limit);

// Whether the ways of a convex shape and a triangle lead deeper into each other than depth [m] until a
// moment [s]; in doubt they do. normal: unit, from a to b, across which they are likely to stay apart.
bool triangle_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, Vec3 normal,
                          double depth, double until);

// A convex shape above a plane: by how much [m], and its lowest point in the world.
struct Clearance {
    double height;
    Vec3 normal, lowest;  // out of the plane
};
inline Clearance clearance(const Shape& plane, const Placement& at_plane, const Shape& convex, const Placement& at) {
    const Vec3 normal = (at_plane.rotation.cast<double>() * plane.size.cast<double>()).normalized();
    const Mat3 rotation = at.rotation.cast<double>();
    const Vec3 lowest = at.position + rotation * furthest_point(convex, rotation.transpose() * -normal);
    return {normal.dot(lowest - at_plane.position), normal, lowest};
}

}  // namespace taut::collision
