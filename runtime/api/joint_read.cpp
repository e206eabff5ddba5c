// What a joint says at the present poses: where it sits, what it carries, how far it is off.
#include <taut/joint.h>

#include "api/joint_parts.h"
#include "api/sized.h"

using namespace taut;

namespace {

// act(world, joint, reading)
template <class Act>
taut_result reading(const Check& check, taut_joint handle, Act&& act) {
    if (!check) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Joint& joint = world.joints.record[index];
        return act(world, joint, read_joint(world.nodes, joint));
    });
}

}  // namespace

taut_result taut_joint_get_anchors(taut_joint handle, taut_pos* anchor_a, taut_pos* anchor_b) {
    Check check(__func__);
    check.pointer("anchor_a", anchor_a).pointer("anchor_b", anchor_b);
    return reading(check, handle, [&](const World& world, const Joint& joint, const JointReading&) {
        *anchor_a = to_pos(world_anchor(world.nodes, joint, 0));
        *anchor_b = to_pos(world_anchor(world.nodes, joint, 1));
        return TAUT_OK;
    });
}

taut_result taut_joint_get_frames(taut_joint handle, taut_frame* frame_a, taut_frame* frame_b) {
    Check check(__func__);
    check.pointer("frame_a", frame_a).pointer("frame_b", frame_b);
    return reading(check, handle, [&](const World& world, const Joint& joint, const JointReading&) {
        *frame_a = frame_of(world, joint, 0);
        *frame_b = frame_of(world, joint, 1);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_force(taut_joint handle, taut_vec3* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Joint& joint, const JointReading& now) {
        *out = to_vec3(wrench_of(joint, now).force);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_torque(taut_joint handle, taut_vec3* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Joint& joint, const JointReading& now) {
        *out = to_vec3(wrench_of(joint, now).torque);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_error(taut_joint handle, float* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Joint& joint, const JointReading& now) {
        *out = to_float(error_of(joint, now).linear);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_angular_error(taut_joint handle, float* out) {
    Check check(__func__);
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Joint& joint, const JointReading& now) {
        *out = to_float(error_of(joint, now).angular);
        return TAUT_OK;
    });
}

taut_result taut_joint_get_coordinates(taut_joint handle, uint32_t axis, float* value, float* rate) {
    const Check check(__func__);
    return reading(check, handle, [&](const World& world, const Joint& joint, const JointReading& now) {
        JointAxis place;
        const taut_result found = find_axis(check.call(), joint, axis, place);
        if (found != TAUT_OK) return found;
        if (value) *value = to_float(now.value[place.row]);
        if (rate) *rate = to_float(rate_of(world.nodes, joint, now, place.row));
        return TAUT_OK;
    });
}

taut_result taut_joint_get_axis_forces_sized(taut_joint handle, uint32_t axis, taut_axis_forces* first, uint32_t size) {
    const RecordOut<taut_axis_forces> out(first, size);
    Check check("taut_joint_get_axis_forces");
    check.pointer("out", out);
    return reading(check, handle, [&](const World&, const Joint& joint, const JointReading&) {
        JointAxis place;
        const taut_result found = find_axis(check.call(), joint, axis, place);
        if (found != TAUT_OK) return found;
        taut_axis_forces forces{};
        *out = forces;
        if (joint.fresh) return TAUT_OK;
        const AxisMemory& memory = joint.memory[place.row];
        forces.total = to_float(joint.lambda[place.row]);
        forces.stop = to_float(double{memory.lower} - double{memory.upper});
        forces.drive = to_float(double{memory.drive});
        forces.friction = to_float(double{memory.friction});
        forces.active_stop = forces.stop > 0 ? -1 : forces.stop < 0 ? 1 : 0;
        *out = forces;
        return TAUT_OK;
    });
}
