// Shapes that are built: ahead and in a world with the same bits, with memory of the host, by several threads, and
// soon.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <random>
#include <thread>
#include <vector>

#include "aligned_memory.h"
#include "starts.h"
#include "support.h"

using namespace taut_test;

namespace {

// Counts what any number of threads hold.
struct AtomicLedger {
    std::atomic<int64_t> bytes{0};
    std::atomic<int64_t> left{INT64_MAX};  // allocations before it runs out

    taut_allocator allocator() {
        return {[](size_t size, size_t alignment, void* self) -> void* {
                    auto& ledger = *static_cast<AtomicLedger*>(self);
                    if (ledger.left.fetch_sub(1) <= 0) return nullptr;
                    ledger.bytes += static_cast<int64_t>(size);
                    return allocate_aligned(size, alignment);
                },
                [](void* pointer, size_t size, size_t, void* self) {
                    static_cast<AtomicLedger*>(self)->bytes -= static_cast<int64_t>(size);
                    free_aligned(pointer);
                },
                this};
    }
};

// A hull, a mesh and a height field, with what their defs point to.
struct Plans {
    explicit Plans(uint32_t n = 33) : side(n) {
        std::mt19937 random(5);
        const auto number = [&] { return static_cast<float>(random() % 1000) * 1e-3f; };
        for (uint32_t i = 0; i < n * n; ++i) {
            heights.push_back(i % 5 ? 0 : 0.2f * number());
            corners.push_back({static_cast<float>(i % n), heights.back(), static_cast<float>(i / n)});
        }
        for (uint32_t row = 0; row + 1 < n; ++row)
            for (uint32_t column = 0; column + 1 < n; ++column) {
                const uint32_t a = row * n + column;
                for (const uint32_t i : {a, a + n, a + 1, a + 1, a + n, a + n + 1}) indices.push_back(i);
            }
        for (int i = 0; i < 40; ++i) points.push_back({number() - 0.5f, number() - 0.5f, number() - 0.5f});
        taut_hull_def_init(&hull);
        hull.points = points.data();
        hull.point_count = static_cast<uint32_t>(points.size());
        taut_mesh_def_init(&mesh);
        mesh.vertices = corners.data();
        mesh.vertex_count = n * n;
        mesh.indices = indices.data();
        mesh.triangle_count = static_cast<uint32_t>(indices.size() / 3);
        taut_height_field_def_init(&field);
        field.rows = field.columns = n;
        field.heights = heights.data();
    }

