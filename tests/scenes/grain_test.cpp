// Grains poured on a rough bed: they come to rest in a heap whose slope rises with their friction.
#include "scenes/running_scene.h"

namespace {

using namespace lab;

// Slope of the heap's surface [rad]: a line through the highest grain of each ring about the axis, by least squares.
double slope_of(const RunningScene& run) {
    constexpr double kRing = 0.1;  // [m]
    std::vector<double> top;
    for (int i : run.scene.roles.pile) {
        const auto x = run.body(static_cast<size_t>(i)).position;
        const size_t ring = static_cast<size_t>(std::hypot(x.x, x.z) / kRing);
        if (ring >= top.size()) top.resize(ring + 1, 0);
        top[ring] = std::max(top[ring], x.y);
    }
    // From the peak, which is round, to where only single grains lie.
    double n = 0, sr = 0, sy = 0, srr = 0, sry = 0;
    for (size_t ring = 1; ring < top.size() && top[ring] > 0.12; ++ring) {
        const double r = (static_cast<double>(ring) + 0.5) * kRing;
        n += 1, sr += r, sy += top[ring], srr += r * r, sry += r * top[ring];
    }
    EXPECT_GE(n, 3) << "no heap";
    return std::atan(-(n * sry - sr * sy) / (n * srr - sr * sr));
}

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
