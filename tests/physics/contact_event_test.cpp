// Contact events against mechanics: speeds of falls, impulses of weights, and the pairing of what begins and ends.
#include <bit>
#include <random>
#include <set>

#include "physics/contact_lab.h"
#include "physics/surface_lab.h"
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

std::function<void(taut_world_def&)> asking_for(uint32_t contact_events, taut_solver solver = TAUT_SOLVER_BLOCK_LDLT,
                                                uint32_t threads = 1) {
    return [=](taut_world_def& def) {
        def.contact_events = contact_events;
        def.solver = solver;
        def.threads = threads;
    };
}

double sum_of(const taut_events& events, const taut_contact_event& event, float taut_contact_point::*of) {
    double sum = 0;
    for (uint32_t k = 0; k < event.point_count; ++k)
        sum += static_cast<double>(events.points[event.first_point + k].*of);
    return sum;
}

double sum_of(const taut_events& events, float taut_contact_point::*of) {
    double sum = 0;
    for (uint32_t k = 0; k < events.point_count; ++k) sum += static_cast<double>(events.points[k].*of);
    return sum;
}

class WithEachSolver : public testing::TestWithParam<taut_solver> {};

// v^2 = 2 g h; forces push once a step, so that both sides of the blow's step may be meant.
TEST_P(WithEachSolver, AFallHitsOnceAtItsSpeed) {
    for (double height = 0.1; height < 6.2; height += 0.137) {
        World world(asking_for(TAUT_CONTACT_EVENTS_ALL, GetParam()));
        world.add_ground();
        const taut_body ball = world.add({.shape = world.sphere(0.3), .position = {0, 0.3 + height, 0}, .mass = 2});
        int hits = 0, begins = 0;
        double pushed = 0;
        for (int i = 0; i < 120; ++i) {
            world.step();
            const taut_events e = events_of(world);
            begins += static_cast<int>(e.begin_count);
            pushed += sum_of(e, &taut_contact_point::normal_impulse);
            for (uint32_t k = 0; k < e.hit_count; ++k, ++hits) {
                const taut_hit_event& hit = e.hit[k];
                const double v = std::sqrt(2 * kG * height);
                EXPECT_NEAR(static_cast<double>(hit.approach_speed), v, 1.5 * kG * world.frame()) << height;
                EXPECT_TRUE(hit.body_a.bits == ball.bits || hit.body_b.bits == ball.bits);
                EXPECT_NEAR(std::abs(static_cast<double>(hit.normal.y)), 1, 1e-6);
                EXPECT_NEAR(hit.position.y, 0, v * world.frame());
            }
        }
        EXPECT_EQ(hits, 1) << height;
        EXPECT_EQ(begins, 1) << height;
        // At rest in the end: what the ground gave is what gravity gave.
        EXPECT_NEAR(pushed / (2 * kG * 120 * world.frame()), 1, 0.005) << height;
    }
}

TEST_P(WithEachSolver, WhatRestsIsPushedByItsWeight) {
    World world(asking_for(TAUT_CONTACT_EVENTS_PERSIST | TAUT_CONTACT_EVENTS_POINTS, GetParam()));
    world.add_ground();
    for (int i = 0; i < 3; ++i)
        world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {0, 0.25 + 0.5 * i, 0}, .mass = 5});
    world.step(120);
    events_of(world);  // and forgets them
    double pushed[3] = {0, 0, 0};
    constexpr int kSteps = 60;
    for (int i = 0; i < kSteps; ++i) {
        world.step();
        const taut_events e = events_of(world);
        ASSERT_EQ(e.persist_count, 3 * e.steps);
        EXPECT_EQ(e.begin_count + e.end_count + e.hit_count, 0u);
        ASSERT_EQ(e.point_count, 12 * e.steps);
        for (uint32_t k = 0; k < e.persist_count; ++k) {
            ASSERT_EQ(e.persist[k].point_count, 4u);
            pushed[k % 3] += sum_of(e, e.persist[k], &taut_contact_point::normal_impulse);
        }
    }
    // In the order of the colliders: ground and lowest, lowest and middle, middle and top.
    for (int k = 0; k < 3; ++k)
        EXPECT_NEAR(pushed[k] / (5 * (3 - k) * kG * kSteps * world.frame()), 1, 0.005) << "interface " << k;
}

