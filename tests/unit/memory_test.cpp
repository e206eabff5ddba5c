// The world's memory: what the hooks see and what the books say.
#include "base/memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <map>

#include "aligned_memory.h"

namespace taut::test {
namespace {

// A host's allocator that remembers what it gave.
struct Host {
    struct Given {
        size_t size, alignment;
    };
    std::map<void*, Given> live;
    uint64_t calls = 0, frees = 0, mistakes = 0;
    bool empty_handed = false;

    taut_hooks hooks() {
        taut_hooks h{};
        h.allocate = [](size_t size, size_t alignment, void* self) -> void* {
            Host& host = *static_cast<Host*>(self);
            ++host.calls;
            if (host.empty_handed) return nullptr;
            void* pointer = allocate_aligned(size, alignment);
            host.live[pointer] = {size, alignment};
            return pointer;
        };
        h.free = [](void* pointer, size_t size, size_t alignment, void* self) {
            Host& host = *static_cast<Host*>(self);
            ++host.frees;
            const auto at = host.live.find(pointer);
            if (at == host.live.end() || at->second.size != size || at->second.alignment != alignment) {
                ++host.mistakes;
                return;
            }
            host.live.erase(at);
            free_aligned(pointer);
        };
        h.memory_user_data = this;
        return h;
    }
    uint64_t bytes() const {
        uint64_t sum = 0;
        for (const auto& [pointer, given] : live) sum += given.size;
        return sum;
    }
};

// Pieces of 64 bytes and more stay for the next of their size; those above 256 KiB go back at once.
TEST(Memory, KeepsTheBooksOfItsHost) {
    Host host;
    {
        Memory memory(host.hooks());
        const Memory::Keeping keeping(memory);
        void* a = memory.allocate(100, 16);
        void* b = memory.allocate(7, 64);
        void* large = memory.allocate(300000, 16);
        EXPECT_EQ(memory.bytes(), 128u + 64u + 300000u);
        EXPECT_EQ(memory.bytes(), host.bytes());
        EXPECT_EQ(memory.calls(), 3u);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(b) % 64, 0u);
        memory.release(a, 100, 16);
        memory.release(b, 7, 64);
        EXPECT_EQ(host.frees, 0u);
        EXPECT_EQ(memory.allocate(65, 32), a);
        EXPECT_EQ(memory.allocate(64, 16), b);
        EXPECT_EQ(memory.calls(), 3u);
        memory.release(a, 65, 32);
        memory.release(b, 64, 16);
        memory.release(large, 300000, 16);
        EXPECT_EQ(host.frees, 1u);
        EXPECT_EQ(memory.bytes(), host.bytes());
    }
    EXPECT_EQ(host.frees, 3u);
    EXPECT_EQ(host.mistakes, 0u);
    EXPECT_TRUE(host.live.empty());
}

// What steps let go is for steps: whoever asks between them neither gets it nor leaves anything.
TEST(Memory, GivesBackWhatIsLetGoWhileItKeepsNothing) {
    Host host;
    Memory memory(host.hooks());
    {
        const Memory::Keeping keeping(memory);
        memory.release(memory.allocate(100, 16), 100, 16);
        EXPECT_EQ(host.frees, 0u);
    }
    const size_t kept = memory.bytes();
    EXPECT_GE(kept, 100u);
    memory.release(memory.allocate(100, 16), 100, 16);
    EXPECT_EQ(memory.calls(), 2u);
    EXPECT_EQ(host.frees, 1u);
    EXPECT_EQ(memory.bytes(), kept);
    const Memory::Keeping keeping(memory);
    memory.release(memory.allocate(100, 16), 100, 16);
    EXPECT_EQ(memory.calls(), 2u);
}

// What arrays leave behind as they grow goes back after a while; what each step asks for, and what is small, stays.
TEST(Memory, GivesBackLargePiecesThatNobodyAsksFor) {
    constexpr size_t kLarge = 100000, kUsed = 50000, kSmall = 1000;
    Host host;
    Memory memory(host.hooks());
    size_t unused = 0;
    for (int step = 0; step < 1000; ++step) {
        const Memory::Keeping keeping(memory);
        if (step == 0) memory.release(memory.allocate(kLarge, 16), kLarge, 16);
        if (step == 0) memory.release(memory.allocate(kSmall, 16), kSmall, 16);
        memory.release(memory.allocate(kUsed, 16), kUsed, 16);
        unused = memory.bytes() - Memory::whole(kUsed, 16) - Memory::whole(kSmall, 16);
        EXPECT_EQ(memory.bytes(), host.bytes());
        if (step < 100 || step > 300) {
            EXPECT_EQ(unused, step < 100 ? Memory::whole(kLarge, 16) : 0) << step;
        }
    }
    EXPECT_EQ(memory.calls(), 3u);
    EXPECT_EQ(host.frees, 1u);
}

// From 256 bytes on by at most a quarter.
TEST(Memory, RoundsUpByLittle) {
    for (size_t size = 0; size <= 300000; ++size) {
        const size_t whole = Memory::whole(size, 16);
        ASSERT_GE(whole, size);
        ASSERT_LE(whole, std::max(size + size / 4, size + 64)) << size;
        ASSERT_EQ(Memory::whole(whole, 16), whole) << size;
    }
}

TEST(Memory, GivesEvenNothingAPlace) {
    Host host;
    Memory memory(host.hooks());
    void* nothing = memory.allocate(0, 16);
    ASSERT_NE(nothing, nullptr);
    EXPECT_EQ(memory.bytes(), host.bytes());
    memory.release(nothing, 0, 16);
    EXPECT_EQ(host.mistakes, 0u);
}

TEST(Memory, ThrowsWhenTheHostHasNoneAndBooksNothing) {
    Host host;
    Memory memory(host.hooks());
    host.empty_handed = true;
    EXPECT_THROW(memory.allocate(8, 8), std::bad_alloc);
    EXPECT_EQ(memory.bytes(), 0u);
    EXPECT_EQ(memory.calls(), 0u);
}

TEST(Memory, ForgivesReleasingNull) {
    Host host;
    Memory memory(host.hooks());
    memory.release(nullptr, 100, 16);
    EXPECT_EQ(memory.bytes(), 0u);
    EXPECT_EQ(host.frees, 0u);
}

TEST(Memory, TakesTheRuntimesWithoutHooks) {
    Memory memory(taut_hooks{});
    const Memory::Keeping keeping(memory);
    for (size_t alignment : {8, 16, 32, 64}) {
        void* p = memory.allocate(33, alignment);
        ASSERT_NE(p, nullptr);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(p) % alignment, 0u);
        std::memset(p, 1, 33);
        EXPECT_EQ(memory.bytes(), 64u);
        memory.release(p, 33, alignment);
    }
    EXPECT_EQ(memory.calls(), 1u);
}

struct alignas(64) WideItem {
    float f[16];
};

TEST(Array, TakesEverythingFromItsMemory) {
    Host host;
    {
        Memory memory(host.hooks());
        Array<int> numbers(memory);
        for (int i = 0; i < 1000; ++i) numbers.push_back(i);
        EXPECT_GE(memory.bytes(), 1000 * sizeof(int));
        Array<WideItem> wide(3, WideItem{}, memory);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(wide.data()) % 64, 0u);
        Array<Array<int>> nested(4, Array<int>(memory), memory);
        for (auto& inner : nested) inner.assign(10, 1);
        EXPECT_EQ(memory.bytes(), host.bytes());
        Array<int> other(memory);
        other.swap(numbers);
        EXPECT_EQ(other.size(), 1000u);
        Array<int> moved = std::move(other);
        EXPECT_EQ(moved[999], 999);
        EXPECT_EQ(memory.bytes(), host.bytes());
    }
    EXPECT_TRUE(host.live.empty());
    EXPECT_EQ(host.mistakes, 0u);
}

}  // namespace
}  // namespace taut::test
