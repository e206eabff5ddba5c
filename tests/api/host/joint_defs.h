// Defs of joints.
#pragma once

#include "host.h"

namespace taut_test {

class JointDefs : protected virtual Host {
protected:
    template <class Def>
    Def joint_def(size_t w, void (*init)(Def*)) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        def.collide_connected = byte() & 1;
        spoil(def.collide_connected);
        def.body_a = pick_body(w);
        def.body_b = pick_body(w);
        if (one_in(2)) def.anchor_a = pos(2);
        if (one_in(2)) def.anchor_b = pos(2);
        if (one_in(2)) def.compliance = real(0, 0.01);
        if (one_in(2)) def.damping = real(0, 10);
        if (one_in(4)) def.break_force = real(0, 1e4);
        if (one_in(4)) def.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 4 : 3));
        return def;
    }
    taut_frame joint_frame() {
        taut_frame out;
        taut_frame_init(&out);
        if (one_in(2)) out.position = pos(2);
        if (one_in(2)) out.rotation = quat();
        return out;
    }
    taut_axis_def axis_def(bool lockable) {
        taut_axis_def def;
        taut_axis_def_init(&def);
        spoil(def.struct_size);
        def.mode = static_cast<taut_axis_mode>(lockable && one_in(4) ? 0 : 1 + byte() % 2);
        if (one_in(2)) def.lower = real(-3, 0);
        if (one_in(2)) def.upper = real(0.01, 3);
        if (one_in(4)) def.stop_compliance = real(0, 0.01);
        if (one_in(4)) def.stop_damping = real(0, 10);
        if (def.mode != TAUT_AXIS_LOCKED || one_in(8)) {
            if (one_in(4)) def.drive = drive();
            if (one_in(4)) def.friction = real(0, 10);
        }
        return def;
    }
    taut_drive drive() {
        taut_drive out;
        taut_drive_init(&out);
        out.target = real(-1, 1);
        out.speed = real(-5, 5);
        out.damping_ratio = real(0, 2);
        out.max_force = real(0, 1000);
        if (one_in(2)) {
            out.frequency = real(0.1, 30);
        } else {
            out.stiffness = real(0, 1000);
            out.damping = one_in(8) ? INFINITY : real(0, 100);
        }
        if (one_in(8)) out.stiffness = 0;
        return out;
    }
    template <class Def>
    Def framed_def(size_t w, void (*init)(Def*)) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        def.collide_connected = byte() & 1;
        def.body_a = pick_body(w);
        def.body_b = pick_body(w);
        def.frame_a = joint_frame();
        def.frame_b = joint_frame();
        if (one_in(4)) {
            const taut_vec3 axis = vec(1), second = vec(1);
            const taut_pos pivot = pos(5);
            if (one_in(2))
                run("taut_joint_frames_from_world", [&] {
                    return taut_joint_frames_from_world(worlds_[w], def.body_a, def.body_b, pivot, axis, &def.frame_a,
                                                        &def.frame_b);
                });
            else
                run("taut_joint_frames_from_two_axes", [&] {
                    return taut_joint_frames_from_two_axes(worlds_[w], def.body_a, def.body_b, pivot, axis, second,
                                                           &def.frame_a, &def.frame_b);
                });
        }
        if constexpr (requires { def.break_force; }) {
            if (one_in(4)) def.compliance = real(0, 0.01);
            if (one_in(4)) def.damping = real(0, 10);
        }
        if constexpr (requires { def.break_torque; }) {
            if (one_in(4)) def.angular_compliance = real(0, 0.01);
            if (one_in(4)) def.angular_damping = real(0, 10);
        }
        if constexpr (requires { def.break_force; })
            if (one_in(4)) def.break_force = real(0, 1e4);
        if constexpr (requires { def.break_torque; })
            if (one_in(4)) def.break_torque = real(0, 1e4);
        if constexpr (requires { def.housing; }) {
            def.housing = one_in(2) ? taut_body{0} : pick_body(w);
            def.housing_frame_a = joint_frame();
            def.housing_frame_b = joint_frame();
            if (one_in(2)) def.ratio = real(-3, 3);
        }
        if (one_in(4)) def.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 4 : 3));
        spoil(def.reserved);
        return def;
    }
};

}  // namespace taut_test
