// The host's filter and one-way colliders: what they ignore goes free, what they accept moves as mechanics says.
#include "physics/contact_lab.h"

namespace {

using namespace lab;

// A host whose answer is a function, with all that it was asked.
struct Host {
    std::function<int32_t(const taut_pre_solve&, taut_pre_solve_answer&)> answer =
        [](const taut_pre_solve&, taut_pre_solve_answer&) { return 1; };
    std::vector<taut_pre_solve> asked;

    void serve(const World& world) {
        ok(taut_world_set_pre_solve(
            world.handle,
            [](const taut_pre_solve* contact, taut_pre_solve_answer* out, void* self) {
                Host& host = *static_cast<Host*>(self);
                host.asked.push_back(*contact);
                return host.answer(*contact, *out);
            },
            this));
    }
};

taut_body add_asking(const World& world, const BodyPlan& plan) {
    const taut_body body = world.add(plan);
    ok(taut_collider_set_pre_solve(collider_of(body), 1));
    return body;
}

TEST(PreSolve, IgnoredContactsDoNotHold) {
    World world;
    world.add_ground();
    const taut_shape box = world.box({0.25, 0.25, 0.25});
    const taut_body asking = add_asking(world, {.shape = box, .position = {0, 0.25, 0}});
    const taut_body other = world.add({.shape = box, .position = {3, 0.25, 0}});
    Host host;
    host.serve(world);
    world.step(30);
    EXPECT_NEAR(position(asking).y, 0.25, 1e-3);
    EXPECT_EQ(host.asked.size(), 30u) << "once a step, about one of the two";
    host.answer = [](const taut_pre_solve&, taut_pre_solve_answer&) { return 0; };
    world.step();
    taut_events events{};
    ok(taut_world_get_events(world.handle, &events));
    ASSERT_EQ(events.end_count, 1u);
    EXPECT_EQ(events.end[0].body_b.bits, asking.bits);
    EXPECT_EQ(host.asked.back().touching, 1u);
    world.step(19);
    EXPECT_EQ(host.asked.back().touching, 0u);
    const double t = 20 * world.frame();
    EXPECT_NEAR(position(asking).y, 0.25 - 0.5 * kG * t * t, 0.02 * kG * t) << "free fall";
    EXPECT_NEAR(position(other).y, 0.25, 1e-3);
    EXPECT_EQ(world.contacts().size(), 4u);
}

TEST(PreSolve, TellsTheContactAsItIs) {
    World world;
    const taut_body ground = world.add_ground(0.36, 0.25);
    const taut_body ball = add_asking(world, {.shape = world.sphere(0.5),
                                              .position = {2, 0.51, 1},
                                              .velocity = {1, -3, 0},
                                              .friction = 0.25,
                                              .restitution = 0.125});
    Host host;
    float friction = 0, restitution = 0;
    host.answer = [&](const taut_pre_solve&, taut_pre_solve_answer& answer) {
        friction = answer.friction;
        restitution = answer.restitution;
        return 1;
    };
    host.serve(world);
    world.step();
    ASSERT_EQ(host.asked.size(), 1u);
    const taut_pre_solve& q = host.asked[0];
    EXPECT_EQ(q.body_a.bits, ground.bits);
    EXPECT_EQ(q.body_b.bits, ball.bits);
    EXPECT_EQ(q.collider_b.bits, collider_of(ball).bits);
    EXPECT_EQ(q.point_count, 1u);
    EXPECT_NEAR(norm(Vec(q.normal) - Vec(0, 1, 0)), 0, 1e-6);
    EXPECT_NEAR(static_cast<double>(q.points[0].separation), 0.01, 1e-5);
    EXPECT_NEAR(static_cast<double>(q.points[0].approach_speed), 3, 1e-5);
    EXPECT_NEAR(norm(Vec(q.points[0].position) - Vec(2, 0.005, 1)), 0, 1e-4);
    EXPECT_NEAR(static_cast<double>(friction), 0.3, 1e-6);
    EXPECT_EQ(restitution, 0.25f);
}

// A friction that the host gives brakes a box as Coulomb says: v = v0 - mu g t.
TEST(PreSolve, GivesFriction) {
    World world;
    world.add_ground(1);
    const taut_body box = add_asking(
        world, {.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}, .velocity = {3, 0, 0}, .friction = 1});
    Host host;
    host.answer = [](const taut_pre_solve&, taut_pre_solve_answer& answer) {
        answer.friction = 0.1f;
        return 1;
    };
    host.serve(world);
    world.step(60);
    EXPECT_NEAR(velocity(box).x, 3 - 0.1 * kG * 60 * world.frame(), 0.03);
}