// What hits with a corner and is off again before the step ends has touched: m (dv + g dt) is the sum of all impulses.
TEST_P(WithEachSolver, EveryPushIsTold) {
    std::mt19937 random(11);
    int blows = 0, hits = 0;
    for (int start = 0; start < 60; ++start) {
        World world(asking_for(TAUT_CONTACT_EVENTS_ALL, GetParam()));
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({10, 0.5, 10}), .position = {0, -0.5, 0}});
        const double speed = between(random, 1, 10), mass = 3;
        const taut_body cube = world.add({.shape = world.box({0.05, 0.05, 0.05}),
                                          .position = {0, between(random, 0.1, 0.3), 0},
                                          .rotation = Quat::turn(random_direction(random), between(random, 0, 6)),
                                          .velocity = {0, -speed, 0},
                                          .spin = between(random, 0, 20) * random_direction(random),
                                          .mass = mass});
        bool touching = false;
        for (int step = 0; step < 60; ++step) {
            const double before = velocity(cube).y;
            world.step();
            const double push = mass * (velocity(cube).y - before + kG * world.frame());
            const taut_events e = events_of(world);
            double told = 0;
            for (uint32_t k = 0; k < e.point_count; ++k)
                told += static_cast<double>(e.points[k].normal_impulse) * std::abs(e.points[k].normal.y);
            EXPECT_NEAR(told, push, 1e-3 * mass * speed) << "start " << start << ", step " << step;
            if (!touching && push > 0.5 * mass) ++blows, hits += e.hit_count == 1;
            touching = e.begin_count + e.persist_count > 0;
        }
    }
    EXPECT_GT(blows, 60);
    EXPECT_GT(hits, 0.9 * blows) << "of " << blows;
}

INSTANTIATE_TEST_SUITE_P(Contacts, WithEachSolver,
                         testing::Values(TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                         TAUT_SOLVER_ACCELERATED_JACOBI));

// A loaded chain's contacts are rows of its block, found anew in each substep.
TEST(ContactEvents, ABlocksContactsCarryItsWeight) {
    World world(asking_for(TAUT_CONTACT_EVENTS_ALL));
    world.add_ground();
    const taut_body light = world.add({.shape = world.box({0.25, 0.05, 0.25}), .position = {0, 0.05, 0}, .mass = 1});
    const taut_body heavy = world.add({.position = {0, 0.5, 0}, .mass = 200, .inertia = {20, 20, 20}});
    taut_fixed_joint_def joint;
    taut_fixed_joint_def_init(&joint);
    joint.base.body_a = light;
    joint.base.body_b = heavy;
    joint.base.frame_a.position = {0, 0.45, 0};
    taut_joint out{};
    ok(taut_world_add_fixed_joint(world.handle, &joint, &out));
    world.step(120);
    events_of(world);  // and forgets them
    double pushed = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        const taut_events e = events_of(world);
        ASSERT_EQ(e.persist_count, e.steps);
        pushed += sum_of(e, &taut_contact_point::normal_impulse);
    }
    EXPECT_NEAR(pushed / (201 * kG * 60 * world.frame()), 1, 0.005);
}

