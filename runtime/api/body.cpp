#include <taut/body.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "api/access.h"
#include "api/body_mass.h"
#include "api/collider_def.h"
#include "models/bodies.h"
#include "sleep/wake.h"

using namespace taut;

namespace {

constexpr taut_body_kind kPublicKind[] = {TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC, TAUT_BODY_DYNAMIC, TAUT_BODY_PARTICLE};
constexpr NodeKind kNodeKind[] = {NodeKind::fixed, NodeKind::kinematic, NodeKind::dynamic};

// ---------------------------------------------------------------- check

Check& check_inertia(Check& check, const taut_sym3& m) {
    return check.number("inertia.xx", m.xx, kInertia)
        .number("inertia.yy", m.yy, kInertia)
        .number("inertia.zz", m.zz, kInertia)
        .number("inertia.xy", m.xy, kInertia)
        .number("inertia.xz", m.xz, kInertia)
        .number("inertia.yz", m.yz, kInertia);
}

Check& check_def(Check& check, const taut_body_def& def) {
    check.struct_size(def.struct_size, sizeof def)
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
        .number("density", def.density, kDensity)
        .zero_or("mass", def.mass, kBodyMass)
        .vector("centre_of_mass", def.centre_of_mass, kShapeCoordinate);
    check_asks(check, "collider_flags", def.collider_flags, def.contact_events);
    check_inertia(check, def.inertia).number("gravity_scale", def.gravity_scale, kGravityScale);
    if (def.collider_count > 0) check.pointer("colliders", def.colliders);
    if (!check) return check;
    char scope[32];
    for (uint32_t i = 0; i < def.collider_count; ++i) {
        std::snprintf(scope, sizeof scope, "colliders[%u].", i);
        check_collider_def(check.within(scope), def.colliders[i]);
        if (!check) return check;
    }
    return check.within("");
}

// A node that forces and impulses move; angular: whether there is any moment, which a particle cannot take.
Check& check_pushable(Check& check, NodeKind kind, bool angular) {
    check.require(moves_by_forces(kind), "body is not dynamic: forces do not move it");
    return check.require(kind != NodeKind::particle || !angular, "body is a particle, which takes no torque");
}

// The stride of an array of entries of this size: 0 means packed.
size_t check_stride(Check& check, const char* wrong, size_t stride, size_t entry, size_t alignment) {
    if (stride == 0) return entry;
    check.require(stride >= entry && stride % alignment == 0, wrong);
    return stride;
}

template <class Entry>
Entry& at_stride(Entry* first, uint32_t index, size_t stride) {
    return *reinterpret_cast<Entry*>(reinterpret_cast<unsigned char*>(first) + index * stride);
}

// ---------------------------------------------------------------- act

taut_pose to_pose(const Vec3& position, const Quat& rotation) { return {to_pos(position), to_quat(rotation), {0, 0}}; }

void set_velocity(NodeMotion& motion, const Vec3& v, const Vec3& w) {
    motion.v = motion.slow_v = v;
    motion.w = motion.slow_w = w;
}

// A kinematic body that is told to stand still has no news for what rests on it.
void give_velocity(World& world, uint32_t node, const Vec3& v, const Vec3& w) {
    NodeMotion& motion = world.nodes.motion[node];
    if (world.nodes.info[node].kind != NodeKind::kinematic || !stands_still(v, w)) wake(world, node);
    set_velocity(motion, v, w);
}

// Of the next step. Nothing does not wake a body.
void add_load(World& world, uint32_t node, const Vec3& force, const Vec3& torque) {
    if (force == Vec3::Zero() && torque == Vec3::Zero()) return;
    world.nodes.add_load(node, force, torque);
    wake(world, node);
}

taut_result add_body(Check& check, World& world, const NodeInfo& info, const NodeMotion& motion, const NodeMass& mass,
                     std::span<const ColliderPlan> colliders, taut_body* out) {
    taut_result room = room_for_bodies(check.call(), world, 1);
    if (room == TAUT_OK) room = room_for_colliders(check.call(), world, colliders.size());
    if (room != TAUT_OK) return room;
    NodeInfo own = info;
    own.continuous = world.def.continuous != 0;
    *out = world.body_handle(add_node(world, own, motion, mass, colliders));
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
        const taut_result made = make_collider(check, world, kind, def.colliders[i], out.emplace_back());
        if (made != TAUT_OK) return made;
    }
    return TAUT_OK;
}

