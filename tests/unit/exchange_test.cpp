// What leaves a sorted list and what comes into it.
#include "base/exchange.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace taut::test {
namespace {

// Bears its key and what it was made with.
struct Record {
    uint64_t key = 0;
    uint64_t made = 0;
};

// A random part of [0, most), sorted.
std::vector<uint64_t> some_of(std::mt19937& engine, uint64_t most, double part) {
    std::vector<uint64_t> keys;
    for (uint64_t key = 0; key < most; ++key)
        if (std::uniform_real_distribution<>(0, 1)(engine) < part) keys.push_back(key);
    return keys;
}

template <class List>
void exchange(List& list, const std::vector<uint64_t>& gone, const std::vector<uint64_t>& fresh, uint64_t round) {
    Exchange(
        list, {gone, fresh}, [](const Record& record) { return record.key; },
        [&](uint64_t key) {
            return Record{key, round};
        })
        .run();
}

// Rounds in which some of the list goes and some of the rest comes; what stays must be what it was.
template <class List>
void stays_like_a_set(List& list, uint32_t seed) {
    constexpr uint64_t kMost = 400;
    std::mt19937 engine(seed);
    std::vector<uint64_t> made(kMost, UINT64_MAX);  // the round in which a key came; none: it is not there
    const auto share = [&] { return std::pow(10.0, std::uniform_real_distribution<>(-2.5, 0)(engine)); };
    for (uint64_t round = 0; round < 60; ++round) {
        std::vector<uint64_t> gone = some_of(engine, kMost, share()), fresh = some_of(engine, kMost, share());
        std::erase_if(gone, [&](uint64_t key) { return made[key] == UINT64_MAX; });
        std::erase_if(fresh, [&](uint64_t key) { return made[key] != UINT64_MAX; });
        exchange(list, gone, fresh, round);
        for (const uint64_t key : gone) made[key] = UINT64_MAX;
        for (const uint64_t key : fresh) made[key] = round;
        size_t index = 0;
        for (uint64_t key = 0; key < kMost; ++key) {
            if (made[key] == UINT64_MAX) continue;
            ASSERT_LT(index, list.size());
            ASSERT_EQ(list[index].key, key) << "round " << round;
            ASSERT_EQ(list[index].made, made[key]) << "round " << round;
            ++index;
        }
        ASSERT_EQ(index, list.size()) << "round " << round;
    }
}

class Exchanges : public testing::TestWithParam<uint32_t> {
protected:
    Memory memory_{taut_hooks{}};
};
INSTANTIATE_TEST_SUITE_P(Seeds, Exchanges, testing::Range(0u, 20u));

TEST_P(Exchanges, LeaveASegmentedListSorted) {
    SegmentedArray<Record> list(memory_);
    stays_like_a_set(list, GetParam());
}

TEST_P(Exchanges, LeaveAnArraySorted) {
    Array<Record> list(memory_);
    stays_like_a_set(list, GetParam());
}

TEST(Exchange, NeedsNoMemoryWhereTheListDoesNotGrow) {
    Memory memory{taut_hooks{}};
    SegmentedArray<Record> list(memory);
    std::vector<uint64_t> all(1000);
    for (size_t i = 0; i < all.size(); ++i) all[i] = 2 * i;
    exchange(list, {}, all, 0);
    const std::vector<uint64_t> gone(all.begin(), all.begin() + 500);
    std::vector<uint64_t> fresh(500);
    for (size_t i = 0; i < fresh.size(); ++i) fresh[i] = 2 * i + 1001;
    const uint64_t calls = memory.calls();
    exchange(list, gone, fresh, 1);
    EXPECT_EQ(memory.calls(), calls);
    EXPECT_EQ(list.size(), 1000u);
    EXPECT_TRUE(std::ranges::is_sorted(list, {}, &Record::key));
}

}  // namespace
}  // namespace taut::test
