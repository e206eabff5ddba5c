// Calls of world.h, snapshot.h, event.h, pre_solve.h, profile.h and lint.h.
#pragma once

#include <cstdlib>
#include <memory>

#include "aligned_memory.h"
#include "event_watch.h"

namespace taut_test {

class WorldCalls : protected virtual Host {
protected:
    void create(size_t w) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.solver = static_cast<taut_solver>(byte() % (one_in(4) ? 8 : 3));
        def.hooks = hooks();
        def.threads = one_in(4) ? 1 + byte() % 4 : 1;
        def.adaptive_damping = one_in(4);
        def.air_density = one_in(4) ? real(0, 10) : 1.2f;
        if (!(def.air_density >= 0 && def.air_density <= 10)) def.air_density = 0;
        if (one_in(8)) def.max_bodies = 4 + byte() % 64;
        if (one_in(8)) def.max_colliders = 4 + byte() % 64;
        if (one_in(8)) def.max_joints = 1 + byte() % 32;
        if (one_in(8)) def.max_contacts = 1 + byte() % 64;
        if (def.hooks.enqueue_task) def.threads = 1;
        def.substeps = 1 + byte() % 4;
        def.fixed_substeps = byte() & 1;
        def.sweeps = 1 + byte() % 4;
        def.sleeping = byte() & 1;
        def.sleep_time = 0.05f;
        def.continuous = byte() & 1;
        taut_world out = {0};
        call_ = "taut_world_create";
        expect(taut_solver_name(def.solver) != nullptr, "a solver without a name");
        expect(taut_version() > 0 && std::strcmp(taut_result_name(TAUT_OK), "TAUT_OK") == 0, "no version or name");
        if (taut_world_create(&def, &out) != TAUT_OK) expect(false, taut_last_error());
        worlds_[w] = out;
        if (created_) created_(out);
        record_new(w);
        watch_[w] = {};
        saved_[w] = {};
    }

    void replace_world() {
        if (!one_in(32)) return;
        const size_t w = pick_world();
        run("taut_world_destroy", [&] { return taut_world_destroy(worlds_[w]); });
        expect(!taut_world_is_valid(worlds_[w]), "a destroyed world that lives");
        create(w);
    }

    void write_world() {
        const size_t w = pick_world();
        const taut_world world = worlds_[w];
        const taut_vec3 gravity = vec(20);
        run("taut_world_set_gravity", [&] { return taut_world_set_gravity(world, gravity); });
        const taut_profile_scope_fn scope = [](const char*, uint32_t, uint32_t, void*) {};
        run("taut_world_set_profile_scopes",
            [&] { return taut_world_set_profile_scopes(world, one_in(2) ? scope : nullptr, nullptr); });
        // World 0 always tells of beginnings and ends, so that its books can be kept.
        const uint32_t asked = byte() % (one_in(16) ? 32 : 16) | (w == 0 ? TAUT_CONTACT_EVENTS_BEGIN_END : 0);
        run("taut_world_set_contact_events", [&] { return taut_world_set_contact_events(world, asked); });
        const float length = one_in(4) ? real(1e-3f, 0.05f) : 1.0f / 60;
        run("taut_world_set_time_step", [&] { return taut_world_set_time_step(world, length); });
        const uint32_t substeps = byte() % (one_in(16) ? 80 : 4) + 1;
        run("taut_world_set_substeps", [&] { return taut_world_set_substeps(world, substeps); });
        const float speed = real(0, 10);
        run("taut_world_set_hit_speed", [&] { return taut_world_set_hit_speed(world, speed); });
        const float slowest = one_in(2) ? 0 : real(0, 2);
        run("taut_world_set_restitution_threshold",
            [&] { return taut_world_set_restitution_threshold(world, slowest); });
        const taut_vec3 wind = vec(one_in(8) ? 1000 : 20);
        run("taut_world_set_wind", [&] { return taut_world_set_wind(world, wind); });
        taut_relaxation relaxed;
        if (one_in(4)) run("taut_world_relax", [&] { return taut_world_relax(world, 1, 3, &relaxed); });
        const taut_pre_solve_fn filter = one_in(2) ? judge : nullptr;
        run("taut_world_set_pre_solve", [&] { return taut_world_set_pre_solve(world, filter, this); });
    }