// Rotation vector of q, at most pi long [rad]. By Newton's iteration on rotation_from_vector, whose bits no C
// library decides: the remainder turns about the same axis by an angle e, and 2 sin(e/2) of it is taken off.
Vec3 rotation_vector(const Quat& q) {
    Vec3 theta = Vec3::Zero();
    for (int i = 0; i < 6; ++i) {
        const Quat left = q * rotation_from_vector(theta).conjugate();
        theta += (left.w() < 0 ? -2.0 : 2.0) * left.vec();
    }
    return theta;
}

// Adds an impulse [N s] and an angular impulse [N m s] about the centre of mass.
taut_result push(Check& check, World& world, uint32_t node, const Vec3& impulse, const Vec3& angular_impulse) {
    NodeMotion& motion = world.nodes.motion[node];
    const NodeMass& mass = world.nodes.mass[node];
    const Vec3 v = motion.v + mass.inv_mass * impulse;
    const Vec3 w = motion.w + motion.q * (mass.inv_inertia.matrix() * (motion.q.conjugate() * angular_impulse));
    // A body beyond the limit may still be slowed.
    const auto within = [](double speed, double before) { return speed <= std::max(kSpeed.hi, before); };
    check.require(within(v.norm(), motion.v.norm()), "impulse gives a speed beyond 1e4 m/s");
    check.require(within(w.norm(), motion.w.norm()), "impulse gives an angular speed beyond 1e4 rad/s");
    if (!check) return check.result();
    wake(world, node);
    motion.v = v;
    motion.w = w;
    return TAUT_OK;
}

}  // namespace

void taut_body_def_init(taut_body_def* def) {
    if (!def) return;
    *def = {};
    def->struct_size = sizeof *def;
    def->kind = TAUT_BODY_DYNAMIC;
    def->rotation = {0, 0, 0, 1};
    def->material = kDefaultMaterial;
    def->filter = kDefaultFilter;
    def->density = 1000;
    def->gravity_scale = 1;
}

void taut_particle_def_init(taut_particle_def* def) {
    if (!def) return;
    *def = {};
    def->struct_size = sizeof *def;
    def->mass = 1;
    def->gravity_scale = 1;
    def->material = kDefaultMaterial;
    def->filter = kDefaultFilter;
}

taut_result taut_world_add_body(taut_world handle, const taut_body_def* def, taut_body* out) {
    Check check(__func__);
    if (!check.pointer("def", def).pointer("out", out)) return check.result();
    if (!check_def(check, *def)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        NodeInfo info;
        info.kind = kNodeKind[def->kind];
        info.user_data = def->user_data;
        std::vector<ColliderPlan> colliders;
        const taut_result made = make_colliders(check, world, info.kind, *def, colliders);
        if (made != TAUT_OK) return made;
        NodeMass mass;
        mass.gravity_scale = def->gravity_scale;
        if (info.kind == NodeKind::dynamic) {
            set_body_mass(check, *def, world.shapes, colliders, mass);
            if (!check) return check.result();
        }
        NodeMotion motion;
        motion.q = to_quat(def->rotation);
        motion.x = to_vec(def->position) + motion.q * mass.centre;
        set_velocity(motion, to_vec(def->linear_velocity), to_vec(def->angular_velocity));
        return add_body(check, world, info, motion, mass, colliders, out);
    });
}

taut_result taut_world_add_particle(taut_world handle, const taut_particle_def* def, taut_body* out) {
    Check check(__func__);
    if (!check.pointer("def", def).pointer("out", out)) return check.result();
    check.struct_size(def->struct_size, sizeof *def)
        .number("mass", def->mass, kParticleMass)
        .bounded("position", def->position, kPosition)
        .bounded("velocity", def->velocity, kSpeed)
        .number("gravity_scale", def->gravity_scale, kGravityScale);
    check_material(check, kMaterialInDef, def->material).zero("filter.reserved", def->filter.reserved);
    check_asks(check, "collider_flags", def->collider_flags, def->contact_events);
    if (!check) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        const bool has_shape = def->shape.bits != 0;
        ColliderPlan collider;
        if (has_shape) {
            const taut_result made = make_collider(check, world, NodeKind::particle, own_collider(*def, 0), collider);
            if (made != TAUT_OK) return made;
        }
        NodeMass mass;
        mass.mass = def->mass;
        mass.inv_mass = 1 / mass.mass;
        mass.gravity_scale = def->gravity_scale;
        mass.isotropic = true;
        NodeMotion motion;
        motion.x = to_vec(def->position);
        set_velocity(motion, to_vec(def->velocity), Vec3::Zero());
        NodeInfo info;
        info.kind = NodeKind::particle;
        info.user_data = def->user_data;
        return add_body(check, world, info, motion, mass, {&collider, has_shape ? 1u : 0u}, out);
    });
}

