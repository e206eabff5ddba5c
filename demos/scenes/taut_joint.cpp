#include "taut_joint.h"

#include <limits>
#include <type_traits>

namespace scenes {

namespace {

// What the defs of all kinds share.
void fill_base(const Joint& joint, taut_body a, taut_body b, uint64_t index, taut_joint_base& base) {
    base.body_a = a;
    base.body_b = b;
    base.frame_a = {joint.anchor_a, joint.rotation_a};
    base.frame_b = {joint.anchor_b, joint.rotation_b};
    base.compliance = joint.compliance;
    base.damping = joint.damping;
    base.angular_compliance = joint.angular_compliance;
    base.break_force = joint.break_force;
    base.break_torque = joint.break_torque;
    base.solve = joint.solve;
    base.user_data = index;
}

// What they have beside it.
template <typename Def>
void fill_own(const Joint&, Def&) {}

void fill_own(const Joint& joint, taut_distance_joint_def& def) {
    def.length = joint.max_length > 0 ? 0 : joint.length;
    def.max_length = joint.max_length;
    if (!joint.axes.empty()) {  // a range without stops of its own is driven
        if (joint.max_length == 0) def.max_length = std::numeric_limits<float>::infinity();
        def.drive = joint.axes[0].drive;
    }
}

void fill_own(const Joint& joint, taut_pulley_joint_def& def) { def.length = joint.length; }

}  // namespace

taut_result add_joint(taut_world world, const Joint& joint, taut_body a, taut_body b, taut_body housing, uint64_t index,
                      taut_joint* out) {
    const auto add_by = [&]<typename Def>(void (*init)(Def*),
                                          taut_result (*add)(taut_world, const Def*, taut_joint*)) -> taut_result {
        Def def;
        init(&def);
        fill_base(joint, a, b, index, def.base);
        if constexpr (requires { def.housing; }) {
            def.housing = housing;
            def.housing_frame_a = joint.housing_a;
            def.housing_frame_b = joint.housing_b;
            def.ratio = joint.ratio;
        }
        fill_own(joint, def);
        taut_result result = add(world, &def, out);
        // Axes are set once the joint is there; that of a distance joint is of its def.
        if constexpr (!std::is_same_v<Def, taut_distance_joint_def>)
            for (uint32_t i = 0; result == TAUT_OK && i < joint.axes.size(); ++i)
                result = taut_joint_set_axis(*out, i, &joint.axes[i]);
        return result;
    };
    switch (joint.kind) {
        case TAUT_JOINT_BALL:
            return add_by(taut_ball_joint_def_init, taut_world_add_ball_joint);
        case TAUT_JOINT_DISTANCE:
            return add_by(taut_distance_joint_def_init, taut_world_add_distance_joint);
        case TAUT_JOINT_FIXED:
            return add_by(taut_fixed_joint_def_init, taut_world_add_fixed_joint);
        case TAUT_JOINT_HINGE:
            return add_by(taut_hinge_joint_def_init, taut_world_add_hinge_joint);
        case TAUT_JOINT_SLIDER:
            return add_by(taut_slider_joint_def_init, taut_world_add_slider_joint);
        case TAUT_JOINT_UNIVERSAL:
            return add_by(taut_universal_joint_def_init, taut_world_add_universal_joint);
        case TAUT_JOINT_CYLINDRICAL:
            return add_by(taut_cylindrical_joint_def_init, taut_world_add_cylindrical_joint);
        case TAUT_JOINT_CONE_TWIST:
            return add_by(taut_cone_twist_joint_def_init, taut_world_add_cone_twist_joint);
        case TAUT_JOINT_SIX_DOF:
            return add_by(taut_six_dof_joint_def_init, taut_world_add_six_dof_joint);
        case TAUT_JOINT_WHEEL:
            return add_by(taut_wheel_joint_def_init, taut_world_add_wheel_joint);
        case TAUT_JOINT_GEAR:
            return add_by(taut_gear_joint_def_init, taut_world_add_gear_joint);
        case TAUT_JOINT_RACK_PINION:
            return add_by(taut_rack_pinion_joint_def_init, taut_world_add_rack_pinion_joint);
        case TAUT_JOINT_PULLEY:
            return add_by(taut_pulley_joint_def_init, taut_world_add_pulley_joint);
        case TAUT_JOINT_KIND_MAX:
            break;
    }
    throw BadScene("a joint of the scene has no kind");
}

}  // namespace scenes
