// Where a contact point is on its two bodies.
#pragma once

#include "state/pairs.h"

namespace taut {

// Contacts, found once a frame, turn their levers and masses with bodies that turned by more than this since they last
// did [rad]. With levers of the frame's beginning and masses of now thin bodies gain energy without bound.
constexpr double kLeverTurn = 0.05;

struct Movement {
    Vec3 x, v, w;  // of the centre of mass; world axes [m], [m/s], [rad/s]

    // Of a point at the lever, in time [s].
    Vec3 way(const Vec3& lever, double time) const { return time * v + rotation_from_vector(time * w) * lever - lever; }
};

// How fast the line between two particles turns, its stretch left out; of one node: the node itself [rad/s].
inline Vec3 spin_of(const Nodes& nodes, uint32_t node, uint32_t other) {
    const NodeMotion& m = nodes.motion[node];
    if (other == kNone) return m.w;
    const Vec3 along = nodes.motion[other].x - m.x;
    return along.cross(nodes.motion[other].v - m.v) / std::max(along.squaredNorm(), 1e-24);
}

// Of a node, or of the line between two particles: that of a rod, for what ties them keeps their distance.
inline Movement movement_of(const Nodes& nodes, uint32_t node, uint32_t other) {
    const NodeMotion& m = nodes.motion[node];
    if (other == kNone) return {m.x, m.v, m.w};
    const NodeMotion& far = nodes.motion[other];
    return {0.5 * (m.x + far.x), 0.5 * (m.v + far.v), spin_of(nodes, node, other)};
}

// The axis of a shape of revolution as it stands, and from the centre of mass of its node to the shape's origin, world
// axes. Without an axis the shape has no circles about it.
struct Axle {
    Vec3 axis = Vec3::Zero();  // unit, or 0
    Vec3 from = Vec3::Zero();  // [m]

    Axle after(const Quat& turn) const { return {turn * axis, turn * from}; }
};
struct Axles {
    Axle a, b;
};

// The unit vector across an axis that is nearest to a unit vector n; 0 without an axis, and where the two are within 3
// degrees of each other: there the furthest point of a circle along n goes around it faster than levers follow, and faces meet.
inline Vec3 across(const Vec3& axis, const Vec3& n) {
    constexpr double kLeastSine = 0.05;
    if (axis == Vec3::Zero()) return axis;
    const Vec3 side = n - n.dot(axis) * axis;
    const double sine = side.norm();
    return sine > kLeastSine ? Vec3(side / sine) : Vec3(Vec3::Zero());
}

// Where a contact point is on one side's surface, from the centre of mass of its node, world axes. Between detections
// its core turns with the body. The skin, from there to the point, does not: it ends where a ball or a circle about the
// axis reaches furthest along the outward normal o,
//   skin = round o + rim u(o),   u: the unit vector across the axis that is nearest to o,
// so that what rolls, on a plane or about another, touches below its axis, whatever material is there.
struct Lever {
    Vec3 at, skin;   // [m]
    double rim = 0;  // radius of the circle [m]

