// Adding and removing a node with all that hangs on it: shape and broadphase, pairs, joints.
#pragma once

#include "world.h"

namespace taut {

// The shape's box at the node's pose, grown by the contact margin.
collision::Box contact_box(const World& world, uint32_t node);

inline NodePose origin_pose(const World& world, uint32_t node) {
    return {world.nodes.origin(node), world.nodes.motion[node].q};
}

// Throws std::bad_alloc with nothing changed.
uint32_t add_node(World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass);
// With every joint that ends on it. Throws std::bad_alloc with nothing changed, and not at all where
// reserve_ended(world.pairs, node) has gone before.
void remove_node(World& world, uint32_t node);

}  // namespace taut
