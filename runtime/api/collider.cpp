#include <taut/collider.h>

#include <utility>
#include <vector>

#include "api/body_mass.h"
#include "api/collider_def.h"
#include "api/sized.h"
#include "detect/detect.h"
#include "models/bodies.h"
#include "queries/queries.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

void set_one_way(const taut_vec3& direction, ColliderTraits& traits, Collider& collider) {
    traits.one_way = to_vec(direction).stableNormalized().cast<float>();  // 0 stays 0
    ask_for(collider, kAsksOneWay, traits.one_way == Vec3f::Zero() ? 0 : kAsksOneWay);
}

// What a refusal calls the fields of taut_friction.
struct FrictionNames {
    const char *static_friction, *slide_factor, *slide_direction, *reserved;
};
constexpr FrictionNames kFrictionAlone{"static_friction", "slide_factor", "slide_direction", "reserved"};
constexpr FrictionNames kFrictionInDef{"friction.static_friction", "friction.slide_factor", "friction.slide_direction",
                                       "friction.reserved"};

Check& check_friction(Check& check, const FrictionNames& names, const taut_friction& friction) {
    return check.number(names.static_friction, friction.static_friction, kFriction)
        .number(names.slide_factor, friction.slide_factor, kUnitInterval)
        .vector(names.slide_direction, friction.slide_direction, kOneWay)
        .zero(names.reserved, friction.reserved);
}

void set_friction(const taut_friction& friction, ColliderTraits& traits) {
    traits.static_friction = friction.static_friction;
    traits.slide_factor = friction.slide_factor;
    traits.slide_direction = to_vec(friction.slide_direction).stableNormalized().cast<float>();  // 0 stays 0
}

}  // namespace

namespace taut {

Check& check_material(Check& check, const MaterialNames& names, const taut_material& material) {
    return check.number(names.friction, material.friction, kFriction)
        .number(names.restitution, material.restitution, kUnitInterval)
        .choice(names.friction_rule, material.friction_rule, TAUT_COMBINE_MAXIMUM)
        .choice(names.restitution_rule, material.restitution_rule, TAUT_COMBINE_MAXIMUM)
        .number(names.rolling_friction, material.rolling_friction, kFrictionArm)
        .number(names.spinning_friction, material.spinning_friction, kFrictionArm);
}

Check& check_asks(Check& check, const char* flags_field, uint32_t flags, uint32_t contact_events) {
    constexpr uint32_t kFlags =
        TAUT_COLLIDER_SENSOR | TAUT_COLLIDER_SENSES_STATIC | TAUT_COLLIDER_PRE_SOLVE | TAUT_COLLIDER_GRAIN;
    return check.count(flags_field, flags, 0, kFlags)
        .count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL);
}

Check& check_collider_def(Check& check, const taut_collider_def& def) {
    check.zero_or("density", def.density, kDensity)
        .vector("position", def.position, kShapeCoordinate)
        .rotation("rotation", def.rotation);
    check_material(check, kMaterialInDef, def.material).zero("filter.reserved", def.filter.reserved);
    check_asks(check, "flags", def.flags, def.contact_events)
        .vector("one_way", def.one_way, kOneWay)
        .zero("reserved", def.reserved);
    return check_friction(check, kFrictionInDef, def.friction);
}

