// Restorations from many frames of every scene, on 1, 2 and 5 threads.
#include <random>

#include "scenes/restored_scene.h"

namespace {

using namespace lab;

class RestoredScenes : public testing::TestWithParam<scenes::Family> {};

TEST_P(RestoredScenes, GoOnAsBeforeFromAnyFrame) {
    for (const uint32_t threads : {1u, 2u, 5u}) {
        scenes::Scene plan = example_of(GetParam());
        plan.world.threads = threads;
        plan.world.sleeping = threads == 2;
        RestoredScene run(std::move(plan));
        std::mt19937 random(threads);
        const int last = GetParam().large ? 0 : 5;
        for (int start = 0; start <= last; ++start) {
            for (auto frames = random() % 60; frames > 0; --frames) run.step();
            run.expect_to_go_on_as_before(start == last);
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, RestoredScenes, testing::ValuesIn(scenes::families()),
                         [](const auto& tested) -> std::string { return tested.param.example; });

}  // namespace
