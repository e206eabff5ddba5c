// Poses, velocities, forces and impulses of bodies.
#include <taut/body.h>

#include <algorithm>
#include <cstdio>

#include "advance.h"
#include "api/access.h"
#include "models/bodies.h"
#include "publish/publish.h"
#include "sleep/wake.h"
#include "state/joint_reading.h"

using namespace taut;

namespace {

// ---------------------------------------------------------------- check

// A node that forces and impulses move; angular: whether there is any moment, which a particle cannot take.
Check& check_pushable(Check& check, const Nodes& nodes, uint32_t node, bool angular) {
    const NodeKind kind = nodes.info[node].kind;
    check.require(moves_by_forces(kind), "body is not dynamic: forces do not move it");
    check.require(nodes.enabled(node), "body is disabled: nothing moves it");
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

// A kinematic body that is told to stand still has no news for what rests on it.
void give_velocity(World& world, uint32_t node, const Vec3& v, const Vec3& w) {
    NodeMotion& motion = world.nodes.motion[node];
    if (world.nodes.info[node].kind != NodeKind::kinematic || !stands_still(v, w)) wake(world, node);
    set_velocity(motion, v, w);
}

// Over the time of the host's next call. Nothing does not wake a body.
void add_load(World& world, uint32_t node, const Vec3& force, const Vec3& torque) {
    if (force == Vec3::Zero() && torque == Vec3::Zero()) return;
    world.nodes.add_load(node, force, torque);
    wake(world, node);
}

// Adds an impulse [N s] and an angular impulse [N m s] about the centre of mass.
taut_result push(Check& check, World& world, uint32_t node, const Vec3& impulse, const Vec3& angular_impulse) {
    NodeMotion& motion = world.nodes.motion[node];
    const NodeMass& mass = world.nodes.mass[node];
    const Locks locks = world.nodes.locks_of(node);
    Vec3 v = motion.v + mass.inv_mass * impulse;
    Vec3 w = motion.w + (locks.any_angular()
                             ? world.nodes.spin_by(node, motion.q.toRotationMatrix(), angular_impulse)
                             : Vec3(motion.q * (mass.inv_inertia.matrix() * (motion.q.conjugate() * angular_impulse))));
    locks.hold(v, w);
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

taut_result taut_body_get_pose(taut_body handle, taut_pose* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = to_pose(world.nodes.origin(node), world.nodes.motion[node].q);
        return TAUT_OK;
    });
}

taut_result taut_body_set_pose(taut_body handle, const taut_pose* pose) {
    TAUT_RECORD(taut_body_set_pose, handle, pose);
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
        restart_path(world, node);
        wake_about(world, node);
        for_pairs(world.pairs, [&](Pair& pair) {
            if (ends_on(node)(pair)) forget_forces(pair);
        });
        for (Joint& joint : world.joints.record)
            if (ends_on(joint, node)) place_anew(world.nodes, joint);
        return TAUT_OK;
    });
}

taut_result taut_body_get_render_pose(taut_body handle, taut_pose* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const NodePose before = world.nodes.before[node], now = origin_pose(world, node);
        const double t = render_weight(world);
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
    TAUT_RECORD(taut_body_set_velocity, handle, linear, angular);
    Check check(__func__);
    if (!check.bounded("linear", linear, kSpeed).bounded("angular", angular, kSpeed)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        check.require(kind != NodeKind::fixed, "body is static: it has no velocity");
        if (kind == NodeKind::particle) check.zero("angular", angular, "for a particle");
        if (!check) return check.result();
        forget_path(world.nodes, node);
        give_velocity(world, node, to_vec(linear), to_vec(angular));
        world.nodes.hold(node);
        return TAUT_OK;
    });
}

