// Bodies under way that turn as well: two shapes apart by s along n need at least s / (n . (v_a - v_b) + |w_a x n| r_a
// + |w_b x n| r_b) to meet, r the reach of a core about the centre that it turns about (conservative advancement;
// Mirtich 1996).
#include <array>
#include <limits>

#include "collision/queries/couple.h"
#include "collision/queries/surface.h"

namespace taut::collision {
namespace {

bool is_convex(const Shape& shape) { return shape.kind != ShapeKind::plane && shape.kind != ShapeKind::surface; }

constexpr double kNever = std::numeric_limits<double>::infinity();
// A few as a rule. What needs more grazes; the moment reached is before the meeting.
constexpr int kMaxSteps = 64;
// Whether a meeting goes deep is looked at no more often.
constexpr int kMaxLooks = 64;

// How fast two shapes can come nearer [m/s].
class Approach {
public:
    Approach(const Motion& a, const Motion& b)
        : velocity_(a.velocity - b.velocity), turn_a_(a.reach * a.spin), turn_b_(b.reach * b.spin) {}
    // Across a plane with the normal n, from a to b: n . (v + w x r) <= n . v + |w x n| |r| for each point.
    double along(const Vec3& normal) const {
        return normal.dot(velocity_) + turn_a_.cross(normal).norm() + turn_b_.cross(normal).norm();
    }
    double fastest() const { return velocity_.norm() + turn_a_.norm() + turn_b_.norm(); }

private:
    Vec3 velocity_;
    Vec3 turn_a_, turn_b_;  // spins times reaches
};

// b is the plane, which may move but, being endless, not turn much: its turning is left out.
double plane_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                     double limit) {
    Motion still = motion_b;
    still.spin.setZero();
    double t = 0;
    for (int step = 0; step < kMaxSteps; ++step) {
        const Clearance clear = clearance(b, still.after(t), a, motion_a.after(t));
        if (clear.height <= reach) return t;
        const double approach =
            -clear.normal.dot(motion_a.velocity - motion_b.velocity) + motion_a.spin.norm() * motion_a.reach;
        if (!(approach > 0)) return limit;
        t += (clear.height - 0.5 * reach) / approach;
        if (!(t < limit)) return limit;
    }
    return t;
}

using Meeting = double (*)(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                           double limit);

// By the kind of b; a is convex and bounded.
constexpr std::array<Meeting, kShapeKinds> kMeetings = {plane_meeting,  convex_meeting, convex_meeting,
                                                        convex_meeting, convex_meeting, convex_meeting,
                                                        convex_meeting, convex_meeting, surface_meeting};

// No more than the gap between two shapes [m], and less than -depth just where they are deeper in each other.
struct Clear {
    double gap;
    Vec3 normal;  // of a plane that keeps them as far apart, from a to b, world axes; 0: of none
};
Clear least_gap(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, double depth) {
    if (!is_convex(b)) return {find_gap(a, at_a, b, at_b).distance, Vec3::Zero()};
    const Couple couple(a, at_a, b, at_b);
    if (const auto plane = couple.bound(depth)) return {plane->apart, couple.to_world(plane->normal)};
    const Gap gap = find_gap(a, at_a, b, at_b);
    return {gap.distance, gap.normal};
}

// When the centres are nearest to each other, from one moment to another [s].
double nearest_moment(const Motion& a, const Motion& b, double from, double to) {
    const Vec3 apart = b.centre - a.centre, velocity = b.velocity - a.velocity;
    const double squared = velocity.squaredNorm();
    return squared > 0 ? std::clamp(-apart.dot(velocity) / squared, from, to) : from;
}

// Whether the ways lead deeper than depth from the moment met on, where they are apart by reach. In doubt they do. Most
// that do are as deep where the centres pass each other.
bool passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double met,
                 double reach, double depth, double until) {
    const auto clear_at = [&](double t) { return least_gap(a, motion_a.after(t), b, motion_b.after(t), depth); };
    if (is_convex(b) && clear_at(nearest_moment(motion_a, motion_b, met, until)).gap < -depth) return true;
    const Approach approach(motion_a, motion_b);
    const double least = 0.5 * depth / approach.fastest();  // of the time from look to look
    Clear clear = {reach, Vec3::Zero()};
    double t = met;
    for (int look = 0; look < kMaxLooks && t <= until; ++look) {
        const double speed = clear.normal == Vec3::Zero() ? approach.fastest() : approach.along(clear.normal);
        if (!(speed > 0)) return false;
        t += std::max((clear.gap + depth) / speed, least);
        clear = clear_at(t);
        if (clear.gap < -depth) return true;
    }
    return t <= until;
}

// From one centre to the other where they are nearest.
Vec3 nearest_way(const Motion& a, const Motion& b, double limit) {
    return b.centre - a.centre + nearest_moment(a, b, 0, limit) * (b.velocity - a.velocity);
}

