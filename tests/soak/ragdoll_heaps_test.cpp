// Heaps of a hundred ragdolls, from many starts.
#include "scenes/running_scene.h"

namespace {

using namespace lab;

// Largest joint gap of the eighth second.
double late_joint_error(uint64_t seed) {
    constexpr int kFrames = 480, kLate = 420;
    RunningScene run(scenes::make_scene("ragdolls100", {.seed = seed, .mesh = {}}));
    double most = 0;
    for (int i = 0; i < kFrames; ++i) {
        run.step();
        if (i >= kLate) most = std::max(most, run.joint_error());
    }
    EXPECT_TRUE(run.sound()) << "seed " << seed;
    return most;
}

// What is jammed opens its joints; nothing stays so, and hardly anything quivers.
TEST(RagdollHeaps, CloseTheirJointsFromAnyStart) {
    int wide = 0;
    double most = 0;
    for (uint64_t seed = 30; seed < 60; ++seed) {
        const double error = late_joint_error(seed);
        EXPECT_LT(error, 0.02) << "seed " << seed;
        wide += error > 0.004;
        most = std::max(most, error);
    }
    EXPECT_LE(wide, 3);
    RecordProperty("wide", wide);
    RecordProperty("joint_error_mm", std::to_string(1e3 * most));
}

}  // namespace
