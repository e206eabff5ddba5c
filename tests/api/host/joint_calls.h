// Calls of joint.h on joints that are there.
#pragma once

#include "joint_defs.h"

namespace taut_test {

class JointCalls : protected virtual JointDefs {
protected:
    void remove_joint() {
        if (!one_in(2)) return;
        const taut_joint joint = pick_joint();
        if (run("taut_joint_remove", [&] { return taut_joint_remove(joint); }))
            expect(!taut_joint_is_valid(joint), "a removed joint that lives");
    }

    void read_joint() {
        const taut_joint joint = pick_joint();
        taut_pos a, b;
        if (ask("taut_joint_get_anchors", [&] { return taut_joint_get_anchors(joint, &a, &b); })) {
            expect(finite(a) && finite(b), "an anchor that is not finite");
        }
        float error;
        if (ask("taut_joint_get_error", [&] { return taut_joint_get_error(joint, &error); })) {
            expect(error >= 0, "an error that is none");
        }
        taut_vec3 force;
        ask("taut_joint_get_force", [&] { return taut_joint_get_force(joint, &force); });
        taut_joint_kind kind;
        ask("taut_joint_get_kind", [&] { return taut_joint_get_kind(joint, &kind); });
        taut_body body_a, body_b;
        if (ask("taut_joint_get_bodies", [&] { return taut_joint_get_bodies(joint, &body_a, &body_b); })) {
            expect(body_a.bits == 0 || taut_body_is_valid(body_a), "a joint on a dead body");
            expect(body_b.bits == 0 || taut_body_is_valid(body_b), "a joint on a dead body");
        }
        if (ask("taut_joint_get_angular_error", [&] { return taut_joint_get_angular_error(joint, &error); }))
            expect(error >= 0, "an error that is none");
        taut_vec3 torque;
        if (ask("taut_joint_get_torque", [&] { return taut_joint_get_torque(joint, &torque); }))
            expect(!std::isnan(torque.x) && !std::isnan(torque.y) && !std::isnan(torque.z), "a torque that is none");
        taut_frame frame_a, frame_b;
        if (ask("taut_joint_get_frames", [&] { return taut_joint_get_frames(joint, &frame_a, &frame_b); }))
            expect(finite(frame_a.position) && finite(frame_b.position), "a frame that is not finite");
        taut_body housing;
        if (ask("taut_joint_get_housing", [&] { return taut_joint_get_housing(joint, &housing); }))
            expect(housing.bits == 0 || taut_body_is_valid(housing), "a joint in a dead housing");
        if (ask("taut_joint_get_housing_frames",
                [&] { return taut_joint_get_housing_frames(joint, &frame_a, &frame_b); }))
            expect(finite(frame_a.position) && finite(frame_b.position), "a housing frame that is not finite");
        float number;
        if (ask("taut_joint_get_ratio", [&] { return taut_joint_get_ratio(joint, &number); }))
            expect(std::isfinite(number) && number != 0, "a ratio that is none");
        if (ask("taut_joint_get_length", [&] { return taut_joint_get_length(joint, &number); }))
            expect(number > 0, "a length that is none");
        uint32_t axes = 0;
        const bool known = ask("taut_joint_get_axis_count", [&] { return taut_joint_get_axis_count(joint, &axes); });
        const uint32_t axis = byte() % 8;
        float value, rate;
        const bool read =
            ask("taut_joint_get_coordinates", [&] { return taut_joint_get_coordinates(joint, axis, &value, &rate); });
        expect(read == (known && axis < axes), "an axis that is there and is not");
        expect(!read || (std::isfinite(value) && std::isfinite(rate)), "a coordinate that is not finite");
        taut_axis_forces forces;
        if (ask("taut_joint_get_axis_forces", [&] { return taut_joint_get_axis_forces(joint, axis, &forces); }))
            expect(std::abs(forces.active_stop) <= 1 && forces.reserved == 0, "forces that are none");
        taut_axis_def def;
        if (ask("taut_joint_get_axis", [&] { return taut_joint_get_axis(joint, axis, &def); })) {
            // What is read can be written, and changes nothing.
            const uint64_t before[2] = {hash(0), hash(1)};
            expect(run("taut_joint_set_axis", [&] { return taut_joint_set_axis(joint, axis, &def); }),
                   "an axis that is read but not taken");
            expect(before[0] == hash(0) && before[1] == hash(1), "an axis that is not what was read");
        }
    }

