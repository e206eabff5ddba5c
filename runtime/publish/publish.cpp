#include "publish/publish.h"

#include <algorithm>

#include "state/joint_reading.h"

namespace taut {
namespace {

taut_pose public_pose(const Vec3& position, const Quat& q) {
    taut_pose pose{};
    pose.position = {position.x(), position.y(), position.z()};
    pose.rotation = {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
                     static_cast<float>(q.w())};
    return pose;
}

}  // namespace

void publish_motion(World& world, const Array<uint32_t>& frozen) {
    const Nodes& nodes = world.nodes;
    world.moved.clear();
    world.quarantined.clear();
    for (uint32_t node = 0; node < nodes.slots(); ++node) {
        const NodeInfo& info = nodes.info[node];
        if (nodes.rest[node] != Rest::awake) continue;
        if (info.kind == NodeKind::dead || info.kind == NodeKind::fixed) continue;
        const Vec3 origin = nodes.origin(node);
        const Quat& q = nodes.motion[node].q;
        if (origin == nodes.before[node].position && q.coeffs() == nodes.before[node].rotation.coeffs()) continue;
        world.moved.push_back({world.body_handle(node), info.user_data, public_pose(origin, q)});
    }
    for (uint32_t node : frozen) world.quarantined.push_back({world.body_handle(node), nodes.info[node].user_data});
}

void publish_profile(World& world) {
    taut_profile& p = world.profile;
    p.pairs = static_cast<uint32_t>(world.broadphase.pairs().size());
    p.touching = static_cast<uint32_t>(world.pairs.active.size());
    for (const ActivePair& active : world.pairs.active) {
        p.points += active.points;
        for (uint32_t k = 0; k < active.points; ++k)
            p.penetration = std::max(p.penetration, -world.pairs.list[active.pair].manifold.points[k].separation);
    }
    for (const NodeInfo& info : world.nodes.info) p.bodies += moves_by_forces(info.kind);
    for (const Joint& joint : world.joints.record) {
        if (!joint.type) continue;
        ++p.joints;
        if (asleep(world.nodes, joint)) continue;
        const JointError error = error_of(world.nodes, joint);
        p.joint_error = std::max(p.joint_error, static_cast<float>(error.linear));
    }
    p.islands = world.partition.islands;
    p.blocks = static_cast<uint32_t>(world.partition.blocks.size());
    p.colours = world.partition.colours;
    p.bytes = world.memory.bytes();
}

}  // namespace taut