    uint32_t side;
    std::vector<float> heights;
    std::vector<taut_vec3> corners, points;
    std::vector<uint32_t> indices;
    taut_hull_def hull;
    taut_mesh_def mesh;
    taut_height_field_def field;
};

struct Built {
    taut_shape hull{0}, mesh{0}, field{0};
};
struct Bakes {
    taut_baked hull{0}, mesh{0}, field{0};
};

Bakes bake(const Plans& plans, const taut_allocator* allocator) {
    Bakes out;
    EXPECT_OK(taut_bake_hull(&plans.hull, allocator, &out.hull));
    EXPECT_OK(taut_bake_mesh(&plans.mesh, allocator, &out.mesh));
    EXPECT_OK(taut_bake_height_field(&plans.field, allocator, &out.field));
    return out;
}
void release(const Bakes& bakes) {
    for (const taut_baked baked : {bakes.hull, bakes.mesh, bakes.field}) EXPECT_OK(taut_baked_release(baked));
}

Built add_built(taut_world world, const Plans& plans) {
    Built out;
    EXPECT_OK(taut_world_add_hull(world, &plans.hull, &out.hull));
    EXPECT_OK(taut_world_add_mesh(world, &plans.mesh, &out.mesh));
    EXPECT_OK(taut_world_add_height_field(world, &plans.field, &out.field));
    return out;
}
Built add_baked(taut_world world, const Bakes& bakes) {
    Built out;
    EXPECT_OK(taut_world_add_baked(world, bakes.hull, &out.hull));
    EXPECT_OK(taut_world_add_baked(world, bakes.mesh, &out.mesh));
    EXPECT_OK(taut_world_add_baked(world, bakes.field, &out.field));
    return out;
}

// Hulls that fall on the mesh and on the height field beside it.
uint64_t play(taut_world world, const Built& shapes, int steps) {
    add_body(world, body_def(TAUT_BODY_STATIC, shapes.mesh, 0, 0, 0));
    add_body(world, body_def(TAUT_BODY_STATIC, shapes.field, 40, 0, 0));
    for (int i = 0; i < 12; ++i)
        add_body(world, body_def(TAUT_BODY_DYNAMIC, shapes.hull, (i % 2 ? 45.3 : 5.3) + i, 1 + 0.1 * i, 7.7));
    for (int i = 0; i < steps; ++i) EXPECT_OK(taut_world_step(world));
    return hash_of(world);
}

std::vector<float> triangles(taut_shape shape) {
    uint32_t count = 0;
    EXPECT_EQ(taut_shape_get_triangles(shape, nullptr, 0, &count), TAUT_TOO_SMALL);
    std::vector<taut_vec3> points(count);
    EXPECT_OK(taut_shape_get_triangles(shape, points.data(), count, &count));
    std::vector<float> out;
    for (const taut_vec3& p : points) out.insert(out.end(), {p.x, p.y, p.z});
    return out;
}

TEST(Baking, GivesTheBitsOfTheWorld) {
    const Plans plans;
    const Bakes bakes = bake(plans, nullptr);
    const taut_world one = make_world(), other = make_world();
    const Built built = add_built(one, plans), baked = add_baked(other, bakes);
    EXPECT_EQ(triangles(built.hull), triangles(baked.hull));
    EXPECT_EQ(triangles(built.mesh), triangles(baked.mesh));
    EXPECT_EQ(triangles(built.field), triangles(baked.field));
    EXPECT_EQ(play(one, built, 90), play(other, baked, 90));
    release(bakes);
    for (const taut_world world : {one, other}) ASSERT_OK(taut_world_destroy(world));
}

TEST(Baking, IsSharedByWorldsOfManyThreads) {
    AtomicLedger ledger;
    const taut_allocator allocator = ledger.allocator();
    const Plans plans;
    const Bakes bakes = bake(plans, &allocator);
    uint64_t bytes = 0, all = 0;
    for (const taut_baked baked : {bakes.hull, bakes.mesh, bakes.field}) {
        ASSERT_OK(taut_baked_get_bytes(baked, &bytes));
        all += bytes;
        EXPECT_EQ(taut_baked_is_valid(baked), 1);
    }
    EXPECT_EQ(static_cast<int64_t>(all), ledger.bytes);
    std::vector<uint64_t> hashes(8);
    std::vector<std::thread> threads;
    for (uint64_t& hash : hashes)
        threads.emplace_back([&] {
            for (int round = 0; round < 4; ++round) {
                const taut_world world = make_world();
                hash = play(world, add_baked(world, bakes), 10);
                EXPECT_OK(taut_world_destroy(world));
            }
        });
    for (std::thread& thread : threads) thread.join();
    for (const uint64_t hash : hashes) EXPECT_EQ(hash, hashes[0]);
    // What a world still has outlives the handle.
    const taut_world world = make_world();
    const Built shapes = add_baked(world, bakes);
    release(bakes);
    EXPECT_EQ(taut_baked_is_valid(bakes.mesh), 0);
    EXPECT_EQ(taut_baked_release(bakes.mesh), TAUT_STALE_HANDLE);
    EXPECT_GT(ledger.bytes, 0);
    EXPECT_EQ(play(world, shapes, 10), hashes[0]);
    ASSERT_OK(taut_world_destroy(world));
    EXPECT_EQ(ledger.bytes, 0);
}

TEST(Baking, MemoryComesFromTheHostAndIsCounted) {
    Ledger ledger;
    const taut_world world = make_world(ledger.hooks());
    const Plans plans(129);
    uint64_t before = 0, bytes = 0;
    ASSERT_OK(taut_world_get_bytes(world, &before));
    const Built shapes = add_built(world, plans);
    ASSERT_OK(taut_world_get_bytes(world, &bytes));
    EXPECT_EQ(bytes, ledger.bytes);
    EXPECT_GT(bytes - before, 2 * 128 * 128 * 60u);  // bytes of a mesh's triangle alone
    for (const taut_shape shape : {shapes.hull, shapes.mesh, shapes.field}) ASSERT_OK(taut_shape_remove(shape));
    ASSERT_OK(taut_world_get_bytes(world, &bytes));
    EXPECT_LT(bytes, before + 10000);
    ASSERT_OK(taut_world_destroy(world));
    EXPECT_TRUE(ledger.empty());
    EXPECT_EQ(ledger.errors, 0u);
}

TEST(Baking, ThatFailsLeavesNothing) {
    const Plans plans(9);
    AtomicLedger ledger;
    const taut_allocator allocator = ledger.allocator();
    int failures = 0;
    const auto often = [&](auto&& call) {
        for (int64_t most = 0;; ++most) {
            ledger.left = most;
            taut_baked out{7};
            const taut_result result = call(out);
            if (result == TAUT_OK) {
                EXPECT_OK(taut_baked_release(out));
                EXPECT_EQ(ledger.bytes, 0);
                return;
            }
            ++failures;
            ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
            ASSERT_EQ(out.bits, 7u);
            ASSERT_EQ(ledger.bytes, 0);
        }
    };
    often([&](taut_baked& out) { return taut_bake_hull(&plans.hull, &allocator, &out); });
    often([&](taut_baked& out) { return taut_bake_mesh(&plans.mesh, &allocator, &out); });
    often([&](taut_baked& out) { return taut_bake_height_field(&plans.field, &allocator, &out); });
    EXPECT_GT(failures, 30);
}

TEST(Baking, RefusesWhatIsWrong) {
    const Plans plans(9);
    taut_baked baked{0};
    taut_shape shape{0};
    EXPECT_EQ(taut_bake_mesh(nullptr, nullptr, &baked), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_bake_mesh(&plans.mesh, nullptr, nullptr), TAUT_NULL_POINTER);
    taut_mesh_def flat = plans.mesh;
    const std::vector<uint32_t> line(3, 0);
    flat.indices = line.data();
    flat.triangle_count = 1;
    EXPECT_EQ(taut_bake_mesh(&flat, nullptr, &baked), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "taut_bake_mesh: no triangle has an area")) << taut_last_error();
    flat.struct_size += 8;
    EXPECT_EQ(taut_bake_mesh(&flat, nullptr, &baked), TAUT_STRUCT_SIZE);
    taut_allocator half{};
    half.allocate = AtomicLedger().allocator().allocate;
    EXPECT_EQ(taut_bake_hull(&plans.hull, &half, &baked), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "allocate and free")) << taut_last_error();
    const taut_world world = make_world();
    EXPECT_EQ(taut_world_add_baked(world, {0}, &shape), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_world_add_baked(world, {99}, &shape), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_baked_is_valid({0}), 0);
    EXPECT_EQ(taut_baked_release({12345}), TAUT_STALE_HANDLE);
    uint64_t bytes = 0;
    EXPECT_EQ(taut_baked_get_bytes({0}, &bytes), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_baked_get_bytes({0}, nullptr), TAUT_NULL_POINTER);
    ASSERT_OK(taut_bake_hull(&plans.hull, nullptr, &baked));
    EXPECT_EQ(taut_world_add_baked({0}, baked, &shape), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_world_add_baked(world, baked, nullptr), TAUT_NULL_POINTER);
    ASSERT_OK(taut_baked_release(baked));
    EXPECT_EQ(taut_world_add_baked(world, baked, &shape), TAUT_STALE_HANDLE);
    ASSERT_OK(taut_world_destroy(world));
}

