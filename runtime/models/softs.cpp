#include "models/softs.h"

#include <algorithm>
#include <cmath>

#include "models/attachments.h"
#include "models/bodies.h"
#include "models/tethers.h"
#include "sleep/wake.h"

namespace taut {
namespace {

constexpr int32_t kFirstSoftGroup = -1500000001;  // of vertices that do not collide with each other

NodeMass mass_of_vertex(const Soft& soft, uint32_t vertex) {
    NodeMass mass;
    mass.gravity_scale = soft.gravity_scale;
    mass.mass = soft.mass[vertex];
    mass.inv_mass = 1 / mass.mass;
    mass.isotropic = true;
    return mass;
}

void add_vertices(World& world, uint32_t index, const SoftPlan& plan) {
    Soft& soft = world.softs.record[index];
    ColliderPlan sphere;
    if (plan.radius > 0) {
        collision::Shape shape;
        shape.kind = collision::ShapeKind::sphere;
        shape.size = {static_cast<float>(plan.radius), 0, 0};
        sphere.shape = soft.shape = world.shapes.add_inner(shape);
        sphere.traits = plan.traits;
        if (sphere.traits.filter.group == 0) sphere.traits.filter.group = kFirstSoftGroup - static_cast<int32_t>(index);
    }
    // A solid without a surface is touched at each vertex.
    Array<uint8_t> outside(plan.position.size(), soft.triangle.empty() ? 1 : 0, soft.node.get_allocator());
    for (const uint32_t vertex : soft.triangle) outside[vertex] = 1;
    soft.node.reserve(plan.position.size());
    NodeInfo info;
    info.kind = NodeKind::particle;
    info.soft = index;
    info.continuous = world.def.continuous != 0;
    info.user_data = soft.user_data;
    for (uint32_t v = 0; v < plan.position.size(); ++v) {
        NodeMotion motion;
        motion.x = plan.position[v];
        const std::span<const ColliderPlan> spheres(&sphere, plan.radius > 0 && outside[v] ? 1 : 0);
        soft.node.push_back(add_node(world, info, motion, mass_of_vertex(soft, v), spheres));
    }
}

Swing swing_of(const World& world, const ElementSet& set, uint32_t element) {
    const auto nodes = set.nodes_of(element);
    Pose x[kMaxNodes];
    double inverse[kMaxNodes];
    for (size_t n = 0; n < nodes.size(); ++n) {
        x[n].x = world.nodes.motion[nodes[n]].x;
        inverse[n] = world.nodes.mass[nodes[n]].inv_mass;
    }
    return swing_of(set.type->row, set.stiffness, set.data_of(element), set.softness[element], x, inverse);
}

// What fused sweeps of a set yield from the start. Those that are to be resolved are about as stiff as the material in
// substeps of 1 / rate, which they take where the world's step has room for so many; what is stiffer counts as rigid.
// Others shake beyond their tolerance: an element that the shortest substeps do not hold is as soft as these do.
void begin_yield(const World& world, bool resolved, ElementSet& set) {
    const uint32_t most_substeps = world.def.fixed_substeps != 0 ? world.least_substeps() : kMostElasticSubsteps;
    const double shortest = static_cast<double>(world.def.time_step) / most_substeps;
    Swing most;
    for (uint32_t e = 0; e < set.size(); ++e) {
        const Swing each = swing_of(world, set, e);
        const double over = resolved ? 1 : std::max(1.0, each.yield * shortest * shortest / set.tolerance);
        set.softness[e] *= over;
        most.yield = std::max(most.yield, each.yield / over);
        most.rate = std::max(most.rate, each.rate / over);
    }
    if (resolved && most.rate * shortest * shortest <= 1) set.least_yield = set.tolerance * most.rate;
    set.yield = std::max(set.least_yield, most.yield);
}

void add_elements(World& world, Soft& soft, const ElementPlan& plan) {
    const auto nodes = static_cast<uint32_t>(plan.type->row.nodes), numbers = static_cast<uint32_t>(plan.type->numbers);
    const auto rows = static_cast<size_t>(plan.type->row.rows), count = plan.softness.size();
    const uint32_t index = world.elements.add(*plan.type);
    soft.sets.push_back({index, plan.part});
    ElementSet& set = world.elements.set[index];
    set.form = plan.form;
    set.solve = plan.solve;
    set.fused = plan.solve == JointSolve::swept && plan.type->sweep != nullptr;
    set.stage = plan.stage;
    set.tolerance = plan.tolerance;
    set.pulls = plan.pulls;
    set.collide_connected = true;  // a group keeps the vertices apart
    set_compliance(set, {plan.compliance, rows * rows}, plan.relaxation + plan.rayleigh);
    set.rayleigh = plan.rayleigh;
    reserve_elements(set, static_cast<uint32_t>(count));
    for (uint32_t e = 0; e < count; ++e) {
        uint32_t node[kMaxNodes];
        for (uint32_t n = 0; n < nodes; ++n) node[n] = soft.node[plan.vertex[e * nodes + n]];
        world.elements.insert(set, e, {node, nodes}, plan.softness[e]);
        std::copy_n(&plan.data[size_t{e} * numbers], numbers, set.data_of(e));
    }
    if (set.fused && set.tolerance > 0) begin_yield(world, plan.resolved, set);
    if (soft.tear_strain > 0) soft.corner.insert(soft.corner.end(), plan.corner.begin(), plan.corner.end());
}

}  // namespace

Swing swing_of(const ConstraintType& row, const double* stiffness, const double* data, double softness, const Pose* x,
               const double* inverse_mass) {
    double c[kMaxRows], j[kMaxNodes * kMaxRows * kDof];
    row.evaluate(data, x, c, j);
    Swing most;
    for (int r = 0; r < row.rows; ++r) {
        double force = 0, moves = 0;
        for (int k = 0; k < row.rows; ++k) force += stiffness[r * row.rows + k] * c[k] / softness;
        for (int n = 0; n < row.nodes; ++n)
            moves += inverse_mass[n] * Vec3::Map(j + (n * row.rows + r) * kDof).squaredNorm();
        most.yield = std::max(most.yield, moves * std::abs(force));
        most.rate = std::max(most.rate, moves * stiffness[r * (row.rows + 1)] / softness);
    }
    return most;
}

uint32_t add_soft(World& world, const SoftPlan& plan) {
    Soft soft(world.memory);
    soft = plan.soft;
    soft.sets.reserve(plan.element.size());
    const uint32_t index = world.softs.add(std::move(soft));
    try {
        add_vertices(world, index, plan);
        for (const ElementPlan& element : plan.element) add_elements(world, world.softs.record[index], element);
    } catch (...) {
        remove_soft(world, index);  // no pairs yet: does not throw
        throw;
    }
    return index;
}

void remove_soft(World& world, uint32_t index) {
    const auto own = [&](uint32_t node) { return node != kNone && world.nodes.info[node].soft == index; };
    // What may fail comes first.
    reserve_ended(world.pairs, [&](const PairEnds& pair) { return own(pair.a) || own(pair.b); });
    Soft& soft = world.softs.record[index];
    for (const uint32_t node : soft.node) wake(world, node);  // and what it is tied to
    for (uint32_t joint = 0; joint < world.joints.ids.slots(); ++joint) {
        if (!world.joints.ids.live(joint)) continue;
        const auto nodes = world.joints.record[joint].ends();
        if (std::any_of(nodes.begin(), nodes.end(), own)) world.joints.remove(joint);
    }
    drop_attachments(world, own);
    for (const SoftSet& set : soft.sets) world.elements.remove(set.set);
    for (const uint32_t node : soft.node) drop_node(world, node);
    if (soft.shape != kNone) world.shapes.remove(soft.shape);
    world.softs.remove(index);
}

void pin_vertex(World& world, const Soft& soft, uint32_t vertex, bool pinned) {
    const uint32_t node = soft.node[vertex];
    if (pinned == is_pinned(world, soft, vertex)) return;
    world.nodes.mass.reserve_values(1);
    TetherPlan tethers(world.memory);
    plan_tethers(world, soft, vertex, pinned, tethers);
    forget_pairs(world.pairs, world.nodes, world.colliders, ends_on(node));
    wake(world, node);
    NodeMass mass = mass_of_vertex(soft, vertex);
    if (pinned) mass.mass = mass.inv_mass = 0;
    world.nodes.mass.set(node, mass);
    world.nodes.info[node].kind = pinned ? NodeKind::kinematic : NodeKind::particle;
    if (pinned) set_velocity(world.nodes.motion[node], Vec3::Zero(), Vec3::Zero());
    world.nodes.clear_load(node);
    set_tethers(world, soft, tethers);
    wake(world, node);
}

bool is_pinned(const World& world, const Soft& soft, uint32_t vertex) {
    return world.nodes.info[soft.node[vertex]].kind == NodeKind::kinematic;
}

}  // namespace taut