taut_result make_collider(Check& check, const World& world, NodeKind kind, const taut_collider_def& def,
                          ColliderPlan& out) {
    const taut_result found = find_shape(check.call(), "shape", world, def.shape, out.shape);
    if (found != TAUT_OK) return found;
    const collision::ShapeKind shape = world.shapes[out.shape].shape.kind;
    check.require(!moves_by_forces(kind) || shape != collision::ShapeKind::plane,
                  "shape is a plane, which only static and kinematic bodies may have");
    check.require(!moves_by_forces(kind) || shape != collision::ShapeKind::surface,
                  "shape is a mesh or height field, which only static and kinematic bodies may have");
    check.require(kind != NodeKind::particle || shape == collision::ShapeKind::sphere,
                  "shape is not a sphere, the only one that a particle may have");
    out.position = to_vec(def.position);
    out.rotation = to_quat(def.rotation);
    check.require(kind != NodeKind::particle || out.position == Vec3::Zero(), "position is not 0 on a particle");
    check.require(kind == NodeKind::particle || !(def.flags & TAUT_COLLIDER_GRAIN),
                  "flags ask for a grain, which only a particle may be");
    out.traits.density = def.density;
    out.traits.material = def.material;
    out.traits.filter = def.filter;
    out.user_data = def.user_data;
    out.sensor = (def.flags & TAUT_COLLIDER_SENSOR) != 0;
    out.senses_static = (def.flags & TAUT_COLLIDER_SENSES_STATIC) != 0;
    out.grain = (def.flags & TAUT_COLLIDER_GRAIN) && solvers()[world.def.solver]->lanes;
    out.asks = static_cast<uint8_t>(def.contact_events | (def.flags & TAUT_COLLIDER_PRE_SOLVE ? kAsksPreSolve : 0));
    set_one_way(def.one_way, out.traits, out);
    set_friction(def.friction, out.traits);
    return check.result();
}

}  // namespace taut

namespace {

// Colliders of cables, cloths and solids belong to these.
Check& check_own(Check& check, const World& world, uint32_t node) {
    return check.require(!world.nodes.info[node].is_part(), "the body is part of a cable, cloth or solid", TAUT_IN_USE);
}

taut_collider_def def_of(const World& world, uint32_t index) {
    const Collider& collider = world.colliders.record[index];
    const ColliderTraits& traits = world.colliders.traits[index];
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.density = traits.density;
    def.shape = world.shape_handle(collider.shape);
    def.position = to_vec3(collider.position);
    def.rotation = to_quat(collider.rotation);
    def.material = traits.material;
    def.filter = traits.filter;
    def.user_data = collider.user_data;
    def.flags =
        (collider.sensor ? TAUT_COLLIDER_SENSOR : 0) | (collider.senses_static ? TAUT_COLLIDER_SENSES_STATIC : 0) |
        (collider.grain ? TAUT_COLLIDER_GRAIN : 0) | (collider.asks & kAsksPreSolve ? TAUT_COLLIDER_PRE_SOLVE : 0);
    def.contact_events = collider.asks & TAUT_CONTACT_EVENTS_ALL;
    def.one_way = to_vec3(traits.one_way.cast<double>());
    def.friction = {traits.static_friction, traits.slide_factor, to_vec3(traits.slide_direction.cast<double>()), 0};
    return def;
}

// A pair whose surface is none any more keeps one record, without points: it may touch on.
void forget_parts(Pairs& pairs, NearPair& near) {
    if (near.pair == kNone || pairs.list[near.pair].part == 0) return;
    Pair& first = pairs.list[near.pair];
    NearPair others;
    others.pair = std::exchange(first.next, kNone);
    give_slots(pairs, others);
    first.part = 0;
    first.manifold.count = 0;
}

}  // namespace

void taut_collider_def_init_sized(taut_collider_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_collider_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.density = 1000;
        own.rotation = kUnturned;
        own.material = kDefaultMaterial;
        own.filter = kDefaultFilter;
    });
}

taut_result taut_body_add_collider(taut_body handle, const taut_collider_def* given, taut_collider* out) {
    TAUT_RECORD(taut_body_add_collider, handle, given, out);
    Check check(__func__);
    taut_collider_def def;
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, taut_collider_def_init, def))
        return check.result();
    if (!check_collider_def(check, def)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        check.require(kind != NodeKind::particle, "body is a particle, whose shape comes with its def");
        if (!check_own(check, world, node)) return check.result();
        ColliderPlan collider;
        collider.node = node;
        const taut_result made = make_collider(check, world, kind, def, collider);
        if (made != TAUT_OK) return made;
        const taut_result room = room_for_colliders(check.call(), world, 1);
        if (room != TAUT_OK) return room;
        *out = world.collider_handle(add_collider(world, collider));
        wake(world, node);
        return TAUT_OK;
    });
}

taut_result taut_collider_remove(taut_collider handle) {
    TAUT_RECORD(taut_collider_remove, handle);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        if (!check_own(check, world, world.colliders.record[collider].node)) return check.result();
        remove_collider(world, collider);
        return TAUT_OK;
    });
}

int32_t taut_collider_is_valid(taut_collider handle) { return is_valid(handle); }

