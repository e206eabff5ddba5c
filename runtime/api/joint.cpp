// Joints that are there: what they connect, and changes of what they do.
#include <taut/joint.h>

#include <tuple>

#include "api/joint_parts.h"
#include "api/sized.h"
#include "models/bodies.h"

using namespace taut;

namespace {

// act(world, joint, place) on an axis that the joint has.
template <class Act>
taut_result with_axis(const Check& check, taut_joint handle, uint32_t axis, Use use, Act&& act) {
    return with(check.call(), handle, use, [&](World& world, uint32_t index) {
        Joint& joint = world.joints.record[index];
        JointAxis place;
        const taut_result found = find_axis(check.call(), joint, axis, place);
        return found == TAUT_OK ? act(world, joint, place) : found;
    });
}

bool same(const Axis& a, const Axis& b) {
    const auto all = [](const Axis& x) {
        return std::tie(x.mode, x.lower, x.upper, x.limit_compliance, x.limit_damping, x.stiffness, x.damping, x.target,
                        x.speed, x.max_force, x.friction);
    };
    return all(a) == all(b);
}

template <class Change>
taut_result change(const Check& check, taut_joint handle, Change&& apply) {
    if (!check) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        const taut_result changed = apply(world, world.joints.record[index]);
        if (changed == TAUT_OK) wake_ends(world, world.joints.record[index]);
        return changed;
    });
}

}  // namespace

taut_result taut_joint_remove(taut_joint handle) {
    TAUT_RECORD(taut_joint_remove, handle);
    return with(__func__, handle, Use::write, [](World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        reserve_pairs_of_ends(world, joint);
        wake_ends(world, joint);
        if (!joint.collide_connected) forget_pairs_of_ends(world, joint);
        world.joints.remove(index);
        return TAUT_OK;
    });
}

int32_t taut_joint_is_valid(taut_joint handle) { return is_valid(handle); }

taut_result taut_joint_get_kind(taut_joint handle, taut_joint_kind* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = kind_of(world.joints.record[index]).kind;
        return TAUT_OK;
    });
}

taut_result taut_joint_get_user_data(taut_joint handle, uint64_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = world.joints.record[index].user_data;
        return TAUT_OK;
    });
}

taut_result taut_joint_set_user_data(taut_joint handle, uint64_t value) {
    TAUT_RECORD(taut_joint_set_user_data, handle, value);
    return with(__func__, handle, Use::write, [&](World& world, uint32_t index) {
        world.joints.record[index].user_data = value;
        return TAUT_OK;
    });
}

taut_result taut_joint_get_bodies(taut_joint handle, taut_body* body_a, taut_body* body_b) {
    Check check(__func__);
    if (!check.pointer("body_a", body_a).pointer("body_b", body_b)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        *body_a = world.body_handle(joint.node[0]);
        *body_b = world.body_handle(joint.node[1]);
        return TAUT_OK;
    });
}

// ---------------------------------------------------------------- axes

taut_result taut_joint_get_axis_count(taut_joint handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = static_cast<uint32_t>(kind_of(world.joints.record[index]).axes.size());
        return TAUT_OK;
    });
}

taut_result taut_joint_get_axis_sized(taut_joint handle, uint32_t axis, taut_axis_def* first, uint32_t size) {
    const RecordOut<taut_axis_def> out(first, size);
    Check check("taut_joint_get_axis");
    if (!check.pointer("out", out)) return check.result();
    return with_axis(check, handle, axis, Use::read, [&](const World&, const Joint& joint, const JointAxis& place) {
        const Axis& held = joint.axis[place.row];
        taut_axis_def def;
        taut_axis_def_init(&def);
        def.mode = static_cast<taut_axis_mode>(held.mode);
        def.stop_compliance = held.limit_compliance;
        def.stop_damping = held.limit_damping;
        def.friction = held.friction;
        if (held.mode == AxisMode::limited) {
            def.lower = held.lower;
            def.upper = held.upper;
        }
        if (has_drive(held)) {
            def.drive = {held.target, held.speed, held.stiffness, held.damping, 0, 1, held.max_force};
        }
        *out = def;
        return TAUT_OK;
    });
}

