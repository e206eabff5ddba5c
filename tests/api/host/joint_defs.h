// Defs of joints.
#pragma once

#include "host.h"

namespace taut_test {

class JointDefs : protected virtual Host {
protected:
    // Of a kind that sits on points.
    template <class Def>
    Def joint_def(size_t w, void (*init)(Def*)) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        taut_joint_base& base = def.base;
        taut_joint_base_init(&base);
        base.collide_connected = byte() & 1;
        spoil(base.collide_connected);
        base.body_a = pick_body(w);
        base.body_b = pick_body(w);
        if (one_in(2)) base.frame_a.position = pos(2);
        if (one_in(2)) base.frame_b.position = pos(2);
        if (one_in(2)) base.compliance = real(0, 0.01);
        if (one_in(2)) base.damping = real(0, 10);
        if (one_in(4)) base.break_force = real(0, 1e4);
        if (one_in(4)) base.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 4 : 3));
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
    // What a kind holds: a gear no points, a rack no angles. What it does not is set now and then, and refused.
    enum Holds { kPoints = 1, kAngles = 2, kBoth = 3 };
    template <class Def>
    Def framed_def(size_t w, void (*init)(Def*), Holds holds = kBoth) {
        Def def;
        init(&def);
        spoil(def.struct_size);
        taut_joint_base& base = def.base;
        base.collide_connected = byte() & 1;
        base.body_a = pick_body(w);
        base.body_b = pick_body(w);
        base.frame_a = joint_frame();
        base.frame_b = joint_frame();
        if (one_in(4)) {
            const taut_vec3 axis = vec(1), second = vec(1);
            const taut_pos pivot = pos(5);
            if (one_in(2))
                run("taut_joint_frames_from_world", [&] {
                    return taut_joint_frames_from_world(worlds_[w], base.body_a, base.body_b, pivot, axis,
                                                        &base.frame_a, &base.frame_b);
                });
            else
                run("taut_joint_frames_from_two_axes", [&] {
                    return taut_joint_frames_from_two_axes(worlds_[w], base.body_a, base.body_b, pivot, axis, second,
                                                           &base.frame_a, &base.frame_b);
                });
        }
        if (holds & kPoints) {
            if (one_in(4)) base.compliance = real(0, 0.01);
            if (one_in(4)) base.damping = real(0, 10);
        }
        if (holds & kAngles) {
            if (one_in(4)) base.angular_compliance = real(0, 0.01);
            if (one_in(4)) base.angular_damping = real(0, 10);
        }
        if (holds & kPoints || one_in(32))
            if (one_in(4)) base.break_force = real(0, 1e4);
        if (holds & kAngles || one_in(32))
            if (one_in(4)) base.break_torque = real(0, 1e4);
        if constexpr (requires { def.housing; }) {
            def.housing = one_in(2) ? taut_body{0} : pick_body(w);
            def.housing_frame_a = joint_frame();
            def.housing_frame_b = joint_frame();
            if (one_in(2)) def.ratio = real(-3, 3);
        }
        if (one_in(4)) base.solve = static_cast<taut_joint_solve>(byte() % (one_in(16) ? 4 : 3));
        spoil(base.reserved[0]);
        return def;
    }
};

}  // namespace taut_test
