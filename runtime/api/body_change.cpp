// What forces do to a body, and what a body is, changed at run time.
#include <taut/body.h>

#include <vector>

#include "api/body_mass.h"
#include "models/bodies.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

// What cables, cloths and solids are made of belongs to these.
Check& check_whole(Check& check, const World& world, uint32_t node) {
    return check.require(!world.nodes.info[node].is_part(), "body is part of a cable, cloth or solid", TAUT_IN_USE);
}

Check& check_at_large(Check& check, const World& world, uint32_t node) {
    return check.require(!world.nodes.find_frozen(node), "body is in quarantine");
}

Restraint restraint_of(const Nodes& nodes, uint32_t node) {
    const Restraint* const held = nodes.find_restraint(node);
    return held ? *held : Restraint{node, 0, 0, 0, 0};
}

std::vector<ColliderPlan> plans_of(const World& world, uint32_t node) {
    std::vector<ColliderPlan> plans;
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) { plans.push_back(world.colliders.plan(c)); });
    return plans;
}

// Changes what slows a body by act(Restraint&). What is the same does not wake it.
template <class Act>
taut_result restrain(Check& check, taut_body handle, bool of_spin, Act&& act) {
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check_whole(check, world, node)
            .require(!of_spin || world.nodes.info[node].kind != NodeKind::particle,
                     "body is a particle, which does not turn: angular is not 0");
        if (!check) return check.result();
        const Restraint before = restraint_of(world.nodes, node);
        Restraint restraint = before;
        act(restraint);
        if (restraint == before) return TAUT_OK;
        world.nodes.set_restraint(restraint);
        wake(world, node);
        return TAUT_OK;
    });
}

// A cable, cloth or solid, or an attachment.
bool is_held(const World& world, uint32_t node) {
    bool held = false;
    for_each_element(world.elements, [&](const ElementSet&, uint32_t, std::span<const uint32_t> ends) {
        held = held || std::ranges::find(ends, node) != ends.end();
    });
    for (const Joint& joint : world.joints.record) held = held || (joint.inner && ends_on(joint, node));
    return held;
}

void check_shapes_of_dynamic(Check& check, const World& world, uint32_t node) {
    for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
        const collision::ShapeKind shape = world.shapes[world.colliders.record[c].shape].shape.kind;
        check
            .require(shape != collision::ShapeKind::plane,
                     "kind is dynamic, but the body has a plane, which only static and kinematic bodies may have")
            .require(shape != collision::ShapeKind::surface,
                     "kind is dynamic, but the body has a mesh or height field, which only static and kinematic bodies "
                     "may have");
    });
}

bool is_zero(const taut_sym3& m, const taut_vec3& v) {
    return m.xx == 0 && m.yy == 0 && m.zz == 0 && m.xy == 0 && m.xz == 0 && m.yz == 0 && v.x == 0 && v.y == 0 &&
           v.z == 0;
}

}  // namespace

taut_result taut_body_set_kind(taut_body handle, taut_body_kind kind) {
    TAUT_RECORD(taut_body_set_kind, handle, kind);
    constexpr NodeKind kKinds[] = {NodeKind::fixed, NodeKind::kinematic, NodeKind::dynamic};
    Check check(__func__);
    if (!check.choice("kind", kind, TAUT_BODY_DYNAMIC)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind before = world.nodes.info[node].kind, after = kKinds[kind];
        check_whole(check, world, node).require(before != NodeKind::particle, "body is a particle, and stays one");
        if (!check_at_large(check, world, node) || after == before) return check.result();
        NodeMass mass = world.nodes.mass[node];
        const SpareMass* const spare = world.nodes.find_spare(node);
        if (before == NodeKind::dynamic) {
            world.nodes.spares.reserve(world.nodes.spares.size() + 1);  // what may fail comes first
            const SpareMass kept = put_aside(node, mass);
            change_kind(world, node, after, mass);
            world.nodes.set_spare(kept);
            return TAUT_OK;
        }
        if (after == NodeKind::dynamic) {
            check_shapes_of_dynamic(check, world, node);
            if (check && spare) take_back(check, *spare, mass);
            if (check && !spare) set_body_mass(check, world.shapes, plans_of(world, node), mass);
        }
        if (!check) return check.result();
        change_kind(world, node, after, mass);
        if (after == NodeKind::dynamic) world.nodes.drop_spare(node);
        return TAUT_OK;
    });
}

taut_result taut_body_set_enabled(taut_body handle, uint32_t enabled) {
    TAUT_RECORD(taut_body_set_enabled, handle, enabled);
    Check check(__func__);
    if (!check.boolean("enabled", enabled)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (world.nodes.enabled(node) == (enabled != 0)) return TAUT_OK;
        check_whole(check, world, node)
            .require(enabled || !is_held(world, node), "a cable or attachment holds the body", TAUT_IN_USE);
        if (!check) return check.result();
        set_enabled(world, node, enabled != 0);
        return TAUT_OK;
    });
}

