// What the calls that make joints share: fields that the defs of all kinds have, checked and put into a joint.
#pragma once

#include "api/joint_parts.h"
#include "api/sized.h"
#include "models/bodies.h"

namespace taut {

template <class Def>
constexpr bool kFramed = requires(Def def) {
    def.frame_a;
};
template <class Def>
constexpr bool kHoldsPoints = requires(Def def) {
    def.break_force;
};
template <class Def>
constexpr bool kHoldsAngles = requires(Def def) {
    def.break_torque;
};

// def: as this library knows it.
template <class Def>
bool check_def(Check& check, const Def* given, void (*init)(Def*), Def* def, const taut_joint* out) {
    if (!check.pointer("def", given).pointer("out", out) || !take_def(check, given, init, *def)) return false;
    check.boolean("collide_connected", def->collide_connected);
    if constexpr (kFramed<Def>) {
        for (int end = 0; end < 2; ++end) {
            const taut_frame& frame = end == 0 ? def->frame_a : def->frame_b;
            check.bounded(kFrameNames[end].position, frame.position, kPosition)
                .rotation(kFrameNames[end].rotation, frame.rotation);
        }
    } else {
        check.bounded("anchor_a", def->anchor_a, kPosition).bounded("anchor_b", def->anchor_b, kPosition);
    }
    if constexpr (kHoldsAngles<Def>) {
        check.number("angular_compliance", def->angular_compliance, kCompliance)
            .number("angular_damping", def->angular_damping, kDamping)
            .number("break_torque", def->break_torque, kJointForce);
    }
    if constexpr (kHoldsPoints<Def>) {
        check.number("compliance", def->compliance, kCompliance)
            .number("damping", def->damping, kDamping)
            .number("break_force", def->break_force, kJointForce);
    }
    check.choice("solve", def->solve, TAUT_JOINT_SOLVE_BY_LOAD);
    if constexpr (requires { def->reserved; }) check.zero("reserved", def->reserved);
    return static_cast<bool>(check);
}

// Ends a and b.
template <class Def>
taut_result place_ends(Check& check, const World& world, const JointKind& kind, const Def& def, JointEnd (&ends)[2]) {
    const EndNames* names = kFramed<Def> ? kFrameNames : kAnchorNames;
    for (int i = 0; i < 2; ++i) {
        const taut_body body = i == 0 ? def.body_a : def.body_b;
        if (body.bits != 0) {
            const taut_result found = find_body(check.call(), names[i].body, world, body, ends[i].node);
            if (found != TAUT_OK) return found;
        }
        taut_frame frame;
        if constexpr (kFramed<Def>)
            frame = i == 0 ? def.frame_a : def.frame_b;
        else
            frame = {i == 0 ? def.anchor_a : def.anchor_b, kUnturned};
        if (!place_end(check, world, kind, names[i], frame, ends[i])) return check.result();
    }
    return check.result();
}

inline bool moves_by_forces(const World& world, const JointEnd& end) {
    return end.node != kNone && moves_by_forces(world.nodes.info[end.node].kind);
}

template <class Def>
Joint make_joint(const JointKind& kind, const Def& def, const JointEnd (&ends)[2]) {
    Joint joint;
    joint.type = kind.type;
    joint.node[0] = ends[0].node;
    joint.node[1] = ends[1].node;
    if constexpr (kHoldsPoints<Def>) {
        joint.compliance = def.compliance;
        joint.damping = def.damping;
        joint.break_force = or_never(def.break_force);
    }
    if constexpr (kHoldsAngles<Def>) {
        joint.angular_compliance = def.angular_compliance;
        joint.angular_damping = def.angular_damping;
        joint.break_torque = or_never(def.break_torque);
    }
    joint.solve = static_cast<JointSolve>(def.solve);
    joint.collide_connected = def.collide_connected != 0;
    joint.user_data = def.user_data;
    write_ends(joint, kind, ends[0], ends[1]);
    return joint;
}

inline taut_result add_joint(Check& check, World& world, const Joint& joint, taut_joint* out) {
    const taut_result room = room_for_joints(check.call(), world, 1);
    if (room != TAUT_OK) return room;
    reserve_pairs_of_ends(world, joint);
    const uint32_t index = world.joints.add(joint);
    world.joints.record[index].idle = is_idle(world.nodes, joint);
    if (!joint.collide_connected) forget_pairs_of_ends(world, joint);
    wake_ends(world, joint);
    *out = world.joint_handle(index);
    return TAUT_OK;
}

}  // namespace taut
