// The same scene gives the same bits: twice in a row, between other worlds, and on another thread.
#include <memory>
#include <thread>

#include "determinism/step_trace.h"
#include "starts.h"

namespace {

using namespace lab;
using namespace determinism;

uint64_t hash_of(const RunningScene& run) {
    uint64_t hash = 0;
    ok(taut_world_get_state_hash(run.world.world, &hash));
    return hash;
}

std::vector<uint64_t> hashes(const scenes::Scene& scene, int steps) {
    RunningScene run(scene);
    std::vector<uint64_t> out;
    for (int i = 0; i < steps; ++i) {
        run.step();
        out.push_back(hash_of(run));
    }
    return out;
}

class SameBits : public testing::TestWithParam<scenes::Family> {};

TEST_P(SameBits, InEveryStepOfTwoRuns) {
    const int steps = GetParam().large ? 3 : 60;
    const scenes::Scene scene = example_of(GetParam());
    const auto first = hashes(scene, steps), second = hashes(scene, steps);
    for (size_t i = 0; i < first.size(); ++i) ASSERT_EQ(first[i], second[i]) << "step " << i;
    EXPECT_NE(first.front(), first.back()) << "the hash does not see the motion";
}

INSTANTIATE_TEST_SUITE_P(Of, SameBits, testing::ValuesIn(scenes::families()),
                         [](const auto& tested) -> std::string { return tested.param.example; });

const char* const kMixed[] = {"pyramid10", "wrecking_ball", "chain10_r1000", "heavy_on_light_r100"};

TEST(SameBits, InInterleavedWorlds) {
    constexpr int kSteps = 120;
    std::vector<std::vector<uint64_t>> alone;
    std::vector<std::unique_ptr<RunningScene>> together;
    for (const char* name : kMixed) {
        alone.push_back(hashes(scenes::make_scene(name), kSteps));
        together.push_back(std::make_unique<RunningScene>(name));
    }
    for (size_t step = 0; step < kSteps; ++step)
        for (size_t w = 0; w < together.size(); ++w) {
            together[w]->step();
            ASSERT_EQ(hash_of(*together[w]), alone[w][step]) << kMixed[w] << ", step " << step;
        }
}

TEST(SameBits, OnThreadsAtOnce) {
    constexpr int kSteps = 120;
    std::vector<std::vector<uint64_t>> found(std::size(kMixed));
    std::vector<std::thread> threads;
    for (size_t w = 0; w < found.size(); ++w)
        threads.emplace_back([&, w] { found[w] = hashes(scenes::make_scene(kMixed[w]), kSteps); });
    for (std::thread& thread : threads) thread.join();
    for (size_t w = 0; w < found.size(); ++w)
        EXPECT_EQ(found[w], hashes(scenes::make_scene(kMixed[w]), kSteps)) << kMixed[w];
}

// Large enough for every parallel loop: sweeps by colour, blocks side by side, narrowphase.
struct OnTeams {
    const char* scene;
    bool swept = false;  // of cloths and solids
};
void PrintTo(const OnTeams& tested, std::ostream* out) { *out << tested.scene << (tested.swept ? "_swept" : ""); }

class SameBitsOnTeams : public testing::TestWithParam<OnTeams> {};

TEST_P(SameBitsOnTeams, OfAnySize) {
    const int steps = few_starts() ? 10 : 40;
    scenes::Scene scene = scenes::make_scene(GetParam().scene, {0, {}, GetParam().swept});
    TracedScene alone(scene);
    std::vector<std::unique_ptr<TracedScene>> teams;
    for (uint32_t threads : {2u, 3u, 5u, 8u}) {
        scene.world.threads = threads;
        teams.push_back(std::make_unique<TracedScene>(scene));
    }
    for (int step = 0; step < steps; ++step) {
        alone.step();
        const uint64_t hash = alone.hash();
        for (const auto& team : teams) {
            team->step();
            const auto difference = StepTrace::first_difference(alone.trace, team->trace);
            ASSERT_FALSE(difference) << team->scene.world.threads << " threads differ first in step " << step << ", "
                                     << *difference;
            ASSERT_EQ(team->hash(), hash) << team->scene.world.threads << " threads, step " << step;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, SameBitsOnTeams,
                         testing::Values(OnTeams{"boxes2000"}, OnTeams{"pyramid30"}, OnTeams{"wrecking_ball"},
                                         OnTeams{"bridge"}, OnTeams{"ragdolls20"}, OnTeams{"grains1000_r1"},
                                         OnTeams{"terrain"}, OnTeams{"net47"}, OnTeams{"cloth_hang20"},
                                         OnTeams{"solids3_e1e5"}, OnTeams{"cloth_hang40", true},
                                         OnTeams{"solids3_e1e5", true}, OnTeams{"knee"}, OnTeams{"grains_box1000"},
                                         OnTeams{"meshless1_e1e5"}, OnTeams{"quads"}, OnTeams{"plastic_bar7"},
                                         OnTeams{"cloth_fold", true}),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Soak, SameBitsOnTeams, testing::Values(OnTeams{"meshless3_e1e5"}, OnTeams{"plastic_bar"}),
                         testing::PrintToStringParamName());

// Islands fall asleep, and a brick that is kicked wakes its own.
TEST(SleepOnTeams, GivesTheSameBits) {
    scenes::Scene scene = scenes::make_scene("pyramid30");
    scene.world.sleeping = 1;
    scene.world.sleep_time = 0.1f;
    const auto hashes_with = [&](uint32_t threads) {
        scene.world.threads = threads;
        RunningScene run(scene);
        std::vector<uint64_t> out;
        bool slept = false;
        for (int step = 0, kicked = 0; step < 400 && kicked < 40; ++step) {
            run.step();
            out.push_back(hash_of(run));
            slept = slept || run.world.profile().awake == 0;
            if (slept && kicked++ == 0) ok(taut_body_apply_impulse(run.world.bodies.back(), {0, 0, 500}, {}));
        }
        EXPECT_TRUE(slept);
        return out;
    };
    const auto alone = hashes_with(1);
    for (uint32_t threads : {2u, 3u, 5u, 8u}) EXPECT_EQ(hashes_with(threads), alone) << threads << " threads";
}

// A difference of one part in 2^24 in one velocity must show, at once and after a while.
TEST(StateHash, SeesTheLeastDifference) {
    scenes::Scene scene = scenes::make_scene("stack10");
    const auto before = hashes(scene, 30);
    scene.bodies.back().linear_velocity.x = 1e-7f;
    const auto after = hashes(scene, 30);
    EXPECT_NE(before.front(), after.front());
    EXPECT_NE(before.back(), after.back());
}

}  // namespace
