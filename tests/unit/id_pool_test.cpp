// Generations: a handle to what is gone never comes back to life.
#include "base/id_pool.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <utility>
#include <vector>

namespace taut::test {
namespace {

struct PoolTest : testing::Test {
    Memory memory{taut_hooks{}};
    IdPool pool{memory};

    uint32_t create() {
        pool.reserve_one();
        return pool.create();
    }
};

using IdPoolTest = PoolTest;

TEST_F(IdPoolTest, CountsUpAndReusesTheSmallestFree) {
    EXPECT_EQ(create(), 0u);
    EXPECT_EQ(create(), 1u);
    EXPECT_EQ(create(), 2u);
    pool.destroy(0);
    pool.destroy(2);
    EXPECT_EQ(pool.count(), 1u);
    EXPECT_EQ(pool.slots(), 3u);
    EXPECT_EQ(create(), 0u);
    EXPECT_EQ(create(), 2u);
    EXPECT_EQ(create(), 3u);
    EXPECT_EQ(pool.count(), 4u);
}

TEST_F(IdPoolTest, GenerationsAreOddWhileLiveAndNeverRepeat) {
    std::mt19937 engine(1);
    std::set<std::pair<uint32_t, uint32_t>> ever;
    std::vector<uint32_t> live;
    for (int i = 0; i < 20000; ++i) {
        if (live.empty() || engine() % 2) {
            const uint32_t index = create();
            EXPECT_EQ(pool.generation(index) % 2, 1u);
            EXPECT_TRUE(ever.insert({index, pool.generation(index)}).second);
            live.push_back(index);
        } else {
            const size_t at = engine() % live.size();
            const uint32_t index = live[at], generation = pool.generation(index);
            pool.destroy(index);
            live.erase(live.begin() + static_cast<std::ptrdiff_t>(at));
            EXPECT_FALSE(pool.live(index));
            EXPECT_FALSE(pool.live(index, generation));
            EXPECT_FALSE(pool.live(index, generation + 1));  // even: free, not a generation to hold
        }
        ASSERT_EQ(pool.count(), live.size());
    }
    for (uint32_t index : live) EXPECT_TRUE(pool.live(index, pool.generation(index)));
}

TEST_F(IdPoolTest, KnowsNothingBeyondItsSlots) {
    EXPECT_FALSE(pool.live(0));
    EXPECT_FALSE(pool.live(UINT32_MAX, 1));
}

// 16 bits of generation in a handle: the slot is given up before they come round.
TEST_F(IdPoolTest, RetiresASlotWhoseGenerationsAreUsedUp) {
    std::set<uint32_t> seen;
    while (pool.slots() < 2) {
        const uint32_t index = create();
        if (index != 0) break;
        EXPECT_LE(pool.generation(0), IdPool::kMaxGeneration);
        EXPECT_TRUE(seen.insert(pool.generation(0) & 0xffff).second);
        ASSERT_LE(seen.size(), 40000u);
        pool.destroy(0);
    }
    EXPECT_GE(seen.size(), 32766u);
    EXPECT_FALSE(pool.live(0));
    EXPECT_TRUE(pool.live(1, 1));
    pool.destroy(1);
    EXPECT_EQ(create(), 1u);  // and is not reused
}

// create() and destroy() between reservations never allocate, so that they cannot fail half way.
TEST_F(IdPoolTest, CreatesAndDestroysWithoutAllocatingAfterAReservation) {
    for (int i = 0; i < 500; ++i) {
        pool.reserve_one();
        const uint64_t calls = memory.calls();
        const uint32_t index = pool.create();
        pool.destroy(index);
        const uint32_t again = pool.create();
        EXPECT_EQ(again, index);
        EXPECT_EQ(memory.calls(), calls);
    }
    const uint64_t calls = memory.calls();
    for (uint32_t index = 0; index < pool.slots(); ++index) pool.destroy(index);
    EXPECT_EQ(memory.calls(), calls);
    EXPECT_EQ(pool.count(), 0u);
}

}  // namespace
}  // namespace taut::test
