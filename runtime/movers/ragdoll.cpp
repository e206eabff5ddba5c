// Ragdolls: bodies and joints of a skeleton, and what drives these to the angles of a pose.
#include <taut/ragdoll.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include <taut/joint.h>

#include "advance.h"
#include "api/sized.h"
#include "models/bodies.h"
#include "movers/call_parts.h"

using namespace taut;

namespace {

constexpr double kHalfTurn = 3.1415928;  // [rad], as single precision has it
// About x, the turned y and z; that about y keeps off a quarter of a turn, where the others are undefined.
constexpr double kMostAngle[3] = {kHalfTurn, 1.5, kHalfTurn};
constexpr Range kBoneMass{1e-6, 1e15};      // [kg]
constexpr Range kBoneFrequency{1e-3, 1e3};  // [Hz]
constexpr Range kBoneRatio{0, 1e3};
constexpr Range kBoneTorque{0, 1e24};      // [N m]
constexpr Range kRagdollSeconds{1e-4, 1};  // [s]
constexpr uint32_t kFirstAngle = 3;        // of a six-dof joint's axes

struct BoneFrame {
    Vec3 position = Vec3::Zero();
    Quat rotation = Quat::Identity();

    explicit BoneFrame(const taut_pose& pose) : position(to_vec(pose.position)), rotation(to_quat(pose.rotation)) {}
    BoneFrame(const Vec3& p, const Quat& q) : position(p), rotation(q) {}
    BoneFrame operator*(const BoneFrame& inner) const {
        return {position + rotation * inner.position, (rotation * inner.rotation).normalized()};
    }
    BoneFrame inverse() const { return {-(rotation.conjugate() * position), rotation.conjugate()}; }
    taut_pose pose() const { return {to_pos(position), to_quat(rotation), {0, 0}}; }
    taut_frame frame() const { return {to_pos(position), to_quat(rotation)}; }
};

float part(const taut_vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
bool is_locked(const taut_bone_def& bone, int axis) {
    return part(bone.lower, axis) == 0 && part(bone.upper, axis) == 0;
}

// ---------------------------------------------------------------- check

void check_bone(Check& check, const taut_bone_def& bone, uint32_t number) {
    check.nested(bone.struct_size, sizeof bone)
        .pose("pose.position", "pose.rotation", bone.pose)
        .vector("shape_position", bone.shape_position, kShapeCoordinate)
        .rotation("shape_rotation", bone.shape_rotation)
        .zero_or("mass", bone.mass, kBoneMass)
        .number("friction", bone.friction, kBoneTorque)
        .zero_or("frequency", bone.frequency, kBoneFrequency)
        .number("damping_ratio", bone.damping_ratio, kBoneRatio)
        .number_or("max_torque", bone.max_torque, kBoneTorque, std::numeric_limits<float>::infinity())
        .zero("reserved", bone.reserved)
        .require(bone.parent >= -1 && bone.parent < static_cast<int32_t>(number),
                 "a bone's parent is not below its own number, nor -1");
    if (bone.parent < 0) return;
    check.pose("joint.position", "joint.rotation", bone.joint);
    static const char* const kLower[] = {"lower.x", "lower.y", "lower.z"};
    static const char* const kUpper[] = {"upper.x", "upper.y", "upper.z"};
    for (int axis = 0; axis < 3; ++axis)
        check.number(kLower[axis], part(bone.lower, axis), Range{-kMostAngle[axis], 0})
            .number(kUpper[axis], part(bone.upper, axis), Range{0, kMostAngle[axis]});
}

bool take_ragdoll_def(Check& check, const taut_ragdoll_def* given, taut_ragdoll_def& def) {
    if (!take_def(check, given, taut_ragdoll_def_init, def)) return false;
    check.count("bone_count", def.bone_count, 1, TAUT_RAGDOLL_MAX_BONES)
        .pointer("bones", def.bones)
        .pose("pose.position", "pose.rotation", def.pose);
    char scope[32];
    for (uint32_t i = 0; check && i < def.bone_count; ++i) {
        std::snprintf(scope, sizeof scope, "def.bones[%u].", i);
        check_bone(check.within(scope), def.bones[i], i);
    }
    check.within("");
    return static_cast<bool>(check);
}

bool check_ragdoll(Check& check, const taut_ragdoll* ragdoll) {
    return check.pointer("ragdoll", ragdoll) && check.nested(ragdoll->struct_size, sizeof *ragdoll) &&
           check.count("ragdoll.bone_count", ragdoll->bone_count, 0, TAUT_RAGDOLL_MAX_BONES);
}

void check_poses(Check& check, const taut_pose* poses, uint32_t count) {
    char position[32], rotation[32];
    for (uint32_t i = 0; check && i < count; ++i) {
        std::snprintf(position, sizeof position, "poses[%u].position", i);
        std::snprintf(rotation, sizeof rotation, "poses[%u].rotation", i);
        check.pose(position, rotation, poses[i]);
    }
}

// ---------------------------------------------------------------- parts

taut_axis_def axis_of(const taut_bone_def& bone, int axis, bool driven) {
    taut_axis_def out;
    taut_axis_def_init(&out);
    if (is_locked(bone, axis)) {
        out.mode = TAUT_AXIS_LOCKED;
        return out;
    }
    out.mode = TAUT_AXIS_LIMITED;
    out.lower = part(bone.lower, axis);
    out.upper = part(bone.upper, axis);
    out.friction = bone.friction;
    if (driven && bone.frequency > 0) {
        out.drive.frequency = bone.frequency;
        out.drive.damping_ratio = bone.damping_ratio;
        out.drive.max_force = bone.max_torque;
    }
    return out;
}

taut_result add_bone_body(taut_world world, const taut_ragdoll_def& def, const taut_bone_def& bone, taut_body* out) {
    taut_collider_def collider;
    taut_collider_def_init(&collider);
    collider.shape = bone.shape;
    collider.position = bone.shape_position;
    collider.rotation = bone.shape_rotation;
    collider.material = def.material;
    collider.filter = def.filter;
    taut_body_def body;
    taut_body_def_init(&body);
    const taut_pose pose = (BoneFrame(def.pose) * BoneFrame(bone.pose)).pose();
    body.position = pose.position;
    body.rotation = pose.rotation;
    body.mass = bone.mass;
    body.colliders = &collider;
    body.collider_count = 1;
    const taut_result result = taut_world_add_body(world, &body, out);
    return result == TAUT_OK && bone.name ? taut_body_set_name(*out, bone.name) : result;
}

taut_result add_bone_joint(taut_world world, const taut_ragdoll_def& def, uint32_t number, taut_ragdoll& ragdoll) {
    const taut_bone_def& bone = def.bones[number];
    const auto parent = static_cast<uint32_t>(bone.parent);
    taut_six_dof_joint_def joint;
    taut_six_dof_joint_def_init(&joint);
    joint.base.body_a = ragdoll.bodies[parent];
    joint.base.body_b = ragdoll.bodies[number];
    joint.base.frame_a = (BoneFrame(def.bones[parent].pose).inverse() * BoneFrame(bone.joint)).frame();
    joint.base.frame_b = (BoneFrame(bone.pose).inverse() * BoneFrame(bone.joint)).frame();
    for (int axis = 0; axis < 3; ++axis) joint.axes[kFirstAngle + uint32_t(axis)] = axis_of(bone, axis, false);
    return taut_world_add_six_dof_joint(world, &joint, &ragdoll.joints[number]);
}

// Angles of a joint in a pose: A^T B = Rx(a) Ry(b) Rz(c), so that its first row is (cos b cos c, -cos b sin c, sin b)
// and its last column (sin b, -sin a cos b, cos a cos b).
Vec3 angles_between(const Quat& a, const Quat& b) {
    const Mat3 turn = (a.conjugate() * b).toRotationMatrix();
    return {angle_of(-turn(1, 2), turn(2, 2)),
            angle_of(turn(0, 2), std::sqrt(turn(1, 2) * turn(1, 2) + turn(2, 2) * turn(2, 2))),
            angle_of(-turn(0, 1), turn(0, 0))};
}

// Targets of all joints, within the limits.
void targets_of(const taut_ragdoll_def& def, const taut_pose* poses, taut_vec3* targets) {
    for (uint32_t i = 0; i < def.bone_count; ++i) {
        targets[i] = {0, 0, 0};
        const taut_bone_def& bone = def.bones[i];
        if (bone.parent < 0) continue;
        const auto parent = static_cast<uint32_t>(bone.parent);
        const Quat joint = to_quat(bone.joint.rotation);
        const Quat a = to_quat(poses[parent].rotation) * to_quat(def.bones[parent].pose.rotation).conjugate() * joint;
        const Quat b = to_quat(poses[i].rotation) * to_quat(bone.pose.rotation).conjugate() * joint;
        const Vec3 angles = angles_between(a, b);
        float* const out[] = {&targets[i].x, &targets[i].y, &targets[i].z};
        for (int axis = 0; axis < 3; ++axis)
            *out[axis] = std::clamp(static_cast<float>(angles[axis]), part(bone.lower, axis), part(bone.upper, axis));
    }
}

bool is_driven(taut_ragdoll_mode mode) { return mode == TAUT_RAGDOLL_POWERED || mode == TAUT_RAGDOLL_HELD; }
bool is_led(const taut_bone_def& bone, taut_ragdoll_mode mode) {
    return mode == TAUT_RAGDOLL_LED || (mode == TAUT_RAGDOLL_HELD && bone.parent < 0);
}

taut_result drive_joint(const taut_bone_def& bone, taut_joint joint, taut_ragdoll_mode mode, bool renew,
                        const taut_vec3& target, const taut_vec3& speed) {
    if (!taut_joint_is_valid(joint)) return TAUT_OK;
    taut_result result = TAUT_OK;
    for (int axis = 0; result == TAUT_OK && axis < 3; ++axis) {
        if (is_locked(bone, axis)) continue;
        const uint32_t number = kFirstAngle + uint32_t(axis);
        if (renew) {
            taut_axis_def def = axis_of(bone, axis, is_driven(mode));
            if (is_driven(mode)) def.drive.target = part(target, axis);
            result = taut_joint_set_axis(joint, number, &def);
        } else if (is_driven(mode) && bone.frequency > 0) {
            result = taut_joint_set_target(joint, number, part(target, axis), part(speed, axis));
        }
    }
    return result;
}

// Whether a bone can be led: it is enabled, and not further away than taut_body_move_kinematic allows.
taut_result check_way(Check& check, taut_body body, const taut_pose& pose) {
    return with(check.call(), body, Use::read, [&](const World& world, uint32_t node) {
        const NodePose to{to_vec(pose.position), to_quat(pose.rotation)};
        const auto [v, w] = speed_between(world.nodes, node, origin_pose(world, node), to, world.def.time_step);
        check.require(world.nodes.enabled(node), "a bone is disabled: nothing moves it")
            .require(v.norm() <= kSpeed.hi, "poses ask for a speed beyond 1e4 m/s")
            .require(w.norm() <= kSpeed.hi, "poses ask for an angular speed beyond 1e4 rad/s");
        return check.result();
    });
}

taut_result lead_bone(const taut_bone_def& bone, taut_body body, taut_ragdoll_mode mode, const taut_pose* pose) {
    const taut_body_kind wanted = is_led(bone, mode) ? TAUT_BODY_KINEMATIC : TAUT_BODY_DYNAMIC;
    taut_body_kind kind;
    taut_result result = taut_body_get_kind(body, &kind);
    if (result == TAUT_OK && kind != wanted) result = taut_body_set_kind(body, wanted);
    if (result == TAUT_OK && wanted == TAUT_BODY_KINEMATIC) result = taut_body_move_kinematic(body, pose);
    return result;
}

}  // namespace

void taut_bone_def_init_sized(taut_bone_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_bone_def& own) {
        own = {};
        own.struct_size = sizeof own;
        own.parent = -1;
        own.pose.rotation = own.shape_rotation = own.joint.rotation = {0, 0, 0, 1};
        own.lower = {-0.5f, -0.5f, -0.5f};
        own.upper = {0.5f, 0.5f, 0.5f};
        own.frequency = 5;
        own.damping_ratio = 1;
        own.max_torque = std::numeric_limits<float>::infinity();
    });
}