    Vec3 core() const { return at - skin; }
};
struct Levers {
    Lever a, b;
};

// Of a point that was found where the side will have turned so far, told as it stands.
inline Lever lever_of(const Vec3& found, const Vec3& outward, double round, const Axle& axle, const Quat& turn) {
    const Axle then = axle.after(turn);
    const Vec3 ball = round * outward, side = across(then.axis, outward);
    Lever lever{found, ball, std::max((found - ball - then.from).dot(side), 0.0)};
    const Vec3 core = turn.conjugate() * (found - ball - lever.rim * side);
    lever.skin += lever.rim * across(axle.axis, outward);
    lever.at = core + lever.skin;
    return lever;
}
inline Lever lever_of(const Vec3& found, const Vec3& outward, double round, const Axle& axle) {
    Lever lever{found, round * outward};
    if (axle.axis == Vec3::Zero()) return lever;
    const Vec3 side = across(axle.axis, outward);
    lever.rim = std::max((lever.core() - axle.from).dot(side), 0.0);
    lever.skin += lever.rim * side;
    return lever;
}

// How far a side's surface gets at a point, in time [s].
inline Vec3 way_of(const Lever& lever, const Vec3& outward, const Axle& axle, const Movement& moves, double time) {
    const Vec3 way = moves.way(lever.core(), time);
    if (lever.rim == 0) return way;
    const Vec3 then = rotation_from_vector(time * moves.w) * axle.axis;
    return way + lever.rim * (across(then, outward) - across(axle.axis, outward));
}

// From a core's point to the nearest one of the line that a collider's ball runs along, across the normal; core: from
// the node's centre of mass, world axes [m].
inline Vec3 to_ball_path(const Pairs& pairs, const Nodes& nodes, uint32_t collider, uint32_t node, const Vec3& normal,
                         const Vec3& core) {
    const Stance& stance = pairs.stance[collider];
    const Vec3 middle = stance.from_node.cast<double>() - (nodes.motion[node].x - nodes.origin(node));
    const auto half = static_cast<double>(stance.reach);  // of the core: of the line, 0 of a ball
    const Vec3 along = (stance.turn * Vec3f::UnitY()).cast<double>();
    const Vec3 way = middle + std::clamp(along.dot(core - middle), -half, half) * along - core;
    return way - normal.dot(way) * normal;
}

// Levers of a pair found at the present, those of balls and capsules ending exactly at their radius from the line of
// centres. A point that lags behind the centre of a ball by d, as rounding or a contact that is reused leave it, turns
// it on by the torque d N, so that it begins to roll by itself:
//   (m r^2 + I) d'' = r N d,  with I = 2/5 m r^2, N = m g:  d ~ exp(t sqrt(g / 1.4 r)).
// Both levers shift by the same, so that the two forces stay on one line; but of two round sides each has its own.
inline Levers on_ball_paths(const Pairs& pairs, const Nodes& nodes, const Pair& pair, Levers levers) {
    const bool a = pair.round_a > 0 && !pair.rolls_a, b = pair.round_b > 0 && !pair.rolls_b;
    if (pair.then > 0 || !(a || b)) return levers;
    const Vec3 n = pair.manifold.normal.cast<double>();
    const Vec3 none = Vec3::Zero();
    const Vec3 way_a = a ? to_ball_path(pairs, nodes, pair.collider_a(), pair.a, n, levers.a.core()) : none;
    const Vec3 way_b = b ? to_ball_path(pairs, nodes, pair.collider_b(), pair.b, n, levers.b.core()) : way_a;
    levers.a.at += a ? way_a : way_b;
    levers.b.at += way_b;
    return levers;
}

// How the gap at a point grows until Pair::then [m].
inline double growth_of(const Pair& pair, const Levers& levers, const Axles& axles, const Movement& a,
                        const Movement& b) {
    const Vec3 n = pair.manifold.normal.cast<double>();
    const auto then = static_cast<double>(pair.then);
    return n.dot(way_of(levers.b, -n, axles.b, b, then) - way_of(levers.a, n, axles.a, a, then));
}

// Of a point between surfaces that are this far apart when they meet, at the present poses. arm_a: from the origin of
// node a, which positions are relative to, to its centre of mass.
inline Levers levers_of(const Pair& pair, int k, double separation, const Vec3& arm_a, const Axles& axles,
                        const Movement& a, const Movement& b) {
    const Vec3 position = pair.manifold.points[k].position.cast<double>(), n = pair.manifold.normal.cast<double>();
    const Vec3 half = 0.5 * separation * n;
    const double round_a = static_cast<double>(pair.round_a), round_b = static_cast<double>(pair.round_b);
    const auto then = static_cast<double>(pair.then);
    if (then == 0) {
        const Vec3 lever = position - arm_a;
        return {lever_of(lever - half, n, round_a, axles.a),
                lever_of(lever + half - (b.x - a.x), -n, round_b, axles.b)};
    }
    const Quat turn_a = rotation_from_vector(then * a.w), turn_b = rotation_from_vector(then * b.w);
    const Vec3 lever = position - turn_a * arm_a;
    return {lever_of(lever - half, n, round_a, axles.a, turn_a),
            lever_of(lever + half - (b.x + then * b.v - a.x - then * a.v), -n, round_b, axles.b, turn_b)};
}

// Of a point of a pair in the state: its separation is of now.
inline Levers levers_of(const Pair& pair, int k, const Vec3& arm_a, const Axles& axles, const Movement& a,
                        const Movement& b) {
    const auto now = static_cast<double>(pair.manifold.points[k].separation);
    const double growth =
        pair.then > 0 ? growth_of(pair, levers_of(pair, k, 0, arm_a, axles, a, b), axles, a, b) : 0;
    return levers_of(pair, k, now + growth, arm_a, axles, a, b);
}

// Of a pair whose colliders are placed as their nodes stand.
inline Axle axle_of(const Pairs& pairs, uint32_t collider, const Vec3& arm) {
    const Stance& stance = pairs.stance[collider];
    return {stance.turn.cast<double>() * Vec3::UnitY(), stance.from_node.cast<double>() - arm};
}
// arm_a, arm_b: from the nodes' origins to their centres of mass.
inline Axles axles_of(const Pairs& pairs, const Pair& pair, const Vec3& arm_a, const Vec3& arm_b) {
    Axles axles;
    if (pair.rolls_a) axles.a = axle_of(pairs, pair.collider_a(), arm_a);
    if (pair.rolls_b) axles.b = axle_of(pairs, pair.collider_b(), arm_b);
    return axles;
}

}  // namespace taut
