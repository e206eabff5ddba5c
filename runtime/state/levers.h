// Where a contact point is on its two bodies.
#pragma once

#include "state/pairs.h"

namespace taut {

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

// From the centres of mass to where a contact point is on each of the two surfaces, world axes [m].
struct Levers {
    Vec3 a, b;
};

// Of levers, what turns with the bodies between detections: those to the cores, which balls grow to the shapes. A
// ball's contact does not turn with the ball.
inline Levers cores_of(const Pair& pair, const Levers& levers) {
    const Vec3 n = pair.manifold.normal.cast<double>();
    return {levers.a - static_cast<double>(pair.round_a) * n, levers.b + static_cast<double>(pair.round_b) * n};
}

// How the gap at a point grows until Pair::then [m].
inline double growth_of(const Pair& pair, const Levers& levers, const Movement& a, const Movement& b) {
    const Levers cores = cores_of(pair, levers);
    const auto then = static_cast<double>(pair.then);
    return pair.manifold.normal.cast<double>().dot(b.way(cores.b, then) - a.way(cores.a, then));
}

// Of a point between surfaces that are this far apart when they meet, at the present poses. arm_a: from the origin of
// node a, which positions are relative to, to its centre of mass.
inline Levers levers_of(const Pair& pair, int k, double separation, const Vec3& arm_a, const Movement& a,
                        const Movement& b) {
    const Vec3 position = pair.manifold.points[k].position.cast<double>();
    const Vec3 half = 0.5 * separation * pair.manifold.normal.cast<double>();
    const auto then = static_cast<double>(pair.then);
    if (then == 0) return {position - half - arm_a, position + half - arm_a - (b.x - a.x)};
    const Quat turn_a = rotation_from_vector(then * a.w), turn_b = rotation_from_vector(then * b.w);
    const Vec3 lever = position - turn_a * arm_a;
    return {turn_a.conjugate() * (lever - half),
            turn_b.conjugate() * (lever + half - (b.x + then * b.v - a.x - then * a.v))};
}

// Of a point of a pair in the state: its separation is of now.
inline Levers levers_of(const Pair& pair, int k, const Vec3& arm_a, const Movement& a, const Movement& b) {
    const auto now = static_cast<double>(pair.manifold.points[k].separation);
    const double growth = pair.then > 0 ? growth_of(pair, levers_of(pair, k, 0, arm_a, a, b), a, b) : 0;
    return levers_of(pair, k, now + growth, arm_a, a, b);
}

}  // namespace taut
