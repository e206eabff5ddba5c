#include "models/bodies.h"

#include <algorithm>
#include <cstring>

#include "detect/detect.h"
#include "models/attachments.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"

namespace taut {
namespace {

void remove_colliders(World& world, uint32_t node) {
    while (world.nodes.info[node].collider != kNone) remove_collider(world, world.nodes.info[node].collider);
}

// What leads to a collider: its node or the collider before it.
uint32_t& link_to(World& world, uint32_t node, uint32_t collider) {
    uint32_t* link = &world.nodes.info[node].collider;
    while (*link != collider) link = &world.colliders.record[*link].next;
    return *link;
}

// Into the broadphase, or there as what its node is now. Throws std::bad_alloc with nothing changed.
void enter(World& world, uint32_t index) {
    const Collider& record = world.colliders.record[index];
    const bool moves = world.nodes.info[record.node].kind != NodeKind::fixed;
    reserve_more(world.pairs.grains.gone, world.colliders.grains.size() + 1);
    reserve_more(world.pairs.surfaces.gone, world.colliders.record.size());
    world.broadphase.add(index, contact_box(world.nodes, world.shapes, record), moves,
                         record.grain || is_surface_vertex(world.nodes, world.softs, record.node));
}

// All of a node's, or none.
void enter_all(World& world, uint32_t node) {
    uint32_t entered = 0;
    try {
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
            enter(world, c);
            ++entered;
        });
    } catch (...) {
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
            if (entered == 0) return;
            world.broadphase.remove(c);
            --entered;
        });
        throw;
    }
}

bool has_met(const World& world, uint32_t node) { return has_met(world.pairs, world.nodes, world.colliders, node); }

}  // namespace

uint32_t add_node(World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass,
                  std::span<const ColliderPlan> colliders) {
    Nodes& nodes = world.nodes;
    world.system.make_room(nodes.slots() + 1, nodes.movable + 1);
    const uint32_t node = nodes.add();
    nodes.info[node] = info;
    nodes.movable += info.kind != NodeKind::fixed;
    nodes.info[node].collider = kNone;
    nodes.motion[node] = motion;
    nodes.mass.set(node, mass);
    nodes.before[node] = origin_pose(world, node);
    try {
        for (ColliderPlan collider : colliders) {
            collider.node = node;
            add_collider(world, collider);
        }
    } catch (...) {
        remove_colliders(world, node);  // no pairs yet: does not throw
        nodes.remove(node);
        throw;
    }
    return node;
}

void remove_node(World& world, uint32_t node) {
    wake(world, node);
    // What may fail comes first.
    if (has_met(world, node)) reserve_ended(world.pairs, ends_on(node));
    for (uint32_t joint = 0; joint < world.joints.ids.slots(); ++joint) {
        if (!world.joints.ids.live(joint)) continue;
        if (ends_on(world.joints.record[joint], node)) world.joints.remove(joint);
    }
    drop_attachments(world, [&](uint32_t end) { return end == node; });
    drop_node(world, node);
}

void drop_node(World& world, uint32_t node) {
    wake(world, node);
    if (has_met(world, node)) forget_pairs(world.pairs, world.nodes, world.colliders, ends_on(node));
    remove_colliders(world, node);
    world.nodes.remove(node);
}

uint32_t add_collider(World& world, const ColliderPlan& collider) {
    world.colliders.reserve_one();
    world.pairs.make_room(world.colliders.record.size() + 1);
    const uint32_t index = world.colliders.add(collider);
    Collider& record = world.colliders.record[index];
    record.next = kNone;
    const bool enabled = world.nodes.enabled(record.node);
    try {
        enter(world, index);
        if (!enabled) world.broadphase.remove(index);  // which leaves its box, that all colliders have
    } catch (...) {
        world.colliders.remove(index);
        throw;
    }
    world.colliders.chained += world.nodes.info[record.node].collider != kNone;
    link_to(world, record.node, kNone) = index;
    world.pairs.forget_place(index);
    world.pairs.met[index] = 0;
    ++world.shapes[record.shape].users;
    if (!enabled) {
        world.colliders.list_own(index, false);
        return index;
    }
    if (!moves_by_forces(world.nodes.info[record.node].kind))
        wake_box(world, contact_box(world.nodes, world.shapes, record));
    return index;
}