void taut_ragdoll_def_init_sized(taut_ragdoll_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_ragdoll_def& own) {
        taut_body_def body;
        taut_body_def_init(&body);
        own = {};
        own.struct_size = sizeof own;
        own.pose.rotation = {0, 0, 0, 1};
        own.material = body.material;
        own.filter = body.filter;
    });
}

void taut_ragdoll_init_sized(taut_ragdoll* ragdoll, uint32_t size) {
    give_defaults(ragdoll, size, [](taut_ragdoll& own) {
        own = {};
        own.struct_size = sizeof own;
    });
}

taut_result taut_world_add_ragdoll(taut_world world, const taut_ragdoll_def* given, taut_ragdoll* ragdoll) {
    Check check(__func__);
    taut_ragdoll_def def;
    if (!check_ragdoll(check, ragdoll) || !take_ragdoll_def(check, given, def)) return check.result();
    taut_ragdoll out;
    taut_ragdoll_init(&out);
    out.bone_count = def.bone_count;
    taut_result result = TAUT_OK;
    for (uint32_t i = 0; result == TAUT_OK && i < def.bone_count; ++i) {
        result = add_bone_body(world, def, def.bones[i], &out.bodies[i]);
        if (result == TAUT_OK && def.bones[i].parent >= 0) result = add_bone_joint(world, def, i, out);
    }
    if (result == TAUT_OK) {
        *ragdoll = out;
        return TAUT_OK;
    }
    result = refuse_as(check, result);
    char text[512];
    std::snprintf(text, sizeof text, "%s", last_error());
    for (uint32_t i = def.bone_count; i-- > 0;)
        if (out.bodies[i].bits != 0) taut_body_remove(out.bodies[i]);
    return refuse(result, "%s", text);
}

