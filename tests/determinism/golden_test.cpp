// Hashes after 120 steps, which every build must reproduce (compiler, optimisation, machine), with any number of
// workers and lanes of any width. A change of the physics changes them: golden_hashes.inc then takes the lines that
// this test prints.
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <iterator>
#include <string_view>

#include "scenes/running_scene.h"
#include "simd/width.h"
#include "widths.h"

namespace {

using namespace lab;
using taut::Width;

struct Golden {
    const char* scene;
    uint64_t hash;
    uint64_t seed;  // of a violent start, or 0
};

constexpr Golden kGolden[] = {
#include "determinism/golden_hashes.inc"
};

void PrintTo(const Golden& golden, std::ostream* out) { *out << golden.scene; }

uint64_t hash_of(const Golden& golden, uint32_t threads) {
    scenes::Options options;
    options.seed = golden.seed;
    scenes::Scene plan = scenes::make_scene(golden.scene, options);
    plan.world.threads = threads;
    RunningScene run(std::move(plan));
    for (int i = 0; i < 120; ++i) run.step();
    uint64_t hash = 0;
    ok(taut_world_get_state_hash(run.world.world, &hash));
    return hash;
}

TEST(Golden, HashesAfter120Steps) {
    for (const Golden& golden : kGolden) {
        const uint64_t hash = hash_of(golden, 1);
        std::printf("{\"%s\", 0x%016" PRIx64 ", %" PRIu64 "},\n", golden.scene, hash, golden.seed);
        EXPECT_EQ(hash, golden.hash) << golden.scene;
    }
}

class GoldenMatrix : public testing::TestWithParam<Golden> {
protected:
    void TearDown() override { taut::set_kernel_width(taut::widest()); }
};

TEST_P(GoldenMatrix, HoldsWithAnyWorkersAndLanes) {
    for (const Width width : taut::widths_here()) {
        taut::set_kernel_width(width);
        for (const uint32_t threads : {1u, 2u, 3u, 5u, 8u})
            EXPECT_EQ(hash_of(GetParam(), threads), GetParam().hash)
                << threads << " threads, width " << static_cast<int>(width);
    }
}

// Those with more than a thousand contacts or elements take longer than the others together.
constexpr std::string_view kLarge[] = {"pyramid40", "solids1_e1e5"};
std::vector<Golden> golden(bool large) {
    std::vector<Golden> some;
    std::copy_if(std::begin(kGolden), std::end(kGolden), std::back_inserter(some), [=](const Golden& each) {
        return (std::find(std::begin(kLarge), std::end(kLarge), each.scene) != std::end(kLarge)) == large;
    });
    return some;
}
INSTANTIATE_TEST_SUITE_P(Of, GoldenMatrix, testing::ValuesIn(golden(false)),
                         [](const auto& tested) -> std::string { return tested.param.scene; });
INSTANTIATE_TEST_SUITE_P(Soak, GoldenMatrix, testing::ValuesIn(golden(true)),
                         [](const auto& tested) -> std::string { return tested.param.scene; });

// Fused sweeps of cloths and solids, which none of the golden scenes has, and grains.
class SweptMatrix : public testing::TestWithParam<const char*> {
protected:
    void TearDown() override { taut::set_kernel_width(taut::widest()); }
    static uint64_t hash_with(uint32_t threads) {
        const bool triangles = std::string(GetParam()) == "triangles";
        scenes::Scene plan = scenes::make_scene(triangles ? "cloth_hang20" : GetParam(), {0, {}, true});
        if (triangles) plan.cloths.front().def.kind = TAUT_CLOTH_TRIANGLES;
        plan.world.threads = threads;
        RunningScene run(std::move(plan));
        for (int i = 0; i < 40; ++i) run.step();
        uint64_t hash = 0;
        ok(taut_world_get_state_hash(run.world.world, &hash));
        return hash;
    }
};

TEST_P(SweptMatrix, HoldsWithAnyWorkersAndLanes) {
    taut::set_kernel_width(Width::scalar);
    const uint64_t expected = hash_with(1);
    for (const Width width : taut::widths_here()) {
        taut::set_kernel_width(width);
        for (const uint32_t threads : {1u, 2u, 5u})
            EXPECT_EQ(hash_with(threads), expected) << threads << " threads, width " << static_cast<int>(width);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, SweptMatrix, testing::Values("cloth_hang20", "triangles", "solids2_e1e5", "grains300_r1"),
                         [](const auto& tested) { return std::string(tested.param); });

}  // namespace