double seconds_of(const std::function<void()>& act) {
    timespec from, to;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &from);
    act();
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &to);
    return static_cast<double>(to.tv_sec - from.tv_sec) + 1e-9 * static_cast<double>(to.tv_nsec - from.tv_nsec);
}

// Of the processor, a quarter and an eighth of the largest that games have: a height field of 2049 x 2049 samples in a
// second, a mesh of two million triangles in two. Twice of that is allowed where others use the processor.
TEST(Baking, OfLargeSurfacesIsSoonDone) {
    if (few_starts()) GTEST_SKIP() << "instrumented";
    const Plans plans(513);
    Plans large(1025);
    taut_baked baked{0};
    for (const bool flat : {false, true}) {
        for (float& height : large.heights) height = flat ? 0 : static_cast<float>(std::rand() % 1000) * 1e-4f;
        EXPECT_LT(seconds_of([&] { ASSERT_OK(taut_bake_height_field(&large.field, nullptr, &baked)); }), 0.5) << flat;
        ASSERT_OK(taut_baked_release(baked));
    }
    EXPECT_LT(seconds_of([&] { ASSERT_OK(taut_bake_mesh(&plans.mesh, nullptr, &baked)); }), 1.0);
    ASSERT_OK(taut_baked_release(baked));
}

}  // namespace