// The parts of a mesh that a body touches make one event with the points of all.
TEST(ContactEvents, AMeshIsOneCollider) {
    World world(asking_for(TAUT_CONTACT_EVENTS_ALL));
    const Triangles roof = {{{-2, 0, -2}, {-2, 0, 2}, {0, 0, 2}, {0, 0, -2}, {2, 2, 2}, {2, 2, -2}},
                            {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5}};
    world.add({.kind = TAUT_BODY_STATIC, .shape = mesh(world, roof), .friction = 0});
    world.add(
        {.shape = world.sphere(0.25), .position = {-0.2, 0.3, 0}, .velocity = {0.5, 0, 0}, .mass = 2, .friction = 0});
    uint32_t begins = 0, most = 0;
    double up = 0, back = 0;
    for (int i = 0; i < 240; ++i) {
        world.step();
        const taut_events e = events_of(world);
        begins += e.begin_count;
        ASSERT_LE(e.begin_count + e.persist_count, e.steps);
        for (uint32_t k = 0; k < e.persist_count; ++k) most = std::max(most, e.persist[k].point_count);
        for (uint32_t k = 0; k < e.point_count; ++k) {
            const Vec push = static_cast<double>(e.points[k].normal_impulse) * Vec(e.points[k].normal);
            up += push.y;
            back -= push.x;
        }
    }
    EXPECT_EQ(begins, 1u);
    EXPECT_EQ(most, 2u) << "floor and slope at once";
    EXPECT_GT(back, 0);
    EXPECT_NEAR(up / (2 * kG * 240 * world.frame()), 1, 0.02);
}

// A sliding box loses momentum to friction alone.
TEST(ContactEvents, FrictionImpulsesAreTheMomentumLost) {
    World world(asking_for(TAUT_CONTACT_EVENTS_ALL));
    world.add_ground(0.3);
    const taut_body box = world.add({.shape = world.box({0.5, 0.1, 0.5}),
                                     .position = {0, 0.1, 0},
                                     .velocity = {4, 0, 0},
                                     .mass = 3,
                                     .friction = 0.3});
    double friction = 0;
    for (int i = 0; i < 30; ++i) {
        world.step();
        const taut_events e = events_of(world);
        ASSERT_EQ(e.begin_count + e.persist_count, e.steps);
        friction += sum_of(e, &taut_contact_point::friction_impulse);
    }
    const double lost = 3 * (4 - velocity(box).x);
    EXPECT_NEAR(friction / lost, 1, 0.01);
    EXPECT_NEAR(lost / (0.3 * 3 * kG * 0.5), 1, 0.02);
}

// What nobody asks for is not told: by world, body and collider.
TEST(ContactEvents, AreToldToThoseWhoAsk) {
    World world(asking_for(0));
    world.add_ground();
    const taut_shape ball = world.sphere(0.25);
    std::vector<taut_body> bodies;
    for (int i = 0; i < 3; ++i) bodies.push_back(world.add({.shape = ball, .position = {2.0 * i, 1, 0}}));
    ok(taut_body_set_contact_events(bodies[1], TAUT_CONTACT_EVENTS_BEGIN_END));
    taut_collider last{};
    uint32_t count = 0;
    ok(taut_body_get_colliders(bodies[2], &last, 1, &count));
    ok(taut_collider_set_contact_events(last, TAUT_CONTACT_EVENTS_HIT));
    int begins = 0, hits = 0, others = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        const taut_events e = events_of(world);
        for (uint32_t k = 0; k < e.begin_count; ++k, ++begins) EXPECT_EQ(e.begin[k].body_b.bits, bodies[1].bits);
        for (uint32_t k = 0; k < e.hit_count; ++k, ++hits) EXPECT_EQ(e.hit[k].body_b.bits, bodies[2].bits);
        others += static_cast<int>(e.persist_count + e.end_count + e.point_count);
    }
    EXPECT_EQ(begins, 1);
    EXPECT_EQ(hits, 1);
    EXPECT_EQ(others, 0);
    EXPECT_EQ(world.contacts().size(), 3u);
    for (const taut_body body : bodies) ok(taut_body_remove(body));
    ok(taut_world_step(world.handle));
    ASSERT_EQ(events_of(world).end_count, 1u);
    EXPECT_EQ(events_of(world).end[0].body_b.bits, bodies[1].bits);
}

using Pair = std::pair<uint64_t, uint64_t>;

Pair pair_of(const taut_contact_event& event) { return {event.collider_a.bits, event.collider_b.bits}; }

void expect_sorted(const taut_contact_event* events, uint32_t count) {
    for (uint32_t i = 1; i < count; ++i) EXPECT_LT(pair_of(events[i - 1]), pair_of(events[i]));
}

