// Calls of character.h, vehicle.h, ragdoll.h and forces.h.
#pragma once

#include <cstddef>

#include "query_values.h"

namespace taut_test {

class MoverCalls : protected virtual QueryValues {
protected:
    void move_character() {
        const size_t w = pick_world();
        if (one_in(4)) {
            taut_character_init(&character_[w]);
            character_[w].position = pos(reach(10));
        }
        taut_character_def def;
        taut_character_def_init(&def);
        spoil(def.struct_size);
        def.shape = pick(shapes_, w);
        if (one_in(4)) def.body = pick_body(w);
        if (one_in(4)) def.up = vec(1);
        if (one_in(4)) def.gap = real(1e-4, 0.1), def.step_height = real(0, 1), def.max_slope = real(0, 1.55);
        if (one_in(4)) def.push_force = real(0, 1e9), def.mass = real(0, 1e6), def.gravity = real(0, 1e4);
        if (one_in(4)) def.acceleration = real(0, 1e6), def.air_acceleration = real(0, 1e6);
        const Filter filter = query_filter(w);
        def.filter = filter.get();
        const taut_character before = character_[w];
        const taut_vec3 walk = vec(10);
        const float jump = one_in(4) ? real(0, 10) : 0, seconds = one_in(8) ? real(0, 1) : 1 / 60.0f;
        if (run("taut_character_move",
                [&] { return taut_character_move(worlds_[w], &def, walk, jump, seconds, &character_[w]); })) {
            expect(finite(character_[w].position) && finite(character_[w].velocity), "a character that is not finite");
            expect(character_[w].state <= TAUT_CHARACTER_SLIDING, "a state that is none");
            expect_finite(character_[w].ground_pose);
            expect_all_finite();
        } else {
            expect(std::memcmp(&before, &character_[w], sizeof before) == 0, "a refused call moved a character");
        }
        if (one_in(16)) spoil_bytes(&character_[w], sizeof character_[w]);
    }

    void drive_vehicle() {
        const size_t w = pick_world();
        if (one_in(8)) taut_vehicle_init(&vehicle_[w]);
        taut_wheel_def wheels[3];
        for (taut_wheel_def& wheel : wheels) {
            taut_wheel_def_init(&wheel);
            wheel.position = vec(1);
            if (one_in(4)) wheel.stiffness = scale(1, 1e12), wheel.compression_damping = scale(1, 1e12);
            if (one_in(4)) wheel.radius = real(0.01, 2), wheel.travel = real(0.01, 2), wheel.inertia = scale(1e-6, 1e9);
            if (one_in(4)) wheel.friction = real(0, 100), wheel.relaxation = real(0.01, 10);
            if (one_in(4)) wheel.shape = pick(shapes_, w);
            wheel.steering = real(-1.5, 1.5);
            wheel.drive = real(0, 1);
        }
        const taut_engine_point torque[] = {{0, real(0, 300)}, {real(1, 500), real(0, 300)}, {600, real(-100, 300)}};
        const float gears[] = {real(0.1, 20), real(0.1, 20)};
        taut_vehicle_def def;
        taut_vehicle_def_init(&def);
        spoil(def.struct_size);
        def.chassis = pick_body(w);
        def.wheels = wheels;
        def.wheel_count = one_in(32) ? byte() : 1 + byte() % 3;
        if (def.wheel_count > 3 && def.wheel_count <= TAUT_VEHICLE_MAX_WHEELS) def.wheel_count = 3;
        def.torque = torque;
        def.torque_count = byte() % 4;
        def.gears = gears;
        def.gear_count = byte() % 3;
        if (one_in(8)) def.forward = vec(1), def.up = vec(1);
        const Filter filter = query_filter(w);
        def.filter = filter.get();
        taut_vehicle_input input;
        taut_vehicle_input_init(&input);
        input.throttle = real(0, 1);
        if (one_in(2)) input.brake = real(0, 1), input.handbrake = real(0, 1);
        input.steering = real(-1, 1);
        input.gear = one_in(2) ? TAUT_VEHICLE_AUTOMATIC : byte() % 4 - 1;
        const float seconds = one_in(8) ? real(1e-4, 0.1) : 1 / 60.0f;
        const taut_vehicle before = vehicle_[w];
        if (run("taut_vehicle_drive",
                [&] { return taut_vehicle_drive(worlds_[w], &def, &input, seconds, &vehicle_[w]); })) {
            for (uint32_t i = 0; i < def.wheel_count; ++i) {
                const taut_wheel& wheel = vehicle_[w].wheels[i];
                expect_finite(wheel.pose);
                expect(
                    finite(wheel.force) && std::isfinite(wheel.speed) && std::isfinite(wheel.slip[0] + wheel.slip[1]),
                    "a wheel that is not finite");
            }
            expect_all_finite();
        } else {
            expect(std::memcmp(&before, &vehicle_[w], sizeof before) == 0, "a refused call drove a vehicle");
        }
        if (one_in(16)) spoil_bytes(&vehicle_[w], sizeof vehicle_[w]);
    }

