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

// Whether b's surface slips on a's at a point, by more than rounding of how fast they go.
inline bool slips(const Nodes& nodes, const Pair& pair, int k) {
    constexpr float kRounding = 0x1p-20f;
    const RelativeMotion motion = relative_motion(nodes, pair);
    const Vec3f n = pair.manifold.normal, drive = pair.driven ? pair.drive_at(k) : Vec3f(Vec3f::Zero());
    const Vec3f v = motion.apart + motion.turning.cross(pair.manifold.points[k].position) - drive;
    const double speed = nodes.motion[pair.a].v.norm() + nodes.motion[pair.b].v.norm();
    return (v - n.dot(v) * n).norm() > kRounding * (static_cast<float>(speed) + drive.norm());
}

}  // namespace taut
