// Scenes of which the quick tests take few frames, for two seconds and from random starts.
#include <algorithm>
#include <iterator>

#include "scenes/running_scene.h"

namespace {

using namespace lab;

std::vector<scenes::Family> large_scenes() {
    std::vector<scenes::Family> large;
    std::copy_if(scenes::families().begin(), scenes::families().end(), std::back_inserter(large),
                 [](const scenes::Family& family) { return family.large; });
    return large;
}

class LargeScenes : public testing::TestWithParam<scenes::Family> {};

TEST_P(LargeScenes, StayFiniteForTwoSeconds) {
    for (uint64_t seed : {0, 1}) {
        RunningScene run(example_of(GetParam(), seed));
        for (int frame = 0; frame < 120; ++frame) {
            run.step();
            ASSERT_TRUE(run.sound()) << "frame " << frame << ", seed " << seed;
        }
        EXPECT_LT(run.joint_error(), 0.1) << "seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, LargeScenes, testing::ValuesIn(large_scenes()),
                         [](const auto& tested) -> std::string { return tested.param.example; });

TEST(GrainsThroughMesh, SmallOnesPassAndLargeOnesStay) {
    constexpr float kLarge = 0.08f;    // [m]
    constexpr double kBelowNet = 0.9;  // [m]
    RunningScene run("grains_through_mesh");
    for (uint32_t frame = 0; frame < 300; ++frame) run.step();
    int passed = 0;
    for (const int i : run.scene.roles.pile) {
        const auto body = static_cast<size_t>(i);
        const bool large = run.scene.shapes[static_cast<size_t>(run.scene.bodies[body].shape)].radius > kLarge;
        const bool below = run.body(body).position.y < kBelowNet;
        EXPECT_FALSE(large && below) << "grain " << i;
        passed += below;
    }
    EXPECT_GT(passed, 100);
    EXPECT_LT(run.joint_error(), 1e-3);
}

}  // namespace
