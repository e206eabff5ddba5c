// After its warm-up a steady scene takes no memory: neither from the world's hook nor from the C runtime.
#include <cstdlib>
#include <memory>

#include "aligned_memory.h"
#include "scenes/running_scene.h"
#include "soak/allocation_counter.h"

namespace {

using namespace lab;

TEST(AllocationCounterShort, SeesNewAndWhatTheLibraryTakes) {
    if (!soak::counts_allocations()) GTEST_SKIP() << "a sanitizer owns malloc";
    uint64_t before = soak::allocations();
    const auto probe = std::make_unique<volatile int>(1);
    EXPECT_EQ(soak::allocations() - before, 1u);
    before = soak::allocations();
    World world;
    world.add_ground();
    EXPECT_GT(soak::allocations(), before);
}

struct Steady {
    const char* name;
    const char* scene;  // null: the bin
    int warm_up;
    bool swept = false;  // of cloths and solids
};

void PrintTo(const Steady& s, std::ostream* out) { *out << s.name; }

// Cubes a little above one another in a walled bin, so that they are at rest within the warm-up.
scenes::Scene bin() {
    scenes::Scene scene;
    taut_world_def_init(&scene.world);
    auto box = [&](double x, double y, double z) {
        scenes::Shape shape;
        shape.half_extents = Vec(x, y, z).narrow();
        return scene.add_shape(shape);
    };
    auto still = [&](int shape, const Vec& at) {
        scenes::Body body;
        body.kind = TAUT_BODY_STATIC;
        body.shape = shape;
        body.position = at.pos();
        scene.add_body(body);
    };
    still(box(5, 0.5, 5), {0, -0.5, 0});
    const int along_x = box(0.1, 1.5, 1.6), along_z = box(1.6, 1.5, 0.1);
    for (double sign : {-1.0, 1.0}) {
        still(along_x, {sign * 1.5, 1.5, 0});
        still(along_z, {0, 1.5, sign * 1.5});
    }
    const int cube = box(0.25, 0.25, 0.25);
    for (int i = 0; i < 100; ++i) {
        scenes::Body body;
        body.shape = cube;
        const int column = i % 5, row = i / 5 % 5, layer = i / 25;
        body.position = {-1.04 + 0.52 * column, 0.26 + 0.51 * layer, -1.04 + 0.52 * row};
        scene.add_body(body);
    }
    return scene;
}

class SteadyShort : public testing::TestWithParam<Steady> {};

TEST_P(SteadyShort, TakesNoMemoryAfterWarmUp) {
    struct Hook {
        uint64_t taken = 0;
    } hook;
    scenes::Scene scene = GetParam().scene ? scenes::make_scene(GetParam().scene, {0, {}, GetParam().swept}) : bin();
    scene.world.hooks.allocate = [](size_t size, size_t alignment, void* self) -> void* {
        ++static_cast<Hook*>(self)->taken;
        return allocate_aligned(size, alignment);
    };
    scene.world.hooks.free = [](void* pointer, size_t, size_t, void*) { free_aligned(pointer); };
    scene.world.hooks.memory_user_data = &hook;
    const scenes::TautWorld world(scene);
    for (int i = 0; i < GetParam().warm_up; ++i) ok(taut_world_step(world.world));

    const uint64_t hooked = hook.taken, taken = soak::allocations();
    uint64_t reported = 0;
    for (int i = 0; i < 240; ++i) {
        ok(taut_world_step(world.world));
        reported += world.profile().allocations;
    }
    EXPECT_EQ(soak::allocations() - taken, 0u) << "calls of malloc and its kin";
    EXPECT_EQ(hook.taken - hooked, 0u) << "calls of the world's hook";
    EXPECT_EQ(reported, 0u) << "taut_profile.allocations";
    EXPECT_GT(hooked, 0u);
}

INSTANTIATE_TEST_SUITE_P(
    Scene, SteadyShort,
    testing::Values(Steady{"stack10", "stack10", 60}, Steady{"stack20", "stack20", 60},
                    Steady{"pyramid10", "pyramid10", 60}, Steady{"chain10_r1000", "chain10_r1000", 60},
                    Steady{"swing_r100", "swing_r100", 60}, Steady{"cable50_r1000", "cable50_r1000", 60},
                    Steady{"heavy_on_light_r10", "heavy_on_light_r10", 60}, Steady{"bin", nullptr, 60},
                    Steady{"cloth_hang12", "cloth_hang12", 60}, Steady{"cloth_hang12_swept", "cloth_hang12", 60, true},
                    Steady{"cloth_hang20_swept", "cloth_hang20", 60, true}, Steady{"solids1_e1e5", "solids1_e1e5", 120},
                    Steady{"solids2_swept", "solids2_e1e5", 120, true}, Steady{"knee", "knee", 120},
                    Steady{"grains_box300", "grains_box300", 240}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