taut_result taut_body_get_colliders(taut_body handle, taut_collider* colliders, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        uint32_t needed = 0;
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t) { ++needed; });
        *count = needed;
        if (needed > capacity) {
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        }
        if (needed > 0 && !check.pointer("colliders", colliders)) return check.result();
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) { *colliders++ = world.collider_handle(c); });
        return TAUT_OK;
    });
}

taut_result taut_body_set_mass_from_colliders(taut_body handle) {
    TAUT_RECORD(taut_body_set_mass_from_colliders, handle);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check.require(world.nodes.info[node].kind == NodeKind::dynamic, "body is not dynamic");
        if (!check_own(check, world, node)) return check.result();
        std::vector<ColliderPlan> colliders;
        for_colliders(world.nodes, world.colliders, node,
                      [&](uint32_t c) { colliders.push_back(world.colliders.plan(c)); });
        const NodeMass mass = world.nodes.mass[node];
        NodeMass fresh = mass;
        set_body_mass(check, world.shapes, colliders, fresh);
        if (!check) return check.result();
        world.nodes.mass.reserve_values(1);
        wake(world, node);
        shift_centre(world, node, world.nodes.motion[node].q * (fresh.centre - mass.centre));
        world.nodes.mass.set(node, fresh);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_def_sized(taut_collider handle, taut_collider_def* first, uint32_t size) {
    const RecordOut<taut_collider_def> out(first, size);
    Check check("taut_collider_get_def");
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t collider) {
        *out = def_of(world, collider);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_body(taut_collider handle, taut_body* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t collider) {
        *out = world.body_handle(world.colliders.record[collider].node);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_bounds(taut_collider handle, taut_pos* low, taut_pos* high) {
    Check check(__func__);
    if (!check.pointer("low", low).pointer("high", high)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t collider) {
        const Bounds of = bounds_of(world, collider);
        *low = to_pos(of.low);
        *high = to_pos(of.high);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_user_data(taut_collider handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t collider) {
        *out = world.colliders.record[collider].user_data;
        return TAUT_OK;
    });
}

taut_result taut_collider_set_user_data(taut_collider handle, uint64_t value) {
    TAUT_RECORD(taut_collider_set_user_data, handle, value);
    return with(__func__, handle, Use::write, [&](World& world, uint32_t collider) {
        world.colliders.record[collider].user_data = value;
        return TAUT_OK;
    });
}

taut_result taut_collider_set_shape(taut_collider handle, taut_shape shape, taut_vec3 position, taut_quat rotation) {
    TAUT_RECORD(taut_collider_set_shape, handle, shape, position, rotation);
    Check check(__func__);
    check.vector("position", position, kShapeCoordinate).rotation("rotation", rotation);
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Collider& collider = world.colliders.record[index];
        if (!check_own(check, world, collider.node)) return check.result();
        taut_collider_def def = def_of(world, index);
        def.shape = shape;
        def.position = position;
        def.rotation = rotation;
        ColliderPlan changed = world.colliders.plan(index);
        const taut_result made = make_collider(check, world, world.nodes.info[collider.node].kind, def, changed);
        if (made != TAUT_OK) return made;
        if (world.nodes.enabled(collider.node))
            world.broadphase.update(index, contact_box(world.nodes, world.shapes, changed), Vec3f::Zero());
        --world.shapes[collider.shape].users;
        ++world.shapes[changed.shape].users;
        collider = changed;
        world.pairs.forget_place(index);
        wake_about(world, collider.node);
        for_near(world.pairs, [&](NearPair& near) {
            if (near.collider_a() != index && near.collider_b() != index) return;
            near.forget_shapes();
            if (!collision::has_parts(world.shapes[collider.shape].shape)) forget_parts(world.pairs, near);
        });
        return TAUT_OK;
    });
}

taut_result taut_collider_set_material(taut_collider handle, const taut_material* material) {
    TAUT_RECORD(taut_collider_set_material, handle, material);
    Check check(__func__);
    if (!check.pointer("material", material)) return check.result();
    if (!check_material(check, kMaterialAlone, *material)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        world.colliders.change_traits(collider, [&](ColliderTraits& own) { own.material = *material; });
        wake(world, world.colliders.record[collider].node);
        return TAUT_OK;
    });
}

