// What a world reports of its solves, against what mechanics says they leave.
#include <numbers>

#include "physics/lab.h"

namespace lab {
namespace {

void with_report(taut_world_def& def) {
    def.report = 1;
    def.time_step = 1.0f / 60;
    def.substeps = 4;
    def.fixed_substeps = 1;
}

// A spring of frequency f on the reduced mass gives way by g / (2 pi f)^2, and a contact's f is .25 / h.
TEST(Report, BallAtRestYieldsByItsWeight) {
    const World world(with_report);
    world.add_ground();
    world.add({.shape = world.sphere(0.5), .position = {0, 0.5, 0}, .mass = 3});
    world.step(120);
    const double om = 2 * std::numbers::pi * 0.25 / world.substep();
    const taut_profile profile = world.profile();
    EXPECT_NEAR(profile.yield, kG / (om * om), 1e-3 * kG / (om * om));
    EXPECT_LT(profile.solve_residual, 1e-7f);
    EXPECT_LT(std::abs(profile.energy_gain), 1e-6f);
}

// A particle on a rod: sqrt(L^2 + h^2 v^2) - L. Solved directly, it does not yield.
TEST(Report, RodIsStraightForASubstep) {
    constexpr double kLength = 2, kSpeed = 5;
    const World world([](taut_world_def& def) {
        with_report(def);
        def.gravity = {};
    });
    const taut_body weight = world.particle(1, {kLength, 0, 0}, {0, kSpeed, 0});
    world.rod({}, {}, weight, {}, kLength);
    world.step();
    const double way = world.substep() * kSpeed, left = std::sqrt(kLength * kLength + way * way) - kLength;
    const taut_profile profile = world.profile();
    EXPECT_NEAR(profile.linearisation, left, 0.02 * left);
    EXPECT_EQ(profile.yield, 0);
    EXPECT_LT(profile.solve_residual, 1e-9f);
    EXPECT_LE(profile.energy_gain, 1e-6f);
}

// What a lift gives the ball on it is no gain.
TEST(Report, KinematicBodiesDoWork) {
    const World world(with_report);
    world.add({.kind = TAUT_BODY_KINEMATIC,
               .shape = world.box({1, 0.1, 1}),
               .position = {0, -0.1, 0},
               .velocity = {0, 2, 0}});
    world.add({.shape = world.sphere(0.5), .position = {0, 0.5, 0}, .velocity = {0, 2, 0}, .mass = 3});
    world.step(30);
    const double work = 3 * kG * 2 * world.substep();  // in a substep [J]
    EXPECT_LT(std::abs(world.profile().energy_gain), 0.01 * work);
}

// What pushes a ball out of the ground raises it without taking its weight's work from anything.
TEST(Report, OverlapsGiveEnergy) {
    const World world(with_report);
    world.add_ground();
    const taut_body ball = world.add({.shape = world.sphere(0.5), .position = {0, 0.3, 0}, .mass = 3});
    const double before = position(ball).y;
    world.step();
    const double raised = 3 * kG * (position(ball).y - before);  // in four substeps [J]
    const taut_profile profile = world.profile();
    EXPECT_GT(raised, 0);
    EXPECT_GT(profile.energy_gain, 0.2 * raised);
    EXPECT_LT(profile.energy_gain, 2 * raised);
}

// A heap of boxes and a chain end in the same bits with and without.
TEST(Report, ChangesNoResult) {
    const auto hash = [](uint32_t reports, uint32_t threads) {
        const World world([&](taut_world_def& def) {
            def.report = reports;
            def.time_step = 1.0f / 60;
            def.threads = threads;
        });
        world.add_ground();
        for (int i = 0; i < 40; ++i)
            world.add({.shape = world.box({0.3, 0.2, 0.25}),
                       .position = {0.1 * (i % 5), 0.3 + 0.25 * i, 0.07 * (i % 3)},
                       .mass = 1.0 + i % 4});
        taut_body above{};
        for (int i = 0; i < 6; ++i) {
            const taut_body link = world.particle(1, {3.0 + 0.5 * i, 5, 0});
            world.rod(above, i == 0 ? Vec(2.5, 5, 0) : Vec(), link, {}, 0.5);
            above = link;
        }
        world.step(90);
        uint64_t bits = 0;
        ok(taut_world_get_state_hash(world.handle, &bits));
        return bits;
    };
    const uint64_t without = hash(0, 1);
    EXPECT_EQ(hash(1, 1), without);
    EXPECT_EQ(hash(1, 3), without);
}

TEST(Report, IsSilentUnlessAsked) {
    const World world;
    world.add_ground();
    world.add({.shape = world.sphere(0.5), .position = {0, 0.5, 0}, .mass = 3});
    world.step(10);
    const taut_profile profile = world.profile();
    EXPECT_EQ(profile.yield, 0);
    EXPECT_EQ(profile.solve_residual, 0);
    EXPECT_EQ(profile.linearisation, 0);
    EXPECT_EQ(profile.energy_gain, 0);
}

}  // namespace
}  // namespace lab
