// Calls of body.h.
#pragma once

#include "host.h"

namespace taut_test {

class BodyCalls : protected virtual Host {
protected:
    void add_body() {
        if (live(bodies_, taut_body_is_valid) >= kMostBodies) return;
        const size_t w = pick_world();
        taut_body_def def;
        taut_body_def_init(&def);
        spoil(def.struct_size);
        const uint8_t kind = byte();
        def.kind = static_cast<taut_body_kind>(kind < 4 ? kind : kind < 40 ? kind % 2 : 2);
        def.position = pos(reach(10));
        def.rotation = quat();
        if (def.kind != TAUT_BODY_STATIC || one_in(32)) {
            def.linear_velocity = vec(10);
            def.angular_velocity = vec(10);
        }
        def.shape = pick(shapes_, w);
        def.material = material(2);
        def.density = real(1, 5000);
        if (one_in(3)) def.mass = one_in(8) ? scale(1e-6, 1e15) : real(0.01, 1000);
        if (one_in(8))
            def.inertia = {real(0.1, 10), real(0.1, 10), real(0.1, 10), real(-1, 1), real(-1, 1), real(-1, 1)};
        if (one_in(8)) def.centre_of_mass = vec(1);
        if (one_in(8)) def.filter = {word(), word(), static_cast<int32_t>(byte() % 5) - 2, one_in(32) ? 1u : 0u};
        if (one_in(8)) def.collider_flags = byte() % (one_in(16) ? 16 : 8);
        if (one_in(8)) def.contact_events = byte() % (one_in(16) ? 32 : 16);
        def.gravity_scale = real(-2, 2);
        if (one_in(4)) def.linear_damping = damping(), def.angular_damping = damping();
        if (one_in(6)) def.locked_axes = byte() % (one_in(16) ? 256 : 64);
        if (one_in(8)) def.max_linear_speed = real(0, 20), def.max_angular_speed = real(0, 20);
        taut_collider_def colliders[2];
        for (taut_collider_def& collider : colliders) collider = collider_def(w);
        if (one_in(8)) def.colliders = colliders, def.collider_count = 1 + byte() % 2;
        taut_body out = {0};
        if (run("taut_world_add_body", [&] { return taut_world_add_body(worlds_[w], &def, &out); })) {
            keep(bodies_, out, w);
            keep_colliders(out, w);
        }
    }

    void add_particle() {
        if (live(bodies_, taut_body_is_valid) >= kMostBodies) return;
        const size_t w = pick_world();
        taut_particle_def def;
        taut_particle_def_init(&def);
        spoil(def.struct_size);
        def.mass = one_in(8) ? scale(1e-9, 1e21) : one_in(4) ? real(1e-9, 1e6) : real(0.1, 10);
        def.position = pos(10);
        def.velocity = vec(10);
        if (one_in(2)) def.shape = pick(shapes_, w);
        if (one_in(4)) def.damping = damping();
        if (one_in(8)) def.max_speed = real(0, 20);
        taut_body out = {0};
        if (run("taut_world_add_particle", [&] { return taut_world_add_particle(worlds_[w], &def, &out); })) {
            keep(bodies_, out, w);
            keep_colliders(out, w);
        }
    }

    // Poses and velocities of several at once are those of each alone.
    void read_states() {
        const size_t w = pick_world();
        taut_body bodies[4];
        for (taut_body& body : bodies) body = one_in(8) ? pick_body(w) : one_of(w);
        struct Row {
            taut_pose pose;
            taut_vec3 linear, angular;
            uint32_t rest[2];
        } rows[4];
        const size_t strides[] = {sizeof(Row), sizeof(Row), sizeof(Row), 4, 52};
        const size_t stride = strides[byte() % 5];
        const uint32_t wanted = byte() % 5;
        if (!ask("taut_world_get_body_states", [&] {
                return taut_world_get_body_states(worlds_[w], bodies, wanted, &rows[0].pose, stride, &rows[0].linear,
                                                  stride, &rows[0].angular, stride);
            }))
            return;
        for (uint32_t i = 0; i < wanted && stride == sizeof(Row); ++i) {
            taut_pose at;
            taut_vec3 v, turn;
            expect_finite(rows[i].pose);
            expect(taut_body_get_pose(bodies[i], &at) == TAUT_OK && std::memcmp(&at, &rows[i].pose, sizeof at) == 0,
                   "a pose of another");
            expect(taut_body_get_velocity(bodies[i], &v, &turn) == TAUT_OK &&
                       std::memcmp(&v, &rows[i].linear, sizeof v) == 0 &&
                       std::memcmp(&turn, &rows[i].angular, sizeof turn) == 0,
                   "a velocity of another");
        }
    }

