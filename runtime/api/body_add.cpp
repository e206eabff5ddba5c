// Bodies and particles come and go.
#include <taut/body.h>

#include <cstdio>
#include <vector>

#include "api/body_mass.h"
#include "api/collider_def.h"
#include "api/sized.h"
#include "models/bodies.h"

using namespace taut;

namespace {

constexpr NodeKind kNodeKind[] = {NodeKind::fixed, NodeKind::kinematic, NodeKind::dynamic};

// One of a body's, which lie as far apart as the first of them says that it is long.
bool take_collider(Check& check, const taut_body_def& def, uint32_t i, taut_collider_def& out) {
    const size_t stride = def.colliders[0].struct_size;
    const auto* const at = reinterpret_cast<const std::byte*>(def.colliders) + i * stride;
    return take_def(check, reinterpret_cast<const taut_collider_def*>(at), taut_collider_def_init, out);
}

Check& check_def(Check& check, const taut_body_def& def) {
    check
        .choice("kind", def.kind, TAUT_BODY_DYNAMIC)  // a particle has its own def
        .bounded("position", def.position, kPosition)
        .rotation("rotation", def.rotation)
        .bounded("linear_velocity", def.linear_velocity, kSpeed)
        .bounded("angular_velocity", def.angular_velocity, kSpeed);
    if (check && def.kind == TAUT_BODY_STATIC) {
        check.zero("linear_velocity", def.linear_velocity, "for a static body")
            .zero("angular_velocity", def.angular_velocity, "for a static body");
    }
    check_material(check, kMaterialInDef, def.material)
        .zero("filter.reserved", def.filter.reserved)
        .number("density", def.density, kDensity);
    check_mass(check, def.mass, def.centre_of_mass, def.inertia);
    check_asks(check, "collider_flags", def.collider_flags, def.contact_events)
        .number("gravity_scale", def.gravity_scale, kGravityScale)
        .number("linear_damping", def.linear_damping, kDampingRate)
        .number("angular_damping", def.angular_damping, kDampingRate)
        .zero_or("max_linear_speed", def.max_linear_speed, kSpeedLimit)
        .zero_or("max_angular_speed", def.max_angular_speed, kSpeedLimit)
        .count("locked_axes", def.locked_axes, 0, TAUT_LOCK_ALL);
    if (def.collider_count > 0) check.pointer("colliders", def.colliders);
    if (!check) return check;
    char scope[32];
    for (uint32_t i = 0; i < def.collider_count; ++i) {
        std::snprintf(scope, sizeof scope, "colliders[%u].", i);
        taut_collider_def collider;
        if (!take_collider(check.within(scope), def, i, collider) || !check_collider_def(check, collider)) return check;
    }
    return check.within("");
}

taut_result add_body(Check& check, World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass,
                     std::span<const ColliderPlan> colliders, Restraint restraint, Locks locks, taut_body* out) {
    taut_result room = room_for_bodies(check.call(), world, 1);
    if (room == TAUT_OK) room = room_for_colliders(check.call(), world, colliders.size());
    if (room != TAUT_OK) return room;
    NodeInfo own = info;
    own.continuous = world.def.continuous != 0;
    if (restraint.any()) reserve_more(world.nodes.restraints, 1);  // what may fail comes first
    if (locks.any()) reserve_more(world.nodes.locked, 1);
    restraint.node = add_node(world, own, motion, mass, colliders);
    world.nodes.set_restraint(restraint);
    world.nodes.set_locks(restraint.node, locks);
    world.nodes.hold(restraint.node);
    *out = world.body_handle(restraint.node);
    return TAUT_OK;
}

// The collider that a def's own shape, material and filter make.
template <class Def>
taut_collider_def own_collider(const Def& def, float density) {
    taut_collider_def own;
    taut_collider_def_init(&own);
    own.density = density;
    own.shape = def.shape;
    own.material = def.material;
    own.filter = def.filter;
    own.user_data = def.user_data;
    own.flags = def.collider_flags;
    own.contact_events = def.contact_events;
    return own;
}

// Of a checked def, its own shape first.
taut_result make_colliders(Check& check, const World& world, NodeKind kind, const taut_body_def& def,
                           std::vector<ColliderPlan>& out) {
    if (def.shape.bits != 0) {
        const taut_result made = make_collider(check, world, kind, own_collider(def, def.density), out.emplace_back());
        if (made != TAUT_OK) return made;
    }
    for (uint32_t i = 0; i < def.collider_count; ++i) {
        taut_collider_def collider;
        if (!take_collider(check, def, i, collider)) return check.result();
        const taut_result made = make_collider(check, world, kind, collider, out.emplace_back());
        if (made != TAUT_OK) return made;
    }
    return TAUT_OK;
}

}  // namespace

