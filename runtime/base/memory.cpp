#include "base/memory.h"

#include <cstdlib>

namespace taut {

void* Memory::allocate(size_t size, size_t alignment) {
    if (size == 0) size = 1;
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

void Memory::release(void* pointer, size_t size, size_t alignment) noexcept {
    if (!pointer) return;
    if (size == 0) size = 1;
    bytes_ -= size;
    if (hooks_.free)
        hooks_.free(pointer, size, alignment, hooks_.memory_user_data);
    else
        std::free(pointer);
}

}  // namespace taut
