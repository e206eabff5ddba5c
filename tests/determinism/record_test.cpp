// A scene's recording plays again on any number of threads, with the state of each step, and is the same file whatever
// threads it was recorded on.
#include "api/host/recording.h"
#include "determinism/step_trace.h"
#include "starts.h"

namespace {

using namespace lab;
using namespace determinism;
using taut_test::Recording;
using taut_test::Replay;

Recording record_scene(scenes::Scene scene, int steps, uint32_t threads) {
    scene.world.threads = threads;
    Recording out;
    const taut_record_def def = out.def();
    scenes::TautWorld world(scene, [&](taut_world created) { ok(taut_world_record(created, &def)); });
    for (int i = 0; i < steps; ++i) world.step();
    ok(taut_world_end_recording(world.world));
    return out;
}

class RecordedScene : public testing::TestWithParam<scenes::Family> {};

TEST_P(RecordedScene, ReplaysOnAnyThreads) {
    if (few_starts() && GetParam().large) GTEST_SKIP() << "takes long with sanitizers";
    const int steps = GetParam().large ? 2 : 12;
    const scenes::Scene scene = example_of(GetParam());
    const Recording recording = record_scene(scene, steps, 1);
    EXPECT_TRUE(record_scene(scene, steps, 2).bytes == recording.bytes) << "another file on two threads";
    for (const uint32_t threads : {1u, 2u, 5u}) {
        Replay replay(recording.bytes, threads);
        ASSERT_TRUE(replay.play().is_same())
            << replay.text() << ", threads " << threads << ": see " << recording.leave(GetParam().example);
        EXPECT_EQ(replay.state.whole, 1u);
        EXPECT_EQ(replay.state.frame, static_cast<uint64_t>(steps));
    }
}

INSTANTIATE_TEST_SUITE_P(Of, RecordedScene, testing::ValuesIn(scenes::families()),
                         [](const auto& tested) -> std::string { return tested.param.example; });

}  // namespace