// Those of a surface's vertex go with the next step, all of a cloth or solid at once.
static void forget_surface_contacts(World& world, uint32_t collider) {
    SurfaceContacts& surfaces = world.pairs.surfaces;
    if (surfaces.contact.empty()) return;
    const uint32_t node = world.colliders.record[collider].node;
    if (is_surface_vertex(world.nodes, world.softs, node)) return surfaces.gone.push_back(node);
    const size_t gone = std::erase_if(surfaces.contact, [&](const SurfaceContact& contact) {
        return contact.collider[0] == collider || contact.collider[1] == collider;
    });
    if (gone > 0) ++surfaces.version;
}

void remove_collider(World& world, uint32_t collider) {
    wake(world, world.colliders.record[collider].node);
    if (world.pairs.met[collider]) forget_pairs(world.pairs, world.nodes, world.colliders, ends_on_collider(collider));
    const Collider& record = world.colliders.record[collider];
    if (record.grain) world.pairs.grains.gone.push_back(record.node);
    forget_surface_contacts(world, collider);
    link_to(world, record.node, collider) = record.next;
    world.colliders.chained -= world.nodes.info[record.node].collider != kNone;
    if (world.nodes.enabled(record.node)) world.broadphase.remove(collider);
    --world.shapes[record.shape].users;
    world.colliders.remove(collider);
}

void refresh_boxes(World& world, uint32_t node) {
    if (!world.nodes.enabled(node)) return;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        world.broadphase.update(c, contact_box(world.nodes, world.shapes, world.colliders.record[c]), Vec3f::Zero());
    });
}

void update_idle(World& world, Joint& joint) {
    const bool idle = is_idle(world.nodes, joint);
    if (idle == joint.idle) return;
    joint.idle = idle;
    joint.fresh = true;
    joint.loaded = 0;
    joint.need = 0;
    std::ranges::fill(joint.lambda, 0.0);
    std::ranges::fill(joint.drift, 0.0);
    std::ranges::fill(joint.memory, AxisMemory{});
    if (!idle) restart(world.nodes, joint);
    ++world.joints.version;
}

// Pairs that a joint's bodies have with each other.
static auto between_ends(const Joint& joint) {
    return [&joint](const PairEnds& pair) {
        const auto ends = joint.ends();
        for (size_t b = 0; b < ends.size(); ++b)
            for (size_t a = 0; a < b; ++a)
                if (ends[a] != kNone && ends[b] != kNone && between_nodes(ends[a], ends[b])(pair)) return true;
        return false;
    };
}
static bool ties_bodies(const Joint& joint) {
    return std::ranges::count_if(joint.ends(), [](uint32_t end) { return end != kNone; }) > 1;
}

void reserve_pairs_of_ends(World& world, const Joint& joint) {
    if (ties_bodies(joint)) reserve_ended(world.pairs, between_ends(joint));
}

void forget_pairs_of_ends(World& world, const Joint& joint) {
    if (ties_bodies(joint)) forget_pairs(world.pairs, world.nodes, world.colliders, between_ends(joint));
}

static void update_joints(World& world, uint32_t node) {
    for (Joint& joint : world.joints.record)
        if (ends_on(joint, node)) update_idle(world, joint);
}

