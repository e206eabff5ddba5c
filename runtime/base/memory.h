// Memory of one world: the host's allocator or the C runtime, with a count of calls and bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include <taut/base.h>

namespace taut {

// Pieces that the world lets go stay with it for the next one of their size, so that a world whose blocks and lists
// come and go asks the host for nothing once it is warm.
class Memory {
public:
    explicit Memory(const taut_hooks& hooks) : hooks_(hooks) {}
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    void* allocate(size_t size, size_t alignment);  // throws std::bad_alloc
    void release(void* pointer, size_t size, size_t alignment) noexcept;

    uint64_t bytes() const { return bytes_; }  // held from the host
    uint64_t calls() const { return calls_; }  // to the host
    // What a request of this size takes from the host.
    static size_t whole(size_t size, size_t alignment);

private:
    struct Piece {  // one that is kept, in the piece itself
        Piece* next;
    };
    static constexpr size_t kLeast = 64, kAlignment = 64;  // of pieces that are kept
    static constexpr int kSizes = 13;                      // 64 bytes to 256 KiB, by twos

    static int size_class(size_t size, size_t alignment);  // or kSizes: not kept
    void* take_from_host(size_t size, size_t alignment);
    void give_to_host(void* pointer, size_t size, size_t alignment) noexcept;

    taut_hooks hooks_;
    uint64_t bytes_ = 0;
    uint64_t calls_ = 0;
    Piece* kept_[kSizes] = {};
};

template <class T>
struct HostAllocator {
    using value_type = T;
    Memory* memory;

    HostAllocator(Memory& m) : memory(&m) {}
    template <class U>
    HostAllocator(const HostAllocator<U>& other) : memory(other.memory) {}

    T* allocate(size_t count) { return static_cast<T*>(memory->allocate(count * sizeof(T), alignment())); }
    void deallocate(T* pointer, size_t count) noexcept { memory->release(pointer, count * sizeof(T), alignment()); }

    static constexpr size_t alignment() { return alignof(T) > 16 ? alignof(T) : 16; }
    template <class U>
    bool operator==(const HostAllocator<U>& other) const {
        return memory == other.memory;
    }
};

// A growing array in the world's memory. Constructed from the world's Memory: Array<int> a(memory);
template <class T>
using Array = std::vector<T, HostAllocator<T>>;

}  // namespace taut