taut_result taut_body_remove(taut_body handle) {
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check.require(world.nodes.info[node].cable == kNone, "body is part of a cable, which is removed as a whole",
                      TAUT_IN_USE);
        if (!check) return check.result();
        remove_node(world, node);
        return TAUT_OK;
    });
}

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
    return with(__func__, handle, Use::write, [&](World& world, uint32_t node) {
        world.nodes.info[node].user_data = value;
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
    Check check(__func__);
    if (!check.count("contact_events", contact_events, 0, TAUT_CONTACT_EVENTS_ALL)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        for_colliders(world.nodes, world.colliders, node,
                      [&](uint32_t c) { ask_for(world.colliders.change(c), TAUT_CONTACT_EVENTS_ALL, contact_events); });
        return TAUT_OK;
    });
}

taut_result taut_body_set_continuous(taut_body handle, uint32_t continuous) {
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

taut_result taut_body_get_pose(taut_body handle, taut_pose* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = to_pose(world.nodes.origin(node), world.nodes.motion[node].q);
        return TAUT_OK;
    });
}

taut_result taut_body_set_pose(taut_body handle, const taut_pose* pose) {
    Check check(__func__);
    if (!check.pointer("pose", pose)) return check.result();
    if (!check.pose("position", "rotation", *pose)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        NodeMotion& motion = world.nodes.motion[node];
        const NodeInfo& info = world.nodes.info[node];
        const NodeMotion old = motion;
        if (info.kind != NodeKind::particle) motion.q = to_quat(pose->rotation);
        motion.x = to_vec(pose->position) + motion.q * world.nodes.mass[node].centre;
        set_velocity(motion, motion.v, motion.w);
        try {
            refresh_boxes(world, node);
        } catch (...) {
            motion = old;
            throw;
        }
        world.nodes.before[node] = origin_pose(world, node);  // no streak while rendering between the two
        wake(world, node);
        wake_near(world, node);
        for_pairs(world.pairs, [&](Pair& pair) {
            if (ends_on(node)(pair)) std::fill(std::begin(pair.impulse), std::end(pair.impulse), Impulse{});
        });
        return TAUT_OK;
    });
}

taut_result taut_body_get_render_pose(taut_body handle, taut_pose* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const NodePose before = world.nodes.before[node], now = origin_pose(world, node);
        const double t = std::clamp(world.accumulator / world.def.time_step, 0.0, 1.0);
        const Vec3 position = before.position + t * (now.position - before.position);
        // Linear and normalised, the short way round.
        const double sign = before.rotation.dot(now.rotation) < 0 ? -1 : 1;
        Quat rotation;
        rotation.coeffs() = (1 - t) * before.rotation.coeffs() + sign * t * now.rotation.coeffs();
        *out = to_pose(position, rotation.normalized());
        return TAUT_OK;
    });
}

taut_result taut_body_get_velocity(taut_body handle, taut_vec3* linear, taut_vec3* angular) {
    return with(__func__, handle, Use::read, [&](const World& world, uint32_t node) {
        if (linear) *linear = to_vec3(world.nodes.motion[node].v);
        if (angular) *angular = to_vec3(world.nodes.motion[node].w);
        return TAUT_OK;
    });
}

taut_result taut_world_get_body_states(taut_world handle, const taut_body* bodies, uint32_t count, taut_pose* poses,
                                       size_t pose_stride, taut_vec3* linear, size_t linear_stride, taut_vec3* angular,
                                       size_t angular_stride) {
    Check check(__func__);
    if (count > 0) check.pointer("bodies", bodies);
    pose_stride = check_stride(check, "pose_stride is too small or not a multiple of 8", pose_stride, sizeof *poses, 8);
    linear_stride =
        check_stride(check, "linear_stride is too small or not a multiple of 4", linear_stride, sizeof *linear, 4);
    angular_stride =
        check_stride(check, "angular_stride is too small or not a multiple of 4", angular_stride, sizeof *angular, 4);
    if (!check) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        const Nodes& nodes = world.nodes;
        for (uint32_t i = 0; i < count; ++i) {
            uint32_t node;
            if (const taut_result found = find_body(check.call(), "bodies", world, bodies[i], node); found != TAUT_OK) {
                char field[32];
                std::snprintf(field, sizeof field, "bodies[%u]", i);
                return find_body(check.call(), field, world, bodies[i], node);
            }
        }
        for (uint32_t i = 0; i < count; ++i) {
            HandleBits bits{};
            unpack_handle(bodies[i].bits, bits);
            const NodeMotion& motion = nodes.motion[bits.index];
            if (poses) at_stride(poses, i, pose_stride) = to_pose(nodes.origin(bits.index), motion.q);
            if (linear) at_stride(linear, i, linear_stride) = to_vec3(motion.v);
            if (angular) at_stride(angular, i, angular_stride) = to_vec3(motion.w);
        }
        return TAUT_OK;
    });
}

