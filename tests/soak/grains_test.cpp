// Thousands of grains poured on a rough bed.
#include "scenes/heap_slope.h"

namespace {

using namespace lab;

struct Heap {
    double slope = 0, height = 0, speed = 0;  // [degrees], mean of all [m], of the fastest grain there [m/s]
    uint64_t hash = 0;            // of the final state
};

// Of the grains' middles [m].
double mean_height(const RunningScene& run) {
    double sum = 0;
    for (int i : run.scene.roles.pile) sum += run.body(static_cast<size_t>(i)).position.y;
    return sum / static_cast<double>(run.scene.roles.pile.size());
}

// Single grains that the column throws far roll on over the ground for longer than the heap takes to come to rest.
double fastest_within(const RunningScene& run, double distance) {
    double most = 0;
    for (int i : run.scene.roles.pile) {
        const auto grain = run.body(static_cast<size_t>(i));
        if (std::hypot(grain.position.x, grain.position.z) < distance) most = std::max(most, norm(grain.velocity));
    }
    return most;
}

Heap pour(const char* friction, uint32_t threads) {
    scenes::Scene scene = scenes::make_scene(std::string("grains4000_r") + friction, {.seed = 1, .mesh = {}});
    scene.world.threads = threads;
    RunningScene run(std::move(scene));
    for (int i = 0; i < 900 && run.sound(); ++i) run.step();
    EXPECT_TRUE(run.sound());
    Heap heap{slope_of(run) * 180 / kPi, mean_height(run), fastest_within(run, 10), 0};
    EXPECT_EQ(taut_world_get_state_hash(run.world.world, &heap.hash), TAUT_OK);
    return heap;
}

// Poured as a column of 250 layers: those that hardly rub run flat, but for few, whose slope means little.
TEST(FourThousandGrains, HeapAtAnAngleThatRisesWithFrictionOnAnyThreads) {
    double before = 0, slope = 0;
    for (const char* friction : {"0.1", "0.3", "0.6"}) {
        const Heap heap = pour(friction, 1);
        std::printf("friction %s: slope %.1f degrees, mean height %.3f m, fastest grain %.4f m/s\n", friction, heap.slope,
                    heap.height, heap.speed);
        EXPECT_GT(heap.height, 1.5 * before) << "friction " << friction;
        EXPECT_LT(heap.speed, 0.1) << "friction " << friction;
        EXPECT_EQ(heap.hash, pour(friction, 2).hash) << "friction " << friction;
        before = heap.height;
        slope = heap.slope;
    }
    EXPECT_GT(slope, 20);
    EXPECT_LT(slope, 45);
}

}  // namespace