// An answer is of one step: the next begins with what the surfaces have.
TEST(PreSolve, GivesFrictionForOneStep) {
    World world;
    world.add_ground(1);
    const taut_body box = add_asking(
        world, {.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}, .velocity = {8, 0, 0}, .friction = 0.25});
    Host host;
    host.answer = [](const taut_pre_solve&, taut_pre_solve_answer& answer) {
        answer.friction = 0;
        return 1;
    };
    host.serve(world);
    world.step(10);
    EXPECT_NEAR(velocity(box).x, 8, 0.01);
    host.answer = [](const taut_pre_solve&, taut_pre_solve_answer&) { return 1; };
    world.step(30);
    EXPECT_NEAR(velocity(box).x, 8 - 0.5 * kG * 30 * world.frame(), 0.05);
}

// A loaded box is part of a block, which finds its contacts anew in each substep: the answer holds in all of them, so
// that the box moves as on a ground of that friction.
TEST(PreSolve, AnswersHoldForTheWholeStepInBlocks) {
    Vec moved[3];
    for (int way = 0; way < 3; ++way) {  // friction of the surfaces, of the host, and another
        World world;
        const double friction = way == 0 ? 0.25 : 1;
        world.add_ground(friction);
        const taut_body box = add_asking(world, {.shape = world.box({0.5, 0.1, 0.5}),
                                                 .position = {0, 0.1, 0},
                                                 .velocity = {3, 0, 0},
                                                 .mass = 1,
                                                 .friction = friction});
        const taut_body load =
            world.add({.position = {0, 0.1, 0}, .velocity = {3, 0, 0}, .mass = 100, .inertia = {10, 10, 10}});
        taut_fixed_joint_def joint;
        taut_fixed_joint_def_init(&joint);
        joint.base.body_a = box;
        joint.base.body_b = load;
        taut_joint out{};
        ok(taut_world_add_fixed_joint(world.handle, &joint, &out));
        Host host;
        host.answer = [](const taut_pre_solve&, taut_pre_solve_answer& answer) {
            answer.friction = 0.25f;
            return 1;
        };
        if (way == 1) host.serve(world);
        world.step(30);
        moved[way] = position(box);
    }
    EXPECT_EQ(norm(moved[1] - moved[0]), 0);
    EXPECT_GT(norm(moved[2] - moved[0]), 0.1);
}

TEST(PreSolve, GivesRestitution) {
    World world;
    world.add_ground();
    const taut_body ball = add_asking(world, {.shape = world.sphere(0.5), .position = {0, 2.5, 0}});
    Host host;
    host.answer = [](const taut_pre_solve&, taut_pre_solve_answer& answer) {
        answer.restitution = 0.8f;
        return 1;
    };
    host.serve(world);
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        fastest = std::max(fastest, velocity(ball).y);
    }
    EXPECT_NEAR(fastest, 0.8 * std::sqrt(2 * kG * 2), 0.2);
}

TEST(PreSolve, RefusesAnswersOutOfRangeWithAWarning) {
    int warnings = 0;
    World world([&](taut_world_def& def) {
        def.hooks.log = [](taut_log_level level, const char* text, void* count) {
            if (level == TAUT_LOG_WARNING && std::string(text).find("pre-solve") != std::string::npos)
                ++*static_cast<int*>(count);
        };
        def.hooks.log_user_data = &warnings;
    });
    world.add_ground(0.5);
    const taut_body box = add_asking(world, {.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}});
    Host host;
    host.serve(world);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    struct Answer {
        int32_t said;
        float friction, restitution;
    };
    int expected = 0;
    for (const Answer& bad : {Answer{1, nan, 0},
                              {1, inf, 0},
                              {1, -1, 0},
                              {1, 101, 0},
                              {1, 0, nan},
                              {1, 0, 1.5f},
                              {1, 0, -0.1f},
                              {2, 0, 0},
                              {-1, 0, 0}}) {
        host.answer = [bad](const taut_pre_solve&, taut_pre_solve_answer& answer) {
            answer = {bad.friction, bad.restitution};
            return bad.said;
        };
        world.step();
        EXPECT_EQ(warnings, ++expected);
    }
    // All were accepted with the surfaces' own friction: the box is held on its slope of forces.
    ok(taut_body_apply_force(box, {0.4f * 100 * 9.81f, 0, 0}, {0, 0, 0}));
    world.step();
    EXPECT_NEAR(velocity(box).x, 0, 1e-3);
    EXPECT_NEAR(position(box).y, 0.1, 1e-3);
}

