// Memory of one world: the host's allocator or the C runtime, with a count of calls and bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <new>
#include <vector>

#include <taut/base.h>

namespace taut {

// Pieces that a step lets go stay with the world for the next one of their size, so that a world whose blocks and lists
// come and go asks the host for nothing once it is warm. Large ones that no step asked for in a while, such as arrays
// leave behind when they grow, go back to the host, and so does what is let go between steps.
class Memory {
public:
    explicit Memory(const taut_hooks& hooks) : hooks_(hooks) {}
    ~Memory();
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;

    void* allocate(size_t size, size_t alignment);  // throws std::bad_alloc
    void release(void* pointer, size_t size, size_t alignment) noexcept;

    const taut_hooks& hooks() const { return hooks_; }
    uint64_t bytes() const { return bytes_; }  // held from the host
    uint64_t calls() const { return calls_; }  // to the host
    // Whether pieces let go stay; as long as this is true.
    class Keeping {
    public:
        explicit Keeping(Memory& memory) : memory_(memory) { memory_.keeping_ = true; }
        ~Keeping() { memory_.end_step(); }
        Keeping(const Keeping&) = delete;
        Keeping& operator=(const Keeping&) = delete;

    private:
        Memory& memory_;
    };

    // Whether this step ends with a look at what was not needed for long: the steps 128, 256, 512, ...
    bool takes_stock() const;

    static constexpr size_t kLarge = 16384;  // bytes; smaller pieces stay as long as the world
    // What a request of this size takes from the host.
    static size_t whole(size_t size, size_t alignment);

private:
    struct Piece {  // one that is kept, in the piece itself
        Piece* next;
    };
    struct Kept {  // pieces of one size
        Piece* first = nullptr;
        uint32_t count = 0, least = 0;  // how many there are, and at least were since those too many went back
    };
    static constexpr size_t kLeast = 64, kAlignment = 64;  // of pieces that are kept
    static constexpr int kSizes = 44;                      // 64 bytes to 256 KiB, four to an octave
    static constexpr uint64_t kPatience = 128;             // steps; grows with the world's age

    static int size_class(size_t size, size_t alignment);  // or kSizes: not kept
    static size_t size_of_class(int size_class);
    void* take_from_host(size_t size, size_t alignment);
    void give_to_host(void* pointer, size_t size, size_t alignment) noexcept;
    void take_out(int size_class, uint32_t count) noexcept;
    void end_step() noexcept;

    taut_hooks hooks_;
    uint64_t bytes_ = 0;
    uint64_t calls_ = 0;
    uint64_t steps_ = 0;
    Kept kept_[kSizes];
    bool keeping_ = false;
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

// An array whose new elements hold whatever was there before: for large ones that are filled at once, each part by the
// thread that goes on with it.
template <class T>
struct UnsetAllocator : HostAllocator<T> {
    using HostAllocator<T>::HostAllocator;
    template <class U>
    struct rebind {
        using other = UnsetAllocator<U>;
    };
    template <class U>
    void construct(U* element) {
        ::new (static_cast<void*>(element)) U;
    }
    template <class U, class... From>
    void construct(U* element, From&&... from) {
        ::new (static_cast<void*>(element)) U(std::forward<From>(from)...);
    }
};
template <class T>
using UnsetArray = std::vector<T, UnsetAllocator<T>>;

// Room for more elements. By an eighth, not by doubling: large arrays make up a world's memory.
constexpr size_t with_slack(size_t needed) { return needed + needed / 8; }

// How many elements a piece of memory holds that is asked for with so many.
template <class T>
size_t held_with(size_t count) {
    return Memory::whole(count * sizeof(T), HostAllocator<T>::alignment()) / sizeof(T);
}

template <class T, class Allocator>
void reserve_more(std::vector<T, Allocator>& array, size_t more) {
    const size_t needed = array.size() + more;
    if (needed > array.capacity()) array.reserve(held_with<T>(with_slack(needed)));
}

// As many elements, if there are fewer: each is written, so that the step that uses it meets no new memory. Grows into
// all that a piece of memory holds; beyond what is kept in pieces, by a sixteenth.
template <class T>
void grow_to(Array<T>& array, size_t size) {
    if (array.size() >= size) return;
    if (size > array.capacity()) {
        const size_t held = held_with<T>(size);
        array.reserve(held > size ? held : size + size / 16);
    }
    array.resize(size);
}

// Empties an array that few steps use, and leaves its memory, if that is much, to whatever asks next.
template <class T, class Allocator>
void let_go(std::vector<T, Allocator>& array) {
    array.clear();
    if (array.capacity() * sizeof(T) >= Memory::kLarge) std::vector<T, Allocator>(array.get_allocator()).swap(array);
}

// Most of it unused, and that is much.
template <class T>
bool is_too_large(size_t size, size_t capacity) {
    return capacity * sizeof(T) >= Memory::kLarge && size <= capacity / 4;
}

// Gives back most of what an array does not need, if it is too large. Does nothing where memory is short.
template <class T, class Allocator>
void trim(std::vector<T, Allocator>& array) noexcept try {
    if (!is_too_large<T>(array.size(), array.capacity())) return;
    std::vector<T, Allocator> kept(array.get_allocator());
    kept.reserve(with_slack(array.size()));
    kept.assign(array.begin(), array.end());
    kept.swap(array);
} catch (const std::bad_alloc&) {
}

}  // namespace taut