    void read_body() {
        const taut_body body = pick_body(pick_world());
        taut_pose at;
        if (ask("taut_body_get_pose", [&] { return taut_body_get_pose(body, &at); })) expect_finite(at);
        if (ask("taut_body_get_render_pose", [&] { return taut_body_get_render_pose(body, &at); })) expect_finite(at);
        float mass;
        taut_vec3 centre;
        taut_sym3 inertia;
        if (ask("taut_body_get_mass", [&] { return taut_body_get_mass(body, &mass, &centre, &inertia); })) {
            expect(mass >= 0 && std::isfinite(mass) && finite(centre) && inertia.xx >= 0, "a mass that is none");
        }
        taut_body_kind kind;
        if (ask("taut_body_get_kind", [&] { return taut_body_get_kind(body, &kind); })) {
            expect(kind >= TAUT_BODY_STATIC && kind <= TAUT_BODY_PARTICLE, "a kind that is none");
        }
        taut_material material;
        if (ask("taut_body_get_material", [&] { return taut_body_get_material(body, &material); })) {
            expect(material.friction >= 0 && material.restitution <= 1, "a material that is none");
        }
        taut_cable cable;
        if (ask("taut_body_get_cable", [&] { return taut_body_get_cable(body, &cable); }))
            expect(cable.bits == 0 || taut_cable_is_valid(cable), "a body of a dead cable");
        taut_vec3 v, w;
        if (ask("taut_body_get_velocity", [&] { return taut_body_get_velocity(body, &v, &w); })) {
            expect(finite(v) && finite(w), "a velocity that is not finite");
        }
    }

    void write_body() {
        const taut_body body = pick_body(pick_world());
        switch (byte() % 8) {
            case 0: {
                const taut_pose to = pose();
                run("taut_body_set_pose", [&] { return taut_body_set_pose(body, &to); });
                break;
            }
            case 1: {
                const taut_vec3 linear = vec(one_in(16) ? 1e4 : 20), angular = one_in(2) ? taut_vec3{0, 0, 0} : vec(20);
                run("taut_body_set_velocity", [&] { return taut_body_set_velocity(body, linear, angular); });
                break;
            }
            case 2: {
                const taut_pose to = pose();
                run("taut_body_move_kinematic", [&] { return taut_body_move_kinematic(body, &to); });
                break;
            }
            case 3: {
                const taut_material changed = material(100);
                run("taut_body_set_material", [&] { return taut_body_set_material(body, &changed); });
                break;
            }
            case 4: {
                const uint32_t asked = byte() % (one_in(16) ? 32 : 16);
                run("taut_body_set_contact_events", [&] { return taut_body_set_contact_events(body, asked); });
                break;
            }
            case 5:
                run("taut_body_set_mass_from_colliders", [&] { return taut_body_set_mass_from_colliders(body); });
                break;
            case 6: {
                if (!one_in(8)) break;
                if (run("taut_body_remove", [&] { return taut_body_remove(body); }))
                    expect(!taut_body_is_valid(body), "a removed body that lives");
                break;
            }
            default: {
                const uint64_t value = word();
                if (!run("taut_body_set_user_data", [&] { return taut_body_set_user_data(body, value); })) return;
                uint64_t read = 0;
                taut_body_get_user_data(body, &read);
                expect(read == value, "user data that changed");
            }
        }
    }

