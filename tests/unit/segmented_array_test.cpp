// A list that grows in segments.
#include "base/segmented_array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "aligned_memory.h"

namespace {

using namespace taut;

TEST(SegmentedArray, HoldWhatWasPutInWhereItIs) {
    Memory memory{taut_hooks{}};
    SegmentedArray<int> list(memory);
    const int* first = nullptr;
    for (int i = 0; i < 1000; ++i) {
        list.emplace_back() = i;
        if (i == 0) first = &list[0];
    }
    EXPECT_EQ(&list[0], first);
    ASSERT_EQ(list.size(), 1000u);
    for (size_t i = 0; i < list.size(); ++i) EXPECT_EQ(list[i], static_cast<int>(i));
    int sum = 0;
    for (const int x : list) sum += x;
    EXPECT_EQ(sum, 999 * 1000 / 2);
}

TEST(SegmentedArray, ReserveRoomAndBeginWithNewElements) {
    Memory memory{taut_hooks{}};
    struct Seven {
        int value = 7;
    };
    SegmentedArray<Seven> list(memory);
    list.reserve(100);
    EXPECT_GE(list.capacity(), 100u);
    EXPECT_EQ(list.size(), 0u);
    const uint64_t calls = memory.calls();
    for (int i = 0; i < 100; ++i) EXPECT_EQ(list.emplace_back().value, 7);
    EXPECT_EQ(memory.calls(), calls);
}

TEST(SegmentedArray, AreSearchedAndThinnedOutLikeAnArray) {
    Memory memory{taut_hooks{}};
    SegmentedArray<int> list(memory);
    EXPECT_TRUE(list.empty());
    list.resize(1000);
    EXPECT_TRUE(std::ranges::all_of(list, [](int x) { return x == 0; }));
    for (int i = 0; i < 1000; ++i) list[static_cast<size_t>(i)] = 2 * i;
    for (const int x : {-1, 0, 1, 777, 1998, 1999}) {
        const auto at = std::ranges::lower_bound(list, x);
        EXPECT_EQ(at - list.begin(), std::clamp((x + 1) / 2, 0, 1000)) << x;
    }
    list.erase_if([](int x) { return x % 3 != 0; });
    ASSERT_EQ(list.size(), 334u);
    for (size_t i = 0; i < list.size(); ++i) EXPECT_EQ(list[i], static_cast<int>(6 * i));
    list.resize(10);
    list.resize(12);
    EXPECT_EQ(list[9], 54);
    EXPECT_EQ(list[11], 0);
}

TEST(SegmentedArray, ShiftWhatTheyHoldAsMemmoveDoes) {
    Memory memory{taut_hooks{}};
    constexpr size_t kSize = 100;
    SegmentedArray<int> list(memory);
    list.resize(kSize);
    for (size_t from = 0; from <= kSize; from += 7)
        for (size_t end = from; end <= kSize; ++end)
            for (size_t to = 0; to + (end - from) <= kSize; to += 3) {
                int expected[kSize];
                for (size_t i = 0; i < kSize; ++i) expected[i] = list[i] = static_cast<int>(i);
                std::memmove(expected + to, expected + from, (end - from) * sizeof(int));
                list.shift(from, end, to);
                ASSERT_TRUE(std::ranges::equal(list, expected)) << from << " to " << end << ", to " << to;
            }
}

// A host that gives so many pieces, then none.
taut_hooks hooks_of(int& left) {
    taut_hooks hooks{};
    hooks.allocate = [](size_t size, size_t alignment, void* pieces) -> void* {
        if (--*static_cast<int*>(pieces) < 0) return nullptr;
        return allocate_aligned(size, alignment);
    };
    hooks.free = [](void* pointer, size_t, size_t, void*) { free_aligned(pointer); };
    hooks.memory_user_data = &left;
    return hooks;
}

TEST(SegmentedArray, StayAsTheyAreWithoutMemory) {
    for (int allowed = 0; allowed < 8; ++allowed) {
        int left = allowed;
        Memory memory(hooks_of(left));
        SegmentedArray<int> list(memory);
        bool failed = false;
        size_t held = 0;
        try {
            for (;; ++held) list.emplace_back() = static_cast<int>(held);
        } catch (const std::bad_alloc&) {
            failed = true;
        }
        EXPECT_TRUE(failed);
        ASSERT_EQ(list.size(), held);
        for (size_t i = 0; i < held; ++i) EXPECT_EQ(list[i], static_cast<int>(i));
    }
}

}  // namespace
