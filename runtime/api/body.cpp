// What a body is and is made of; body_motion.cpp has how it moves.
#include <taut/body.h>

#include <string.h>

#include <algorithm>
#include <array>

#include "api/access.h"
#include "api/collider_def.h"
#include "models/bodies.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

constexpr taut_body_kind kPublicKind[] = {TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC, TAUT_BODY_PARTICLE};

}  // namespace

int32_t taut_body_is_valid(taut_body handle) { return is_valid(handle); }

taut_result taut_body_get_kind(taut_body handle, taut_body_kind* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = kPublicKind[static_cast<int>(world.nodes.info[node].kind)];
        return TAUT_OK;
    });
}

taut_result taut_body_get_user_data(taut_body handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.nodes.info[node].user_data;
        return TAUT_OK;
    });
}

taut_result taut_body_set_user_data(taut_body handle, uint64_t value) {
    TAUT_RECORD(taut_body_set_user_data, handle, value);
    return with(__func__, handle, Use::write, [&](World& world, uint32_t node) {
        world.nodes.info[node].user_data = value;
        return TAUT_OK;
    });
}

taut_result taut_body_set_name(taut_body handle, const char* name) {
    TAUT_RECORD(taut_body_set_name, handle, name);
    Check check(__func__);
    std::array<char, TAUT_BODY_NAME_SIZE> text{};
    const size_t length = name ? strnlen(name, text.size()) : 0;
    if (!check.require(length < text.size(), "name has 32 bytes or more, expected at most 31")) return check.result();
    std::copy_n(name ? name : "", length, text.begin());
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        world.nodes.set_name(node, text);
        return TAUT_OK;
    });
}

taut_result taut_body_get_name(taut_body handle, char* name, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const char* const held = world.nodes.name_of(node);
        const char* const text = held ? held : "";
        const auto needed = static_cast<uint32_t>(std::strlen(text) + 1);
        *count = needed;
        if (needed > capacity)
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        if (!check.pointer("name", name)) return check.result();
        std::copy_n(text, needed, name);
        return TAUT_OK;
    });
}

taut_result taut_body_get_mass(taut_body handle, float* mass, taut_vec3* centre_of_mass, taut_sym3* inertia) {
    Check check(__func__);
    check.pointer("mass", mass).pointer("centre_of_mass", centre_of_mass).pointer("inertia", inertia);
    if (!check) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const NodeMass& held = world.nodes.mass[node];
        const bool moves = moves_by_forces(world.nodes.info[node].kind);  // a body in quarantine keeps its mass unseen
        *mass = moves ? static_cast<float>(held.mass) : 0.0f;
        *centre_of_mass = to_vec3(held.centre);
        *inertia = moves ? to_sym3(held.inertia) : taut_sym3{};
        return TAUT_OK;
    });
}

taut_result taut_body_get_material(taut_body handle, taut_material* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const uint32_t first = world.nodes.info[node].collider;
        if (!check.require(first != kNone, "body has no collider")) return check.result();
        *out = world.colliders.traits[first].material;
        return TAUT_OK;
    });
}

taut_result taut_body_set_material(taut_body handle, const taut_material* material) {
    TAUT_RECORD(taut_body_set_material, handle, material);
    Check check(__func__);
    if (!check.pointer("material", material)) return check.result();
    if (!check_material(check, kMaterialAlone, *material)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        uint32_t count = 0;
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t) { ++count; });
        world.colliders.traits.reserve_values(count);
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
            world.colliders.change_traits(c, [&](ColliderTraits& own) { own.material = *material; });
        });
        wake(world, node);
        return TAUT_OK;
    });
}

taut_result taut_body_set_contact_events(taut_body handle, uint32_t contact_events) {
    TAUT_RECORD(taut_body_set_contact_events, handle, contact_events);
    Check check(__func__);
    if (!check.count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        for_colliders(world.nodes, world.colliders, node,
                      [&](uint32_t c) { ask_for(world.colliders.change(c), TAUT_CONTACT_EVENTS_ALL, contact_events); });
        return TAUT_OK;
    });
}

taut_result taut_body_set_continuous(taut_body handle, uint32_t continuous) {
    TAUT_RECORD(taut_body_set_continuous, handle, continuous);
    Check check(__func__);
    if (!check.boolean("continuous", continuous)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        world.nodes.info[node].continuous = continuous != 0;
        return TAUT_OK;
    });
}

taut_result taut_body_get_continuous(taut_body handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.nodes.info[node].continuous ? 1 : 0;
        return TAUT_OK;
    });
}