taut_result taut_collider_set_friction(taut_collider handle, const taut_friction* friction) {
    TAUT_RECORD(taut_collider_set_friction, handle, friction);
    Check check(__func__);
    if (!check.pointer("friction", friction)) return check.result();
    if (!check_friction(check, kFrictionAlone, *friction)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        if (!check_own(check, world, world.colliders.record[collider].node)) return check.result();
        world.colliders.change_traits(collider, [&](ColliderTraits& own) { set_friction(*friction, own); });
        wake(world, world.colliders.record[collider].node);
        return TAUT_OK;
    });
}

taut_result taut_collider_set_filter(taut_collider handle, const taut_filter* filter) {
    TAUT_RECORD(taut_collider_set_filter, handle, filter);
    Check check(__func__);
    if (!check.pointer("filter", filter)) return check.result();
    if (!check.zero("reserved", filter->reserved)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        if (!check_own(check, world, world.colliders.record[collider].node)) return check.result();
        world.colliders.traits.reserve_values(1);
        wake_about(world, world.colliders.record[collider].node);
        forget_pairs(world.pairs, world.nodes, world.colliders, ends_on_collider(collider));  // asked anew by the step
        world.colliders.change_traits(collider, [&](ColliderTraits& own) { own.filter = *filter; });
        return TAUT_OK;
    });
}

taut_result taut_collider_set_density(taut_collider handle, float density) {
    TAUT_RECORD(taut_collider_set_density, handle, density);
    Check check(__func__);
    if (!check.zero_or("density", density, kDensity)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        world.colliders.change_traits(collider, [&](ColliderTraits& own) { own.density = density; });
        return TAUT_OK;
    });
}

taut_result taut_collider_set_surface_velocity(taut_collider handle, taut_vec3 velocity, taut_vec3 spin) {
    TAUT_RECORD(taut_collider_set_surface_velocity, handle, velocity, spin);
    Check check(__func__);
    if (!check.bounded("velocity", velocity, kSpeed).bounded("spin", spin, kSpeed)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        if (!check_own(check, world, world.colliders.record[index].node)) return check.result();
        world.colliders.change_traits(index, [&](ColliderTraits& own) {
            own.surface_velocity = to_vec(velocity).cast<float>();
            own.surface_spin = to_vec(spin).cast<float>();
        });
        wake(world, world.colliders.record[index].node);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_surface_velocity(taut_collider handle, taut_vec3* velocity, taut_vec3* spin) {
    Check check(__func__);
    if (!check.pointer("velocity", velocity).pointer("spin", spin)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const ColliderTraits& traits = world.colliders.traits[index];
        *velocity = to_vec3(traits.surface_velocity.cast<double>());
        *spin = to_vec3(traits.surface_spin.cast<double>());
        return TAUT_OK;
    });
}

taut_result taut_collider_set_contact_events(taut_collider handle, uint32_t contact_events) {
    TAUT_RECORD(taut_collider_set_contact_events, handle, contact_events);
    Check check(__func__);
    if (!check.count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        ask_for(world.colliders.change(collider), TAUT_CONTACT_EVENTS_ALL, contact_events);
        return TAUT_OK;
    });
}

taut_result taut_collider_set_pre_solve(taut_collider handle, int32_t pre_solve) {
    TAUT_RECORD(taut_collider_set_pre_solve, handle, pre_solve);
    Check check(__func__);
    if (!check.boolean("pre_solve", static_cast<uint32_t>(pre_solve))) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        ask_for(world.colliders.change(collider), kAsksPreSolve, pre_solve ? kAsksPreSolve : 0);
        wake_about(world, world.colliders.record[collider].node);
        return TAUT_OK;
    });
}

taut_result taut_collider_set_one_way(taut_collider handle, taut_vec3 direction) {
    TAUT_RECORD(taut_collider_set_one_way, handle, direction);
    Check check(__func__);
    if (!check.vector("direction", direction, kOneWay)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t collider) {
        world.colliders.change_traits(
            collider, [&](ColliderTraits& own) { set_one_way(direction, own, world.colliders.record[collider]); });
        wake_about(world, world.colliders.record[collider].node);
        return TAUT_OK;
    });
}
