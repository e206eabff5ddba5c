// Grains poured on a rough bed: they come to rest in a heap whose slope rises with their friction.
#include <numbers>

#include "scenes/heap_slope.h"
#include "starts.h"

namespace {

using namespace lab;

// Mean slope of heaps of 1000 grains from three starts [degrees]. Random ones: poured exactly on its axis, a heap of
// grains that do not turn wears a needle on top.
double mean_slope(const char* friction) {
    const auto count = starts<uint64_t>(3);
    double sum = 0;
    for (uint64_t seed = 1; seed <= count; ++seed) {
        RunningScene run(scenes::make_scene(std::string("grains1000_r") + friction, {.seed = seed, .mesh = {}}));
        for (int i = 0; i < 420; ++i) run.step();
        EXPECT_TRUE(run.sound());
        EXPECT_LT(run.pile_speed(), 0.1) << "friction " << friction << ", seed " << seed;
        sum += slope_of(run) * 180 / std::numbers::pi;
    }
    return sum / static_cast<double>(count);
}

TEST(Grains, HeapAtAnAngleThatRisesWithFriction) {
    double before = 0;
    for (const char* friction : {"0.1", "0.3", "0.6"}) {
        const double slope = mean_slope(friction);
        std::printf("friction %s: slope %.1f degrees\n", friction, slope);
        EXPECT_GT(slope, before + 1) << "friction " << friction;
        before = slope;
    }
    EXPECT_GT(before, 20);
    EXPECT_LT(before, 45);
}

}  // namespace
