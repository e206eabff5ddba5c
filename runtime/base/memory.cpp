#include "base/memory.h"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace taut {

Memory::~Memory() {
    for (int c = 0; c < kSizes; ++c) take_out(c, kept_[c].count);
}

void Memory::take_out(int size_class, uint32_t count) noexcept {
    Kept& kept = kept_[size_class];
    for (uint32_t i = 0; i < count; ++i) {
        Piece* const piece = kept.first;
        kept.first = piece->next;
        give_to_host(piece, size_of_class(size_class), kAlignment);
    }
    kept.count -= count;
}

// With patience that grows with the world's age, what comes and goes is asked of the host anew a few times at most.
bool Memory::takes_stock() const { return steps_ + 1 >= kPatience && std::has_single_bit(steps_ + 1); }

void Memory::end_step() noexcept {
    const bool looks = takes_stock();
    keeping_ = false;
    ++steps_;
    if (!looks) return;
    for (int c = 0; c < kSizes; ++c) {
        if (size_of_class(c) >= kLarge) take_out(c, kept_[c].least);
        kept_[c].least = kept_[c].count;
    }
}

int Memory::size_class(size_t size, size_t alignment) {
    if (size > size_of_class(kSizes - 1) || alignment > kAlignment) return kSizes;
    const size_t units = size <= kLeast ? 1 : (size + kLeast - 1) / kLeast;
    const int octave = std::max(0, static_cast<int>(std::bit_width(units - 1)) - 3);
    return 4 * octave + static_cast<int>((units - 1) >> octave);
}

// 1 to 8 units, then 5 to 8 times 2, 4, 8, ...
size_t Memory::size_of_class(int size_class) {
    const int octave = std::max(0, size_class / 4 - 1);
    return (static_cast<size_t>(size_class - 4 * octave) + 1) * kLeast << octave;
}

size_t Memory::whole(size_t size, size_t alignment) {
    const int c = size_class(size, alignment);
    return c == kSizes ? size : size_of_class(c);
}

void* Memory::allocate(size_t size, size_t alignment) {
    const int c = size_class(size, alignment);
    if (c == kSizes) return take_from_host(size, alignment);
    Kept& kept = kept_[c];
    if (!keeping_ || !kept.first)
        return take_from_host(size_of_class(c), kAlignment);  // what steps let go is for steps
    Piece* const piece = kept.first;
    kept.first = piece->next;
    kept.least = std::min(kept.least, --kept.count);
    return piece;
}

void Memory::release(void* pointer, size_t size, size_t alignment) noexcept {
    if (!pointer) return;
    const int c = size_class(size, alignment);
    if (c == kSizes)
        give_to_host(pointer, size, alignment);
    else if (!keeping_)
        give_to_host(pointer, size_of_class(c), kAlignment);
    else {
        kept_[c].first = new (pointer) Piece{kept_[c].first};
        ++kept_[c].count;
    }
}

void* Memory::take_from_host(size_t size, size_t alignment) {
    void* pointer = nullptr;
    if (hooks_.allocate) {
        pointer = hooks_.allocate(size, alignment, hooks_.memory_user_data);
    } else {
#if defined(_WIN32)
        pointer = _aligned_malloc(size, alignment);
#else
        const size_t rounded = (size + alignment - 1) / alignment * alignment;
        pointer = std::aligned_alloc(alignment, rounded);
#endif
    }
    if (!pointer) throw std::bad_alloc();
    bytes_ += size;
    ++calls_;
    return pointer;
}

void Memory::give_to_host(void* pointer, size_t size, size_t alignment) noexcept {
    bytes_ -= size;
    if (hooks_.free)
        hooks_.free(pointer, size, alignment, hooks_.memory_user_data);
    else
#if defined(_WIN32)
        _aligned_free(pointer);
#else
        std::free(pointer);
#endif
}

}  // namespace taut
