// The host's allocator: books balance, and running out of memory at any call is a result, not a wreck.
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

TEST(Memory, BooksBalance) {
    Ledger ledger;
    {
        Populated p(ledger.hooks());
        for (int i = 0; i < 100; ++i) {
            const taut_body body = add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, i % 10, 1 + i / 10, 3));
            if (i > 0 && i % 3 == 0) add_ball(p.world, body, p.bob);
            if (i % 7 == 0) {
                ASSERT_OK(taut_body_remove(body));
            }
            if (i % 20 == 0) {
                ASSERT_OK(taut_world_step(p.world));
            }
        }
        uint64_t bytes = 0;
        ASSERT_OK(taut_world_get_bytes(p.world, &bytes));
        EXPECT_EQ(bytes, ledger.bytes);
        taut_profile profile;
        profile.struct_size = sizeof profile;
        ASSERT_OK(taut_world_get_profile(p.world, &profile));
        EXPECT_EQ(profile.bytes, ledger.bytes);
    }
    EXPECT_TRUE(ledger.empty()) << ledger.bytes;
    EXPECT_EQ(ledger.errors, 0u);
}

// One call of the interface: OK, or out of memory with the world as it was, and then OK again.
class Retry {
public:
    explicit Retry(Ledger& ledger) : ledger_(ledger) {}

    template <class Act>
    void operator()(taut_world world, bool steps, Act&& act) {
        if (world.bits == 0) return;
        const Watch watch(world);
        for (int attempt = 0; attempt < 500; ++attempt) {
            const uint64_t failed = ledger_.failed;
            const taut_result result = act();
            if (result == TAUT_OK) return;
            ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
            ASSERT_GT(ledger_.failed, failed) << "out of memory that nobody refused";
            ASSERT_TRUE(contains(taut_last_error(), "out of memory")) << taut_last_error();
            // A step may stop in its middle, with a state that is whole but moved on.
            ASSERT_TRUE(steps || watch.unchanged());
        }
        FAIL() << "memory is there again, yet the call does not succeed";
    }

private:
    Ledger& ledger_;
};

// Creates, fills and steps a world whose allocator fails from call first to call first + length - 1.
void run_short_of_memory(uint64_t first, uint64_t length) {
    SCOPED_TRACE(testing::Message() << "call " << first << ", length " << length);
    Ledger ledger;
    ledger.fail_from = first;
    ledger.fail_until = first + length;
    taut_world_def def;
    taut_world_def_init(&def);
    def.hooks = ledger.hooks();
    taut_world world = {0};
    for (int attempt = 0; attempt < 500 && world.bits == 0; ++attempt) {
        const taut_result result = taut_world_create(&def, &world);
        ASSERT_TRUE(result == TAUT_OK || result == TAUT_OUT_OF_MEMORY) << taut_last_error();
        ASSERT_TRUE(result == TAUT_OK || ledger.empty());
    }

    Retry retry(ledger);
    taut_shape plane = {0}, box = {0};
    retry(world, false, [&] {
        taut_plane_def d;
        taut_plane_def_init(&d);
        return taut_world_add_plane(world, &d, &plane);
    });
    retry(world, false, [&] {
        taut_box_def d;
        taut_box_def_init(&d);
        return taut_world_add_box(world, &d, &box);
    });
    std::vector<taut_body> bodies;
    for (int i = 0; i < 24; ++i) {
        taut_body body = {0};
        retry(world, false, [&] {
            const taut_body_def d = i == 0 ? body_def(TAUT_BODY_STATIC, plane)
                                           : body_def(TAUT_BODY_DYNAMIC, box, 3 * (i % 6), 0.495 + 0.99 * (i / 6), 0);
            return taut_world_add_body(world, &d, &body);
        });
        bodies.push_back(body);
        if (i % 6 == 5) retry(world, true, [&] { return taut_world_step(world); });
    }
    for (int i = 1; i + 6 < 24; i += 5) {
        taut_joint joint = {0};
        retry(world, false, [&] {
            taut_ball_joint_def d;
            taut_ball_joint_def_init(&d);
            d.base.body_a = bodies[static_cast<size_t>(i)];
            d.base.body_b = bodies[static_cast<size_t>(i + 6)];
            d.base.frame_a.position = {0, 0.5, 0};
            d.base.frame_b.position = {0, -0.49, 0};
            return taut_world_add_ball_joint(world, &d, &joint);
        });
    }
    retry(world, true, [&] { return taut_world_step(world); });
    const taut_pose pose = {{40, 1, 0}, {0, 0, 0, 1}, {0, 0}};
    retry(world, false, [&] { return taut_body_set_pose(bodies[7], &pose); });
    retry(world, true, [&] { return taut_world_advance(world, 0.02, nullptr); });
    for (size_t i = 1; i < bodies.size(); i += 3) retry(world, false, [&] { return taut_body_remove(bodies[i]); });
    retry(world, true, [&] { return taut_world_step(world); });
    for (size_t i = 0; i < bodies.size(); ++i) {
        taut_pose at;
        if (i % 3 == 1) continue;
        EXPECT_OK(taut_body_get_pose(bodies[i], &at));
    }
    EXPECT_OK(taut_world_destroy(world));
    EXPECT_TRUE(ledger.empty()) << ledger.bytes;
    EXPECT_EQ(ledger.errors, 0u);
}

TEST(Memory, OneFailedAllocation) {
    for (uint64_t n = 1; n <= 200 && !testing::Test::HasFailure(); ++n) run_short_of_memory(n, 1);
}

TEST(Memory, ALongShortage) {
    for (uint64_t n = 1; n <= 200 && !testing::Test::HasFailure(); n += 3) run_short_of_memory(n, 40);
}

// No call fails where there is memory: what 200 calls do not reach, the numbers below do.
TEST(Memory, LateFailures) {
    for (uint64_t n = 201; n <= 1000 && !testing::Test::HasFailure(); n += 13) run_short_of_memory(n, 2);
}

}  // namespace
