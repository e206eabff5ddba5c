// Calls of cable.h.
#pragma once

#include "host.h"

namespace taut_test {

class CableCalls : protected virtual Host {
protected:
    void add_cable() {
        if (live(cables_, taut_cable_is_valid) >= kMostCables) return;
        const size_t w = pick_world();
        taut_pos path[5];
        taut_cable_def def = cable_def(w);
        def.point_count = one_in(4) ? 0 : 2 + byte() % 4;
        def.points = one_in(32) ? nullptr : path;
        path[0] = pos(10);
        for (int i = 1; i < 5; ++i) {
            const taut_vec3 on = vec(2);
            path[i] = {path[i - 1].x + static_cast<double>(on.x), path[i - 1].y + static_cast<double>(on.y),
                       path[i - 1].z + static_cast<double>(on.z)};
        }
        taut_cable out = {0};
        if (!run("taut_world_add_cable", [&] { return taut_world_add_cable(worlds_[w], &def, &out); })) return;
        keep(cables_, out, w);
        keep_parts(out, w);
        // Attached to a body that is far away it may have thousands of segments: right, but slow.
        if (count_bodies(out) > 64) taut_cable_remove(out);
    }

    void remove_cable() {
        if (!one_in(4)) return;
        const taut_cable cable = pick(cables_, pick_world());
        if (run("taut_cable_remove", [&] { return taut_cable_remove(cable); }))
            expect(!taut_cable_is_valid(cable), "a removed cable that lives");
    }

    void read_cable() {
        const taut_cable cable = pick(cables_, pick_world());
        uint64_t data = 0;
        ask("taut_cable_get_user_data", [&] { return taut_cable_get_user_data(cable, &data); });
        float length;
        if (ask("taut_cable_get_length", [&] { return taut_cable_get_length(cable, &length); }))
            expect(length > 0 && std::isfinite(length), "a length that is none");
        std::vector<taut_pos> points(byte());
        uint32_t count = 0;
        if (ask("taut_cable_get_points", [&] {
                return taut_cable_get_points(cable, points.data(), static_cast<uint32_t>(points.size()), &count);
            }))
            for (uint32_t i = 0; i < count; ++i) expect(finite(points[i]), "a point that is not finite");
        const uint32_t segments = count - 1;
        std::vector<float> tensions(byte());
        if (ask("taut_cable_get_tensions", [&] {
                return taut_cable_get_tensions(cable, tensions.data(), static_cast<uint32_t>(tensions.size()), &count);
            }))
            for (uint32_t i = 0; i < count; ++i) expect(!std::isnan(tensions[i]), "a tension that is none");
        expect(count == segments || !taut_cable_is_valid(cable), "segments that are not one less than points");
        std::vector<taut_body> bodies(byte());
        if (ask("taut_cable_get_bodies", [&] {
                return taut_cable_get_bodies(cable, bodies.data(), static_cast<uint32_t>(bodies.size()), &count);
            }))
            for (uint32_t i = 0; i < count; ++i) {
                taut_cable of = {0};
                expect(taut_body_get_cable(bodies[i], &of) == TAUT_OK && of.bits == cable.bits, "bodies of none");
            }
        const uint32_t end = byte() % 3;
        float speed;
        if (ask("taut_cable_get_reel_speed", [&] { return taut_cable_get_reel_speed(cable, end, &speed); }))
            expect(std::isfinite(speed), "a speed that is none");
        taut_joint joint;
        if (ask("taut_cable_get_end_joint", [&] { return taut_cable_get_end_joint(cable, end, &joint); }))
            expect(joint.bits == 0 || taut_joint_is_valid(joint), "an end at a dead joint");
    }

    void reel_cable() {
        const size_t w = pick_world();
        const taut_cable cable = pick(cables_, w);
        const uint32_t end = byte() % (one_in(8) ? 3 : 2);
        // Long ones are hauled in: time is not what is looked for here.
        const float most = count_bodies(cable) > 24 ? 0.0f : 1.0f;
        const float speed = real(-2, 2 * most), acceleration = real(0, 10), metres = real(-1, most);
        run("taut_cable_set_reel_speed", [&] { return taut_cable_set_reel_speed(cable, end, speed, acceleration); });
        if (one_in(20)) run("taut_cable_cut", [&] { return taut_cable_cut(cable, byte() % 8); });
        if (one_in(2)) run("taut_cable_reel", [&] { return taut_cable_reel(cable, end, metres); });
        if (taut_cable_is_valid(cable) && one_in(4)) keep_parts(cable, world_of(cables_, cable, w));
    }

private:
    taut_cable_def cable_def(size_t w) {
        taut_cable_def def;
        taut_cable_def_init(&def);
        spoil(def.struct_size);
        def.kind = static_cast<taut_cable_kind>(byte() % (one_in(16) ? 3 : 2));
        for (taut_cable_end_def& end : def.end) {
            end.attached = byte() & 1;
            end.body = one_in(3) ? taut_body{0} : pick_body(w);
            end.anchor = end.body.bits == 0 ? pos(10) : one_in(2) ? pos(1) : taut_pos{0, 0, 0};
            end.clamped = one_in(4);
        }
        if (one_in(2)) def.segment_count = byte() % 12;
        if (one_in(4)) def.segment_length = real(0.3, 2);
        if (one_in(8)) def.length = real(0, 10);
        def.diameter = real(0.005, 0.3);
        def.mass_per_metre = real(0.01, 10);
        if (one_in(3)) def.stretch_compliance = real(0, 0.01), def.stretch_damping = real(0, 10);
        if (one_in(2)) def.bending_stiffness = real(1e-6, 100), def.bending_damping = real(0, 1);
        def.material = material(2);
        if (one_in(8)) def.filter = {word(), word(), static_cast<int32_t>(byte() % 5) - 2, 0};
        def.self_collision = byte() & 1;
        spoil(def.self_collision);
        return def;
    }
    static uint32_t count_bodies(taut_cable cable) {
        uint32_t count = 0;
        taut_cable_get_bodies(cable, nullptr, 0, &count);
        return count;
    }
    // A few of the bodies and joints, so that other calls meet them.
    void keep_parts(taut_cable cable, size_t w) {
        std::vector<taut_body> bodies(64);
        uint32_t count = 0;
        if (taut_cable_get_bodies(cable, bodies.data(), static_cast<uint32_t>(bodies.size()), &count) != TAUT_OK)
            return;
        for (uint32_t i = 0; i < count; i += 4) {
            keep(cable_bodies_, bodies[i], w);
            keep_colliders(bodies[i], w);
        }
        for (uint32_t end = 0; end < 2; ++end) {
            taut_joint joint = {0};
            taut_cable_get_end_joint(cable, end, &joint);
            if (joint.bits) keep(cable_joints_, joint, w);
        }
    }
};

}  // namespace taut_test