taut_result taut_ragdoll_remove(taut_ragdoll* ragdoll) {
    Check check(__func__);
    if (!check_ragdoll(check, ragdoll)) return check.result();
    for (uint32_t i = 0; i < ragdoll->bone_count; ++i) {
        const taut_result result = taut_body_remove(ragdoll->bodies[i]);
        if (result != TAUT_OK && result != TAUT_STALE_HANDLE) return refuse_as(check, result);
    }
    taut_ragdoll_init(ragdoll);
    return TAUT_OK;
}

taut_result taut_ragdoll_get_poses(const taut_ragdoll* ragdoll, taut_pose* poses, uint32_t capacity) {
    Check check(__func__);
    if (!check.pointer("poses", poses) || !check_ragdoll(check, ragdoll)) return check.result();
    if (capacity < ragdoll->bone_count)
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity,
                      ragdoll->bone_count);
    taut_pose own[TAUT_RAGDOLL_MAX_BONES];
    for (uint32_t i = 0; i < ragdoll->bone_count; ++i)
        if (const taut_result result = taut_body_get_pose(ragdoll->bodies[i], &own[i]); result != TAUT_OK)
            return refuse_as(check, result);
    std::copy_n(own, ragdoll->bone_count, poses);
    return TAUT_OK;
}