taut_result taut_body_move_kinematic(taut_body handle, const taut_pose* target) {
    TAUT_RECORD(taut_body_move_kinematic, handle, target);
    Check check(__func__);
    if (!check.pointer("target", target)) return check.result();
    if (!check.pose("target.position", "target.rotation", *target)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check.require(world.nodes.info[node].kind == NodeKind::kinematic, "body is not kinematic")
            .require(world.nodes.enabled(node), "body is disabled: nothing moves it");
        if (!check) return check.result();
        const NodePose to{to_vec(target->position), to_quat(target->rotation)};
        const auto [v, w] = speed_between(world.nodes, node, origin_pose(world, node), to, world.def.time_step);
        check.require(v.norm() <= kSpeed.hi, "target.position asks for a speed beyond 1e4 m/s");
        check.require(w.norm() <= kSpeed.hi, "target.rotation asks for an angular speed beyond 1e4 rad/s");
        if (!check) return check.result();
        lead_to(world, node, to);
        give_velocity(world, node, v, w);
        return TAUT_OK;
    });
}

taut_result taut_body_apply_force(taut_body handle, taut_vec3 force, taut_vec3 torque) {
    TAUT_RECORD(taut_body_apply_force, handle, force, torque);
    Check check(__func__);
    if (!check.vector("force", force, kForce).vector("torque", torque, kForce)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const Vec3 moment = to_vec(torque);
        if (!check_pushable(check, world.nodes, node, !moment.isZero(0))) return check.result();
        add_load(world, node, to_vec(force), moment);
        return TAUT_OK;
    });
}

taut_result taut_body_apply_force_at(taut_body handle, taut_vec3 force, taut_pos point) {
    TAUT_RECORD(taut_body_apply_force_at, handle, force, point);
    Check check(__func__);
    if (!check.vector("force", force, kForce).bounded("point", point, kPosition)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const NodeKind kind = world.nodes.info[node].kind;
        if (!check_pushable(check, world.nodes, node, false)) return check.result();
        // A particle is where it is: the point does not matter.
        const Vec3 arm = to_vec(point) - world.nodes.motion[node].x;
        add_load(world, node, to_vec(force), kind != NodeKind::particle ? arm.cross(to_vec(force)) : Vec3::Zero());
        return TAUT_OK;
    });
}

taut_result taut_body_apply_impulse(taut_body handle, taut_vec3 impulse, taut_vec3 angular_impulse) {
    TAUT_RECORD(taut_body_apply_impulse, handle, impulse, angular_impulse);
    Check check(__func__);
    check.vector("impulse", impulse, kForce).vector("angular_impulse", angular_impulse, kForce);
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        const Vec3 moment = to_vec(angular_impulse);
        if (!check_pushable(check, world.nodes, node, !moment.isZero(0))) return check.result();
        return push(check, world, node, to_vec(impulse), moment);
    });
}

taut_result taut_body_apply_impulse_at(taut_body handle, taut_vec3 impulse, taut_pos point) {
    TAUT_RECORD(taut_body_apply_impulse_at, handle, impulse, point);
    Check check(__func__);
    if (!check.vector("impulse", impulse, kForce).bounded("point", point, kPosition)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (!check_pushable(check, world.nodes, node, false)) return check.result();
        // A particle's inverse inertia is zero: the point does not matter.
        const Vec3 arm = to_vec(point) - world.nodes.motion[node].x;
        return push(check, world, node, to_vec(impulse), arm.cross(to_vec(impulse)));
    });
}

taut_result taut_body_get_quarantine(taut_body handle, taut_quarantine_reason* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = public_reason(world.nodes.find_frozen(node));
        return TAUT_OK;
    });
}

taut_result taut_body_release(taut_body handle) {
    TAUT_RECORD(taut_body_release, handle);
    Check check(__func__);
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        if (!check.require(world.nodes.find_frozen(node), "body is in no quarantine")) return check.result();
        world.nodes.mass.reserve_values(1);
        refresh_boxes(world, node);
        forget_pairs(world.pairs, world.nodes, world.colliders, ends_on(node));  // asked anew by the step
        wake_about(world, node);
        world.nodes.let_go(node);
        for (Joint& joint : world.joints.record)
            if (ends_on(joint, node)) place_anew(world.nodes, joint);
        ++world.joints.version;  // blocks have the node again
        return TAUT_OK;
    });
}
