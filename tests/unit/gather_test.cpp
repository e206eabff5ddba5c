// Lists made side by side are those that one thread makes, and each index is asked once.
#include "threads/gather.h"

#include <gtest/gtest.h>

#include <atomic>

namespace {

using taut::Array;
using taut::Memory;
using taut::Team;

constexpr uint32_t kCounts[] = {0, 1, 63, 64, 65, 1000, 4096, 4097, 20011};

bool is_picked(uint32_t i) { return (i * 2654435761u >> 28) < 5; }

template <class Act>
void with_teams(Act&& act) {
    for (const uint32_t threads : {1u, 2u, 3u, 5u, 8u}) {
        Team team({}, threads);
        for (const uint32_t count : kCounts) {
            SCOPED_TRACE(testing::Message() << threads << " threads, " << count);
            act(team, count);
            team.rest();
        }
    }
}

TEST(Gather, PicksInOrder) {
    Memory memory(taut_hooks{});
    Array<uint32_t> picked(memory);
    with_teams([&](Team& team, uint32_t count) {
        std::vector<std::atomic<int>> asked(count);
        taut::gather(team, count, picked, [&](uint32_t i) {
            ++asked[i];
            return is_picked(i);
        });
        size_t next = 0;
        for (uint32_t i = 0; i < count; ++i) {
            EXPECT_EQ(asked[i], 1);
            if (!is_picked(i)) continue;
            ASSERT_LT(next, picked.size());
            EXPECT_EQ(picked[next++], i);
        }
        EXPECT_EQ(next, picked.size());
    });
}

TEST(Gather, WritesListsOfManyLengths) {
    Memory memory(taut_hooks{});
    Array<uint64_t> list(memory);
    const auto length_of = [](uint32_t i) { return i % 7 == 0 ? 3u : i % 2; };
    with_teams([&](Team& team, uint32_t count) {
        taut::write_list(team, count, list, length_of, [&](uint32_t i, uint64_t* to) {
            for (uint32_t k = 0; k < length_of(i); ++k) to[k] = uint64_t{i} << 32 | k;
        });
        size_t next = 0;
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = 0; k < length_of(i); ++k) {
                ASSERT_LT(next, list.size());
                EXPECT_EQ(list[next++], uint64_t{i} << 32 | k);
            }
        EXPECT_EQ(next, list.size());
    });
}

// Whoever has which block in hand.
TEST(Gather, PicksAndWritesInOrderAtHomes) {
    Memory memory(taut_hooks{});
    Array<uint32_t> picked(memory), list(memory);
    const auto home = [](uint32_t i) { return i * 40503u >> 4; };
    with_teams([&](Team& team, uint32_t count) {
        taut::gather(team, count, picked, is_picked, home);
        taut::write_list(
            team, count, list, [](uint32_t i) { return is_picked(i) ? 1u : 0u; },
            [](uint32_t i, uint32_t* to) {
                if (is_picked(i)) *to = i;
            },
            home);
        EXPECT_EQ(std::vector(picked.begin(), picked.end()), std::vector(list.begin(), list.end()));
        EXPECT_TRUE(std::ranges::is_sorted(picked));
        uint32_t number = 0;
        for (uint32_t i = 0; i < count; ++i) number += is_picked(i);
        EXPECT_EQ(picked.size(), number);
    });
}

// A sum whose rounding depends on its order.
TEST(Gather, ReducesToTheSameBits) {
    const auto sum = [](Team& team, uint32_t count) {
        const auto of = [](uint32_t begin, uint32_t end) {
            float part = 0;
            for (uint32_t i = begin; i < end; ++i) part += 1.0f / (1 + static_cast<float>(i % 97));
            return part;
        };
        return taut::reduce(team, count, 0.0f, of, [](float a, float b) { return a + b; });
    };
    Team alone({}, 1);
    with_teams([&](Team& team, uint32_t count) { EXPECT_EQ(sum(team, count), sum(alone, count)); });
}

}  // namespace