static void disable(World& world, uint32_t node) {
    Nodes& nodes = world.nodes;
    if (has_met(world, node)) reserve_ended(world.pairs, ends_on(node));  // what may fail comes first
    wake_about(world, node);
    if (has_met(world, node)) forget_pairs(world.pairs, nodes, world.colliders, ends_on(node));
    for_colliders(nodes, world.colliders, node, [&](uint32_t c) {
        if (world.colliders.record[c].grain) world.pairs.grains.gone.push_back(node);
        forget_surface_contacts(world, c);
        world.broadphase.remove(c);
        world.colliders.list_own(c, false);
    });
    nodes.info[node].disabled.off = true;
    nodes.set_rest(node, Rest::asleep);
    nodes.clear_load(node);
    if (KinematicPath* const path = nodes.find_path(node)) path->follows = path->asked = false;
    nodes.before[node] = origin_pose(world, node);
    if (node < nodes.history.size()) nodes.history[node] = {};
    update_joints(world, node);
}

static void enable(World& world, uint32_t node) {
    Nodes& nodes = world.nodes;
    uint32_t count = 0;
    for_colliders(nodes, world.colliders, node, [&](uint32_t) { ++count; });
    world.colliders.reserve_lists(count);  // what may fail comes first
    enter_all(world, node);
    for_colliders(nodes, world.colliders, node, [&](uint32_t c) {
        world.colliders.list_own(c, true);
        world.pairs.forget_place(c);
        world.pairs.met[c] = 0;
    });
    nodes.info[node].disabled.off = false;
    nodes.set_rest(node, Rest::awake);
    nodes.sleep[node].quiet = 0;
    world.sleep.changed = world.sleep.changed || nodes.sleep[node].told_asleep;
    update_joints(world, node);
    wake_about(world, node);
}

void set_enabled(World& world, uint32_t node, bool enabled) {
    if (enabled == world.nodes.enabled(node)) return;
    enabled ? enable(world, node) : disable(world, node);
}

void change_kind(World& world, uint32_t node, NodeKind kind, const NodeMass& mass) {
    Nodes& nodes = world.nodes;
    const NodeKind before = nodes.info[node].kind;
    const bool enabled = nodes.enabled(node);
    world.system.make_room(nodes.slots(), nodes.movable + 1);  // what may fail comes first
    nodes.mass.reserve_values(1);
    if (enabled && has_met(world, node)) reserve_ended(world.pairs, ends_on(node));
    nodes.info[node].kind = kind;
    try {
        if (enabled) for_colliders(nodes, world.colliders, node, [&](uint32_t c) { enter(world, c); });
    } catch (...) {
        nodes.info[node].kind = before;
        throw;
    }
    nodes.info[node].kind = before;
    wake_about(world, node);
    if (enabled && has_met(world, node)) forget_pairs(world.pairs, nodes, world.colliders, ends_on(node));
    nodes.info[node].kind = kind;
    nodes.movable += kind != NodeKind::fixed;
    nodes.movable -= before != NodeKind::fixed;
    shift_centre(world, node, nodes.motion[node].q * (mass.centre - nodes.mass[node].centre));
    nodes.mass.set(node, mass);
    if (!moves_by_forces(kind)) nodes.clear_load(node);
    if (const KinematicPath* path = nodes.find_path(node))
        nodes.paths.erase(nodes.paths.begin() + (path - nodes.paths.data()));
    if (kind == NodeKind::fixed) set_velocity(nodes.motion[node], Vec3::Zero(), Vec3::Zero());
    nodes.hold(node);
    if (node < nodes.history.size()) nodes.history[node] = {};
    nodes.sleep[node].quiet = 0;
    if (enabled) nodes.set_rest(node, Rest::awake);
    ++world.joints.version;  // blocks gain or lose the node
    wake_about(world, node);
}

void shift_centre(World& world, uint32_t node, const Vec3& offset) {
    NodeMotion& m = world.nodes.motion[node];
    m.x += offset;
    m.v += m.w.cross(offset);
    m.slow_v += m.slow_w.cross(offset);
    world.nodes.hold(node);
    const Vec3 local = m.q.conjugate() * offset;
    for (Joint& joint : world.joints.record) {
        for (int side = 0; side < static_cast<int>(joint.ends().size()); ++side) {
            if (joint.node[side] == node) set_anchor(joint, side, anchor_of(joint, side) - local);
        }
    }
    shift_attachments(world, node, local);
}

}  // namespace taut
