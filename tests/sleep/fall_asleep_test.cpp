// Who falls asleep, when, and what it costs.
#include "sleep/sleep_lab.h"
#include "starts.h"

namespace {

using namespace lab;

class UntilSomebodySleeps : public testing::TestWithParam<const char*> {};

TEST_P(UntilSomebodySleeps, NothingDiffersFromAWorldWithoutSleeping) {
    scenes::Scene scene = scenes::make_scene(GetParam());
    const scenes::TautWorld off(scene);
    scene.world.sleeping = 1;
    const scenes::TautWorld on(scene);
    for (int step = 0; step < 1200; ++step) {
        ok(taut_world_step(off.world));
        ok(taut_world_step(on.world));
        if (events_of(on.world).fell_asleep_count > 0) {
            EXPECT_GT(step, 20);
            return;
        }
        ASSERT_TRUE(Bits(off.world, off.bodies) == Bits(on.world, on.bodies)) << "step " << step;
    }
    FAIL() << "nobody fell asleep";
}

INSTANTIATE_TEST_SUITE_P(Of, UntilSomebodySleeps,
                         testing::Values("stack10", "pyramid10", "heavy_on_light_r1000", "shapes200", "grains300_r1",
                                         "terrain"),
                         [](const auto& tested) -> std::string { return tested.param; });

TEST(FallsAsleep, StackAsAWholeAfterTheTimeOfTheDef) {
    for (const float time : {0.25f, 1.0f}) {
        const World world([&](taut_world_def& def) {
            let_sleep(def);
            def.sleep_time = time;
        });
        world.add_ground();
        const std::vector<taut_body> stack = add_stack(world, 10);
        uint32_t told = 0;
        for (int step = 1; told == 0; ++step) {
            ASSERT_LE(step, 60 * time + 60);
            world.step();
            told = events_of(world.handle).fell_asleep_count;
            EXPECT_EQ(told > 0, all_asleep(stack));
            EXPECT_EQ(told == 0, all_awake(stack));
            EXPECT_TRUE(told == 0 || step >= 60 * time - 1) << step;
        }
        EXPECT_EQ(told, 10u);
        EXPECT_EQ(world.profile().sleeping_islands, 1u);
        EXPECT_EQ(world.profile().awake, 0u);
    }
}

// Each on its own: a heap that does not touch another is another island.
TEST(FallsAsleep, EachIslandByItself) {
    const World world(let_sleep);
    world.add_ground();
    const std::vector<taut_body> early = add_stack(world, 3), late = add_stack(world, 3, 2);
    world.step(20);
    ok(taut_body_apply_impulse(late[2], {0, 100, 0}, {0, 0, 0}));
    ASSERT_GT(steps_to_sleep(world, early, 30), 0);
    EXPECT_TRUE(all_awake(late));
    ASSERT_GT(steps_to_sleep(world, late), 0);
    EXPECT_EQ(world.profile().sleeping_islands, 2u);
}

TEST(FallsAsleep, HangingChainThatKeepsItsForces) {
    const World world(let_sleep);
    const taut_shape link = world.box({0.05, 0.25, 0.05});
    std::vector<taut_body> chain;
    std::vector<taut_joint> joints;
    for (int i = 0; i < 5; ++i) {
        chain.push_back(world.add({.shape = link, .position = {0, -0.25 - 0.5 * i, 0}, .mass = 2}));
        const taut_body above = i == 0 ? taut_body{} : chain[static_cast<size_t>(i) - 1];
        joints.push_back(world.ball(above, {0, i == 0 ? 0.0 : -0.25, 0}, chain.back(), {0, 0.25, 0}));
    }
    ASSERT_GT(steps_to_sleep(world, chain, 120), 0);
    world.step(60);
    for (size_t i = 0; i < joints.size(); ++i) {
        taut_vec3 force{};
        ok(taut_joint_get_force(joints[i], &force));
        const double carried = 2 * kG * static_cast<double>(joints.size() - i);
        EXPECT_NEAR(norm(Vec(force)), carried, 1e-3 * carried) << "joint " << i;
    }
}

// A trunk with four limbs of two parts each, their hinges as stiff as a body's.
TEST(FallsAsleep, PuppetAsAWholeWhereItFell) {
    const World world(let_sleep);
    world.add_ground();
    const taut_shape part = world.box({0.25, 0.06, 0.06});
    std::vector<taut_body> puppet{world.add({.shape = world.box({0.3, 0.1, 0.2}), .position = {0, 1, 0}})};
    for (const Vec& side : {Vec(1, 0, 0.15), Vec(1, 0, -0.15), Vec(-1, 0, 0.15), Vec(-1, 0, -0.15)}) {
        Vec end(0.3 * side.x, 1, side.z);
        taut_body inner = puppet[0];
        for (int i = 0; i < 2; ++i) {
            puppet.push_back(world.add({.shape = part, .position = end + Vec(0.25 * side.x, 0, 0)}));
            taut_hinge_joint_def def;
            taut_hinge_joint_def_init(&def);
            def.base.body_a = inner, def.base.body_b = inner = puppet.back();
            def.angle.friction = 2;
            ok(taut_joint_frames_from_world(world.handle, def.base.body_a, def.base.body_b, end.pos(), {0, 0, 1},
                                            &def.base.frame_a, &def.base.frame_b));
            taut_joint out{};
            ok(taut_world_add_hinge_joint(world.handle, &def, &out));
            end += Vec(0.5 * side.x, 0, 0);
        }
    }
    ASSERT_GT(steps_to_sleep(world, puppet, 300), 0);
    EXPECT_EQ(events_of(world.handle).fell_asleep_count, puppet.size()) << "all in one step";
    ok(taut_body_apply_impulse(puppet[8], {0, 1, 0}, {}));
    EXPECT_TRUE(all_awake(puppet));
}

// Whether at least 95 % of what moves in a scene sleeps within forty seconds.
bool falls_asleep(const char* name, uint64_t seed) {
    scenes::Options options;
    options.seed = seed;
    scenes::Scene scene = scenes::make_scene(name, options);
    scene.world.sleeping = 1;
    RunningScene run(scene);
    uint32_t bodies = 0, asleep = 0;
    for (int step = 0; step < 2400 && (bodies == 0 || asleep < 0.95 * bodies); ++step) {
        run.step();
        const taut_profile profile = run.world.profile();
        bodies = profile.bodies;
        asleep = bodies - profile.awake;
    }
    EXPECT_TRUE(run.sound()) << name << " seed " << seed;
    return asleep >= 0.95 * bodies;
}

TEST(FallsAsleep, Piles) {
    for (const char* name : {"grains300_r1", "heavy_on_light_r1000"}) EXPECT_TRUE(falls_asleep(name, 0)) << name;
}

// Nearly all do: 95 of 96 starts.
TEST(FallsAsleep, HeapsOfMixedShapes) {
    uint64_t asleep = 0;
    const auto count = starts<uint64_t>(16);
    for (uint64_t seed = 1; seed <= count; ++seed) asleep += falls_asleep("shapes200", seed);
    EXPECT_GE(asleep, 15 * count / 16);
}

// Asleep nothing moves by a bit, nothing is told, velocities are zero, and queries find what is there.
TEST(Asleep, NothingMoves) {
    scenes::Scene scene = scenes::make_scene("pyramid10");
    scene.world.sleeping = 1;
    const scenes::TautWorld world(scene);
    std::vector<taut_body> bricks;
    for (size_t i = 0; i < scene.bodies.size(); ++i)
        if (scene.bodies[i].kind == TAUT_BODY_DYNAMIC) bricks.push_back(world.bodies[i]);
    int steps = 0;
    for (; !all_asleep(bricks); ++steps) {
        ASSERT_LT(steps, 600);
        ok(taut_world_step(world.world));
        if (all_awake(bricks)) continue;
        EXPECT_EQ(events_of(world.world).fell_asleep_count, bricks.size());
        EXPECT_GT(events_of(world.world).moved_count, 0u) << "the last motion is told";
    }
    uint32_t points = 0;
    taut_world_get_contacts(world.world, nullptr, 0, &points);
    EXPECT_GT(points, 100u);
    const Bits before(world.world, bricks);
    for (const taut_vec3& v : before.linear) EXPECT_EQ(norm(Vec(v)), 0);
    for (int i = 0; i < 600; ++i) {
        ok(taut_world_step(world.world));
        const taut_events events = events_of(world.world);
        ASSERT_EQ(events.moved_count + events.begin_count + events.end_count + events.fell_asleep_count, 0u) << i;
        ASSERT_TRUE(i == 0 || world.profile().allocations == 0) << i;
    }
    EXPECT_TRUE(Bits(world.world, bricks) == before);
    uint32_t now = 0;
    taut_world_get_contacts(world.world, nullptr, 0, &now);
    EXPECT_EQ(now, points);
    for (taut_body brick : bricks) {
        taut_pose pose{}, drawn{};
        ok(taut_body_get_pose(brick, &pose));
        ok(taut_body_get_render_pose(brick, &drawn));
        EXPECT_EQ(drawn.position.y, pose.position.y);
        const taut_pos above{pose.position.x, 20, pose.position.z};
        const taut_ray ray{above, {0, -19.99f, 0}, 0};
        taut_query_hit hit{};
        ok(taut_world_cast_ray(world.world, &ray, nullptr, &hit));
        EXPECT_NE(hit.body.bits, 0u);
    }
    EXPECT_TRUE(all_asleep(bricks)) << "a query wakes nobody";
}

TEST(Asleep, CostsLittle) {
    scenes::Options options;
    options.seed = 4;  // of those that fall asleep, see FallsAsleep.HeapsOfMixedShapes
    scenes::Scene scene = scenes::make_scene("shapes200", options);
    scene.world.sleeping = 1;
    const scenes::TautWorld world(scene);
    float awake_us = 1e30f, asleep_us = 1e30f;
    uint32_t slept = 0;
    for (int i = 0; i < 3000 && slept < 60; ++i) {
        ok(taut_world_step(world.world));
        const taut_profile profile = world.profile();
        if (profile.awake == profile.bodies && i > 200) awake_us = std::min(awake_us, profile.step_us);
        if (profile.awake > 0) continue;
        asleep_us = std::min(asleep_us, profile.step_us);
        ++slept;
    }
    ASSERT_EQ(slept, 60u);
    EXPECT_LT(10 * asleep_us, awake_us);
}

// ---------------------------------------------------------------- who does not

TEST(StaysAwake, WhatMovesFasterThanTheThreshold) {
    const World world([](taut_world_def& def) {
        let_sleep(def);
        def.gravity = {};
    });
    const taut_shape ball = world.sphere(0.5);
    const taut_body slow = world.add({.shape = ball, .velocity = {0.029, 0, 0}});
    const taut_body fast = world.add({.shape = ball, .position = {0, 5, 0}, .velocity = {0.031, 0, 0}});
    const taut_body turning = world.add({.shape = ball, .position = {0, 10, 0}, .spin = {0, 0.061, 0}});
    const taut_body bare = world.add({.position = {0, 15, 0}, .spin = {0, 0.061, 0}, .mass = 1, .inertia = {1, 1, 1}});
    world.step(120);
    EXPECT_FALSE(awake(slow));
    EXPECT_TRUE(awake(fast));
    EXPECT_TRUE(awake(turning));
    EXPECT_TRUE(awake(bare));
}

TEST(StaysAwake, WhoMayNotSleepAndWhoTouchesHim) {
    const World world(let_sleep);
    world.add_ground();
    const std::vector<taut_body> stack = add_stack(world, 3);
    ok(taut_body_set_can_sleep(stack[1], 0));
    world.step(300);
    EXPECT_TRUE(all_awake(stack));
    ok(taut_body_set_can_sleep(stack[1], 1));
    EXPECT_GT(steps_to_sleep(world, stack, 60), 0);
}

TEST(StaysAwake, InAWorldWithoutSleeping) {
    const World world;
    world.add_ground();
    const std::vector<taut_body> stack = add_stack(world, 3);
    world.step(300);
    EXPECT_TRUE(all_awake(stack));
    EXPECT_EQ(taut_body_set_awake(stack[0], 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_body_set_awake(stack[0], 1), TAUT_OK);
}

// A turntable without friction moves below what stands on it.
TEST(StaysAwake, OnAMovingKinematicBody) {
    const World world(let_sleep);
    const taut_body table = world.add({.kind = TAUT_BODY_KINEMATIC,
                                       .shape = world.box({2, 0.1, 2}),
                                       .position = {0, -0.1, 0},
                                       .spin = {0, 0.5, 0},
                                       .friction = 0});
    const std::vector<taut_body> stack = add_stack(world, 1);
    world.step(300);
    EXPECT_LT(norm(velocity(stack[0])), 0.01);
    EXPECT_TRUE(awake(stack[0]));
    ok(taut_body_set_velocity(table, {}, {}));
    EXPECT_GT(steps_to_sleep(world, stack, 120), 0);
}

// A swing stands still for a moment at each end of its way.
TEST(StaysAwake, APendulumAtItsTurningPoints) {
    const World world(let_sleep);
    const taut_body bob = world.particle(1, {0.1, -1, 0});
    world.rod({}, {0, 0, 0}, bob, {}, std::hypot(0.1, 1.0));
    for (int i = 0; i < 600; ++i) {
        world.step();
        ASSERT_TRUE(awake(bob)) << i;
    }
}

}  // namespace