// Every pair begins, persists in every step until it ends, and ends: checked against a list kept here.
void expect_paired(const taut_events& e, std::set<Pair>& touching) {
    for (uint32_t i = 0; i < e.end_count; ++i) EXPECT_EQ(touching.erase(pair_of(e.end[i])), 1u);
    EXPECT_EQ(e.persist_count, touching.size());
    for (uint32_t i = 0; i < e.persist_count; ++i) EXPECT_EQ(touching.count(pair_of(e.persist[i])), 1u);
    for (uint32_t i = 0; i < e.begin_count; ++i) EXPECT_TRUE(touching.insert(pair_of(e.begin[i])).second);
    expect_sorted(e.begin, e.begin_count);
    expect_sorted(e.persist, e.persist_count);
    expect_sorted(e.end, e.end_count);
}

// A heap on a mesh, of which a body goes now and then. out: all that was told, as words.
void run_heap(uint32_t threads, int steps, std::vector<uint64_t>& out) {
    World world(asking_for(TAUT_CONTACT_EVENTS_ALL, TAUT_SOLVER_BLOCK_LDLT, threads));
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({4, 0.5, 4}), .position = {0, -0.5, 0}});
    const taut_shape shapes[] = {world.box({0.2, 0.15, 0.25}), world.sphere(0.2)};
    std::vector<taut_body> bodies;
    for (int i = 0; i < 120; ++i)
        bodies.push_back(world.add({.shape = shapes[i % 2],
                                    .position = {0.45 * (i % 5) - 1, 0.4 + 0.45 * (i / 25), 0.45 * (i / 5 % 5) - 1},
                                    .rotation = Quat::turn({1, 2, 3}, i)}));
    std::set<Pair> touching;
    for (int step = 0; step < steps; ++step) {
        if (step % 10 == 9) {
            ok(taut_body_remove(bodies.back()));
            bodies.pop_back();
        }
        world.step();
        const taut_events e = events_of(world);
        expect_paired(e, touching);
        for (const auto& [list, count] :
             {std::pair{e.begin, e.begin_count}, std::pair{e.persist, e.persist_count}, std::pair{e.end, e.end_count}})
            for (uint32_t i = 0; i < count; ++i) {
                out.push_back(list[i].collider_a.bits >> 24);  // without the world
                out.push_back(list[i].collider_b.bits >> 24 << 8 | list[i].point_count);
            }
        for (uint32_t i = 0; i < e.point_count; ++i)
            for (float x : {e.points[i].normal_impulse, e.points[i].friction_impulse, e.points[i].approach_speed}) {
                EXPECT_TRUE(std::isfinite(x));
                out.push_back(std::bit_cast<uint32_t>(x));
            }
        for (uint32_t i = 0; i < e.hit_count; ++i) out.push_back(std::bit_cast<uint32_t>(e.hit[i].approach_speed));
    }
}

TEST(ContactEvents, ArePairedAndTheSameOnAnyNumberOfThreads) {
    std::vector<uint64_t> alone;
    run_heap(1, 150, alone);
    EXPECT_GT(alone.size(), 10000u);
    for (uint32_t threads : {2u, 5u}) {
        std::vector<uint64_t> together;
        run_heap(threads, 150, together);
        EXPECT_EQ(together, alone) << threads;
    }
}

TEST(ContactEvents, ChangeNoMotionAndTakeNoMemory) {
    uint64_t hash[2];
    for (int all = 0; all < 2; ++all) {
        World world(asking_for(all ? TAUT_CONTACT_EVENTS_ALL : 0));
        world.add_ground();
        const taut_shape box = world.box({0.25, 0.25, 0.25});
        for (int i = 0; i < 60; ++i)
            world.add({.shape = box, .position = {0.52 * (i % 4), 0.3 + 0.55 * (i / 16), 0.52 * (i / 4 % 4)}});
        world.step(120);
        for (int i = 0; i < 60; ++i) {
            world.step();
            EXPECT_EQ(world.profile().allocations, 0u);
        }
        ok(taut_world_get_state_hash(world.handle, &hash[all]));
    }
    EXPECT_EQ(hash[0], hash[1]);
}

}  // namespace
