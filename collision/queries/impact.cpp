// Bodies under way that turn as well, by conservative advancement (Mirtich 1996): two shapes that a plane across n
// keeps apart by s now need at least s / (n . (v_a - v_b) + |w_a x n| r_a + |w_b x n| r_b) to meet, r the reach of a
// core about the centre that it turns about. And a point that turns about it has an acceleration of |w|^2 r at most, so
// that the plane, which goes along, keeps them apart by
//
//   s(t) >= s(0) (1 - t / T) + s(T) t / T - (|w_a|^2 r_a + |w_b|^2 r_b) t (T - t) / 2
//
// at each t until T: by no more than that does the reach of a point along n exceed the chord between now and then, and
// so that of the furthest one.
#include <limits>

#include "collision/queries/couple.h"
#include "collision/queries/surface.h"

namespace taut::collision {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
// A few as a rule. What needs more grazes; the moment reached is before the meeting.
constexpr int kMaxImpactSteps = 64;
// Whether a meeting goes deep is looked at no more often.
constexpr int kMaxLooks = 64;

// Two convex shapes at a moment of their ways.
class Moment {
public:
    Moment(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double time)
        : motion_a_(motion_a),
          motion_b_(motion_b),
          time_(time),
          at_a_(motion_a.after(time)),
          at_b_(motion_b.after(time)),
          couple_(a, at_a_, b, at_b_) {}

    const Couple& couple() const { return couple_; }
    // How far a plane across a unit vector in world axes keeps the two apart [m].
    double apart(const Vec3& normal) const {
        return couple_.proven(Vec3::Zero(), couple_.to_a(normal)) - couple_.radii();
    }
    // How long such a plane, which keeps them apart by a gap now, keeps them apart by least [m]: up to an end [s].
    double time_apart(const Vec3& normal, double gap, double least, const Moment& end) const;

private:
    // How fast points of the two come nearer to each other along n at most [m/s], and how fast that may change [m/s^2].
    double speed(const Vec3& n) const {
        return n.dot(motion_a_.velocity - motion_b_.velocity) + motion_a_.reach * motion_a_.spin.cross(n).norm() +
               motion_b_.reach * motion_b_.spin.cross(n).norm();
    }
    double acceleration() const {
        return motion_a_.reach * motion_a_.spin.squaredNorm() + motion_b_.reach * motion_b_.spin.squaredNorm();
    }

    const Motion &motion_a_, &motion_b_;
    double time_;
    Placement at_a_, at_b_;
    Couple couple_;
};

// In parts x of the time to the end, with what is left of the gap now and then: now (1 - x) + then x - bend x (1 - x).
double Moment::time_apart(const Vec3& normal, double gap, double least, const Moment& end) const {
    const double time = end.time_ - time_, now = gap - least, closing = speed(normal) * time;
    if (closing <= now) return time;
    const double then = end.apart(normal) - least, bend = 0.5 * acceleration() * time * time;
    const double slope = now + bend - then, root = slope * slope - 4 * bend * now;
    if (slope <= 0 || root < 0) return time;
    return time * std::min(1.0, std::max(now / closing, 2 * now / (slope + std::sqrt(root))));
}

// b is the plane, which may move but, being endless, not turn much: its turning is left out.
double plane_meeting(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                     double limit) {
    Motion still = motion_b;
    still.spin.setZero();
    double t = 0;
    for (int step = 0; step < kMaxImpactSteps; ++step) {
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

// Of two shapes' origins until a time: the chord of the way from one's to the other's, which they leave by no more than
// |w|^2 l t^2 / 8 each, l the lever about which one turns.
struct Chord {
    Vec3 apart, velocity;  // now [m]; [m/s]
    double bend;           // [m]

    Chord(const Motion& a, const Motion& b, double time)
        : apart(b.at.position - a.at.position),
          velocity((b.place_after(time) - a.place_after(time) - apart) / time),
          bend(a.bend(time) + b.bend(time)) {}

    // When they are nearest to each other, from one moment to another [s].
    double nearest_moment(double from, double to) const {
        const double squared = velocity.squaredNorm();
        return squared > 0 ? std::clamp(-apart.dot(velocity) / squared, from, to) : from;
    }
    Vec3 at(double moment) const { return apart + moment * velocity; }
};

// How fast points of two shapes come nearer to each other at most [m/s].
double fastest(const Motion& a, const Motion& b) {
    return (a.velocity - b.velocity).norm() + a.reach * a.spin.norm() + b.reach * b.spin.norm();
}

// Whether two shapes are deeper in each other than depth at a moment, else how long they are not after it.
struct Depth {
    bool deep;
    double clear;  // [s]
};
// b is the plane.
Depth depth_at_plane(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double moment,
                     double depth) {
    const double gap = find_gap(a, motion_a.after(moment), b, motion_b.after(moment)).distance;
    return {gap < -depth, (gap + depth) / fastest(motion_a, motion_b)};
}
Depth depth_at(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double moment,
               double depth, const Moment& end) {
    const Moment now(a, motion_a, b, motion_b, moment);
    const auto plane = now.couple().bound(depth);
    if (!plane || plane->apart < -depth) return {true, 0};  // without a plane, in doubt
    return {false, now.time_apart(now.couple().to_world(plane->normal), plane->apart, -depth, end)};
}
// b is a triangle, which has no inside to make it smaller by. The plane of the look before is asked first, across a
// normal that the look leaves to the next one: most often the triangle's own.
Depth depth_at_triangle(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double moment,
                        double depth, const Moment& end, Vec3& normal) {
    const Moment now(a, motion_a, b, motion_b, moment);
    double apart = now.apart(normal);
    if (apart < -depth) {
        const Couple::Plane plane = now.couple().parting(normal);
        normal = plane.normal;
        apart = plane.apart;
    }
    return {apart < -depth, now.time_apart(normal, apart, -depth, end)};
}

// Whether two get deep, by looks from a moment on until another. In doubt they are.
template <class Look>
bool any_deep(const Motion& motion_a, const Motion& motion_b, double met, double depth, double until, Look&& look_at) {
    const double least = 0.5 * depth / fastest(motion_a, motion_b);  // from look to look [s]
    double t = met;
    for (int look = 0; look < kMaxLooks && t < until; ++look) {
        const Depth found = look_at(t);
        if (found.deep) return true;
        t += std::max(found.clear, least);
    }
    return t < until;
}

bool plane_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double met,
                       double depth, double until) {
    return any_deep(motion_a, motion_b, met, depth, until,
                    [&](double t) { return depth_at_plane(a, motion_a, b, motion_b, t, depth); });
}

// Most of them that pass deep are as deep where the centres pass each other.
bool convex_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double met,
                        double depth, double until) {
    const Moment end(a, motion_a, b, motion_b, until);
    const auto look_at = [&](double t) { return depth_at(a, motion_a, b, motion_b, t, depth, end); };
    return look_at(Chord(motion_a, motion_b, until).nearest_moment(met, until)).deep ||
           any_deep(motion_a, motion_b, met, depth, until, look_at);
}

// Whether balls about the origins, which hold the shapes however they turn, come as near as reach.
bool balls_meet(const Vec3& nearest, const Motion& a, const Motion& b, double radii, double reach) {
    const double touch = a.own_reach() + b.own_reach() + radii + reach;
    return nearest.squaredNorm() <= touch * touch;
}

}  // namespace

