// A step that fails changes nothing: the world goes on as one that never failed.
#include <stdexcept>

#include "support.h"

namespace {

using namespace taut_test;

struct Telling {
    uint32_t begun = 0, ended = 0, moved = 0;
    bool operator==(const Telling&) const = default;
};

struct Yard {
    taut_world world{0};
    Ledger ledger;

    explicit Yard(uint32_t kind) {
        taut_world_def def;
        taut_world_def_init(&def);
        def.hooks = ledger.hooks();
        def.sleeping = kind == 1;
        EXPECT_OK(taut_world_create(&def, &world));
        taut_plane_def plane;
        taut_plane_def_init(&plane);
        taut_box_def box;
        taut_box_def_init(&box);
        taut_body_def body;
        taut_body_def_init(&body);
        body.kind = TAUT_BODY_STATIC;
        EXPECT_OK(taut_world_add_plane(world, &plane, &body.shape));
        taut_body made, before{0};
        EXPECT_OK(taut_world_add_body(world, &body, &made));
        taut_body_def_init(&body);
        EXPECT_OK(taut_world_add_box(world, &box, &body.shape));
        for (int i = 1; i < 40; ++i) {
            body.position = {i % 6 * 1.02, 0.5 + i / 6 * 0.995, 0};
            body.contact_events = TAUT_CONTACT_EVENTS_ALL;
            body.collider_flags = TAUT_COLLIDER_PRE_SOLVE;
            EXPECT_OK(taut_world_add_body(world, &body, &made));
            if (kind == 2 && i > 30) tie(before, made);
            before = made;
        }
        EXPECT_OK(taut_body_apply_force(before, {10, 200, 0}, {0, 0, 0}));
        if (kind == 3) reel();
    }
    ~Yard() {
        EXPECT_OK(taut_world_destroy(world));
        EXPECT_TRUE(ledger.empty());
        EXPECT_EQ(ledger.errors, 0u);
    }
    Yard(const Yard&) = delete;
    Yard& operator=(const Yard&) = delete;

    uint64_t hash() const {
        uint64_t out = 0;
        EXPECT_OK(taut_world_get_state_hash(world, &out));
        return out;
    }
    Telling told() const {
        taut_events events;
        EXPECT_OK(taut_world_get_events(world, &events));
        return {events.begin_count, events.end_count, events.moved_count};
    }

private:
    void tie(taut_body a, taut_body b) {
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_a = a;
        def.base.body_b = b;
        def.base.frame_a.position = {0.51, 0, 0};
        def.base.frame_b.position = {-0.51, 0, 0};
        def.base.break_force = 1;
        taut_joint out;
        EXPECT_OK(taut_world_add_ball_joint(world, &def, &out));
    }
    void reel() {
        taut_cable_def def;
        taut_cable_def_init(&def);
        const taut_pos points[] = {{0, 20, 0}, {6, 20, 0}};
        def.points = points;
        def.point_count = 2;
        def.end[0].attached = 1;
        def.end[0].anchor = points[0];
        taut_cable cable;
        EXPECT_OK(taut_world_add_cable(world, &def, &cable));
        EXPECT_OK(taut_cable_set_reel_speed(cable, 0, 2, 0));
    }
};

class FailedStep : public testing::TestWithParam<uint32_t> {};

TEST_P(FailedStep, ForWantOfMemoryChangesNothing) {
    for (const int steps : {0, 3}) {
        const Yard twin(GetParam());
        for (int i = 0; i < steps + 3; ++i) ASSERT_OK(taut_world_step(twin.world));
        const uint64_t expected = twin.hash();
        uint32_t failed = 0;
        for (uint64_t left = 0; left < 200; left += left < 60 ? 1 : 7) {
            Yard yard(GetParam());
            for (int i = 0; i < steps; ++i) ASSERT_OK(taut_world_step(yard.world));
            const uint64_t before = yard.hash();
            yard.ledger.fail_from = yard.ledger.calls + 1 + left;
            const taut_result result = taut_world_step(yard.world);
            yard.ledger.fail_from = UINT64_MAX;
            if (result == TAUT_OK) {
                ASSERT_OK(taut_world_step(yard.world));
            } else {
                ++failed;
                ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
                ASSERT_EQ(yard.hash(), before) << "with " << left << " pieces, after " << steps << " steps";
                ASSERT_OK(taut_world_step(yard.world));
                ASSERT_OK(taut_world_step(yard.world));
            }
            ASSERT_OK(taut_world_step(yard.world));
            ASSERT_EQ(yard.hash(), expected) << "with " << left << " pieces, after " << steps << " steps";
        }
        if (steps == 0) {
            EXPECT_GT(failed, 20u);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, FailedStep, testing::Values(0u, 1u, 2u, 3u));

// Events that wait to be read stay, and those of the step that failed do not come.
TEST(FailedSteps, OfAnAllocatorThatThrowsChangeNothing) {
    Yard yard(0), twin(0);
    for (const Yard* each : {&yard, &twin}) ASSERT_OK(taut_world_step(each->world));
    const uint64_t before = yard.hash();
    yard.ledger.on_allocate = [] { throw std::runtime_error("no more"); };
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(taut_world_step(yard.world), TAUT_UNSUPPORTED);
        EXPECT_TRUE(contains(taut_last_error(), "no more")) << taut_last_error();
        EXPECT_EQ(yard.hash(), before);
    }
    taut_advance done{};
    EXPECT_EQ(taut_world_advance(yard.world, 0.1, &done), TAUT_UNSUPPORTED);
    EXPECT_EQ(yard.hash(), before);
    EXPECT_TRUE(yard.told() == twin.told());
    yard.ledger.on_allocate = nullptr;
    for (const Yard* each : {&yard, &twin})
        for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(each->world));
    EXPECT_EQ(yard.hash(), twin.hash());
}

// As one out of range, which costs a step nothing.
TEST(FailedSteps, AnAnswerThatIsThrownIsRefused) {
    const Yard yard(0), twin(0);
    const auto throws = [](const taut_pre_solve*, taut_pre_solve_answer*, void*) -> int32_t {
        throw std::runtime_error("no answer");
    };
    const auto refused = [](const taut_pre_solve*, taut_pre_solve_answer*, void*) -> int32_t { return -1; };
    ASSERT_OK(taut_world_set_pre_solve(yard.world, throws, nullptr));
    ASSERT_OK(taut_world_set_pre_solve(twin.world, refused, nullptr));
    for (const Yard* each : {&yard, &twin})
        for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(each->world));
    EXPECT_EQ(yard.hash(), twin.hash());
}

}  // namespace