taut_result taut_joint_set_axis(taut_joint handle, uint32_t axis, const taut_axis_def* def) {
    TAUT_RECORD(taut_joint_set_axis, handle, axis, def);
    Check check(__func__);
    if (!check.pointer("def", def)) return check.result();
    return with_axis(check, handle, axis, Use::write, [&](World& world, Joint& joint, const JointAxis& place) {
        if (!check_axis(check, kind_of(joint), place, *def)) return check.result();
        const JointReading reading = read_joint(world.nodes, joint);
        const double inverse_mass = held_inverse_mass_of(world.nodes, joint, reading, place.row);
        // Both ends may have become static since.
        check.require(def->drive.frequency == 0 || inverse_mass > 0,
                      "drive.frequency is given, but neither end moves any more");
        if (!check) return check.result();
        const Axis wanted = make_axis(place, *def, inverse_mass);
        if (!same(wanted, joint.axis[place.row])) wake_ends(world, joint);
        change_axis(joint, place, wanted);
        return TAUT_OK;
    });
}

taut_result taut_joint_set_target(taut_joint handle, uint32_t axis, float target, float speed) {
    TAUT_RECORD(taut_joint_set_target, handle, axis, target, speed);
    Check check(__func__);
    if (!check.number("speed", speed, kSpeed)) return check.result();
    return with_axis(check, handle, axis, Use::write, [&](World& world, Joint& joint, const JointAxis& place) {
        Axis& held = joint.axis[place.row];
        check.number("target", target, is_angle(joint, place.row) ? kJointAngle : kJointPosition)
            .require(!place.swing || is_swing(target), "target is no swing, expected [0, pi]")
            .require(has_drive(held), "the axis has no drive");
        if (!check) return check.result();
        if (target != held.target || speed != held.speed) wake_ends(world, joint);  // hosts say it every frame
        held.target = target;
        held.speed = speed;
        return TAUT_OK;
    });
}

// ---------------------------------------------------------------- all else

taut_result taut_joint_set_compliance(taut_joint handle, float compliance, float damping) {
    TAUT_RECORD(taut_joint_set_compliance, handle, compliance, damping);
    Check check(__func__);
    check.number("compliance", compliance, kCompliance).number("damping", damping, kDamping);
    return change(check, handle, [&](World&, Joint& joint) {
        if (!check.require(holds_points(kind_of(joint)), "joint holds angles alone")) return check.result();
        joint.compliance = compliance;
        joint.damping = damping;
        if (has_length(joint) && joint.axis[0].mode == AxisMode::limited) {
            joint.axis[0].limit_compliance = compliance;
            joint.axis[0].limit_damping = damping;
        }
        return TAUT_OK;
    });
}

taut_result taut_joint_set_angular_compliance(taut_joint handle, float compliance, float damping) {
    TAUT_RECORD(taut_joint_set_angular_compliance, handle, compliance, damping);
    Check check(__func__);
    check.number("compliance", compliance, kCompliance).number("damping", damping, kDamping);
    return change(check, handle, [&](World&, Joint& joint) {
        if (!check.require(holds_angles(kind_of(joint)), "joint holds no angles")) return check.result();
        joint.angular_compliance = compliance;
        joint.angular_damping = damping;
        return TAUT_OK;
    });
}

taut_result taut_joint_set_break(taut_joint handle, float force, float torque) {
    TAUT_RECORD(taut_joint_set_break, handle, force, torque);
    Check check(__func__);
    check.number("force", force, kJointForce).number("torque", torque, kJointForce);
    return change(check, handle, [&](World&, Joint& joint) {
        const JointKind& kind = kind_of(joint);
        check.require(force == 0 || holds_points(kind), "force of a joint that holds angles alone")
            .require(torque == 0 || holds_angles(kind), "torque of a joint that holds no angles");
        if (!check) return check.result();
        joint.break_force = or_never(force);
        joint.break_torque = or_never(torque);
        return TAUT_OK;
    });
}