    void put_in_fluid() {
        const size_t w = pick_world();
        const taut_body body = pick_body(w);
        taut_fluid_def def;
        taut_fluid_def_init(&def);
        spoil(def.struct_size);
        def.point = pos(reach(10));
        if (one_in(4)) def.normal = one_in(2) ? taut_vec3{0, 0, 0} : vec(1);
        if (one_in(4)) def.density = scale(1e-3, 1e6), def.drag = real(0, 100), def.skin_drag = real(0, 1e9);
        if (one_in(4)) def.velocity = vec(100), def.gravity = vec(20);
        const float seconds = one_in(8) ? real(0, 1) : 1 / 60.0f;
        taut_fluid_report report;
        if (run("taut_body_apply_fluid", [&] { return taut_body_apply_fluid(body, &def, seconds, &report); }))
            expect(finite(report.force) && finite(report.torque) && finite(report.centre) && report.volume >= 0,
                   "a report that is not finite");
    }

    void blow_up() {
        const size_t w = pick_world();
        taut_explosion_def def;
        taut_explosion_def_init(&def);
        spoil(def.struct_size);
        def.position = pos(reach(10));
        def.radius = real(0.1, 20);
        def.impulse = one_in(16) ? real(-1e12, 1e12) : real(-100, 100);
        def.falloff = byte() % (one_in(16) ? 255 : 17);
        def.occlusion = one_in(2);
        const Filter filter = query_filter(w);
        def.filter = filter.get();
        uint32_t pushed = 0;
        if (run("taut_world_apply_explosion", [&] { return taut_world_apply_explosion(worlds_[w], &def, &pushed); }))
            expect_all_finite();
    }

    void use_ragdoll() {
        const size_t w = pick_world();
        taut_ragdoll& ragdoll = ragdoll_[w];
        taut_bone_def bones[3];
        for (uint32_t i = 0; i < 3; ++i) {
            taut_bone_def_init(&bones[i]);
            bones[i].parent = i == 0 || one_in(4) ? -1 : static_cast<int32_t>(i) - 1;
            if (one_in(16)) bones[i].parent = static_cast<int32_t>(word());
            bones[i].shape = pick(shapes_, w);
            bones[i].pose = pose();
            bones[i].joint = pose();
            if (one_in(2)) bones[i].mass = real(0.1, 10);
            if (one_in(4)) bones[i].lower = {real(-3, 0), real(-1.5, 0), 0}, bones[i].upper = {real(0, 3), 0, 0};
            if (one_in(4)) bones[i].frequency = real(0, 100), bones[i].max_torque = real(0, 1e6);
            spoil(bones[i].struct_size);
        }
        taut_ragdoll_def def;
        taut_ragdoll_def_init(&def);
        spoil(def.struct_size);
        def.bones = bones;
        def.bone_count = 1 + byte() % 3;
        if (one_in(4)) def.pose = pose();
        const taut_ragdoll before = ragdoll;
        const auto unchanged = [&] {
            expect(std::memcmp(&before, &ragdoll, sizeof before) == 0, "a refused call changed a ragdoll");
        };
        taut_pose poses[3] = {pose(), pose(), pose()};
        switch (byte() % 5) {
            case 0:
                if (live(bodies_, taut_body_is_valid, w) + 3 > kMostBodies) return;
                if (!run("taut_world_add_ragdoll", [&] { return taut_world_add_ragdoll(worlds_[w], &def, &ragdoll); }))
                    return unchanged();
                for (uint32_t i = 0; i < ragdoll.bone_count; ++i) {
                    keep(bodies_, ragdoll.bodies[i], w);
                    keep_colliders(ragdoll.bodies[i], w);
                    if (ragdoll.joints[i].bits != 0) keep(joints_, ragdoll.joints[i], w);
                }
                return;
            case 1:
                if (one_in(4)) run("taut_ragdoll_remove", [&] { return taut_ragdoll_remove(&ragdoll); });
                return;
            case 2:
                if (ask("taut_ragdoll_get_poses", [&] { return taut_ragdoll_get_poses(&ragdoll, poses, 3); }))
                    for (uint32_t i = 0; i < ragdoll.bone_count; ++i) expect_finite(poses[i]);
                return;
            case 3:
                if (ragdoll.bone_count > 3) return;
                if (run("taut_ragdoll_set_poses", [&] { return taut_ragdoll_set_poses(&ragdoll, poses); }))
                    expect_all_finite();
                return;
            default: {
                const auto mode = static_cast<taut_ragdoll_mode>(byte() % (one_in(16) ? 8 : 4));
                const float seconds = one_in(8) ? real(0, 1) : 1 / 60.0f;
                if (run("taut_ragdoll_drive", [&] { return taut_ragdoll_drive(&def, mode, poses, seconds, &ragdoll); }))
                    expect_all_finite();
                else
                    unchanged();
            }
        }
    }

private:
    // Anything may be in a host's memory but a size beyond it.
    void spoil_bytes(void* at, size_t size) {
        auto* bytes = static_cast<unsigned char*>(at);
        bytes[sizeof(uint32_t) + word() % (size - sizeof(uint32_t))] = byte();
    }

    static taut_character new_character() {
        taut_character out;
        taut_character_init(&out);
        return out;
    }
    static taut_vehicle new_vehicle() {
        taut_vehicle out;
        taut_vehicle_init(&out);
        return out;
    }

    static taut_ragdoll new_ragdoll() {
        taut_ragdoll out;
        taut_ragdoll_init(&out);
        return out;
    }

    taut_character character_[2] = {new_character(), new_character()};
    taut_vehicle vehicle_[2] = {new_vehicle(), new_vehicle()};
    taut_ragdoll ragdoll_[2] = {new_ragdoll(), new_ragdoll()};
};

}  // namespace taut_test
