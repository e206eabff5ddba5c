// A difference of one bit is named by step, stage and island.
#include "determinism/step_trace.h"

#include <cmath>
#include <sstream>

namespace taut {

void PrintTo(const StageEnd& end, std::ostream* out) { *out << determinism::name_of(end.stage) << ' ' << end.substep; }

}  // namespace taut

namespace {

using namespace determinism;
using taut::Stage;
using taut::StageEnd;

constexpr int kStacks = 3, kHigh = 3;

// Stacks far from each other, on a ground that is node 0.
scenes::Scene three_stacks() {
    scenes::Scene scene;
    taut_world_def_init(&scene.world);
    scenes::Shape plane, box;
    plane.kind = scenes::ShapeKind::plane;
    box.half_extents = {0.5f, 0.5f, 0.5f};
    scenes::Body body;
    body.kind = TAUT_BODY_STATIC;
    body.shape = scene.add_shape(plane);
    scene.add_body(body);
    body.kind = TAUT_BODY_DYNAMIC;
    body.shape = scene.add_shape(box);
    for (int stack = 0; stack < kStacks; ++stack)
        for (int i = 0; i < kHigh; ++i) {
            body.position = {10.0 * stack, 0.5 + i, 0};
            scene.add_body(body);
        }
    return scene;
}

// Turns the last bit of a node's velocity after one stage of one step.
class OneBit final : public taut::StageObserver {
public:
    OneBit(taut::StageObserver& next, int step, const StageEnd& when, uint32_t node)
        : next_(next), step_(step), when_(when), node_(node) {}

    void after(taut::World& world, const StageEnd& end) override {
        if (step_ == 0 && end.stage == when_.stage && end.substep == when_.substep) {
            double& v = world.nodes.motion[node_].v.x();
            v = std::nextafter(v, INFINITY);
        }
        if (end.stage == Stage::sleep) --step_;
        next_.after(world, end);
    }

private:
    taut::StageObserver& next_;
    int step_;
    StageEnd when_;
    uint32_t node_;
};

class OneBitAfter : public testing::TestWithParam<StageEnd> {};

TEST_P(OneBitAfter, IsNamedByStepStageAndIsland) {
    constexpr int kStep = 7;
    constexpr uint32_t kNode = 6, kIsland = 4;  // the top of the second stack, and its lowest
    const scenes::Scene scene = three_stacks();
    TracedScene one(scene);
    StepTrace trace;
    OneBit bit(trace, kStep, GetParam(), kNode);
    const TracedScene other(scene, &bit);
    for (int step = 0; step <= kStep; ++step) {
        one.step();
        trace.clear();
        lab::ok(taut_world_step(other.world.world));
        const auto found = StepTrace::first_difference(one.trace, trace);
        ASSERT_EQ(found.has_value(), step == kStep) << "step " << step;
        if (!found) continue;
        EXPECT_EQ(name_of(found->end.stage), std::string(name_of(GetParam().stage)));
        EXPECT_EQ(found->end.substep, GetParam().substep);
        EXPECT_EQ(found->island, kIsland);
    }
}

INSTANTIATE_TEST_SUITE_P(EveryStage, OneBitAfter,
                         testing::Values(StageEnd{Stage::bounds}, StageEnd{Stage::pairs}, StageEnd{Stage::contacts},
                                         StageEnd{Stage::partition}, StageEnd{Stage::predict, 0, 2},
                                         StageEnd{Stage::assemble, 0, 1}, StageEnd{Stage::solve, 0, 3},
                                         StageEnd{Stage::commit, 0, 2}, StageEnd{Stage::relax, 0, 3},
                                         StageEnd{Stage::publish}, StageEnd{Stage::sleep}),
                         [](const auto& tested) -> std::string { return name_of(tested.param.stage); });

TEST(Difference, ReadsAsAPlaceInTheStep) {
    std::ostringstream text;
    text << Difference{{Stage::solve, 1, 2}, 40} << "; " << Difference{{Stage::pairs}, 3};
    EXPECT_EQ(text.str(), "stage solve of substep 2, group 1, island of node 40; stage pairs, island of node 3");
}

}  // namespace
