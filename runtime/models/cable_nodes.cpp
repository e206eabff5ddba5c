// Masses and shapes of a cable's points, links and segments.
#include "models/bodies.h"
#include "models/cable_parts.h"
#include "sleep/wake.h"

namespace taut {
namespace {

// A solid cylinder's: at m r^2/2 about its axis. Its ends count for mass, not for the shape's round caps.
NodeMass mass_of(const Cable& cable, double length, NodeKind kind) {
    NodeMass mass;
    mass.gravity_scale = cable.gravity_scale;
    mass.mass = cable.mass_per_metre * length;
    mass.inv_mass = 1 / mass.mass;
    mass.isotropic = kind == NodeKind::particle;
    if (mass.isotropic) return mass;
    const double rr = cable.radius * cable.radius;
    const double across = mass.mass * (3 * rr + length * length) / 12, about = mass.mass * rr / 2;
    mass.inertia = {across, about, across, 0, 0, 0};
    mass.inv_inertia = {1 / across, 1 / about, 1 / across, 0, 0, 0};
    return mass;
}

collision::Shape shape_of(const Cable& cable, double length) {
    collision::Shape shape;
    shape.kind = collision::ShapeKind::capsule;
    shape.size = {static_cast<float>(cable.radius), static_cast<float>(0.5 * length), 0};
    return shape;
}

// Gives `add` the capsule of a length, with a shape of its own; takes the shape back if that throws.
template <class Add>
auto with_capsule(World& world, const Cable& cable, double length, Add add) {
    ColliderPlan collider;
    collider.shape = world.shapes.add_inner(shape_of(cable, length));
    collider.traits.material = cable.material;
    collider.traits.filter = cable.filter;
    try {
        return add(collider);
    } catch (...) {
        world.shapes.remove(collider.shape);
        throw;
    }
}

}  // namespace

double share_of(const Cable& cable, uint32_t i) {
    if (links(cable)) return cable.length[i];
    const double before = i == 0 ? 0 : cable.length[i - 1], after = i == cable.segments() ? 0 : cable.length[i];
    return 0.5 * (before + after);
}

uint32_t add_cable_node(World& world, uint32_t index, const NodeMotion& motion, double length) {
    const Cable& cable = world.cables.record[index];
    NodeInfo info;
    info.kind = links(cable) ? NodeKind::dynamic : NodeKind::particle;
    info.cable = index;
    info.continuous = world.def.continuous != 0;
    info.user_data = cable.user_data;
    const NodeMass mass = mass_of(cable, length, info.kind);
    if (!links(cable)) return add_node(world, info, motion, mass);
    return with_capsule(world, cable, length, [&](const ColliderPlan& link) {
        return add_node(world, info, motion, mass, {&link, 1});
    });
}

void set_cable_mass(World& world, const Cable& cable, uint32_t i) {
    const uint32_t node = cable.node[i];
    const NodeInfo& info = world.nodes.info[node];
    const double length = share_of(cable, i);
    if (moves_by_forces(info.kind)) {
        world.nodes.mass.reserve_values(1);
        world.nodes.mass.set(node, mass_of(cable, length, info.kind));
    }
    if (!links(cable)) return;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        world.shapes[world.colliders.record[c].shape].shape = shape_of(cable, length);
    });
}

void drop_cable_node(World& world, uint32_t node) {
    wake(world, node);
    forget_pairs(world.pairs, world.nodes, world.colliders, ends_on(node));
    while (world.nodes.info[node].collider != kNone) drop_capsule(world, world.nodes.info[node].collider);
    world.nodes.remove(node);
}

void add_segment(World& world, const Cable& cable, uint32_t node, uint32_t next, double length) {
    with_capsule(world, cable, length, [&](ColliderPlan& capsule) {
        capsule.node = node;
        capsule.node_b = next;
        return add_collider(world, capsule);
    });
}

void tie_segment(World& world, const Cable& cable, uint32_t segment) {
    const uint32_t index = world.nodes.info[cable.node[segment]].collider, next = cable.node[segment + 1];
    if (index == kNone || world.colliders.record[index].node_b == next) return;
    forget_pairs(world.pairs, world.nodes, world.colliders, ends_on_collider(index));
    world.colliders.record[index].node_b = next;
}

void drop_capsule(World& world, uint32_t collider) {
    const uint32_t shape = world.colliders.record[collider].shape;
    remove_collider(world, collider);
    world.shapes.remove(shape);
}

}  // namespace taut
