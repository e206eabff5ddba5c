#include "sleep/wake.h"

#include <algorithm>

#include "detect/detect.h"
#include "sleep/sleep.h"

namespace taut {
namespace {

void wake_node(World& world, uint32_t node) {
    world.nodes.set_rest(node, Rest::awake);
    world.nodes.sleep[node].quiet = 0;
    world.nodes.sleep[node].next = kNone;
    world.sleep.recall = true;
}

void wake_island(World& world, uint32_t node) {
    if (node == kNone || !moves_by_forces(world.nodes.info[node].kind) || !world.nodes.enabled(node)) return;
    if (!world.nodes.sleeps(node)) {
        world.nodes.sleep[node].quiet = 0;
        return;
    }
    --world.sleep.islands;
    world.sleep.changed = true;
    while (world.nodes.sleeps(node)) {
        const uint32_t next = world.nodes.sleep[node].next;
        wake_node(world, node);
        --world.sleep.bodies;
        node = next;
    }
}

// All that touches a node or is tied to it.
void wake_neighbours(World& world, uint32_t node) {
    const auto wake_sides = [&](const Pair& pair) {
        if (!ends_on(node)(pair) || !touches_closely(pair)) return;
        for (uint32_t side : {pair.a, pair.b, pair.a2, pair.b2}) wake_island(world, side);
    };
    if (has_met(world.pairs, world.nodes, world.colliders, node)) for_pairs(world.pairs, wake_sides);
    for (const SurfaceContact& contact : world.pairs.surfaces.contact) {
        if (std::ranges::find(contact.node, node) == std::end(contact.node) || !touches_closely(contact)) continue;
        for (const uint32_t side : contact.node) wake_island(world, side);
    }
    for_each_tie(world.joints, world.elements, [&](std::span<const uint32_t> ends) {
        if (std::ranges::find(ends, node) == ends.end()) return;
        for (const uint32_t end : ends) wake_island(world, end);
    });
}

bool overlap(const collision::Box& a, const collision::Box& b) {
    return (a.lo.array() <= b.hi.array()).all() && (b.lo.array() <= a.hi.array()).all();
}

}  // namespace

void wake(World& world, uint32_t node) {
    if (node == kNone || !world.nodes.enabled(node)) return;
    const NodeKind kind = world.nodes.info[node].kind;
    if (kind == NodeKind::fixed) world.nodes.set_rest(node, Rest::awake);
    if (!world.def.sleeping) return;
    if (moves_by_forces(kind)) {
        wake_island(world, node);
        return;
    }
    if (world.nodes.rest[node] != Rest::awake) wake_node(world, node);
    wake_neighbours(world, node);
}

void wake_all(World& world) {
    if (!world.def.sleeping) return;
    for (uint32_t node = 0; node < world.nodes.slots(); ++node) wake_island(world, node);
}

void wake_near(World& world, uint32_t node) {
    if (!world.def.sleeping || moves_by_forces(world.nodes.info[node].kind) || !world.nodes.enabled(node)) return;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        wake_box(world, contact_box(world.nodes, world.shapes, world.colliders.record[c]));
    });
}

void wake_about(World& world, uint32_t node) {
    wake(world, node);
    wake_near(world, node);
}

void wake_box(World& world, const collision::Box& box) {
    if (!world.def.sleeping) return;
    struct Found final : collision::Visitor {
        World& world;
        const collision::Box& box;
        Found(World& w, const collision::Box& b) : world(w), box(b) {}
        void visit(uint32_t id, collision::Probe&) override {
            const Collider& collider = world.colliders.record[id];
            if (!world.nodes.sleeps(collider.node)) return;
            const collision::Placement at = placement_of(world.nodes, collider);
            if (overlap(box, collision::bounds(world.shapes[collider.shape].shape, at)))
                wake_island(world, collider.node);
        }
    };
    Found found(world, box);
    const Vec3 lo = box.lo.cast<double>(), hi = box.hi.cast<double>();
    const Vec3 middle = 0.5 * (lo + hi);
    world.broadphase.visit({middle, Vec3::Zero(), lo - middle, hi - middle}, found,
                           collision::Broadphase::kMoving | collision::Broadphase::kGrains);
}

}  // namespace taut