taut_result taut_joint_set_length(taut_joint handle, float length) {
    TAUT_RECORD(taut_joint_set_length, handle, length);
    Check check(__func__);
    check.number("length", length, kJointLength);
    return change(check, handle, [&](const World& world, Joint& joint) {
        if (!check.require(has_length(joint), "joint is no distance joint and no pulley")) return check.result();
        Joint changed = joint;
        set_length(changed, length);
        replace_joint(world.nodes, joint, changed);
        return TAUT_OK;
    });
}

taut_result taut_joint_set_solve(taut_joint handle, taut_joint_solve solve) {
    TAUT_RECORD(taut_joint_set_solve, handle, solve);
    Check check(__func__);
    check.choice("solve", solve, TAUT_JOINT_SOLVE_BY_LOAD);
    return change(check, handle, [&](World& world, Joint& joint) {
        if (joint.solve == static_cast<JointSolve>(solve)) return TAUT_OK;
        joint.solve = static_cast<JointSolve>(solve);
        ++world.joints.version;  // blocks gain or lose it
        return TAUT_OK;
    });
}

taut_result taut_joint_set_frames(taut_joint handle, const taut_frame* frame_a, const taut_frame* frame_b) {
    TAUT_RECORD(taut_joint_set_frames, handle, frame_a, frame_b);
    Check check(__func__);
    if (!check.pointer("frame_a", frame_a).pointer("frame_b", frame_b)) return check.result();
    check_frames(check, *frame_a, *frame_b);
    return change(check, handle, [&](const World& world, Joint& joint) {
        const JointKind& kind = kind_of(joint);
        JointEnd ends[2];
        for (int i = 0; i < 2; ++i) {
            ends[i].node = joint.node[i];
            place_end(check, world, kFrameNames[i], i == 0 ? *frame_a : *frame_b, ends[i]);
        }
        if (!check) return check.result();
        Joint moved = joint;
        write_ends(moved, kind, ends[0], ends[1]);
        restart(world.nodes, moved);
        if (moved.type == &kDistance && !check_distance(check, world, moved)) return check.result();
        replace_joint(world.nodes, joint, moved);
        return TAUT_OK;
    });
}

taut_result taut_joint_set_enabled(taut_joint handle, uint32_t enabled) {
    TAUT_RECORD(taut_joint_set_enabled, handle, enabled);
    Check check(__func__);
    check.boolean("enabled", enabled);
    return change(check, handle, [&](World& world, Joint& joint) {
        if (joint.off.off == (enabled == 0)) return TAUT_OK;
        reserve_pairs_of_ends(world, joint);
        wake_ends(world, joint);  // while it ties them
        if (!joint.collide_connected) forget_pairs_of_ends(world, joint);
        joint.off.off = enabled == 0;
        update_idle(world, joint);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_enabled(taut_joint handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = world.joints.record[index].off.off ? 0 : 1;
        return TAUT_OK;
    });
}

taut_result taut_joint_set_collide_connected(taut_joint handle, uint32_t collide_connected) {
    TAUT_RECORD(taut_joint_set_collide_connected, handle, collide_connected);
    Check check(__func__);
    check.boolean("collide_connected", collide_connected);
    return change(check, handle, [&](World& world, Joint& joint) {
        const bool collide = collide_connected != 0;
        if (joint.collide_connected == collide) return TAUT_OK;
        reserve_pairs_of_ends(world, joint);
        forget_pairs_of_ends(world, joint);
        joint.collide_connected = collide;
        ++world.joints.version;  // pairs.joined is taken from the joints anew
        return TAUT_OK;
    });
}