    // What is set is read.
    void change_body() {
        const taut_body body = pick_body(pick_world());
        const float a = damping(), b = one_in(2) ? 0 : damping();
        float linear = 0, angular = 0;
        switch (byte() % 8) {
            case 7: {
                const uint32_t axes = one_in(2) ? 0 : byte() % (one_in(16) ? 256 : 64);
                uint32_t read = 0;
                if (!run("taut_body_set_locked_axes", [&] { return taut_body_set_locked_axes(body, axes); })) break;
                expect(ask("taut_body_get_locked_axes", [&] { return taut_body_get_locked_axes(body, &read); }) &&
                           read == axes,
                       "locked axes of another");
                break;
            }
            case 0:
                if (!run("taut_body_set_damping", [&] { return taut_body_set_damping(body, a, b); })) break;
                expect(ask("taut_body_get_damping", [&] { return taut_body_get_damping(body, &linear, &angular); }) &&
                           linear == a && angular == b,
                       "a damping of another");
                break;
            case 1: {
                const float limit = real(0, 30);
                if (!run("taut_body_set_max_speed", [&] { return taut_body_set_max_speed(body, limit, b); })) break;
                expect(
                    ask("taut_body_get_max_speed", [&] { return taut_body_get_max_speed(body, &linear, &angular); }) &&
                        linear == limit && angular == b,
                    "a greatest speed of another");
                break;
            }
            case 2: {
                const float scale = real(-2, 2);
                if (!run("taut_body_set_gravity_scale", [&] { return taut_body_set_gravity_scale(body, scale); }))
                    break;
                expect(ask("taut_body_get_gravity_scale", [&] { return taut_body_get_gravity_scale(body, &linear); }) &&
                           linear == scale,
                       "a gravity of another");
                break;
            }
            case 3: {
                const float mass = one_in(3) ? 0 : real(0.01, 1000);
                const taut_vec3 centre = one_in(2) ? taut_vec3{0, 0, 0} : vec(1);
                taut_sym3 inertia = {0, 0, 0, 0, 0, 0};
                if (one_in(2)) inertia = {real(1, 10), real(1, 10), real(1, 10), real(-1, 1), 0, real(-1, 1)};
                run("taut_body_set_mass", [&] { return taut_body_set_mass(body, mass, centre, inertia); });
                break;
            }
            case 4: {
                const auto kind = static_cast<taut_body_kind>(byte() % (one_in(8) ? 5 : 3));
                if (!run("taut_body_set_kind", [&] { return taut_body_set_kind(body, kind); })) break;
                taut_body_kind now = TAUT_BODY_PARTICLE;
                expect(taut_body_get_kind(body, &now) == TAUT_OK && now == kind, "a kind of another");
                break;
            }
            case 5: {
                const uint32_t enabled = byte() % (one_in(8) ? 3 : 2);
                if (!run("taut_body_set_enabled", [&] { return taut_body_set_enabled(body, enabled); })) break;
                uint32_t now = 2;
                expect(
                    ask("taut_body_get_enabled", [&] { return taut_body_get_enabled(body, &now); }) && now == enabled,
                    "a switch that is not where it was put");
                break;
            }
            default: {
                char name[40];
                const uint32_t length = byte() % 40;
                for (uint32_t i = 0; i < length; ++i) name[i] = static_cast<char>('a' + i % 26);
                name[length < 40 ? length : 39] = 0;
                const bool none = one_in(8);
                if (!run("taut_body_set_name", [&] { return taut_body_set_name(body, none ? nullptr : name); })) break;
                char read[TAUT_BODY_NAME_SIZE];
                uint32_t count = 0;
                expect(ask("taut_body_get_name", [&] { return taut_body_get_name(body, read, sizeof read, &count); }) &&
                           count == std::strlen(read) + 1 && std::strcmp(read, none ? "" : name) == 0,
                       "a name of another");
            }
        }
    }

    // There and back again, and where the box about a body is.
    void look_at_body() {
        const taut_body body = pick_body(pick_world());
        const taut_vec3 local = vec(2);
        taut_pos point;
        taut_vec3 back, along, speed;
        if (ask("taut_body_get_world_point", [&] { return taut_body_get_world_point(body, local, &point); })) {
            const bool within = std::abs(point.x) <= 1e7 && std::abs(point.y) <= 1e7 && std::abs(point.z) <= 1e7;
            if (ask("taut_body_get_local_point", [&] { return taut_body_get_local_point(body, point, &back); }))
                expect(std::abs(back.x - local.x) + std::abs(back.y - local.y) + std::abs(back.z - local.z) <=
                           1e-5f * (1 + std::abs(local.x) + std::abs(local.y) + std::abs(local.z)),
                       "a point that is elsewhere on its return");
            else
                expect(!within, "a point that has no way back");
            if (ask("taut_body_get_point_velocity", [&] { return taut_body_get_point_velocity(body, point, &speed); }))
                expect(finite(speed), "a velocity that is not finite");
        }
        if (ask("taut_body_get_world_vector", [&] { return taut_body_get_world_vector(body, local, &along); }))
            ask("taut_body_get_local_vector", [&] { return taut_body_get_local_vector(body, along, &back); });
        taut_pos low, high;
        if (ask("taut_body_get_bounds", [&] { return taut_body_get_bounds(body, &low, &high); }))
            expect(low.x <= high.x && low.y <= high.y && low.z <= high.z, "a box that is none");
    }

