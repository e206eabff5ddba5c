// Half an hour in which things come and go and are asked for: nothing bursts, falls through, leaks or slows down.
#include <cstdio>
#include <thread>

#include "soak/allocation_counter.h"
#include "soak/frame_time.h"
#include "soak/playground.h"

namespace {

using namespace lab;
using soak::kBudget, soak::kTimed, soak::processor_ms;

struct Record {
    std::vector<double> ms;
    uint64_t warm_bytes = 0, end_bytes = 0, takes = 0;  // takes: steps that took memory from the world's allocator
    double joint_error = 0;                             // [m]
    size_t fallen = 0;
    uint64_t found_beside = 0;  // by queries of a second thread
};

void step(soak::Playground& ground, Record& record, bool warm) {
    const double start = processor_ms();
    ok(taut_world_step(ground.handle()));
    record.ms.push_back(processor_ms() - start);
    taut_profile profile{};
    profile.struct_size = sizeof profile;
    ok(taut_world_get_profile(ground.handle(), &profile));
    if (warm) record.takes += profile.allocations > 0;
    record.joint_error = std::max(record.joint_error, static_cast<double>(profile.joint_error));
    ground.take_events();
}

Record run(soak::Playground& ground, int frames) {
    Record record;
    const int warm_up = frames / 2;
    for (int frame = 0; frame < frames; ++frame) {
        if (frame % 3 == 0) ground.change();
        if (frame == warm_up) record.warm_bytes = ground.live_bytes();
        step(ground, record, frame >= warm_up);
        if (frame % 16 == 0) {
            std::thread beside([&] { record.found_beside += ground.search(static_cast<uint64_t>(frame)); });
            ground.queries();
            beside.join();
        } else {
            ground.queries();
        }
        if (frame % 60 == 59) {
            EXPECT_TRUE(ground.sound()) << "frame " << frame;
            record.fallen += ground.below_terrain();
        }
        if (testing::Test::HasFailure()) break;
    }
    record.end_bytes = ground.live_bytes();
    return record;
}

struct Bounds {
    double growth;       // of memory after the first half, in parts of it
    size_t fallen;       // below the ground, counted once a second
    double joint_error;  // [m]
    uint64_t takes;      // of memory in the second half, in steps: where the world grows to a new maximum
};

void soak_for(int frames, const Bounds& bounds) {
    soak::Playground ground(11);
    Record record = run(ground, frames);
    std::sort(record.ms.begin(), record.ms.end());
    const size_t n = record.ms.size();
    const double median = record.ms[n / 2], p99 = record.ms[n * 99 / 100], worst = record.ms.back();
    const auto& tally = ground.tally;
    std::printf(
        "playground: %zu frames, %zu bodies, %llu made, %llu removed, step median %.2f ms, p99 %.2f ms, worst %.2f ms, "
        "memory %.2f MiB after warm-up, %.2f MiB at the end, %llu steps that took memory after it, worst joint error "
        "%.1f mm, %zu times below the ground, %llu touches, %llu visits, fell asleep %llu times, queries found %llu "
        "and %llu beside\n",
        n, ground.population(), static_cast<unsigned long long>(tally.made),
        static_cast<unsigned long long>(tally.removed), median, p99, worst,
        static_cast<double>(record.warm_bytes) / (1 << 20), static_cast<double>(record.end_bytes) / (1 << 20),
        static_cast<unsigned long long>(record.takes), 1e3 * record.joint_error, record.fallen,
        static_cast<unsigned long long>(tally.begun), static_cast<unsigned long long>(tally.entered),
        static_cast<unsigned long long>(tally.slept), static_cast<unsigned long long>(tally.found),
        static_cast<unsigned long long>(record.found_beside));
    EXPECT_EQ(tally.quarantined, 0u);
    EXPECT_LE(record.fallen, bounds.fallen);
    EXPECT_LE(record.joint_error, bounds.joint_error);
    EXPECT_LE(static_cast<double>(record.end_bytes), (1 + bounds.growth) * static_cast<double>(record.warm_bytes));
    EXPECT_LE(record.takes, bounds.takes);
    EXPECT_GT(tally.found, 0u);
    EXPECT_GT(record.found_beside, 0u);
    EXPECT_GT(tally.entered, 0u);
    EXPECT_LE(tally.left, tally.entered);
    if (kTimed) {
        EXPECT_LT(p99, kBudget);
        EXPECT_LT(worst, std::max(kBudget, 20 * median));
    }
}

// One ragdoll each that falls onto the hills, its limbs against each other and the ground.
void drop_ragdoll(uint64_t seed) {
    SCOPED_TRACE(seed);
    soak::Playground ground(seed);
    ground.add_ragdoll();
    double spin = 0;
    for (int frame = 0; frame < 200; ++frame) {
        ok(taut_world_step(ground.handle()));
        ground.take_events();
        spin = std::max(spin, ground.spin());
    }
    EXPECT_LE(spin, 160);
    EXPECT_EQ(ground.below_terrain(), 0u);
    EXPECT_EQ(ground.tally.quarantined, 0u);
}

// The first eight burst before contacts of a mechanism counted as loops and its last rounds dropped what pulls.
TEST(FallingRagdollShort, DoesNotBurst) {
    for (uint64_t seed : {1550u, 2227u, 2588u, 2860u, 2866u, 3348u, 3560u, 208u}) drop_ragdoll(seed);
    for (uint64_t seed = 10001; seed <= 10040; ++seed) drop_ragdoll(seed);
}
TEST(FallingRagdoll, DoesNotBurst) {
    for (uint64_t seed = 20001; seed <= 23000; ++seed) drop_ragdoll(seed);
}

TEST(PlaygroundShort, HoldsForTenSeconds) { soak_for(600, {0.6, 0, 0.05, 80}); }  // more come until two thirds of it
// With some 1300 shots at 60 m/s into the terrain.
TEST(Playground, HoldsForHalfAnHour) { soak_for(108000, {0.15, 0, 0.05, 100}); }

}  // namespace
