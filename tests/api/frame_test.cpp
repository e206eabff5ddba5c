// Frames and steps: what waits between calls, and the calls that change the steps.
#include <vector>

#include "support.h"

using namespace taut_test;

namespace {

// Boxes that tumble, a sensor, a lift and forces: the steps have news all the time.
struct Busy {
    Ledger ledger;
    taut_world world{};
    taut_body lift{}, pushed{};

    Busy() {
        taut_world_def def;
        taut_world_def_init(&def);
        def.hooks = ledger.hooks();
        def.contact_events = TAUT_CONTACT_EVENTS_ALL;
        EXPECT_OK(taut_world_create(&def, &world));
        taut_box_def box;
        taut_box_def_init(&box);
        taut_shape shape{};
        EXPECT_OK(taut_world_add_box(world, &box, &shape));
        lift = add_body(world, body_def(TAUT_BODY_KINEMATIC, shape));
        taut_body_def gate = body_def(TAUT_BODY_STATIC, shape, 0, 1.5, 0);
        gate.collider_flags = TAUT_COLLIDER_SENSOR;
        add_body(world, gate);
        pushed = add_body(world, body_def(TAUT_BODY_DYNAMIC, shape, 0.2, 1, 0));
    }
    ~Busy() { EXPECT_OK(taut_world_destroy(world)); }
    Busy(const Busy&) = delete;
    Busy& operator=(const Busy&) = delete;

    // A box that hops through the gate, for ever.
    void act(int frame) const {
        const taut_pose target = {{0, 0.3 * std::sin(0.4 * frame), 0}, {0, 0, 0, 1}, {0, 0}};
        EXPECT_OK(taut_body_move_kinematic(lift, &target));
        EXPECT_OK(taut_body_apply_force(pushed, {0.5f, frame % 40 < 10 ? 9000.0f : 0.0f, 0}, {0, 0, 0}));
        const taut_pose home = {{0.2, 1.2, 0}, {0, 0, 0, 1}, {0, 0}};
        if (frame % 40 == 39) {
            EXPECT_OK(taut_body_set_pose(pushed, &home));
            EXPECT_OK(taut_body_set_velocity(pushed, {0, 0, 0}, {0, 0, 0}));
        }
    }
};

// A host that never reads loses old events, by number of steps, and no memory.
TEST(Frames, UnreadEventsDoNotPileUp) {
    Busy busy;
    uint64_t calls = 0, bytes = 0;
    for (int i = 0; i < 1200; ++i) {
        busy.act(i);
        ASSERT_OK(taut_world_step(busy.world));
        if (i != 599) continue;
        calls = busy.ledger.calls;
        bytes = busy.ledger.bytes;
    }
    EXPECT_EQ(busy.ledger.calls, calls);
    EXPECT_LE(busy.ledger.bytes, bytes);
    const taut_events e = events_of(busy.world);
    EXPECT_EQ(e.steps + e.dropped_steps, 1200u);
    EXPECT_GE(e.steps, uint32_t{TAUT_EVENT_STEPS});
    EXPECT_LE(e.steps, 2u * TAUT_EVENT_STEPS);
    ASSERT_GT(e.begin_count + e.persist_count, 0u);
    uint32_t points = 0;
    for (const auto& list : {std::pair(e.begin, e.begin_count), std::pair(e.persist, e.persist_count)}) {
        for (uint32_t i = 0; i < list.second; ++i) {
            ASSERT_LE(list.first[i].first_point + list.first[i].point_count, e.point_count);
            ASSERT_LT(list.first[i].step, e.steps);
            ASSERT_TRUE(i == 0 || list.first[i - 1].step <= list.first[i].step);
            points += list.first[i].point_count;
        }
    }
    EXPECT_EQ(points, e.point_count);
    ASSERT_OK(taut_world_advance(busy.world, 0, nullptr));
    const taut_events none = events_of(busy.world);
    EXPECT_EQ(none.steps + none.dropped_steps + none.begin_count + none.persist_count + none.moved_count, 0u);
}

// One that reads each frame, at any rate, takes no memory once it is warm.
TEST(Frames, TakeNoMemoryOnceWarm) {
    for (double seconds : {1 / 24.0, 1 / 60.0, 1 / 240.0}) {
        Busy busy;
        uint64_t calls = 0;
        for (int i = 0; i < 1600; ++i) {
            busy.act(i);
            ASSERT_OK(taut_world_advance(busy.world, seconds, nullptr));
            events_of(busy.world);
            if (i == 1000) calls = busy.ledger.calls;
        }
        EXPECT_EQ(busy.ledger.calls, calls) << seconds;
    }
}

// As many steps as one call takes are all there to read.
TEST(Frames, AllStepsOfACallAreThereToRead) {
    taut_world_def def;
    taut_world_def_init(&def);
    def.max_catch_up = 500;
    taut_world world{};
    ASSERT_OK(taut_world_create(&def, &world));
    for (int i = 0; i < 4; ++i) {
        taut_advance done;
        ASSERT_OK(taut_world_advance(world, 500.0 / 60, &done));
        EXPECT_EQ(done.steps, 500u);
        EXPECT_EQ(events_of(world).steps, 500u);
        EXPECT_EQ(events_of(world).dropped_steps, 0u);
    }
    EXPECT_OK(taut_world_destroy(world));
}

TEST(Frames, AMovedBodyIsToldOnceWithItsNewestPose) {
    const taut_world world = make_world();
    const taut_body one = add_particle(world, 0, 0, 0), gone = add_particle(world, 1, 0, 0);
    ASSERT_OK(taut_world_step(world));
    ASSERT_OK(taut_body_remove(gone));
    const taut_body fresh = add_particle(world, 2, 0, 0);  // in the same slot
    ASSERT_OK(taut_body_set_velocity(one, {0, 0, 0}, {0, 0, 0}));
    ASSERT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    ASSERT_OK(taut_world_step(world));
    const taut_events e = events_of(world);
    ASSERT_EQ(e.moved_count, 1u) << "the other one never moved";
    EXPECT_EQ(e.moved[0].body.bits, one.bits);
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(one, &pose));
    EXPECT_EQ(e.moved[0].pose.position.y, pose.position.y);
    EXPECT_TRUE(taut_body_is_valid(fresh));
    EXPECT_OK(taut_world_destroy(world));
}

