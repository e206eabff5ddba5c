// A world inside a call refuses every other call on it: from its own callbacks and from other threads.
#include <atomic>
#include <thread>
#include <vector>

#include "aligned_memory.h"
#include "calls.h"

using namespace taut_test;

namespace {

// Runs every call of the interface on a world that is busy; all must be refused.
void expect_locked(const Populated& p) {
    const auto expect = [](const auto& calls, auto handle) {
        for (const auto& call : calls) {
            EXPECT_EQ(call.run(handle), TAUT_LOCKED) << call.name << ": " << taut_last_error();
            EXPECT_TRUE(contains(taut_last_error(), call.name)) << taut_last_error();
        }
    };
    expect(world_calls(p), p.world);
    expect(body_calls(), p.crate);
    expect(shape_calls(), p.hull);
    expect(collider_calls(p), p.collider);
    expect(joint_calls(), p.rod);
    EXPECT_TRUE(taut_world_is_valid(p.world));
    EXPECT_FALSE(taut_body_is_valid(p.crate));
    EXPECT_FALSE(taut_shape_is_valid(p.hull));
    EXPECT_FALSE(taut_joint_is_valid(p.rod));
}

// Adds bodies until one of them makes the world allocate, and steps: in all, calls the hook at least once.
void work(const Populated& p) {
    for (int i = 0; i < 40; ++i) {
        const taut_body_def def = body_def(TAUT_BODY_DYNAMIC, p.box, 0.4 * i, 10, 0);
        taut_body body;
        ASSERT_OK(taut_world_add_body(p.world, &def, &body));
    }
    ASSERT_OK(taut_world_step(p.world));
}

TEST(Lock, RefusesCallbacks) {
    Ledger ledger;
    {
        Populated p(ledger.hooks());
        int entered = 0;
        ledger.on_allocate = [&] {
            ++entered;
            expect_locked(p);
            // Another world is free.
            Populated other;
            EXPECT_OK(taut_world_step(other.world));
        };
        work(p);
        EXPECT_GT(entered, 1);
        ledger.on_allocate = nullptr;
        EXPECT_OK(taut_world_step(p.world));
        EXPECT_TRUE(taut_body_is_valid(p.crate));
    }
    EXPECT_TRUE(ledger.empty());
    EXPECT_EQ(ledger.errors, 0u);
}

TEST(Lock, IsHeldDuringTheStep) {
    Ledger ledger;
    Populated p(ledger.hooks());
    for (int i = 0; i < 40; ++i) add_body(p.world, body_def(TAUT_BODY_DYNAMIC, p.box, 0.4 * i, 0.5, 0));
    int entered = 0;
    ledger.on_allocate = [&] {
        ++entered;
        expect_locked(p);
    };
    ASSERT_OK(taut_world_step(p.world));
    EXPECT_GT(entered, 0);
}

TEST(Lock, RefusesASecondThread) {
    Ledger ledger;
    Populated p(ledger.hooks());
    ledger.on_allocate = [&] { std::thread([&] { expect_locked(p); }).join(); };
    work(p);
    ledger.on_allocate = nullptr;
    EXPECT_OK(taut_world_step(p.world));
}

TEST(Lock, DestructionIsNotReentered) {
    static taut_world world;
    static int refused;
    refused = 0;
    taut_hooks hooks = {};
    hooks.allocate = [](size_t size, size_t alignment, void*) { return allocate_aligned(size, alignment); };
    hooks.free = [](void* pointer, size_t, size_t, void*) {
        refused += taut_world_destroy(world) == TAUT_STALE_HANDLE && taut_world_step(world) == TAUT_STALE_HANDLE;
        free_aligned(pointer);
    };
    world = make_world(hooks);
    add_particle(world, 0, 0, 0);
    refused = 0;
    EXPECT_OK(taut_world_destroy(world));
    EXPECT_GT(refused, 0);
}

// Readers do not exclude each other: event.h promises them to any number of threads between steps.
TEST(Lock, ReadersShare) {
    Populated p;
    std::vector<std::thread> threads;
    std::atomic<int> refused{0};
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 2000; ++k) {
                taut_events events;
                taut_pose pose;
                if (taut_world_get_events(p.world, &events) != TAUT_OK) ++refused;
                if (taut_body_get_pose(p.crate, &pose) != TAUT_OK) ++refused;
                if (!taut_body_is_valid(p.crate)) ++refused;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(refused, 0);
    EXPECT_OK(taut_world_step(p.world));
}

// Worlds of many threads come and go while others hold on to their old handles.
TEST(Lock, WorldsComeAndGoOnManyThreads) {
    std::atomic<uint64_t> shared{0};
    std::atomic<int> wrong{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 3; ++i) {
        threads.emplace_back([&] {
            for (int k = 0; k < 300; ++k) {
                taut_world_def def;
                taut_world_def_init(&def);
                taut_world world = {0};
                if (taut_world_create(&def, &world) != TAUT_OK) ++wrong;
                const taut_body body = add_particle(world, 0, 1, 0);
                const taut_body old = {shared.exchange(body.bits)};
                taut_pose pose;
                const taut_result read = taut_body_get_pose(old, &pose);  // another thread's, at any time of its life
                if (read != TAUT_OK && read != TAUT_STALE_HANDLE && read != TAUT_LOCKED) ++wrong;
                const taut_result stepped = taut_world_step(world);
                if (stepped != TAUT_OK && stepped != TAUT_LOCKED) ++wrong;
                taut_result destroyed = TAUT_LOCKED;
                while (destroyed == TAUT_LOCKED) destroyed = taut_world_destroy(world);
                if (destroyed != TAUT_OK) ++wrong;
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(wrong, 0);
}

}  // namespace