void taut_body_def_init_sized(taut_body_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_body_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.kind = TAUT_BODY_DYNAMIC;
        own.rotation = kUnturned;
        own.material = kDefaultMaterial;
        own.filter = kDefaultFilter;
        own.density = 1000;
        own.gravity_scale = 1;
    });
}

void taut_particle_def_init_sized(taut_particle_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_particle_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.mass = 1;
        own.gravity_scale = 1;
        own.material = kDefaultMaterial;
        own.filter = kDefaultFilter;
    });
}

taut_result taut_world_add_body(taut_world handle, const taut_body_def* given, taut_body* out) {
    TAUT_RECORD(taut_world_add_body, handle, given, out);
    Check check(__func__);
    taut_body_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_body_def_init, def))
        return check.result();
    if (!check_def(check, def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        NodeInfo info;
        info.kind = kNodeKind[def.kind];
        info.user_data = def.user_data;
        std::vector<ColliderPlan> colliders;
        const taut_result made = make_colliders(check, world, info.kind, def, colliders);
        if (made != TAUT_OK) return made;
        NodeMass mass;
        mass.gravity_scale = def.gravity_scale;
        if (info.kind == NodeKind::dynamic) {
            set_body_mass(check, def, world.shapes, colliders, mass);
            if (!check) return check.result();
        }
        NodeMotion motion;
        motion.q = to_quat(def.rotation);
        motion.x = to_vec(def.position) + motion.q * mass.centre;
        set_velocity(motion, to_vec(def.linear_velocity), to_vec(def.angular_velocity));
        return add_body(check, world, info, motion, mass, colliders,
                        {kNone, def.linear_damping, def.angular_damping, def.max_linear_speed, def.max_angular_speed},
                        {static_cast<uint8_t>(def.locked_axes)}, out);
    });
}

taut_result taut_world_add_particle(taut_world handle, const taut_particle_def* given, taut_body* out) {
    TAUT_RECORD(taut_world_add_particle, handle, given, out);
    Check check(__func__);
    taut_particle_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_particle_def_init, def))
        return check.result();
    check.number("mass", def.mass, kParticleMass)
        .bounded("position", def.position, kPosition)
        .bounded("velocity", def.velocity, kSpeed)
        .number("gravity_scale", def.gravity_scale, kGravityScale)
        .number("damping", def.damping, kDampingRate)
        .zero_or("max_speed", def.max_speed, kSpeedLimit);
    check_material(check, kMaterialInDef, def.material).zero("filter.reserved", def.filter.reserved);
    check_asks(check, "collider_flags", def.collider_flags, def.contact_events);
    if (!check) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const bool has_shape = def.shape.bits != 0;
        ColliderPlan collider;
        if (has_shape) {
            const taut_result made = make_collider(check, world, NodeKind::particle, own_collider(def, 0), collider);
            if (made != TAUT_OK) return made;
        }
        NodeMass mass;
        mass.mass = def.mass;
        mass.inv_mass = 1 / mass.mass;
        mass.gravity_scale = def.gravity_scale;
        mass.isotropic = true;
        NodeMotion motion;
        motion.x = to_vec(def.position);
        set_velocity(motion, to_vec(def.velocity), Vec3::Zero());
        NodeInfo info;
        info.kind = NodeKind::particle;
        info.user_data = def.user_data;
        return add_body(check, world, info, motion, mass, {&collider, has_shape ? 1u : 0u},
                        {kNone, def.damping, 0, def.max_speed, 0}, {}, out);
    });
}

taut_result taut_body_remove(taut_body handle) {
    TAUT_RECORD(taut_body_remove, handle);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check.require(!world.nodes.info[node].is_part(),
                      "body is part of a cable, cloth or solid, which is removed as a whole", TAUT_IN_USE);
        if (!check) return check.result();
        remove_node(world, node);
        return TAUT_OK;
    });
}
