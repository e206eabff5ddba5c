// Ten minutes in which cloths, solids, cables and grains come and go, tear, are tied and pulled about: nothing becomes
// non-finite, no call fails, and memory comes back to its level.
#include <cstdio>

#include "soak/frame_time.h"
#include "soak/soft_ground.h"

namespace {

using namespace lab;
using soak::kBudget, soak::kTimed, soak::processor_ms;

struct SoftRecord {
    std::vector<double> ms;
    uint64_t cleared_bytes[2] = {}, most_bytes = 0;
    size_t escaped = 0;
};

void run_half(soak::SoftGround& ground, int frames, SoftRecord& record) {
    for (int frame = 0; frame < frames && !testing::Test::HasFailure(); ++frame) {
        if (frame % 6 == 0) ground.change();
        const double start = processor_ms();
        ok(taut_world_step(ground.handle()));
        record.ms.push_back(processor_ms() - start);
        ground.take_events();
        record.most_bytes = std::max(record.most_bytes, ground.live_bytes());
        if (frame % 60 != 59) continue;
        EXPECT_TRUE(ground.sound()) << "frame " << frame;
        record.escaped += ground.escaped();
    }
}

constexpr size_t kMany = 700, kFew = 300;  // nodes

// Twice the half of it from an empty floor; growth: of memory from one clearing to the next, in parts of it.
void soak_soft(uint64_t seed, int frames, double growth) {
    soak::SoftGround ground(seed, 1, kMany);
    SoftRecord record;
    for (uint64_t& bytes : record.cleared_bytes) {
        run_half(ground, frames / 2, record);
        ground.clear();
        ok(taut_world_step(ground.handle()));
        bytes = ground.live_bytes();
    }
    std::sort(record.ms.begin(), record.ms.end());
    const size_t n = record.ms.size();
    double mean = 0;
    for (const double ms : record.ms) mean += ms / static_cast<double>(n);
    const auto& tally = ground.tally;
    const auto over = record.ms.end() - std::upper_bound(record.ms.begin(), record.ms.end(), kBudget);
    const auto count = [](uint64_t number) { return static_cast<unsigned long long>(number); };
    std::printf(
        "soft ground: %zu frames, %llu cloths, %llu balloons, %llu solids, %llu cables, %llu times 27 grains, %llu "
        "boxes, %llu ties, %llu removed; step mean %.2f ms, median %.2f ms, p99 %.2f ms, worst %.2f ms, over %.2f ms: "
        "%td; memory %.2f MiB at most, cleared %.2f and %.2f MiB; %llu torn, %llu detached, %llu fell asleep, %llu "
        "quarantined, %zu below the floor\n",
        n, count(tally.cloths), count(tally.balloons), count(tally.solids), count(tally.cables), count(tally.grains),
        count(tally.boxes), count(tally.ties), count(tally.removed), mean, record.ms[n / 2], record.ms[n * 99 / 100],
        record.ms.back(), kBudget, over, static_cast<double>(record.most_bytes) / (1 << 20),
        static_cast<double>(record.cleared_bytes[0]) / (1 << 20),
        static_cast<double>(record.cleared_bytes[1]) / (1 << 20), count(tally.torn), count(tally.detached),
        count(tally.slept), count(tally.quarantined), record.escaped);
    EXPECT_EQ(tally.quarantined, 0u);
    EXPECT_EQ(record.escaped, 0u);
    EXPECT_LE(static_cast<double>(record.cleared_bytes[1]),
              (1 + growth) * static_cast<double>(record.cleared_bytes[0]));
    EXPECT_GT(tally.slept, 0u);
    if (n >= 6000) {
        EXPECT_GT(tally.torn, 0u);
        EXPECT_GT(tally.detached, 0u);
    }
    if (kTimed) {
        EXPECT_LT(mean, kBudget);
    }
}

TEST(SoftGroundShort, HoldsForFiveSeconds) { soak_soft(1, 300, 0.6); }
TEST(SoftGround, HoldsForTenMinutes) { soak_soft(1, 36000, 0.15); }
TEST(SoftGround, HoldsFromAnyStart) {
    for (uint64_t seed = 2; seed <= 6 && !HasFailure(); ++seed) soak_soft(seed, 6000, 0.3);
}

// All kinds together give the same bits on any team, and go on after a restoration as they did.
TEST(SoftGroundShort, GivesTheSameBitsOnAnyThreads) {
    soak::SoftGround one(7, 1, kFew), two(7, 2, kFew), five(7, 5, kFew);
    for (int frame = 0; frame < 60; ++frame) {
        for (soak::SoftGround* each : {&one, &two, &five}) {
            each->change();
            ok(taut_world_step(each->handle()));
        }
        ASSERT_EQ(two.hash(), one.hash()) << "frame " << frame;
        ASSERT_EQ(five.hash(), one.hash()) << "frame " << frame;
    }
}

TEST(SoftGroundShort, GoesOnAfterARestorationAsBefore) {
    soak::SoftGround ground(8, 1, kFew);
    for (int start = 0; start < 4; ++start) {
        for (int frame = 0; frame < 40; ++frame) {
            if (frame % 2 == 0) ground.change();
            ok(taut_world_step(ground.handle()));
        }
        uint64_t size = 0;
        ok(taut_world_snapshot_size(ground.handle(), &size));
        std::vector<std::byte> then(size);
        ok(taut_world_save(ground.handle(), then.data(), size, &size));
        std::vector<uint64_t> told[2];
        for (auto& once : told) {
            for (int frame = 0; frame < 20; ++frame) {
                ok(taut_world_step(ground.handle()));
                once.push_back(ground.hash());
            }
            ok(taut_world_restore(ground.handle(), then.data(), then.size()));
        }
        ASSERT_EQ(told[0], told[1]) << "start " << start;
    }
}

// Once nothing comes or goes, steps take no memory: after ten seconds for what still falls. Short: steady_test.cpp.
TEST(SoftGround, TakesNoMemoryOnceItIsWarm) {
    soak::SoftGround ground(9, 1, kMany);
    for (int frame = 0; frame < 60; ++frame) {
        ground.change();
        ok(taut_world_step(ground.handle()));
    }
    ok(taut_world_set_wind(ground.handle(), {0, 0, 0}));
    for (int frame = 0; frame < 1200; ++frame) ok(taut_world_step(ground.handle()));
    uint64_t taken = 0;
    for (int frame = 0; frame < 600; ++frame) {
        ok(taut_world_step(ground.handle()));
        taut_profile profile{};
        profile.struct_size = sizeof profile;
        ok(taut_world_get_profile(ground.handle(), &profile));
        taken += profile.allocations;
    }
    EXPECT_EQ(taken, 0u);
}

}  // namespace