TEST(PreSolve, IsAskedInOrderOnTheSteppingThreadWithTheWorldLocked) {
    std::vector<uint64_t> orders[2];
    for (uint32_t threads : {1u, 4u}) {
        World world([=](taut_world_def& def) { def.threads = threads; });
        world.add_ground();
        const taut_shape box = world.box({0.25, 0.25, 0.25});
        for (int i = 0; i < 80; ++i)
            add_asking(world, {.shape = box, .position = {0.6 * (i % 4), 0.25 + 0.5 * (i / 16), 0.6 * (i / 4 % 4)}});
        std::vector<uint64_t>& order = orders[threads > 1];
        Host host;
        host.answer = [&](const taut_pre_solve& contact, taut_pre_solve_answer&) {
            order.push_back(contact.collider_a.bits >> 24 << 32 ^ contact.collider_b.bits >> 24);  // without the world
            taut_vec3 gravity{};
            EXPECT_EQ(taut_world_set_gravity(world.handle, {0, 0, 0}), TAUT_LOCKED);
            EXPECT_EQ(taut_world_get_gravity(world.handle, &gravity), TAUT_LOCKED);
            EXPECT_EQ(taut_body_remove(contact.body_b), TAUT_LOCKED);
            return (contact.collider_a.bits >> 40) % 7 != 3;
        };
        host.serve(world);
        for (int i = 0; i < 20; ++i) {
            host.asked.clear();
            world.step();
            for (size_t k = 1; k < host.asked.size(); ++k)
                EXPECT_LT(std::pair(host.asked[k - 1].collider_a.bits, host.asked[k - 1].collider_b.bits),
                          std::pair(host.asked[k].collider_a.bits, host.asked[k].collider_b.bits));
        }
    }
    EXPECT_GT(orders[0].size(), 1000u);
    EXPECT_EQ(orders[0], orders[1]);
}

// A pile, and a ball that hangs in the ground unheld.
TEST(PreSolve, TakesNoMemoryAfterWarmUp) {
    World world;
    world.add_ground();
    const taut_shape box = world.box({0.25, 0.25, 0.25});
    for (int i = 0; i < 40; ++i)
        add_asking(world, {.shape = box, .position = {0.6 * (i % 10), 0.25 + 0.5 * (i / 10), 0}});
    taut_body ghost = add_asking(world, {.shape = world.sphere(0.5), .position = {0, 0.1, 5}, .gravity_scale = 0});
    ok(taut_world_set_pre_solve(
        world.handle,
        [](const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* ignored) {
            answer->restitution = 0.125f;
            return static_cast<int32_t>(contact->body_b.bits != static_cast<const taut_body*>(ignored)->bits);
        },
        &ghost));
    world.step(60);
    for (int i = 0; i < 60; ++i) {
        world.step();
        EXPECT_EQ(world.profile().allocations, 0u);
    }
    EXPECT_EQ(norm(position(ghost) - Vec(0, 0.1, 5)), 0);
}

class OneWay : public testing::Test {
protected:
    // A platform that is open from above, its upper face at 0.
    taut_body platform(taut_body_kind kind = TAUT_BODY_STATIC) {
        const taut_body body = world.add({.kind = kind, .shape = world.box({2, 0.1, 2}), .position = {0, -0.1, 0}});
        ok(taut_collider_set_one_way(collider_of(body), {0, 2, 0}));
        return body;
    }

    World world;
};

// Up through it, then down onto it: as in empty space until it lands.
TEST_F(OneWay, PlatformLetsABoxUpAndCatchesIt) {
    platform();
    for (double speed : {3.8, 5.0, 8.0, 12.0}) {
        const taut_body box =
            world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {0, -0.5, 0}, .velocity = {0, speed, 0}});
        int still = 0;
        for (int i = 0; i < 300 && still < 30; ++i) {
            world.step();
            const double t = (i + 1) * world.frame(), free = speed - kG * t;
            ASSERT_TRUE(free <= 0 || std::abs(velocity(box).y - free) < 1e-3) << speed << ": slowed on its way up";
            still += std::abs(velocity(box).y) < 1e-3;
        }
        EXPECT_NEAR(position(box).y, 0.2, 2e-3) << speed;
        ok(taut_body_remove(box));
    }
}

TEST_F(OneWay, WhatIsInsideFallsOutBelowAndWhatStandsIsHeld) {
    platform();
    const taut_body inside = world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {-1, -0.1, 0}});
    const taut_body loaded = world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {1, 0.2, 0}});
    const taut_body load = world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {1, 0.6, 0}, .mass = 5000});
    world.step(120);
    EXPECT_LT(position(inside).y, -5);
    EXPECT_NEAR(position(loaded).y, 0.2, 0.01);
    EXPECT_NEAR(position(load).y, 0.6, 0.02);
}

// The direction turns with the collider: upside down it catches from below.
TEST_F(OneWay, TurnsWithItsBody) {
    const taut_body body = platform();
    const taut_pose turned = {{0, -0.1, 0}, {1, 0, 0, 0}, {0, 0}};
    ok(taut_body_set_pose(body, &turned));
    const taut_body above = world.add({.shape = world.sphere(0.2), .position = {0, 1, 0}});
    world.step(90);
    EXPECT_LT(position(above).y, -2);
    ok(taut_world_set_gravity(world.handle, {0, 9.81f, 0}));
    world.step(240);
    EXPECT_NEAR(position(above).y, -0.4, 0.01);
}

}  // namespace
