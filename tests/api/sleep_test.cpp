// What the calls about sleeping refuse.
#include "support.h"

namespace {

using namespace taut_test;

struct SleepyWorld {
    taut_world world{};
    taut_body ball{}, wall{};

    SleepyWorld() {
        taut_world_def def;
        taut_world_def_init(&def);
        def.sleeping = 1;
        EXPECT_OK(taut_world_create(&def, &world));
        taut_particle_def particle;
        taut_particle_def_init(&particle);
        EXPECT_OK(taut_world_add_particle(world, &particle, &ball));
        taut_body_def body;
        taut_body_def_init(&body);
        body.kind = TAUT_BODY_STATIC;
        EXPECT_OK(taut_world_add_body(world, &body, &wall));
    }
    ~SleepyWorld() { taut_world_destroy(world); }

    uint64_t hash() const {
        uint64_t out = 0;
        EXPECT_OK(taut_world_get_state_hash(world, &out));
        return out;
    }
};

TEST(SleepCalls, RefuseBadInputAndChangeNothing) {
    const SleepyWorld s;
    const uint64_t before = s.hash();
    const auto refused = [&](taut_result result, taut_result expected, const char* word) {
        EXPECT_EQ(result, expected);
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
        EXPECT_EQ(s.hash(), before);
    };
    refused(taut_body_get_awake(s.ball, nullptr), TAUT_NULL_POINTER, "out");
    refused(taut_body_get_can_sleep(s.ball, nullptr), TAUT_NULL_POINTER, "out");
    refused(taut_body_set_awake(s.ball, 2), TAUT_INVALID_ARGUMENT, "awake");
    refused(taut_body_set_can_sleep(s.ball, 2), TAUT_INVALID_ARGUMENT, "can_sleep");
    refused(taut_body_set_awake(s.wall, 0), TAUT_INVALID_ARGUMENT, "static");
    refused(taut_world_wake_box(s.world, {0, 1, 0}, {1, 0, 1}), TAUT_INVALID_ARGUMENT, "low is above high");
    refused(taut_world_wake_box(s.world, {std::nan(""), 0, 0}, {1, 1, 1}), TAUT_INVALID_ARGUMENT, "low.x");
    refused(taut_world_wake_box(s.world, {0, 0, 0}, {1, 1, 1.1e7}), TAUT_INVALID_ARGUMENT, "high.z");
}

TEST(SleepCalls, ARefusedCallWakesNobody) {
    const SleepyWorld s;
    ASSERT_OK(taut_body_set_awake(s.ball, 0));
    const uint64_t before = s.hash();
    EXPECT_EQ(taut_body_apply_impulse(s.ball, {NAN, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_apply_impulse(s.ball, {1e20f, 0, 0}, {0, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_apply_force(s.ball, {0, 0, 0}, {1, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_velocity(s.ball, {0, 0, 0}, {1, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_set_gravity(s.world, {NAN, 0, 0}), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(s.hash(), before);
    uint32_t awake = 1;
    ASSERT_OK(taut_body_get_awake(s.ball, &awake));
    EXPECT_EQ(awake, 0u);
}

TEST(SleepCalls, ReadWhatWasSet) {
    const SleepyWorld s;
    uint32_t out = 0;
    ASSERT_OK(taut_body_get_can_sleep(s.ball, &out));
    EXPECT_EQ(out, 1u);
    ASSERT_OK(taut_body_set_can_sleep(s.ball, 0));
    ASSERT_OK(taut_body_get_can_sleep(s.ball, &out));
    EXPECT_EQ(out, 0u);
    ASSERT_OK(taut_body_get_awake(s.wall, &out));
    EXPECT_EQ(out, 1u) << "static bodies count as awake";
    taut_world_def def;
    ASSERT_OK(taut_world_get_def(s.world, &def));
    EXPECT_EQ(def.sleeping, 1u);
    EXPECT_EQ(def.sleep_time, 0.5f);
    taut_world_def_init(&def);
    EXPECT_EQ(def.sleeping, 0u) << "a host asks for it";
}

}  // namespace
