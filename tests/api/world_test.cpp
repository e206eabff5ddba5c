// Results, texts, versions, frame time.
#include <cmath>
#include <string>
#include <thread>

#include "support.h"

using namespace taut_test;

namespace {

TEST(Base, NamesEveryResult) {
    EXPECT_STREQ(taut_result_name(TAUT_OK), "TAUT_OK");
    EXPECT_STREQ(taut_result_name(TAUT_LOCKED), "TAUT_LOCKED");
    EXPECT_STREQ(taut_result_name(TAUT_UNSUPPORTED), "TAUT_UNSUPPORTED");
    EXPECT_STREQ(taut_result_name(static_cast<taut_result>(TAUT_UNSUPPORTED + 1)), "unknown");
    EXPECT_STREQ(taut_result_name(TAUT_RESULT_MAX), "unknown");
    EXPECT_EQ(taut_version(), TAUT_VERSION_MAJOR * 10000u + TAUT_VERSION_MINOR * 100u + TAUT_VERSION_PATCH);
}

TEST(Base, EachThreadHasItsText) {
    EXPECT_EQ(taut_world_step({0}), TAUT_STALE_HANDLE);
    const std::string mine = taut_last_error();
    EXPECT_TRUE(contains(mine, "taut_world_step"));
    std::thread([] {
        EXPECT_STREQ(taut_last_error(), "");
        EXPECT_EQ(taut_body_remove({0}), TAUT_STALE_HANDLE);
        EXPECT_TRUE(contains(taut_last_error(), "taut_body_remove"));
    }).join();
    EXPECT_EQ(taut_last_error(), mine);
    // Success does not clear it.
    const taut_world world = make_world();
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(taut_last_error(), mine);
    EXPECT_OK(taut_world_destroy(world));
}

TEST(World, GetsAndSetsGravity) {
    const taut_world world = make_world();
    taut_vec3 gravity;
    ASSERT_OK(taut_world_get_gravity(world, &gravity));
    EXPECT_EQ(gravity.y, -9.81f);
    ASSERT_OK(taut_world_set_gravity(world, {1, 2, 3}));
    for (float bad : {NAN, INFINITY, -INFINITY, 1.01e4f}) {
        EXPECT_EQ(taut_world_set_gravity(world, {bad, 0, 0}), TAUT_INVALID_ARGUMENT);
        EXPECT_EQ(taut_world_set_gravity(world, {0, 0, bad}), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_set_gravity: gravity.z")) << taut_last_error();
    }
    ASSERT_OK(taut_world_get_gravity(world, &gravity));
    EXPECT_EQ(gravity.z, 3);
    EXPECT_EQ(taut_world_get_gravity(world, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_get_bytes(world, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_get_state_hash(world, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_get_events(world, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_get_profile(world, nullptr), TAUT_NULL_POINTER);
    EXPECT_OK(taut_world_get_counts(world, nullptr, nullptr, nullptr));
    EXPECT_OK(taut_world_destroy(world));
}

TEST(World, ProfileAsksForItsSize) {
    Populated p;
    taut_profile profile = {};
    for (uint32_t size : {uint32_t{0}, uint32_t{sizeof profile} - 1, uint32_t{sizeof profile} + 1}) {
        profile.struct_size = size;
        EXPECT_EQ(taut_world_get_profile(p.world, &profile), TAUT_STRUCT_SIZE);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_get_profile: struct_size")) << taut_last_error();
    }
    profile.struct_size = sizeof profile;
    ASSERT_OK(taut_world_get_profile(p.world, &profile));
    EXPECT_EQ(profile.struct_size, sizeof profile);
    EXPECT_EQ(profile.bodies, 3u);
    EXPECT_EQ(profile.joints, 2u);
    EXPECT_GT(profile.bytes, 0u);
}

TEST(Advance, TakesWholeStepsAndKeepsTheRest) {
    taut_world_def def;
    taut_world_def_init(&def);
    def.time_step = 0.25f / 16;  // exact, as are the times below
    def.max_catch_up = 3;
    taut_world world;
    ASSERT_OK(taut_world_create(&def, &world));
    const double dt = def.time_step;
    taut_advance out;
    ASSERT_OK(taut_world_advance(world, 0, &out));
    EXPECT_EQ(out.steps, 0u);
    EXPECT_EQ(out.fraction, 0);
    ASSERT_OK(taut_world_advance(world, 0.5 * dt, &out));
    EXPECT_EQ(out.steps, 0u);
    EXPECT_EQ(out.fraction, 0.5f);
    ASSERT_OK(taut_world_advance(world, 1.75 * dt, &out));
    EXPECT_EQ(out.steps, 2u);
    EXPECT_EQ(out.fraction, 0.25f);
    EXPECT_EQ(out.dropped, 0);
    ASSERT_OK(taut_world_advance(world, 9 * dt, &out));
    EXPECT_EQ(out.steps, 3u);
    EXPECT_EQ(out.fraction, 0.25f);
    EXPECT_EQ(out.dropped, 6 * dt);
    ASSERT_OK(taut_world_advance(world, dt, nullptr));

    const uint64_t hash = hash_of(world);
    for (double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, -1e-9, 1000.1}) {
        EXPECT_EQ(taut_world_advance(world, bad, &out), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_advance: seconds")) << taut_last_error();
    }
    EXPECT_EQ(hash_of(world), hash);
    EXPECT_OK(taut_world_advance(world, 1000, &out));
    EXPECT_EQ(out.steps, 3u);
    EXPECT_OK(taut_world_destroy(world));
}

// 1.0 / 60 is a little less than the step of 1 / 60 in single precision.
TEST(Advance, StepsOnceAFrame) {
    const taut_world world = make_world();
    for (int i = 0; i < 5000; ++i) {
        taut_advance out;
        ASSERT_OK(taut_world_advance(world, 1.0 / 60, &out));
        ASSERT_EQ(out.steps, 1u) << i;
        ASSERT_GE(out.fraction, 0);
        ASSERT_LT(out.fraction, 1);
    }
    EXPECT_OK(taut_world_destroy(world));
}

TEST(Advance, GivesPosesBetweenSteps) {
    const taut_world world = make_world();
    ASSERT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    const taut_body body = add_particle(world, 1, 2, 3);
    ASSERT_OK(taut_body_set_velocity(body, {6, 0, 0}, {0, 0, 0}));
    taut_pose pose;
    ASSERT_OK(taut_world_advance(world, 1.25 / 60, nullptr));
    ASSERT_OK(taut_body_get_render_pose(body, &pose));
    EXPECT_NEAR(pose.position.x, 1 + 0.25 * 0.1, 1e-6);
    ASSERT_OK(taut_world_advance(world, 0.5 / 60, nullptr));
    ASSERT_OK(taut_body_get_render_pose(body, &pose));
    EXPECT_NEAR(pose.position.x, 1 + 0.75 * 0.1, 1e-6);
    // A teleport leaves no streak.
    pose.position = {-50, 0, 0};
    ASSERT_OK(taut_body_set_pose(body, &pose));
    ASSERT_OK(taut_body_get_render_pose(body, &pose));
    EXPECT_EQ(pose.position.x, -50);
    EXPECT_OK(taut_world_destroy(world));
}

// A step that runs out of memory after others were taken ends the call; the time is not lost.
TEST(Advance, KeepsItsTimeWhenAStepFails) {
    Ledger ledger;
    Populated p(ledger.hooks());
    for (int i = 0; i < 60; ++i) add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 0.4 * i, 0.5, 0));
    const std::vector<double> before = motion_of({p.crate, p.wedge, p.bob});
    ledger.fail_from = ledger.calls + 1;
    taut_advance out = {77, 0, 0};
    ASSERT_EQ(taut_world_advance(p.world, 3.0 / 60, &out), TAUT_OUT_OF_MEMORY);
    EXPECT_EQ(out.steps, 77u);
    EXPECT_EQ(motion_of({p.crate, p.wedge, p.bob}), before);
    ledger.fail_from = UINT64_MAX;
    ASSERT_OK(taut_world_advance(p.world, 3.0 / 60, &out));
    EXPECT_EQ(out.steps, 3u);
}

}  // namespace