    void step() {
        const size_t w = pick_world();
        run("taut_world_step", [&] { return taut_world_step(worlds_[w]); });
        expect_all_finite();
        watch_step(w);
    }

    void advance() {
        const size_t w = pick_world();
        const double seconds = number(0, one_in(8) ? 0.05 : 1.0 / 60);
        taut_advance out;
        if (!run("taut_world_advance", [&] { return taut_world_advance(worlds_[w], seconds, &out); })) return;
        expect(out.fraction >= 0 && out.fraction < 1, "a fraction that is none");
        expect(out.steps <= 4 && out.dropped >= 0, "steps beyond the limit");
        expect_all_finite();
        if (out.steps > 0) watch_step(w);
    }

    void save_or_restore() {
        const size_t w = pick_world();
        if (saved_[w].bytes.empty() || one_in(2))
            save_world(w);
        else
            restore_world(w);
    }

    void read_events() {
        const taut_world world = worlds_[pick_world()];
        taut_events events;
        if (!ask("taut_world_get_events", [&] { return taut_world_get_events(world, &events); })) return;
        for (uint32_t i = 0; i < events.moved_count; ++i) expect_finite(events.moved[i].pose);
        for (uint32_t i = 0; i < events.broken_count; ++i)
            expect(!taut_joint_is_valid(events.broken[i].joint), "a broken joint that lives");
        for (uint32_t i = 0; i < events.detached_count; ++i)
            expect(!taut_attachment_is_valid(events.detached[i].attachment), "a broken attachment that lives");
        for (uint32_t i = 0; i < events.point_count; ++i) {
            const taut_contact_point& point = events.points[i];
            expect(finite(point.position) && std::isfinite(point.approach_speed), "a point that is not finite");
            expect(point.normal_impulse >= 0 && point.friction_impulse >= 0, "impulses that are none");
        }
        for (uint32_t i = 0; i < events.hit_count; ++i)
            expect(finite(events.hit[i].position) && events.hit[i].approach_speed > 0, "a hit that is none");
    }

    void read_world() {
        const taut_world world = worlds_[pick_world()];
        std::vector<taut_contact> contacts(byte());
        uint32_t count = 0;
        if (ask("taut_world_get_contacts", [&] {
                return taut_world_get_contacts(world, contacts.data(), static_cast<uint32_t>(contacts.size()), &count);
            })) {
            for (uint32_t i = 0; i < count; ++i) {
                expect(taut_body_is_valid(contacts[i].body_a) && taut_body_is_valid(contacts[i].body_b),
                       "a contact of a dead body");
                expect(finite(contacts[i].position) && finite(contacts[i].normal), "a contact that is not finite");
            }
        }
        taut_vec3 of_world;
        uint64_t bytes = 0;
        if (ask("taut_world_get_gravity", [&] { return taut_world_get_gravity(world, &of_world); }))
            expect(finite(of_world), "a gravity that is not finite");
        if (ask("taut_world_get_wind", [&] { return taut_world_get_wind(world, &of_world); }))
            expect(finite(of_world), "a wind that is not finite");
        if (ask("taut_world_get_bytes", [&] { return taut_world_get_bytes(world, &bytes); }))
            expect(bytes > 0, "bytes that are none");
        taut_profile profile;
        profile.struct_size = sizeof profile;
        spoil(profile.struct_size);
        ask("taut_world_get_profile", [&] { return taut_world_get_profile(world, &profile); });
        taut_world_def def;
        if (ask("taut_world_get_def", [&] { return taut_world_get_def(world, &def); }))
            expect(def.struct_size == sizeof def, "a def that is none");
    }