    void write_joint() {
        const taut_joint joint = pick_joint();
        const float a = real(0, one_in(8) ? 1e6 : 0.01), b = real(0, 100), length = real(1e-4, 5);
        run("taut_joint_set_compliance", [&] { return taut_joint_set_compliance(joint, a, b); });
        run("taut_joint_set_length", [&] { return taut_joint_set_length(joint, length); });
        const uint32_t axis = byte() % 6;
        switch (byte() % 11) {
            case 8: {
                const float ratio = real(-3, 3);
                if (!run("taut_joint_set_ratio", [&] { return taut_joint_set_ratio(joint, ratio); })) break;
                float now = 0;
                expect(ask("taut_joint_get_ratio", [&] { return taut_joint_get_ratio(joint, &now); }) && now == ratio,
                       "a ratio that is not what was set");
                break;
            }
            case 9: {
                const taut_frame frame_a = joint_frame(), frame_b = joint_frame();
                run("taut_joint_set_housing_frames",
                    [&] { return taut_joint_set_housing_frames(joint, &frame_a, &frame_b); });
                break;
            }
            case 7: {
                const uint32_t enabled = byte() % (one_in(8) ? 3 : 2);
                if (!run("taut_joint_set_enabled", [&] { return taut_joint_set_enabled(joint, enabled); })) break;
                uint32_t now = 2;
                expect(ask("taut_joint_get_enabled", [&] { return taut_joint_get_enabled(joint, &now); }) &&
                           now == enabled,
                       "a switch that is not where it was put");
                break;
            }
            case 0: {
                const taut_axis_def def = axis_def(true);
                run("taut_joint_set_axis", [&] { return taut_joint_set_axis(joint, axis, &def); });
                break;
            }
            case 1:
                run("taut_joint_set_target", [&] { return taut_joint_set_target(joint, axis, a, b); });
                break;
            case 2:
                run("taut_joint_set_angular_compliance",
                    [&] { return taut_joint_set_angular_compliance(joint, a, b); });
                break;
            case 3:
                run("taut_joint_set_break", [&] { return taut_joint_set_break(joint, 1e4f * a, b); });
                break;
            case 4: {
                const taut_joint_solve solve = static_cast<taut_joint_solve>(byte() % (one_in(8) ? 4 : 3));
                run("taut_joint_set_solve", [&] { return taut_joint_set_solve(joint, solve); });
                break;
            }
            case 5: {
                const taut_frame frame_a = joint_frame(), frame_b = joint_frame();
                run("taut_joint_set_frames", [&] { return taut_joint_set_frames(joint, &frame_a, &frame_b); });
                break;
            }
            case 6: {
                const uint32_t collide = byte() % (one_in(8) ? 4 : 3);
                run("taut_joint_set_collide_connected",
                    [&] { return taut_joint_set_collide_connected(joint, collide); });
                break;
            }
            default: {
                const uint64_t value = word();
                if (!run("taut_joint_set_user_data", [&] { return taut_joint_set_user_data(joint, value); })) return;
                uint64_t read = 0;
                taut_joint_get_user_data(joint, &read);
                expect(read == value, "user data that changed");
            }
        }
    }

private:
    taut_joint pick_joint() {
        const size_t w = pick_world();
        return one_in(6) ? pick(cable_joints_, w) : pick(joints_, w);
    }
};

}  // namespace taut_test
