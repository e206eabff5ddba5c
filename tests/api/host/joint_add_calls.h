// Calls that add joints.
#pragma once

#include "joint_defs.h"

namespace taut_test {

class JointAddCalls : protected virtual JointDefs {
protected:
    bool add_framed(size_t w, taut_joint& out) {
        const taut_world world = worlds_[w];
        switch (byte() % 10) {
            case 0: {
                const auto def = framed_def(w, taut_fixed_joint_def_init);
                return run("taut_world_add_fixed_joint", [&] { return taut_world_add_fixed_joint(world, &def, &out); });
            }
            case 1: {
                auto def = framed_def(w, taut_hinge_joint_def_init);
                def.angle = axis_def(true);
                return run("taut_world_add_hinge_joint", [&] { return taut_world_add_hinge_joint(world, &def, &out); });
            }
            case 2: {
                auto def = framed_def(w, taut_slider_joint_def_init);
                def.slide = axis_def(true);
                return run("taut_world_add_slider_joint",
                           [&] { return taut_world_add_slider_joint(world, &def, &out); });
            }
            case 3: {
                auto def = framed_def(w, taut_cylindrical_joint_def_init);
                def.slide = axis_def(true);
                def.angle = axis_def(true);
                return run("taut_world_add_cylindrical_joint",
                           [&] { return taut_world_add_cylindrical_joint(world, &def, &out); });
            }
            case 4: {
                auto def = framed_def(w, taut_universal_joint_def_init);
                def.angle_a = axis_def(true);
                def.angle_b = axis_def(true);
                return run("taut_world_add_universal_joint",
                           [&] { return taut_world_add_universal_joint(world, &def, &out); });
            }
            case 5: {
                auto def = framed_def(w, taut_cone_twist_joint_def_init);
                def.swing = axis_def(false);
                if (!one_in(8)) def.swing.drive.target = std::abs(def.swing.drive.target);
                def.twist = axis_def(true);
                return run("taut_world_add_cone_twist_joint",
                           [&] { return taut_world_add_cone_twist_joint(world, &def, &out); });
            }
            case 6: {
                auto def = framed_def(w, taut_wheel_joint_def_init);
                def.suspension = axis_def(true);
                def.steering = axis_def(true);
                def.spin = axis_def(true);
                return run("taut_world_add_wheel_joint", [&] { return taut_world_add_wheel_joint(world, &def, &out); });
            }
            case 7: {
                const auto def = framed_def(w, taut_gear_joint_def_init, kAngles);
                return run("taut_world_add_gear_joint", [&] { return taut_world_add_gear_joint(world, &def, &out); });
            }
            case 8: {
                const auto def = framed_def(w, taut_rack_pinion_joint_def_init, kPoints);
                return run("taut_world_add_rack_pinion_joint",
                           [&] { return taut_world_add_rack_pinion_joint(world, &def, &out); });
            }
            default: {
                auto def = framed_def(w, taut_six_dof_joint_def_init);
                for (taut_axis_def& axis : def.axes)
                    if (one_in(2)) axis = axis_def(true);
                return run("taut_world_add_six_dof_joint",
                           [&] { return taut_world_add_six_dof_joint(world, &def, &out); });
            }
        }
    }
    void add_joint() {
        if (live(joints_, taut_joint_is_valid) >= kMostJoints) return;
        const size_t w = pick_world();
        taut_joint out = {0};
        bool added;
        if (one_in(2)) {
            added = add_framed(w, out);
        } else if (one_in(2)) {
            const auto def = joint_def(w, taut_ball_joint_def_init);
            added = run("taut_world_add_ball_joint", [&] { return taut_world_add_ball_joint(worlds_[w], &def, &out); });
        } else if (one_in(3)) {
            auto def = joint_def(w, taut_pulley_joint_def_init);
            def.housing = one_in(2) ? taut_body{0} : pick_body(w);
            def.housing_frame_a.position = pos(4);
            def.housing_frame_b.position = pos(4);
            if (one_in(2)) def.ratio = real(0.1, 4);
            if (one_in(2)) def.length = real(0, 9);
            def.rigid = byte() & 1;
            spoil(def.rigid);
            spoil(def.base.reserved[1]);
            added =
                run("taut_world_add_pulley_joint", [&] { return taut_world_add_pulley_joint(worlds_[w], &def, &out); });
        } else {
            auto def = joint_def(w, taut_distance_joint_def_init);
            if (one_in(2)) def.length = real(0, 3);
            if (one_in(3)) {
                if (one_in(2)) def.min_length = real(0.01, 2);
                def.max_length = one_in(4) ? INFINITY : real(2, 4);
                if (one_in(2)) def.drive = drive();
                if (one_in(2)) def.friction = real(0, 10);
            }
            if (one_in(4)) def.base.compliance = def.base.damping = 0, def.frequency = real(0.1, 30);
            spoil(def.base.reserved[1]);
            added = run("taut_world_add_distance_joint",
                        [&] { return taut_world_add_distance_joint(worlds_[w], &def, &out); });
        }
        if (added) keep(joints_, out, w);
    }
};

}  // namespace taut_test