    // Of what lists name everything lives, and nothing else does.
    void read_lists() {
        const size_t w = pick_world();
        std::vector<taut_body> bodies(1024);
        std::vector<taut_joint> joints(256), own(256);
        std::vector<taut_shape> shapes(256);
        uint32_t count = 0, all = 0;
        if (ask("taut_world_get_bodies",
                [&] { return taut_world_get_bodies(worlds_[w], bodies.data(), 1024, &count); }))
            for (uint32_t i = 0; i < count; ++i) expect(taut_body_is_valid(bodies[i]) == 1, "a dead body is listed");
        taut_world_get_counts(worlds_[w], &all, nullptr, nullptr);
        expect(count == all, "a list of bodies that is another's");
        count = 0;
        if (ask("taut_world_get_joints", [&] { return taut_world_get_joints(worlds_[w], joints.data(), 256, &count); }))
            for (uint32_t i = 0; i < count; ++i) expect(taut_joint_is_valid(joints[i]) == 1, "a dead joint is listed");
        if (ask("taut_world_get_shapes", [&] { return taut_world_get_shapes(worlds_[w], shapes.data(), 256, &count); }))
            for (uint32_t i = 0; i < count; ++i) expect(taut_shape_is_valid(shapes[i]) == 1, "a dead shape is listed");
        const taut_body body = pick_body(w);
        if (ask("taut_body_get_joints", [&] { return taut_body_get_joints(body, own.data(), 256, &count); }))
            for (uint32_t i = 0; i < count; ++i) {
                taut_body a, b, housing;
                expect(taut_joint_get_bodies(own[i], &a, &b) == TAUT_OK &&
                           taut_joint_get_housing(own[i], &housing) == TAUT_OK &&
                           (a.bits == body.bits || b.bits == body.bits || housing.bits == body.bits),
                       "a joint of another");
            }
        std::vector<taut_contact> contacts(1024);
        if (ask("taut_body_get_contacts", [&] { return taut_body_get_contacts(body, contacts.data(), 1024, &count); }))
            for (uint32_t i = 0; i < count; ++i)
                expect(contacts[i].body_a.bits == body.bits || contacts[i].body_b.bits == body.bits,
                       "a contact of another");
    }

    void push_body() {
        const taut_body body = pick_body(pick_world());
        const taut_vec3 push = vec(one_in(16) ? 1e8 : 100), turn = one_in(2) ? taut_vec3{0, 0, 0} : vec(100);
        const taut_pos point = pos(10);
        switch (byte() % 4) {
            case 0:
                run("taut_body_apply_force", [&] { return taut_body_apply_force(body, push, turn); });
                break;
            case 1:
                run("taut_body_apply_force_at", [&] { return taut_body_apply_force_at(body, push, point); });
                break;
            case 2:
                run("taut_body_apply_impulse", [&] { return taut_body_apply_impulse(body, push, turn); });
                break;
            default:
                run("taut_body_apply_impulse_at", [&] { return taut_body_apply_impulse_at(body, push, point); });
        }
    }

    // Pushed beyond all speed now and then, which the next step freezes.
    void let_go() {
        const taut_body body = pick_body(pick_world());
        if (one_in(4)) run("taut_body_apply_force", [&] { return taut_body_apply_force(body, {1e24f, 0, 0}, {}); });
        taut_quarantine_reason why = TAUT_QUARANTINE_NONE;
        run("taut_body_get_quarantine", [&] { return taut_body_get_quarantine(body, &why); });
        expect(why <= TAUT_QUARANTINE_TOO_FAST, "no reason of a quarantine");
        if (!run("taut_body_release", [&] { return taut_body_release(body); })) return;
        expect(why != TAUT_QUARANTINE_NONE, "who was in no quarantine is let go");
        expect(taut_body_get_quarantine(body, &why) == TAUT_OK && why == TAUT_QUARANTINE_NONE,
               "who was let go is held");
    }

private:
    float damping() { return one_in(8) ? scale(1e-3, 1e6) : real(0, 10); }
    // A live body of a world, null if there is none.
    taut_body one_of(size_t w) {
        for (int attempt = 0; attempt < 8 && !bodies_.empty(); ++attempt) {
            const Known<taut_body>& body = bodies_[word() % bodies_.size()];
            if (body.world == w && taut_body_is_valid(body.handle)) return body.handle;
        }
        return {0};
    }
};

}  // namespace taut_test