taut_result taut_body_get_enabled(taut_body handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.nodes.enabled(node) ? 1 : 0;
        return TAUT_OK;
    });
}

taut_result taut_body_set_mass(taut_body handle, float mass, taut_vec3 centre_of_mass, taut_sym3 inertia) {
    TAUT_RECORD(taut_body_set_mass, handle, mass, centre_of_mass, inertia);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        check_whole(check, world, node);
        if (!check_at_large(check, world, node)) return check.result();
        const NodeMass held = world.nodes.mass[node];
        NodeMass fresh = held;
        if (kind == NodeKind::particle) {
            check.number("mass", mass, kParticleMass)
                .require(is_zero(inertia, centre_of_mass), "body is a particle: centre_of_mass or inertia is not 0");
            fresh.mass = mass;
            fresh.inv_mass = 1 / fresh.mass;
        } else if (check_mass(check, mass, centre_of_mass, inertia)) {
            taut_body_def def{};
            def.mass = mass;
            def.centre_of_mass = centre_of_mass;
            def.inertia = inertia;
            set_body_mass(check, def, world.shapes, plans_of(world, node), fresh);
        }
        if (!check) return check.result();
        world.nodes.mass.reserve_values(1);
        if (!moves_by_forces(kind)) world.nodes.set_spare(put_aside(node, fresh));
        wake(world, node);
        shift_centre(world, node, world.nodes.motion[node].q * (fresh.centre - held.centre));
        world.nodes.mass.set(node, fresh);
        return TAUT_OK;
    });
}

taut_result taut_body_set_damping(taut_body handle, float linear, float angular) {
    TAUT_RECORD(taut_body_set_damping, handle, linear, angular);
    Check check(__func__);
    check.number("linear", linear, kDampingRate).number("angular", angular, kDampingRate);
    return restrain(check, handle, angular != 0, [&](Restraint& of) {
        of.damping = linear;
        of.angular_damping = angular;
    });
}

taut_result taut_body_get_damping(taut_body handle, float* linear, float* angular) {
    return with(__func__, handle, Use::read, [&](const World& world, uint32_t node) {
        const Restraint by = restraint_of(world.nodes, node);
        if (linear) *linear = static_cast<float>(by.damping);
        if (angular) *angular = static_cast<float>(by.angular_damping);
        return TAUT_OK;
    });
}

taut_result taut_body_set_locked_axes(taut_body handle, uint32_t locked_axes) {
    TAUT_RECORD(taut_body_set_locked_axes, handle, locked_axes);
    Check check(__func__);
    if (!check.count("locked_axes", locked_axes, 0, TAUT_LOCK_ALL)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        Nodes& nodes = world.nodes;
        check_whole(check, world, node)
            .require(nodes.info[node].kind != NodeKind::particle, "body is a particle, whose axes are not locked");
        if (!check || nodes.info[node].locks == locked_axes) return check.result();
        nodes.set_locks(node, {static_cast<uint8_t>(locked_axes)});
        nodes.hold(node);
        if (node < nodes.history.size()) nodes.history[node] = {};
        wake(world, node);
        ++world.joints.version;  // blocks order what they solve by what is free
        return TAUT_OK;
    });
}

taut_result taut_body_get_locked_axes(taut_body handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.nodes.info[node].locks;
        return TAUT_OK;
    });
}

taut_result taut_body_set_gravity_scale(taut_body handle, float gravity_scale) {
    TAUT_RECORD(taut_body_set_gravity_scale, handle, gravity_scale);
    Check check(__func__);
    if (!check.number("gravity_scale", gravity_scale, kGravityScale)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (!check_whole(check, world, node)) return check.result();
        if (world.nodes.mass[node].gravity_scale == static_cast<double>(gravity_scale)) return TAUT_OK;
        world.nodes.set_gravity_scale(node, gravity_scale);
        wake(world, node);
        return TAUT_OK;
    });
}

taut_result taut_body_get_gravity_scale(taut_body handle, float* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = static_cast<float>(world.nodes.mass[node].gravity_scale);
        return TAUT_OK;
    });
}

taut_result taut_body_set_max_speed(taut_body handle, float linear, float angular) {
    TAUT_RECORD(taut_body_set_max_speed, handle, linear, angular);
    Check check(__func__);
    check.zero_or("linear", linear, kSpeedLimit).zero_or("angular", angular, kSpeedLimit);
    return restrain(check, handle, angular != 0, [&](Restraint& of) {
        of.most_speed = linear;
        of.most_spin = angular;
    });
}

taut_result taut_body_get_max_speed(taut_body handle, float* linear, float* angular) {
    return with(__func__, handle, Use::read, [&](const World& world, uint32_t node) {
        const Restraint by = restraint_of(world.nodes, node);
        if (linear) *linear = static_cast<float>(by.most_speed);
        if (angular) *angular = static_cast<float>(by.most_spin);
        return TAUT_OK;
    });
}