taut_result taut_ragdoll_set_poses(taut_ragdoll* ragdoll, const taut_pose* poses) {
    Check check(__func__);
    if (!check.pointer("poses", poses) || !check_ragdoll(check, ragdoll)) return check.result();
    check_poses(check, poses, ragdoll->bone_count);
    if (!check) return check.result();
    taut_pose now;
    for (uint32_t i = 0; i < ragdoll->bone_count; ++i)
        if (const taut_result result = taut_body_get_pose(ragdoll->bodies[i], &now); result != TAUT_OK)
            return refuse_as(check, result);
    for (uint32_t i = 0; i < ragdoll->bone_count; ++i)
        if (const taut_result result = taut_body_set_pose(ragdoll->bodies[i], &poses[i]); result != TAUT_OK)
            return refuse_as(check, result);
    return TAUT_OK;
}

taut_result taut_ragdoll_drive(const taut_ragdoll_def* given, taut_ragdoll_mode mode, const taut_pose* poses,
                               float seconds, taut_ragdoll* ragdoll) {
    Check check(__func__);
    taut_ragdoll_def def;
    if (!check_ragdoll(check, ragdoll) || !take_ragdoll_def(check, given, def)) return check.result();
    check.choice("mode", mode, TAUT_RAGDOLL_LED)
        .choice("ragdoll.mode", ragdoll->mode, TAUT_RAGDOLL_LED)
        .number("seconds", seconds, kRagdollSeconds)
        .require(ragdoll->bone_count == def.bone_count, "def.bone_count is not that of the ragdoll");
    if (check && mode != TAUT_RAGDOLL_LIMP) check.pointer("poses", poses);
    if (check && poses) check_poses(check, poses, def.bone_count);
    if (!check) return check.result();
    for (uint32_t i = 0; i < def.bone_count; ++i) {
        taut_body_kind kind;
        const taut_result result = taut_body_get_kind(ragdoll->bodies[i], &kind);
        if (result != TAUT_OK) return refuse_as(check, result);
        check.require(kind == TAUT_BODY_DYNAMIC || kind == TAUT_BODY_KINEMATIC,
                      "a bone is neither dynamic nor kinematic");
        if (!check) return check.result();
        if (!is_led(def.bones[i], mode)) continue;
        if (const taut_result way = check_way(check, ragdoll->bodies[i], poses[i]); way != TAUT_OK) return way;
    }
    taut_vec3 targets[TAUT_RAGDOLL_MAX_BONES] = {};
    if (is_driven(mode)) targets_of(def, poses, targets);
    const bool renew = is_driven(mode) != is_driven(ragdoll->mode);
    for (uint32_t i = 0; i < def.bone_count; ++i) {
        const auto rate = [&](int axis) {
            const double change = double(part(targets[i], axis)) - double(part(ragdoll->targets[i], axis));
            return static_cast<float>(std::clamp(change / double(seconds), kSpeed.lo, kSpeed.hi));
        };
        const taut_vec3 speed = {rate(0), rate(1), rate(2)};
        taut_result result = lead_bone(def.bones[i], ragdoll->bodies[i], mode, poses ? &poses[i] : nullptr);
        if (result == TAUT_OK) result = drive_joint(def.bones[i], ragdoll->joints[i], mode, renew, targets[i], speed);
        if (result != TAUT_OK) return refuse_as(check, result);
    }
    std::copy_n(targets, def.bone_count, ragdoll->targets);
    ragdoll->mode = mode;
    return TAUT_OK;
}