TEST(Frames, AFailedFrameKeepsForcesAndTargets) {
    Ledger ledger;
    Populated p(ledger.hooks());
    for (int i = 0; i < 60; ++i) add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 0.4 * i, 0.5, 0));
    const taut_body lift = add_body(p.world, body_def(TAUT_BODY_KINEMATIC, p.box, 0, 50, 0));
    const taut_body body = add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 0, 80, 0));
    ASSERT_OK(taut_world_set_gravity(p.world, {0, 0, 0}));
    const taut_pose target = {{0, 51, 0}, {0, 0, 0, 1}, {0, 0}};
    ASSERT_OK(taut_body_move_kinematic(lift, &target));
    ASSERT_OK(taut_body_apply_force(body, {0, 100, 0}, {0, 0, 0}));
    const std::vector<double> before = motion_of({lift, body, p.crate, p.wedge});
    for (uint64_t skip : {0, 1, 2}) {
        ledger.fail_from = ledger.calls + 1 + skip;
        ASSERT_EQ(taut_world_advance(p.world, 3.0 / 60, nullptr), TAUT_OUT_OF_MEMORY);
        EXPECT_EQ(motion_of({lift, body, p.crate, p.wedge}), before) << skip;
    }
    ledger.fail_from = UINT64_MAX;
    ASSERT_OK(taut_world_advance(p.world, 3.0 / 60, nullptr));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(lift, &pose));
    EXPECT_NEAR(pose.position.y, 51, 1e-6);
    float mass;
    taut_vec3 centre, v;
    taut_sym3 inertia;
    ASSERT_OK(taut_body_get_mass(body, &mass, &centre, &inertia));
    ASSERT_OK(taut_body_get_velocity(body, &v, nullptr));
    EXPECT_NEAR(v.y, 100 / mass * 3 / 60, 1e-4 * 100 / mass);
}

