// An allocator for a world that counts what it holds.
#pragma once

#include <cstdint>
#include <cstdlib>

#include <taut/taut.h>

#include "aligned_memory.h"

namespace soak {

class CountedMemory {
public:
    void hook(taut_hooks& hooks) {
        hooks.allocate = [](size_t size, size_t alignment, void* self) -> void* {
            static_cast<CountedMemory*>(self)->bytes_ += size;
            return allocate_aligned(size, alignment);
        };
        hooks.free = [](void* pointer, size_t size, size_t, void* self) {
            static_cast<CountedMemory*>(self)->bytes_ -= size;
            free_aligned(pointer);
        };
        hooks.memory_user_data = this;
    }
    uint64_t bytes() const { return bytes_; }

private:
    uint64_t bytes_ = 0;
};

}  // namespace soak
