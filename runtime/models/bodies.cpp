#include "models/bodies.h"

namespace taut {

collision::Box contact_box(const World& world, uint32_t node) {
    const collision::Placement at{world.nodes.origin(node),
                                  world.nodes.motion[node].q.toRotationMatrix().cast<float>()};
    collision::Box box = collision::bounds(world.shapes.record[world.nodes.info[node].shape].shape, at);
    box.lo.array() -= kContactMargin;
    box.hi.array() += kContactMargin;
    return box;
}

uint32_t add_node(World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass) {
    Nodes& nodes = world.nodes;
    const uint32_t node = nodes.add();
    nodes.info[node] = info;
    nodes.motion[node] = motion;
    nodes.mass[node] = mass;
    nodes.before[node] = origin_pose(world, node);
    if (info.shape != kNone) {
        try {
            world.broadphase.add(node, contact_box(world, node), info.kind != NodeKind::fixed);
        } catch (...) {
            nodes.remove(node);
            throw;
        }
        ++world.shapes.record[info.shape].users;
    }
    return node;
}

void remove_node(World& world, uint32_t node) {
    // What may fail comes first.
    reserve_ended(world.pairs, node);
    const uint32_t shape = world.nodes.info[node].shape;
    if (shape != kNone) {
        world.broadphase.remove(node);
        --world.shapes.record[shape].users;
    }
    forget_pairs_of(world.pairs, world.nodes, node);
    for (uint32_t joint = 0; joint < world.joints.ids.slots(); ++joint) {
        if (!world.joints.ids.live(joint)) continue;
        const Joint& record = world.joints.record[joint];
        if (record.node[0] == node || record.node[1] == node) world.joints.remove(joint);
    }
    world.nodes.remove(node);
}

}  // namespace taut