taut_result taut_body_set_velocity(taut_body handle, taut_vec3 linear, taut_vec3 angular) {
    Check check(__func__);
    if (!check.bounded("linear", linear, kSpeed).bounded("angular", angular, kSpeed)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        check.require(kind != NodeKind::fixed, "body is static: it has no velocity");
        if (kind == NodeKind::particle) check.zero("angular", angular, "for a particle");
        if (!check) return check.result();
        give_velocity(world, node, to_vec(linear), to_vec(angular));
        return TAUT_OK;
    });
}

taut_result taut_body_move_kinematic(taut_body handle, const taut_pose* target) {
    Check check(__func__);
    if (!check.pointer("target", target)) return check.result();
    if (!check.pose("target.position", "target.rotation", *target)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (!check.require(world.nodes.info[node].kind == NodeKind::kinematic, "body is not kinematic")) {
            return check.result();
        }
        NodeMotion& motion = world.nodes.motion[node];
        const double dt = world.def.time_step;
        const Quat q = to_quat(target->rotation);
        const Vec3 v = (to_vec(target->position) + q * world.nodes.mass[node].centre - motion.x) / dt;
        const Vec3 w = rotation_vector(q * motion.q.conjugate()) / dt;
        check.require(v.norm() <= kSpeed.hi, "target.position asks for a speed beyond 1e4 m/s");
        check.require(w.norm() <= kSpeed.hi, "target.rotation asks for an angular speed beyond 1e4 rad/s");
        if (!check) return check.result();
        give_velocity(world, node, v, w);
        return TAUT_OK;
    });
}

taut_result taut_body_apply_force(taut_body handle, taut_vec3 force, taut_vec3 torque) {
    Check check(__func__);
    if (!check.vector("force", force, kForce).vector("torque", torque, kForce)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const Vec3 moment = to_vec(torque);
        if (!check_pushable(check, world.nodes.info[node].kind, !moment.isZero(0))) return check.result();
        add_load(world, node, to_vec(force), moment);
        return TAUT_OK;
    });
}

taut_result taut_body_apply_force_at(taut_body handle, taut_vec3 force, taut_pos point) {
    Check check(__func__);
    if (!check.vector("force", force, kForce).bounded("point", point, kPosition)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        if (!check_pushable(check, kind, false)) return check.result();
        // A particle is where it is: the point does not matter.
        const Vec3 arm = to_vec(point) - world.nodes.motion[node].x;
        add_load(world, node, to_vec(force), kind != NodeKind::particle ? arm.cross(to_vec(force)) : Vec3::Zero());
        return TAUT_OK;
    });
}

taut_result taut_body_apply_impulse(taut_body handle, taut_vec3 impulse, taut_vec3 angular_impulse) {
    Check check(__func__);
    check.vector("impulse", impulse, kForce).vector("angular_impulse", angular_impulse, kForce);
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const Vec3 moment = to_vec(angular_impulse);
        if (!check_pushable(check, world.nodes.info[node].kind, !moment.isZero(0))) return check.result();
        return push(check, world, node, to_vec(impulse), moment);
    });
}

taut_result taut_body_apply_impulse_at(taut_body handle, taut_vec3 impulse, taut_pos point) {
    Check check(__func__);
    if (!check.vector("impulse", impulse, kForce).bounded("point", point, kPosition)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (!check_pushable(check, world.nodes.info[node].kind, false)) return check.result();
        // A particle's inverse inertia is zero: the point does not matter.
        const Vec3 arm = to_vec(point) - world.nodes.motion[node].x;
        return push(check, world, node, to_vec(impulse), arm.cross(to_vec(impulse)));
    });
}
