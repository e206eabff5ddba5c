// How two bodies of a pair move against each other at their contact points.
#pragma once

#include "state/levers.h"
#include "state/nodes.h"

namespace taut {

// Velocity of b's points as seen from a's, at r from the origin of node a: v = apart + turning x r [m/s], [rad/s].
struct RelativeMotion {
    Vec3f apart, turning;

    // Along a normal from a to b; positive: they close [m/s].
    float approach(const Vec3f& r, const Vec3f& normal) const { return -(apart + turning.cross(r)).dot(normal); }
};

// The motion of a side of two particles is that of the line between them, without its stretch.
inline RelativeMotion relative_motion(const Nodes& nodes, const Pair& pair) {
    const Vec3 origin = nodes.origin(pair.a);
    Vec3 apart = Vec3::Zero(), turning = Vec3::Zero();
    const auto add = [&](double sign, uint32_t node, uint32_t other) {
        const NodeMotion& m = nodes.motion[node];
        const Vec3 w = spin_of(nodes, node, other);
        apart += sign * (m.v + w.cross(origin - m.x));
        turning += sign * w;
    };
    add(-1, pair.a, pair.a2);
    add(1, pair.b, pair.b2);
    return {apart.cast<float>(), turning.cast<float>()};
}

}  // namespace taut
