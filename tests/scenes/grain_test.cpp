// Grains poured on a rough bed: they come to rest in a heap whose slope rises with their friction.
#include "scenes/heap_slope.h"

namespace {

using namespace lab;

TEST(Grains, HeapAtAnAngleThatRisesWithFriction) {
    double before = 0;
    for (const char* friction : {"0.1", "0.3", "0.6"}) {
        // A random start: poured exactly on its axis, a heap of grains that do not turn wears a needle on top.
        RunningScene run(scenes::make_scene(std::string("grains1000_r") + friction, {.seed = 1, .mesh = {}}));
        for (int i = 0; i < 420; ++i) run.step();
        ASSERT_TRUE(run.sound());
        const double slope = slope_of(run) * 180 / M_PI;
        std::printf("friction %s: slope %.1f degrees, fastest grain %.4f m/s\n", friction, slope, run.pile_speed());
        EXPECT_GT(slope, before + 1) << "friction " << friction;
        EXPECT_LT(run.pile_speed(), 0.1) << "friction " << friction;
        before = slope;
    }
    EXPECT_GT(before, 20);
    EXPECT_LT(before, 45);
}

}  // namespace
