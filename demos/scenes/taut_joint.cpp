#include "taut_joint.h"

#include <limits>

namespace scenes {

namespace {

// What the defs of all kinds share.
template <typename Def>
void fill_ends(const Joint& joint, taut_body a, taut_body b, uint64_t index, Def& def) {
    def.body_a = a;
    def.body_b = b;
    if constexpr (requires { def.break_force; }) {
        def.compliance = joint.compliance;
        def.damping = joint.damping;
        def.break_force = joint.break_force;
    }
    if constexpr (requires { def.break_torque; }) {
        def.angular_compliance = joint.angular_compliance;
        def.break_torque = joint.break_torque;
    }
    def.solve = joint.solve;
    def.user_data = index;
}

taut_result add_ball(taut_world world, const Joint& joint, taut_body a, taut_body b, uint64_t index, taut_joint* out) {
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    fill_ends(joint, a, b, index, def);
    def.anchor_a = joint.anchor_a;
    def.anchor_b = joint.anchor_b;
    return taut_world_add_ball_joint(world, &def, out);
}

taut_result add_distance(taut_world world, const Joint& joint, taut_body a, taut_body b, uint64_t index,
                         taut_joint* out) {
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    fill_ends(joint, a, b, index, def);
    def.anchor_a = joint.anchor_a;
    def.anchor_b = joint.anchor_b;
    def.length = joint.max_length > 0 ? 0 : joint.length;
    def.max_length = joint.max_length;
    if (!joint.axes.empty()) {  // a range without stops of its own is driven
        if (joint.max_length == 0) def.max_length = std::numeric_limits<float>::infinity();
        def.drive = joint.axes[0].drive;
    }
    return taut_world_add_distance_joint(world, &def, out);
}

// A kind that is placed by frames; its axes are set once it is there.
template <typename Def>
taut_result add_framed(taut_world world, const Joint& joint, taut_body a, taut_body b, uint64_t index,
                       void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*), taut_joint* out) {
    Def def;
    init(&def);
    fill_ends(joint, a, b, index, def);
    def.frame_a = {joint.anchor_a, joint.rotation_a};
    def.frame_b = {joint.anchor_b, joint.rotation_b};
    taut_result result = add(world, &def, out);
    for (uint32_t i = 0; result == TAUT_OK && i < joint.axes.size(); ++i)
        result = taut_joint_set_axis(*out, i, &joint.axes[i]);
    return result;
}

// A gear or rack.
template <typename Def>
taut_result add_gear(taut_world world, const Joint& joint, taut_body a, taut_body b, taut_body housing, uint64_t index,
                     void (*init)(Def*), taut_result (*add)(taut_world, const Def*, taut_joint*), taut_joint* out) {
    Def def;
    init(&def);
    fill_ends(joint, a, b, index, def);
    def.housing = housing;
    def.frame_a = {joint.anchor_a, joint.rotation_a};
    def.frame_b = {joint.anchor_b, joint.rotation_b};
    def.housing_frame_a = joint.housing_a;
    def.housing_frame_b = joint.housing_b;
    def.ratio = joint.ratio;
    return add(world, &def, out);
}

taut_result add_pulley(taut_world world, const Joint& joint, taut_body a, taut_body b, taut_body housing,
                       uint64_t index, taut_joint* out) {
    taut_pulley_joint_def def;
    taut_pulley_joint_def_init(&def);
    fill_ends(joint, a, b, index, def);
    def.housing = housing;
    def.anchor_a = joint.anchor_a;
    def.anchor_b = joint.anchor_b;
    def.sheave_a = joint.housing_a.position;
    def.sheave_b = joint.housing_b.position;
    def.ratio = joint.ratio;
    def.length = joint.length;
    taut_result result = taut_world_add_pulley_joint(world, &def, out);
    if (result == TAUT_OK && !joint.axes.empty()) result = taut_joint_set_axis(*out, 0, joint.axes.data());
    return result;
}

}  // namespace

taut_result add_joint(taut_world world, const Joint& joint, taut_body a, taut_body b, taut_body housing, uint64_t index,
                      taut_joint* out) {
    auto framed = [&](auto init, auto add) { return add_framed(world, joint, a, b, index, init, add, out); };
    switch (joint.kind) {
        case TAUT_JOINT_BALL:
            return add_ball(world, joint, a, b, index, out);
        case TAUT_JOINT_DISTANCE:
            return add_distance(world, joint, a, b, index, out);
        case TAUT_JOINT_FIXED:
            return framed(taut_fixed_joint_def_init, taut_world_add_fixed_joint);
        case TAUT_JOINT_HINGE:
            return framed(taut_hinge_joint_def_init, taut_world_add_hinge_joint);
        case TAUT_JOINT_SLIDER:
            return framed(taut_slider_joint_def_init, taut_world_add_slider_joint);
        case TAUT_JOINT_UNIVERSAL:
            return framed(taut_universal_joint_def_init, taut_world_add_universal_joint);
        case TAUT_JOINT_CYLINDRICAL:
            return framed(taut_cylindrical_joint_def_init, taut_world_add_cylindrical_joint);
        case TAUT_JOINT_CONE_TWIST:
            return framed(taut_cone_twist_joint_def_init, taut_world_add_cone_twist_joint);
        case TAUT_JOINT_SIX_DOF:
            return framed(taut_six_dof_joint_def_init, taut_world_add_six_dof_joint);
        case TAUT_JOINT_WHEEL:
            return framed(taut_wheel_joint_def_init, taut_world_add_wheel_joint);
        case TAUT_JOINT_GEAR:
            return add_gear(world, joint, a, b, housing, index, taut_gear_joint_def_init, taut_world_add_gear_joint,
                            out);
        case TAUT_JOINT_RACK_PINION:
            return add_gear(world, joint, a, b, housing, index, taut_rack_pinion_joint_def_init,
                            taut_world_add_rack_pinion_joint, out);
        case TAUT_JOINT_PULLEY:
            return add_pulley(world, joint, a, b, housing, index, out);
        case TAUT_JOINT_KIND_MAX:
            break;
    }
    throw BadScene("a joint of the scene has no kind");
}

}  // namespace scenes
