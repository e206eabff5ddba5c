// A body that diverges is told once and can be let go; nobody reads what is no number.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "support.h"

namespace {

using namespace taut_test;

// Sixty boxes of 1 kg on the ground, in two layers, and on them bodies of 1e-6 to 1e15 kg that far anchors and absurd
// drives tie to each other.
struct MadHouse {
    taut_world world{0};

    MadHouse(taut_solver solver, uint32_t threads, uint64_t start) : random_(start) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.solver = solver;
        def.threads = threads;
        EXPECT_OK(taut_world_create(&def, &world));
        taut_plane_def plane;
        taut_plane_def_init(&plane);
        taut_box_def box;
        taut_box_def_init(&box);
        taut_shape ground, cube, rod;
        EXPECT_OK(taut_world_add_plane(world, &plane, &ground));
        EXPECT_OK(taut_world_add_box(world, &box, &cube));
        box.half_extents = {0.002f, 1.5f, 0.002f};
        EXPECT_OK(taut_world_add_box(world, &box, &rod));
        add(ground, TAUT_BODY_STATIC, 0, {0, 0, 0});
        for (int i = 0; i < 60; ++i) {
            const int column = i % 8, layer = i / 32, row = i / 8 % 4;
            add(cube, TAUT_BODY_DYNAMIC, 1, {1.01 * column, 0.5 + layer, 1.01 * row});
        }
        const auto count = 2 + static_cast<int>(uniform(0, 6));
        taut_body before{0};
        for (int i = 0; i < count; ++i) {
            const taut_shape shape = uniform(0, 1) < 0.5 ? cube : rod;
            const double mass = logarithmic(1e-6, 1e15);
            const taut_body body =
                add(shape, TAUT_BODY_DYNAMIC, mass, {3 + uniform(0, 1), 2 + uniform(0, 1), 1 + uniform(0, 1)});
            if (i > 0) tie(before, body);
            before = body;
        }
    }
    ~MadHouse() { EXPECT_OK(taut_world_destroy(world)); }
    MadHouse(const MadHouse&) = delete;
    MadHouse& operator=(const MadHouse&) = delete;

private:
    double uniform(double low, double high) {
        return low + (high - low) * static_cast<double>(random_() >> 11) / 9007199254740992.0;
    }
    double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }
    taut_body add(taut_shape shape, taut_body_kind kind, double mass, taut_pos position) {
        taut_body_def def;
        taut_body_def_init(&def);
        def.shape = shape;
        def.kind = kind;
        def.mass = static_cast<float>(mass);
        def.position = position;
        taut_body out{0};
        EXPECT_OK(taut_world_add_body(world, &def, &out));
        return out;
    }
    void tie(taut_body a, taut_body b) {
        taut_hinge_joint_def def;
        taut_hinge_joint_def_init(&def);
        def.base.body_a = a;
        def.base.body_b = b;
        def.base.frame_a.position.x = uniform(-0.5, 0.5) * logarithmic(1e-2, 1e4);
        def.base.frame_a.position.z = uniform(-0.5, 0.5) * logarithmic(1e-2, 1e4);
        def.angle.drive.stiffness = static_cast<float>(logarithmic(1, 1e24));
        def.angle.drive.target = 3;
        def.angle.drive.damping = static_cast<float>(logarithmic(1e-3, 1e24));
        def.base.solve = static_cast<taut_joint_solve>(static_cast<int>(uniform(0, 3)));
        taut_joint out;
        EXPECT_OK(taut_world_add_hinge_joint(world, &def, &out));
    }

    std::mt19937_64 random_;
};

void expect_finite(taut_world world) {
    uint32_t count = 0;
    taut_world_get_contacts(world, nullptr, 0, &count);
    std::vector<taut_contact> contacts(count);
    if (count == 0) return;
    ASSERT_OK(taut_world_get_contacts(world, contacts.data(), count, &count));
    for (uint32_t i = 0; i < count; ++i) {
        ASSERT_TRUE(std::isfinite(contacts[i].normal_impulse) && std::isfinite(contacts[i].friction_impulse));
        ASSERT_TRUE(std::isfinite(contacts[i].position.x) && std::isfinite(contacts[i].separation));
    }
}

class QuarantineOfEverySolver : public testing::TestWithParam<int> {};