    void read_lint() {
        std::vector<taut_lint_entry> entries(byte());
        uint32_t count = 0;
        if (!ask("taut_world_lint", [&] {
                return taut_world_lint(worlds_[pick_world()], entries.data(), static_cast<uint32_t>(entries.size()),
                                       &count);
            }))
            return;
        for (uint32_t i = 0; i < count; ++i) {
            expect(entries[i].body.bits == 0 || taut_body_is_valid(entries[i].body), "lint of a dead body");
            expect(entries[i].joint.bits == 0 || taut_joint_is_valid(entries[i].joint), "lint of a dead joint");
            const taut_attachment attachment = entries[i].attachment;
            expect(attachment.bits == 0 || taut_attachment_is_valid(attachment), "lint of a dead attachment");
            expect(std::strcmp(taut_lint_text(entries[i].kind), "unknown") != 0, "lint of no kind");
        }
    }

    // The counts of a world are those of the handles that live.
    void check_counts() {
        call_ = "taut_world_get_counts";
        for (size_t w = 0; w < 2; ++w) {
            uint32_t bodies, shapes, joints;
            taut_world_get_counts(worlds_[w], &bodies, &shapes, &joints);
            expect(bodies == live(bodies_, taut_body_is_valid, w) + count_cable_bodies(w),
                   "bodies that are not counted");
            // Cables bring shapes and joints of their own.
            const bool alone = live(cables_, taut_cable_is_valid, w) == 0 &&
                               live(cloths_, taut_cloth_is_valid, w) + live(solids_, taut_solid_is_valid, w) == 0;
            const size_t shapes_known = live(shapes_, taut_shape_is_valid, w);
            expect(alone ? shapes == shapes_known : shapes >= shapes_known, "shapes that are not counted");
            const size_t joints_known = live(joints_, taut_joint_is_valid, w);
            expect(alone ? joints == joints_known : joints >= joints_known, "joints that are not counted");
        }
    }

private:
    struct Task {
        taut_task_fn run;
        uint32_t count;
        void* data;
    };
    // An allocator, a log and a task system, each of them or none.
    taut_hooks hooks() {
        taut_hooks out;
        taut_hooks_init(&out);
        if (one_in(2)) {
            out.allocate = [](size_t size, size_t alignment, void*) -> void* {
                return allocate_aligned(size, alignment);
            };
            out.free = [](void* pointer, size_t, size_t, void*) { free_aligned(pointer); };
        }
        if (one_in(2)) out.log = [](taut_log_level, const char*, void*) {};
        if (one_in(4)) {
            // Workers that come when all is done.
            out.enqueue_task = [](taut_task_fn task, uint32_t count, uint32_t, void* data, void*) -> void* {
                return new Task{task, count, data};
            };
            out.finish_task = [](void* token, void*) {
                const std::unique_ptr<Task> late(static_cast<Task*>(token));
                for (uint32_t i = 0; i < late->count; ++i) late->run(i, i + 1, i, late->data);
            };
            out.worker_count = 1 + byte() % 3;
        }
        return out;
    }

    // A host's filter that answers anything and calls into the world that is stepping.
    static int32_t judge(const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* self) {
        WorldCalls& host = *static_cast<WorldCalls*>(self);
        host.expect(contact->point_count >= 1 && contact->point_count <= 4, "a contact without points");
        host.expect(finite(contact->normal), "a normal that is not finite");
        if (host.one_in(8)) {
            taut_pose at;
            const taut_vec3 push = {1, 2, 3};
            host.expect(taut_body_get_pose(contact->body_a, &at) == TAUT_LOCKED, "a read within the step");
            host.expect(taut_body_apply_impulse(contact->body_b, push, push) == TAUT_LOCKED, "a push within the step");
            host.expect(taut_collider_remove(contact->collider_a) == TAUT_LOCKED, "a removal within the step");
        }
        *answer = {host.real(0, 2), host.real(0, 1)};
        return host.byte() % (host.one_in(16) ? 3 : 2);
    }

