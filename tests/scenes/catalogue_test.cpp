// Every scene of the catalogue runs, from its own start and from a random one.
#include <regex>

#include "scenes/running_scene.h"

namespace {

using namespace lab;

class EveryScene : public testing::TestWithParam<scenes::Family> {};

// Large ones for a few frames; the rest of their second is in LargeScenes.
TEST_P(EveryScene, StaysFiniteForASecond) {
    const int frames = GetParam().large ? 3 : 60;
    for (uint64_t seed : {0, 1}) {
        RunningScene run(example_of(GetParam(), seed));
        for (int frame = 0; frame < frames; ++frame) {
            run.step();
            ASSERT_TRUE(run.sound()) << "frame " << frame << ", seed " << seed;
        }
        EXPECT_LT(run.joint_error(), 0.1) << "seed " << seed;
    }
}

// A picture says "7 cubes", not "N cubes".
TEST_P(EveryScene, TellsItsOwnNumbers) {
    const std::string text = example_of(GetParam()).description;
    EXPECT_FALSE(std::regex_search(text, std::regex("\\b[NR]\\b"))) << text;
}

TEST(Descriptions, TellTheNumbersOfTheName) {
    EXPECT_EQ(scenes::make_scene("stack7").description, "7 cubes exactly on each other");
    EXPECT_EQ(scenes::make_scene("chain10_r1e5").description, "10 1 kg links and 100000 kg, released from horizontal");
}

// The curve of energy that taut-demo draws: a swing turns height into motion and back, 13 % of it.
TEST(SceneEnergy, OfASwingStays) {
    RunningScene run("swing_r100");
    const double start = run.world.energy();
    for (int frame = 0; frame < 120; ++frame) {
        run.step();
        ASSERT_NEAR(run.world.energy() / start, 1, 0.005) << "frame " << frame;
    }
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryScene, testing::ValuesIn(scenes::families()),
                         [](const auto& tested) -> std::string { return tested.param.example; });

class BallIntoWall : public testing::TestWithParam<std::string> {};

// The ball arrives, knocks bricks about, and nothing bursts; joints give way by millimetres at most.
TEST_P(BallIntoWall, KnocksBricksAboutAndHoldsTogether) {
    RunningScene run(GetParam());
    double error = 0;
    for (uint32_t frame = 0; frame < 480; ++frame) {
        run.step();
        ASSERT_TRUE(run.sound()) << "frame " << frame;
        error = std::max(error, run.joint_error());
        for (int i : run.scene.roles.pile) {
            ASSERT_GT(run.body(static_cast<size_t>(i)).position.y, -0.1) << "brick through the ground, frame " << frame;
        }
    }
    EXPECT_GT(run.pile_shift(), 1) << "no brick was hit";
    EXPECT_LT(error, 0.005);
    RecordProperty("joint_error_mm", std::to_string(1e3 * error));
}

INSTANTIATE_TEST_SUITE_P(Scene, BallIntoWall, testing::Values<std::string>("wrecking_ball", "main"),
                         [](const auto& tested) { return tested.param; });

}  // namespace