TEST_P(QuarantineOfEverySolver, TellsEachOnce) {
    const auto solver = static_cast<taut_solver>(GetParam());
    const bool fast = solver == TAUT_SOLVER_BLOCK_LDLT || solver == TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL;
    const uint64_t starts = fast ? 6 : 2;
    const int frames = fast ? 12 : 3;
    uint32_t frozen = 0;
    for (uint64_t start = 1; start <= starts; ++start) {
        uint64_t first_hash = 0;
        for (const uint32_t threads : {1u, 3u, 8u}) {
            if (threads > 3 && !fast) continue;
            const MadHouse house(solver, threads, start);
            std::set<uint64_t> told;
            for (int frame = 0; frame < frames; ++frame) {
                ASSERT_OK(taut_world_step(house.world));
                taut_events events;
                ASSERT_OK(taut_world_get_events(house.world, &events));
                for (uint32_t i = 0; i < events.quarantined_count; ++i) {
                    const taut_quarantine_event& event = events.quarantined[i];
                    EXPECT_TRUE(told.insert(event.body.bits).second) << "told twice, start " << start;
                    taut_quarantine_reason reason{};
                    EXPECT_OK(taut_body_get_quarantine(event.body, &reason));
                    EXPECT_EQ(reason, event.reason);
                    EXPECT_TRUE(reason == TAUT_QUARANTINE_NON_FINITE || reason == TAUT_QUARANTINE_TOO_FAST);
                }
                expect_finite(house.world);
            }
            frozen += static_cast<uint32_t>(told.size());
            uint64_t hash = 0;
            ASSERT_OK(taut_world_get_state_hash(house.world, &hash));
            if (threads == 1) first_hash = hash;
            EXPECT_EQ(hash, first_hash) << "on " << threads << " threads, start " << start;
        }
    }
    RecordProperty("frozen", static_cast<int>(frozen));
}

INSTANTIATE_TEST_SUITE_P(Of, QuarantineOfEverySolver, testing::Range(0, static_cast<int>(TAUT_SOLVER_MINIMISATION)),
                         [](const auto& tested) { return taut_solver_name(static_cast<taut_solver>(tested.param)); });

// A crate of 2 kg on the ground that an absurd force freezes.
struct FrozenCrate : testing::Test {
    taut_world world{0};
    taut_body crate{0};
    std::vector<std::string> log;

    void SetUp() override {
        taut_world_def def;
        taut_world_def_init(&def);
        def.hooks.log = [](taut_log_level, const char* text, void* self) {
            static_cast<FrozenCrate*>(self)->log.emplace_back(text);
        };
        def.hooks.log_user_data = this;
        ASSERT_OK(taut_world_create(&def, &world));
        taut_plane_def plane;
        taut_plane_def_init(&plane);
        taut_box_def box;
        taut_box_def_init(&box);
        taut_body_def body;
        taut_body_def_init(&body);
        body.kind = TAUT_BODY_STATIC;
        ASSERT_OK(taut_world_add_plane(world, &plane, &body.shape));
        taut_body ground;
        ASSERT_OK(taut_world_add_body(world, &body, &ground));
        body.kind = TAUT_BODY_DYNAMIC;
        body.mass = 2;
        body.position = {0, 3, 0};
        ASSERT_OK(taut_world_add_box(world, &box, &body.shape));
        ASSERT_OK(taut_world_add_body(world, &body, &crate));
    }
    void TearDown() override { EXPECT_OK(taut_world_destroy(world)); }

    void freeze(float force) {
        ASSERT_OK(taut_world_step(world));
        ASSERT_OK(taut_body_apply_force(crate, {force, 0, 0}, {0, 0, 0}));
        ASSERT_OK(taut_world_step(world));
        taut_body_kind kind{};
        ASSERT_OK(taut_body_get_kind(crate, &kind));
        ASSERT_EQ(kind, TAUT_BODY_STATIC);
    }
    taut_quarantine_reason reason() {
        taut_quarantine_reason out = TAUT_QUARANTINE_REASON_MAX;
        EXPECT_OK(taut_body_get_quarantine(crate, &out));
        return out;
    }
    double height() {
        taut_pose pose;
        EXPECT_OK(taut_body_get_pose(crate, &pose));
        return pose.position.y;
    }
};