Vec3 Motion::place_after(double time) const {
    const Vec3 lever = at.position - centre;
    if (lever == Vec3::Zero() || spin == Vec3::Zero()) return at.position + time * velocity;
    return centre + time * velocity + rotation_from_vector(time * spin) * lever;
}

double Motion::bend(double time) const { return spin.squaredNorm() * (at.position - centre).norm() * time * time / 8; }

Placement Motion::after(double time) const {
    if (time == 0) return at;
    if (spin == Vec3::Zero()) return {centre + time * velocity + (at.position - centre), at.rotation};
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
    const Chord chord(motion_a, motion_b, limit);
    const Vec3 nearest = chord.at(chord.nearest_moment(0, limit));
    const double radii = core_radius(a) + core_radius(b);
    if (!balls_meet(nearest, motion_a, motion_b, radii, reach + chord.bend)) return limit;
    double t = 0;
    // Most that do not meet pass by each other: along the way between the origins where they are nearest, these hardly
    // come nearer.
    Vec3 normal = nearest.norm() > 0 ? nearest.normalized() : Vec3::UnitY();  // then of the step before
    const Moment end(a, motion_a, b, motion_b, limit);
    for (int step = 0; step < kMaxImpactSteps; ++step) {
        const Moment now(a, motion_a, b, motion_b, t);
        double separation = now.apart(normal);
        if (separation <= reach) {  // the last normal parts them no more, for which one support point was asked
            const Couple& couple = now.couple();
            const Distance cores = couple.distance(Vec3::Zero(), couple.to_a(normal), kBoundGap);
            if (!cores.apart) return t;
            normal = couple.to_world(cores.normal);
            separation = now.apart(normal);
            if (separation <= reach) return t;
        }
        t += now.time_apart(normal, separation, 0.5 * reach, end);
        if (!(t < limit)) return limit;
    }
    return t;
}

// Most triangles that are passed are so at the end.
bool triangle_passes_deep(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, Vec3 normal,
                          double depth, double until) {
    const Moment end(a, motion_a, b, motion_b, until);
    const auto look_at = [&](double t) { return depth_at_triangle(a, motion_a, b, motion_b, t, depth, end, normal); };
    return look_at(until).deep || any_deep(motion_a, motion_b, 0, depth, until, look_at);
}

double find_impact(const Shape& a, const Motion& motion_a, const Shape& b, const Motion& motion_b, double reach,
                   double depth, double horizon) {
    if (!is_convex(a) && !is_convex(b)) return kNever;  // planes and surfaces do not meet one another
    if (!is_convex(a)) return find_impact(b, motion_b, a, motion_a, reach, depth, horizon);
    const bool on_plane = b.kind == ShapeKind::plane, on_surface = b.kind == ShapeKind::surface;
    uint32_t triangle = 0;
    const double met = on_surface ? surface_meeting(a, motion_a, b, motion_b, reach, horizon, triangle)
                       : on_plane ? plane_meeting(a, motion_a, b, motion_b, reach, horizon)
                                  : convex_meeting(a, motion_a, b, motion_b, reach, horizon);
    if (met == 0) return 0;
    if (!(met < horizon)) return kNever;
    const double until = 2 * horizon;
    const bool deep = on_surface ? surface_passes_deep(a, motion_a, b, motion_b, triangle, met, depth, until)
                      : on_plane ? plane_passes_deep(a, motion_a, b, motion_b, met, depth, until)
                                 : convex_passes_deep(a, motion_a, b, motion_b, met, depth, until);
    return deep ? met : kNever;
}

}  // namespace taut::collision
