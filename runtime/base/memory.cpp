#include "base/memory.h"

#include <bit>
#include <cstdlib>

namespace taut {

Memory::~Memory() {
    for (int c = 0; c < kSizes; ++c)
        while (Piece* piece = kept_[c]) {
            kept_[c] = piece->next;
            give_to_host(piece, kLeast << c, kAlignment);
        }
}

int Memory::size_class(size_t size, size_t alignment) {
    if (size > kLeast << (kSizes - 1) || alignment > kAlignment) return kSizes;
    return size <= kLeast ? 0 : std::bit_width((size - 1) / kLeast);
}

size_t Memory::whole(size_t size, size_t alignment) {
    const int c = size_class(size, alignment);
    return c == kSizes ? size : kLeast << c;
}

void* Memory::allocate(size_t size, size_t alignment) {
    const int c = size_class(size, alignment);
    if (c == kSizes) return take_from_host(size, alignment);
    Piece* piece = kept_[c];
    if (!piece) return take_from_host(kLeast << c, kAlignment);
    kept_[c] = piece->next;
    return piece;
}

void Memory::release(void* pointer, size_t size, size_t alignment) noexcept {
    if (!pointer) return;
    const int c = size_class(size, alignment);
    if (c == kSizes)
        give_to_host(pointer, size, alignment);
    else
        kept_[c] = new (pointer) Piece{kept_[c]};
}

void* Memory::take_from_host(size_t size, size_t alignment) {
    void* pointer = nullptr;
    if (hooks_.allocate) {
        pointer = hooks_.allocate(size, alignment, hooks_.memory_user_data);
    } else {
        const size_t rounded = (size + alignment - 1) / alignment * alignment;
        pointer = std::aligned_alloc(alignment, rounded);
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
        std::free(pointer);
}

}  // namespace taut