TEST(TimeStep, RefusesWhatIsOutOfRange) {
    Populated p;
    const Watch watch(p.world);
    for (float bad : {NAN, INFINITY, -1.0f, 0.0f, 0.99e-4f, 0.1001f}) {
        EXPECT_EQ(taut_world_set_time_step(p.world, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_set_time_step: time_step")) << taut_last_error();
    }
    for (uint32_t bad : {0u, 65u, UINT32_MAX}) {
        EXPECT_EQ(taut_world_set_substeps(p.world, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_set_substeps: substeps")) << taut_last_error();
    }
    EXPECT_TRUE(watch.unchanged());
    ASSERT_OK(taut_world_set_time_step(p.world, 0.004f));
    ASSERT_OK(taut_world_set_substeps(p.world, 7));
    EXPECT_FALSE(watch.unchanged());
    taut_world_def def;
    ASSERT_OK(taut_world_get_def(p.world, &def));
    EXPECT_EQ(def.time_step, 0.004f);
    EXPECT_EQ(def.substeps, 7u);
}

// Time left over is time, however long the steps are.
TEST(TimeStep, KeepsTheTimeLeftOver) {
    const taut_world world = make_world();
    ASSERT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    ASSERT_OK(taut_world_set_time_step(world, 1.0f / 32));
    const taut_body body = add_particle(world, 0, 0, 0);
    ASSERT_OK(taut_body_set_velocity(body, {1, 0, 0}, {0, 0, 0}));
    taut_advance done;
    ASSERT_OK(taut_world_advance(world, 1.75 / 32, &done));
    EXPECT_EQ(done.steps, 1u);
    EXPECT_EQ(done.fraction, 0.75f);
    taut_pose before, after;
    ASSERT_OK(taut_body_get_render_pose(body, &before));
    ASSERT_OK(taut_world_set_time_step(world, 1.0f / 16));
    ASSERT_OK(taut_body_get_render_pose(body, &after));
    EXPECT_EQ(before.position.x, after.position.x);
    ASSERT_OK(taut_world_advance(world, 1.25 / 32, &done));
    EXPECT_EQ(done.steps, 1u);
    EXPECT_EQ(done.fraction, 0);
    ASSERT_OK(taut_world_advance(world, 1.0 / 32, &done));
    EXPECT_EQ(done.steps, 0u);
    ASSERT_OK(taut_world_set_time_step(world, 1.0f / 64));
    ASSERT_OK(taut_world_advance(world, 1.0 / 64, &done));
    EXPECT_EQ(done.steps, 3u);
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(body, &pose));
    EXPECT_NEAR(pose.position.x, 1.0 / 32 + 1.0 / 16 + 3.0 / 64, 1e-9);
    EXPECT_OK(taut_world_destroy(world));
}

// A target that waits is reached by the step as it is now.
TEST(TimeStep, ReachesATargetThatWaits) {
    const taut_world world = make_world();
    taut_sphere_def ball;
    taut_sphere_def_init(&ball);
    taut_shape shape{};
    ASSERT_OK(taut_world_add_sphere(world, &ball, &shape));
    const taut_body body = add_body(world, body_def(TAUT_BODY_KINEMATIC, shape));
    const taut_pose target = {{1, 0, 0}, {0, 0, 0, 1}, {0, 0}};
    ASSERT_OK(taut_body_move_kinematic(body, &target));
    ASSERT_OK(taut_world_set_time_step(world, 1.0f / 200));
    ASSERT_OK(taut_world_step(world));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(body, &pose));
    EXPECT_NEAR(pose.position.x, 1, 1e-9);
    EXPECT_OK(taut_world_destroy(world));
}

}  // namespace