TEST_F(FrozenCrate, TellsThatItWasTooFast) {
    EXPECT_EQ(reason(), TAUT_QUARANTINE_NONE);
    freeze(1e20f);
    EXPECT_EQ(reason(), TAUT_QUARANTINE_TOO_FAST);
    taut_events events;
    ASSERT_OK(taut_world_get_events(world, &events));
    ASSERT_EQ(events.quarantined_count, 1u);
    EXPECT_EQ(events.quarantined[0].reason, TAUT_QUARANTINE_TOO_FAST);
    ASSERT_EQ(log.size(), 1u);
    EXPECT_TRUE(contains(log[0], "0 was not finite, of 1 beyond 1e+06")) << log[0];
}

TEST_F(FrozenCrate, IsLetGoAsItWas) {
    EXPECT_EQ(taut_body_release(crate), TAUT_INVALID_ARGUMENT);
    float mass = 0, mass_before = 0;
    taut_vec3 centre;
    taut_sym3 inertia, inertia_before;
    ASSERT_OK(taut_body_get_mass(crate, &mass_before, &centre, &inertia_before));
    freeze(1e20f);
    const double held = height();
    for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(height(), held);
    ASSERT_OK(taut_body_release(crate));
    EXPECT_EQ(taut_body_release(crate), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(reason(), TAUT_QUARANTINE_NONE);
    ASSERT_OK(taut_body_get_mass(crate, &mass, &centre, &inertia));
    EXPECT_EQ(mass, mass_before);
    EXPECT_EQ(inertia.xx, inertia_before.xx);
    taut_body_kind kind{};
    ASSERT_OK(taut_body_get_kind(crate, &kind));
    EXPECT_EQ(kind, TAUT_BODY_DYNAMIC);
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(world));
    EXPECT_NEAR(height(), 0.5, 0.01) << "it should have fallen on the ground";
}

// Contacts that came while it stood are asked about anew.
TEST_F(FrozenCrate, RestsOnWhatCameMeanwhile) {
    freeze(1e20f);
    taut_box_def box;
    taut_box_def_init(&box);
    box.half_extents = {2, 0.1f, 2};
    taut_body_def body;
    taut_body_def_init(&body);
    body.kind = TAUT_BODY_STATIC;
    body.position = {0, 2, 0};
    ASSERT_OK(taut_world_add_box(world, &box, &body.shape));
    taut_body shelf;
    ASSERT_OK(taut_world_add_body(world, &body, &shelf));
    for (int i = 0; i < 3; ++i) ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_body_release(crate));
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(world));
    EXPECT_NEAR(height(), 2.6, 0.01);
}

TEST_F(FrozenCrate, IsInSnapshots) {
    freeze(1e20f);
    uint64_t bytes = 0, frozen_hash = 0, hash = 0;
    ASSERT_OK(taut_world_get_state_hash(world, &frozen_hash));
    ASSERT_OK(taut_world_snapshot_size(world, &bytes));
    std::vector<unsigned char> snapshot(bytes);
    ASSERT_OK(taut_world_save(world, snapshot.data(), bytes, &bytes));
    ASSERT_OK(taut_body_release(crate));
    ASSERT_OK(taut_world_get_state_hash(world, &hash));
    EXPECT_NE(hash, frozen_hash);
    ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_world_restore(world, snapshot.data(), bytes));
    ASSERT_OK(taut_world_get_state_hash(world, &hash));
    EXPECT_EQ(hash, frozen_hash);
    EXPECT_EQ(reason(), TAUT_QUARANTINE_TOO_FAST);
    ASSERT_OK(taut_body_release(crate));
}

TEST_F(FrozenCrate, MayBeRemoved) {
    freeze(1e20f);
    ASSERT_OK(taut_body_remove(crate));
    taut_particle_def def;
    taut_particle_def_init(&def);
    taut_body other;
    ASSERT_OK(taut_world_add_particle(world, &def, &other));
    taut_quarantine_reason out{};
    EXPECT_OK(taut_body_get_quarantine(other, &out));
    EXPECT_EQ(out, TAUT_QUARANTINE_NONE);
    EXPECT_OK(taut_world_step(world));
}

}  // namespace