// Whether balls about the centres, which hold the shapes however they turn, come as near as reach by the limit.
bool balls_meet(const Vec3& nearest, const Motion& a, const Motion& b, double radii, double reach) {
    const double touch = a.reach + b.reach + radii + reach;
    return nearest.squaredNorm() <= touch * touch;
}

// Whether a plane across the way between the centres where they are nearest keeps the shapes apart by reach all the
// time to the limit. Of those that do not meet most pass so: along it the centres hardly come nearer.
bool pass_by(const Vec3& nearest, const Couple& couple, const Approach& approach, double reach, double limit) {
    const double length = nearest.norm();
    if (!(length > 0)) return false;
    const Vec3 normal = nearest / length;
    const double apart = couple.proven(Vec3::Zero(), couple.to_a(normal)) - couple.radii();
    return apart - std::max(approach.along(normal), 0.0) * limit > reach;
}

}  // namespace

Placement Motion::after(double time) const {
    if (time == 0) return at;
    const Mat3 turn = rotation_from_vector(time * spin).toRotationMatrix();
    const Vec3 lever = turn * (at.position - centre);
    return {centre + time * velocity + lever, (turn * at.rotation.cast<double>()).cast<float>()};
}

double ball_radius(const Shape& shape) { return is_convex(shape) ? core_radius(shape) : 0.0; }

bool rolls(const Shape& shape) {
    return shape.kind == ShapeKind::cylinder || shape.kind == ShapeKind::cone ||
           shape.kind == ShapeKind::tapered_capsule;
}

// A point from which the shape reaches about as far one way as the opposite way: a thin wall that it is in front of
// pushes the shape out in front.
Vec3 middle(const Shape& shape) {
    constexpr double kConeBelow = 0.2;  // of the half length: the ways differ by 0.26 of it where the base is 1.2 wide
    if (shape.kind == ShapeKind::cone) return -kConeBelow * double(shape.size.y()) * Vec3::UnitY();
    if (shape.kind == ShapeKind::tapered_capsule) return 0.5 * double(shape.size.z() - shape.size.x()) * Vec3::UnitY();
    return is_convex(shape) ? Vec3(centre_line(shape).at(0.5f).cast<double>()) : Vec3(Vec3::Zero());
}

// A tapered capsule's surface is as far from its axis as its radius is between the ends' there.
double thickness(const Shape& shape) {
    if (shape.kind != ShapeKind::tapered_capsule) return is_convex(shape) ? double(inner_radius(shape)) : 0.0;
    const Vec3 size = shape.size.cast<double>();
    return 0.5 * (size.x() + size.z() + middle(shape).y() / size.y() * (size.z() - size.x()));
}

double spin_radius(const Shape& shape, double lever) {
    const Box box = bounds(shape, {Vec3::Zero(), Mat3f::Identity()});
    Vec3 corner = box.lo.cwiseAbs().cwiseMax(box.hi.cwiseAbs()).cast<double>();
    corner.array() -= ball_radius(shape);
    return lever + corner.norm();
}

double convex_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                      double limit) {
    const Vec3 nearest = nearest_way(motion_a, motion_b, limit);
    if (!balls_meet(nearest, motion_a, motion_b, core_radius(a) + core_radius(b), reach)) return limit;
    const Approach approach(motion_a, motion_b);
    if (pass_by(nearest, {a, motion_a.at, b, motion_b.at}, approach, reach, limit)) return limit;
    double t = 0;
    std::optional<Vec3> normal;  // of the step before
    for (int step = 0; step < kMaxSteps; ++step) {
        const Placement at_a = motion_a.after(t), at_b = motion_b.after(t);
        const Couple couple(a, at_a, b, at_b);
        if (!normal) normal = couple.hint();
        const auto held = [&] { return couple.proven(Vec3::Zero(), *normal) - couple.radii(); };
        double separation = held();
        if (separation <= reach) {  // the last normal parts them no more, for which one support point was asked
            const Distance cores = couple.distance(Vec3::Zero(), *normal, kBoundGap);
            if (!cores.apart) return t;
            normal = cores.normal;
            separation = held();
            if (separation <= reach) return t;
        }
        const double speed = approach.along(couple.to_world(*normal));
        if (!(speed > 0)) return limit;
        t += (separation - 0.5 * reach) / speed;
        if (!(t < limit)) return limit;
    }
    return t;
}

double find_impact(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                   double depth, double horizon) {
    if (!is_convex(a) && !is_convex(b)) return kNever;  // planes and surfaces do not meet one another
    if (!is_convex(a)) return find_impact(b, motion_b, a, motion_a, reach, depth, horizon);
    const double met = kMeetings[size_t(b.kind)](a, motion_a, b, motion_b, reach, horizon);
    if (met == 0) return 0;
    if (!(met < horizon)) return kNever;
    return passes_deep(a, motion_a, b, motion_b, met, reach, depth, 2 * horizon) ? met : kNever;
}

}  // namespace taut::collision
