// Bodies put into one place: what a step costs there, what becomes of them, and what is no crowd.
#include <ctime>

#include "physics/lab.h"

namespace {

using namespace lab;

enum class Crowded { boxes, balls, boxes_by_a_heavy_one };

class CrowdOf : public testing::TestWithParam<Crowded> {
protected:
    std::vector<taut_body> put_together(World& world, int count, double height) const {
        const taut_shape shape = GetParam() == Crowded::balls ? world.sphere(0.5) : world.box({0.5, 0.5, 0.5});
        std::vector<taut_body> out;
        for (int i = 0; i < count; ++i) {
            const double mass = GetParam() == Crowded::boxes_by_a_heavy_one && i == 0 ? 200 : 1;
            const Vec at(1e-3 * std::sin(i), height + 1e-3 * std::sin(2 * i), 1e-3 * std::cos(3 * i));
            out.push_back(world.add({.shape = shape, .position = at, .mass = mass}));
        }
        return out;
    }
};

// 300 have 44850 pairs: these took 600 ms a step.
TEST_P(CrowdOf, Hundreds) {
    constexpr int kCount = 300;
    World world;
    put_together(world, kCount, 5);
    double seconds = 0;
    constexpr int kSteps = 20;
    for (int i = 0; i < kSteps; ++i) {
        const std::clock_t start = std::clock();
        world.step();
        seconds += static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        EXPECT_LE(world.profile().touching, 12u * kCount) << i;
    }
    EXPECT_GT(world.profile().dropped_contacts, 0u);
    EXPECT_LE(seconds / kSteps, 0.05);
}

// What is elsewhere in the world changes nothing.
TEST_P(CrowdOf, BesideLoneOnes) {
    constexpr int kCount = 60;
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    put_together(world, kCount, 5);
    const taut_shape ball = world.sphere(0.1);
    for (int i = 0; i < 1000; ++i) world.add({.shape = ball, .position = {10.0 + i, 0, 0}, .mass = 1});
    world.step();
    EXPECT_LE(world.profile().touching, 12u * kCount);
    EXPECT_GT(world.profile().dropped_contacts, 0u);
}

// Each has its turn: in the end all lie on the ground, none within another.
TEST_P(CrowdOf, PartsInTheEnd) {
    World world;
    world.add_ground();
    const std::vector<taut_body> bodies = put_together(world, 60, 4);
    world.step(600);
    EXPECT_EQ(world.profile().dropped_contacts, 0u);
    EXPECT_LE(world.profile().penetration, 0.02f);
    for (const taut_body body : bodies) {
        EXPECT_GT(position(body).y, 0.45);
        EXPECT_LT(norm(position(body)), 100);
    }
}

std::string name_of(const testing::TestParamInfo<Crowded>& tested) {
    constexpr const char* kNames[] = {"boxes", "balls", "boxes_by_a_heavy_one"};
    return kNames[static_cast<int>(tested.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, CrowdOf, testing::Values(Crowded::boxes, Crowded::balls, Crowded::boxes_by_a_heavy_one),
                         name_of);

// Hundreds of small balls about a large one, and cubes of a block: as many as have room touch each other.
TEST(Crowds, WhatHasRoomIsNone) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const taut_shape small = world.sphere(0.1), cube = world.box({0.25, 0.25, 0.25});
    world.add({.shape = world.sphere(1), .mass = 100});
    constexpr int kBalls = 300;
    for (int i = 0; i < kBalls; ++i) {
        const double z = 1 - (2 * i + 1.0) / kBalls, across = std::sqrt(1 - z * z), turn = 2.39996 * i;  // by Fibonacci
        world.add(
            {.shape = small, .position = 1.098 * Vec(across * std::cos(turn), across * std::sin(turn), z), .mass = 1});
    }
    for (int i = 0; i < 512; ++i)
        world.add({.shape = cube, .position = Vec(5, 0, 0) + 0.499 * Vec(i % 8, i / 8 % 8, i / 64), .mass = 1});
    for (int i = 0; i < 30; ++i) {
        world.step();
        ASSERT_EQ(world.profile().dropped_contacts, 0u) << i;
    }
    EXPECT_GT(world.profile().touching, 300u);
}

TEST(Crowds, GiveTheirMemoryBack) {
    World world;
    const taut_shape shape = world.sphere(0.5);
    const auto bytes = [&] {
        uint64_t out = 0;
        ok(taut_world_get_bytes(world.handle, &out));
        return out;
    };
    world.step(20);
    const uint64_t before = bytes();
    std::vector<taut_body> bodies;
    for (int i = 0; i < 400; ++i)
        bodies.push_back(world.add({.shape = shape, .position = {1e-3 * i, 5, 0}, .mass = 1}));
    world.step(30);
    const uint64_t most = bytes();
    for (const taut_body body : bodies) ok(taut_body_remove(body));
    world.step(1024);
    EXPECT_GT(most - before, 10'000'000u);
    EXPECT_LE(bytes() - before, (most - before) / 4);
}

}  // namespace
