// What forces do to a body, and what a body is, changed at run time.
#include <taut/body.h>

#include "api/access.h"
#include "models/bodies.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

// What cables, cloths and solids are made of belongs to these.
Check& check_whole(Check& check, const World& world, uint32_t node) {
    return check.require(!world.nodes.info[node].is_part(), "body is part of a cable, cloth or solid", TAUT_IN_USE);
}

Restraint restraint_of(const Nodes& nodes, uint32_t node) {
    const Restraint* const held = nodes.find_restraint(node);
    return held ? *held : Restraint{node, 0, 0, 0, 0};
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

}  // namespace

taut_result taut_body_set_enabled(taut_body handle, uint32_t enabled) {
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

taut_result taut_body_set_damping(taut_body handle, float linear, float angular) {
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

taut_result taut_body_set_gravity_scale(taut_body handle, float gravity_scale) {
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
