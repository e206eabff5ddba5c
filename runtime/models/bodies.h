// Adding and removing nodes and colliders with all that hangs on them: broadphase, pairs, joints.
#pragma once

#include <span>

#include "world.h"

namespace taut {

inline NodePose origin_pose(const World& world, uint32_t node) {
    return {world.nodes.origin(node), world.nodes.motion[node].q};
}

// A node with its colliders, whose node and next are set here. Throws std::bad_alloc with nothing changed.
uint32_t add_node(World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass,
                  std::span<const ColliderPlan> colliders = {});
// With its colliders and every joint and attachment on it. Throws std::bad_alloc with nothing changed, and not at all
// where reserve_ended(world.pairs, ends_on(node)) has gone before.
void remove_node(World& world, uint32_t node);
// The same of one on which there is none of these any more.
void drop_node(World& world, uint32_t node);

// Appends to the colliders of collider.node; next is set here. Throws std::bad_alloc with nothing changed.
uint32_t add_collider(World& world, const ColliderPlan& collider);
// Throws std::bad_alloc with nothing changed, and not at all after reserve_ended.
void remove_collider(World& world, uint32_t collider);

// Brings the fat boxes of a node's colliders to where it is. Throws std::bad_alloc; what was done by then does no harm,
// as the next step does it again.
void refresh_boxes(World& world, uint32_t node);

// Takes a node out of all that steps and queries go through, with its colliders and joints, or puts it back there; it
// is not part of anything. Throws std::bad_alloc with nothing changed.
void set_enabled(World& world, uint32_t node, bool enabled);

// Makes a rigid body static, kinematic or dynamic; mass: what it has then. What is static has no velocity. Throws
// std::bad_alloc with nothing changed but what the next step brings up to date.
void change_kind(World& world, uint32_t node, NodeKind kind, const NodeMass& mass);

// Brings Joint::idle up to date. A joint that begins to work anew is as one just made.
void update_idle(World& world, Joint& joint);
inline bool is_idle(const Nodes& nodes, const Joint& joint) {
    const auto disabled = [&](uint32_t end) { return end != kNone && !nodes.enabled(end); };
    return joint.off.off || std::ranges::any_of(joint.ends(), disabled);
}

// A change of what a joint's bodies may collide with: their pairs are found anew by the next step. The first may throw,
// the second does not.
void reserve_pairs_of_ends(World& world, const Joint& joint);
void forget_pairs_of_ends(World& world, const Joint& joint);

// Moves a body's centre of mass by an offset [m], world axes: what the body does, and where its joints and attachments
// hold it, stays.
void shift_centre(World& world, uint32_t node, const Vec3& offset);

}  // namespace taut