    // A snapshot, with what was known then.
    struct Saved {
        std::vector<unsigned char> bytes;
        uint64_t hash = 0;
        EventWatch watch;
        size_t bodies = 0, cable_bodies = 0, colliders = 0, joints = 0, cable_joints = 0, cables = 0, attachments = 0;
        size_t cloths = 0, solids = 0;
    };
    void save_world(size_t w) {
        uint64_t size = 0;
        if (!ask("taut_world_snapshot_size", [&] { return taut_world_snapshot_size(worlds_[w], &size); })) return;
        std::vector<unsigned char> bytes(one_in(8) ? size / 2 : size);
        if (!ask("taut_world_save", [&] { return taut_world_save(worlds_[w], bytes.data(), bytes.size(), &size); }))
            return;
        saved_[w] = {bytes,
                     hash(w),
                     watch_[w],
                     bodies_.size(),
                     cable_bodies_.size(),
                     colliders_.size(),
                     joints_.size(),
                     cable_joints_.size(),
                     cables_.size(),
                     attachments_.size(),
                     cloths_.size(),
                     solids_.size()};
    }
    // Now and then what is damaged, or in the wrong world.
    void restore_world(size_t w) {
        const Saved& saved = saved_[w];
        std::vector<unsigned char> bytes = saved.bytes;
        const bool spoiled = one_in(4);
        if (spoiled && one_in(2))
            bytes.resize(word() % bytes.size());
        else if (spoiled)
            bytes[word() % bytes.size()] ^= static_cast<unsigned char>(1 << byte() % 8);
        const size_t to = one_in(8) ? 1 - w : w;
        const unsigned char none = 0;
        const void* const buffer = bytes.empty() ? &none : bytes.data();
        if (!run("taut_world_restore", [&] { return taut_world_restore(worlds_[to], buffer, bytes.size()); })) return;
        expect(!spoiled && to == w, "a damaged or foreign snapshot that was restored");
        expect(hash(w) == saved.hash, "a restored world that is another");
        watch_[w] = saved.watch;
        // Handles of what was added since are given again.
        const auto forget = [&](auto& known, size_t first) {
            const auto from = known.begin() + static_cast<std::ptrdiff_t>(first);
            known.erase(std::remove_if(from, known.end(), [&](const auto& one) { return one.world == w; }),
                        known.end());
        };
        forget(bodies_, saved.bodies), forget(cable_bodies_, saved.cable_bodies);
        forget(colliders_, saved.colliders), forget(cables_, saved.cables);
        forget(joints_, saved.joints), forget(cable_joints_, saved.cable_joints);
        forget(attachments_, saved.attachments);
        forget(cloths_, saved.cloths), forget(solids_, saved.solids);
        saved_[1 - w] = {};  // where its own begin in these lists is not known any more
    }

    std::vector<taut_body> bodies_of(size_t w) const {
        std::vector<taut_body> out;
        for (const auto* known : {&bodies_, &cable_bodies_})
            for (const Known<taut_body>& body : *known)
                if (body.world == w) out.push_back(body.handle);
        return out;
    }
    void watch_step(size_t w) {
        taut_events events;
        if (taut_world_get_events(worlds_[w], &events) != TAUT_OK) return expect(false, "no events");
        std::vector<taut_collider> colliders;
        for (const Known<taut_collider>& known : colliders_)
            if (known.world == w) colliders.push_back(known.handle);
        watch_[w].check(events, bodies_of(w), colliders, w == 0,
                        [this](bool condition, const char* what) { expect(condition, what); });
    }

    EventWatch watch_[2];
    Saved saved_[2];
};

}  // namespace taut_test
