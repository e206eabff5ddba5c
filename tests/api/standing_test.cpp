// What a world of many static bodies costs: to build, and each step that something moves among them.
#include <algorithm>
#include <chrono>
#include <ctime>
#include <numeric>
#include <random>
#include <vector>

#include "starts.h"
#include "support.h"

using namespace taut_test;

namespace {

constexpr double kApart = 10;  // [m]
constexpr int kFewSlabs = 12, kManySlabs = 150;

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Slabs side by side, in rows or in any order, and balls that lie on some of them.
class SlabField {
public:
    SlabField(int side, bool shuffled) : world_(make_world()), side_(side) {
        const taut_shape slab = add_box(world_, 4.9f);
        std::vector<int> order(static_cast<size_t>(side * side));
        std::iota(order.begin(), order.end(), 0);
        if (shuffled) std::shuffle(order.begin(), order.end(), std::mt19937(7));
        for (const int i : order)
            slabs_.push_back(add_body(world_, body_def(TAUT_BODY_STATIC, slab, at(i / side), -4.9, at(i % side))));
        const taut_shape ball = add_box(world_, 0.25f);
        for (int i = 0; i < 100; ++i)
            balls_.push_back(add_body(world_, body_def(TAUT_BODY_DYNAMIC, ball, at(i / 10) + 1, 0.4, at(i % 10) + 1)));
    }
    ~SlabField() { taut_world_destroy(world_); }

    double at(int i) const { return kApart * (i - 0.5 * side_); }
    taut_world world() const { return world_; }
    const std::vector<taut_body>& slabs() const { return slabs_; }
    // The shortest step of some; nothing sleeps, for somebody pushes.
    double step() {
        double least = 1;
        for (int i = 0; i < 60; ++i) {
            for (const taut_body body : balls_) EXPECT_OK(taut_body_apply_impulse(body, {0, 0.5f, 0}, {}));
            const double began = seconds_now();
            EXPECT_OK(taut_world_step(world_));
            least = std::min(least, seconds_now() - began);
        }
        return least;
    }

private:
    taut_world world_;
    int side_;
    std::vector<taut_body> slabs_, balls_;
};

// In time: the least of three worlds, for others share the machine.
double least_step(int side) {
    double least = 1;
    for (int run = 0; run < 3; ++run) least = std::min(least, SlabField(side, run == 1).step());
    return least;
}

// Of the processor, a body [s]: slabs that stand alone are taken away, with or without a crowd of boxes that lie side
// by side elsewhere. The least of three times.
double removing_slabs(bool crowd) {
    constexpr int kSide = 40, kSlabs = 400;
    double least = 1;
    for (int run = 0; run < 3; ++run) {
        const taut_world world = make_world();
        const taut_shape slab = add_box(world, 20), box = add_box(world, 0.25f);
        add_body(world, body_def(TAUT_BODY_STATIC, slab, 0, -20, 0));
        for (int i = 0; crowd && i < kSide * kSide; ++i)
            add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0.5 * (i / kSide) - 10, 0.25, 0.5 * (i % kSide) - 10));
        std::vector<taut_body> slabs;
        for (int i = 0; i < kSlabs; ++i)
            slabs.push_back(add_body(world, body_def(TAUT_BODY_STATIC, slab, 100 + 50.0 * i, 0, 0)));
        for (int i = 0; i < 3; ++i) EXPECT_OK(taut_world_step(world));
        timespec from{}, to{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
        for (const taut_body body : slabs) EXPECT_OK(taut_body_remove(body));
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
        const auto seconds =
            static_cast<double>(to.tv_sec - from.tv_sec) + 1e-9 * static_cast<double>(to.tv_nsec - from.tv_nsec);
        least = std::min(least, seconds / kSlabs);
        EXPECT_OK(taut_world_destroy(world));
    }
    return least;
}

}  // namespace

// Of 1600 boxes that touch, which each removal asked for pairs with what goes.
TEST(Standing, RemovingWhatStandsAloneAsksNoCrowd) {
    if (few_starts()) GTEST_SKIP() << "instrumented";
    EXPECT_LE(removing_slabs(true), 4 * removing_slabs(false));
}

// 22500 of them in place of 144: a step that went over all bodies took 25 times as long.
TEST(Standing, StaticBodiesCostAStepNothing) {
    if (few_starts()) GTEST_SKIP() << "instrumented";
    EXPECT_LE(least_step(kManySlabs), 3 * least_step(kFewSlabs));
}

// What a step does not go through any more follows all the same, if its host moves it or takes it away.
TEST(Standing, WhatIsMovedIsSeenByTheNextStep) {
    SlabField field(kFewSlabs, false);
    for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(field.world()));
    const taut_shape ball = add_box(field.world(), 0.25f);
    const taut_body above = add_body(field.world(), body_def(TAUT_BODY_DYNAMIC, ball, 500, 8, 0));
    taut_body slab = field.slabs()[5];
    ASSERT_OK(set_pose(slab, at(500, 0, 0)));
    for (int i = 0; i < 240; ++i) ASSERT_OK(taut_world_step(field.world()));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(above, &pose));
    EXPECT_NEAR(pose.position.y, 5.15, 0.01);
    ASSERT_OK(set_pose(slab, at(500, -2, 0)));
    for (int i = 0; i < 240; ++i) ASSERT_OK(taut_world_step(field.world()));
    ASSERT_OK(taut_body_get_pose(above, &pose));
    EXPECT_NEAR(pose.position.y, 3.15, 0.01);
    ASSERT_OK(taut_body_remove(slab));
    for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(field.world()));
    ASSERT_OK(taut_body_get_pose(above, &pose));
    EXPECT_LT(pose.position.y, -10);
}
