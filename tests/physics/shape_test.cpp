// Cylinders, cones and tapered capsules: what stands stands, what rolls rolls as mechanics says.
#include "physics/lab.h"

namespace {

using namespace lab;

enum class Ground { plane, box };

void add_slope(const World& world, Ground ground, double angle) {
    const Quat turn = Quat::turn({0, 0, 1}, -angle);
    const Vec normal = turn.rotate({0, 1, 0});
    if (ground == Ground::plane) {
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(normal), .friction = 1});
        return;
    }
    world.add({.kind = TAUT_BODY_STATIC,
               .shape = world.box({40, 1, 40}),
               .position = -1.0 * normal,
               .rotation = turn,
               .friction = 1});
}

class OnGround : public testing::TestWithParam<Ground> {};

// I = m r^2 / 2: a = g sin(angle) / (1 + 1/2).
TEST_P(OnGround, CylinderRollsDownAsItsInertiaSays) {
    constexpr double kAngle = 0.2, kRadius = 0.3, kSeconds = 2;
    const World world;
    add_slope(world, GetParam(), kAngle);
    const Vec normal = Quat::turn({0, 0, 1}, -kAngle).rotate({0, 1, 0});
    const taut_body body = world.add({.shape = world.cylinder(kRadius, 0.4),
                                      .position = kRadius * normal,
                                      .rotation = Quat::turn({1, 0, 0}, kPi / 2),
                                      .friction = 1});
    const double rate = 2.0 / 3 * kG * std::sin(kAngle);
    double before = 0, unevenness = 0;
    const int frames = static_cast<int>(std::lround(kSeconds / world.frame()));
    for (int i = 0; i < frames; ++i) {
        world.step();
        const double speed = norm(velocity(body));
        if (i > 30) unevenness = std::max(unevenness, std::abs((speed - before) / world.frame() - rate));
        before = speed;
    }
    const double want = rate * kSeconds;
    const BodyState s = state(body);
    EXPECT_NEAR(norm(s.velocity), want, 0.003 * want);
    EXPECT_NEAR(norm(s.spin), want / kRadius, 0.005 * want / kRadius);
    EXPECT_NEAR(s.position.z, 0, 1e-4) << "leaves its line";
    EXPECT_LT(unevenness, 0.05 * rate) << "bumps";
    RecordProperty("unevenness_pct", std::to_string(100 * unevenness / rate));
    RecordProperty("speed_error_pct", std::to_string(100 * (norm(s.velocity) / want - 1)));
}

TEST_P(OnGround, WhatStandsStaysWhereItIs) {
    const World world;
    add_slope(world, GetParam(), 0);
    const std::vector<taut_body> bodies = {
        world.add({.shape = world.cylinder(0.2, 0.6), .position = {-2, 0.6, 0}}),
        world.add({.shape = world.cylinder(0.5, 0.03), .position = {0, 0.03, 0}}),
        world.add({.shape = world.cone(0.3, 0.4), .position = {2, 0.4, 0}}),
        world.add({.shape = world.cylinder(0.3, 0.3), .position = {4, 0.3, 0}}),
        world.add({.shape = world.cylinder(0.3, 0.3), .position = {4.05, 0.9, 0.02}}),  // on the last, cap to cap
        world.add({.shape = world.cylinder(0.2, 0.3), .position = {4.1, 1.5, 0}}),
    };
    std::vector<BodyState> start;
    for (const taut_body body : bodies) start.push_back(state(body));
    world.step(600);
    for (size_t i = 0; i < bodies.size(); ++i) {
        const BodyState s = state(bodies[i]);
        EXPECT_LT(norm(s.velocity), 0.003) << i;
        EXPECT_LT(norm(s.position - start[i].position), 0.006) << i;
        EXPECT_GT(s.rotation.rotate({0, 1, 0}).y, 0.99999) << i;
    }
}

// Tipped by less than the angle at which its centre passes the rim, a cylinder falls back on its cap and rests.
TEST_P(OnGround, TippedCylinderFallsBackOntoItsCap) {
    const World world;
    add_slope(world, GetParam(), 0);
    const taut_body body = world.add(
        {.shape = world.cylinder(0.3, 0.3), .position = {0, 0.42, 0}, .rotation = Quat::turn({1, 0, 0.4}, 0.35)});
    world.step(300);
    EXPECT_GT(state(body).rotation.rotate({0, 1, 0}).y, 0.9999);
    EXPECT_LT(norm(velocity(body)), 0.003);
    EXPECT_LT(norm(state(body).spin), 0.01);
}

// A cone on its side rests on the line from rim to apex.
TEST_P(OnGround, ConeLiesOnItsSide) {
    constexpr double kRadius = 0.3, kHalf = 0.4;
    const World world;
    add_slope(world, GetParam(), 0);
    // The side's normal (2 h, r) turned to straight down.
    const double turn = std::atan2(kRadius, 2 * kHalf);
    const taut_body body = world.add({.shape = world.cone(kRadius, kHalf),
                                      .position = {0, 0.3, 0},
                                      .rotation = Quat::turn({0, 0, 1}, -kPi / 2 - turn)});
    world.step(240);
    const std::vector<taut_contact> contacts = world.contacts();
    EXPECT_EQ(contacts.size(), 2u);
    EXPECT_LT(norm(velocity(body)), 0.01);
}

INSTANTIATE_TEST_SUITE_P(Shapes, OnGround, testing::Values(Ground::plane, Ground::box),
                         [](const auto& tested) { return tested.param == Ground::plane ? "plane" : "box"; });

}  // namespace
