// Hashes after 120 steps, which every build must reproduce (compiler, optimisation, machine). A change of the physics
// changes them: golden_hashes.inc then takes the lines that this test prints.
#include <cinttypes>
#include <cstdio>

#include "scenes/running_scene.h"

namespace {

using namespace lab;

struct Golden {
    const char* scene;
    uint64_t hash;
};

constexpr Golden kGolden[] = {
#include "determinism/golden_hashes.inc"
};

TEST(Golden, HashesAfter120Steps) {
    for (const Golden& golden : kGolden) {
        RunningScene run(golden.scene);
        for (int i = 0; i < 120; ++i) run.step();
        uint64_t hash = 0;
        ok(taut_world_get_state_hash(run.world.world, &hash));
        std::printf("{\"%s\", 0x%016" PRIx64 "},\n", golden.scene, hash);
        EXPECT_EQ(hash, golden.hash) << golden.scene;
    }
}

}  // namespace
