// Handles: what a host holds instead of a pointer.
#pragma once

#include <cstdint>

namespace taut {

// Bits of a handle: index 28, generation 16, world 20. Index is stored plus one, so that zero is null. A world's
// own handle has the world bits alone.
struct HandleBits {
    uint32_t index, generation, world;
};

constexpr uint32_t kMaxSlots = (1u << 28) - 2;

constexpr uint64_t pack_handle(HandleBits parts) {
    return (static_cast<uint64_t>(parts.index) + 1) << 36 | static_cast<uint64_t>(parts.generation & 0xffff) << 20 |
           (parts.world & 0xfffff);
}

// False for null and for a world's handle.
constexpr bool unpack_handle(uint64_t bits, HandleBits& out) {
    const uint32_t index = static_cast<uint32_t>(bits >> 36);
    if (index == 0) return false;
    out = {index - 1, static_cast<uint32_t>(bits >> 20 & 0xffff), static_cast<uint32_t>(bits & 0xfffff)};
    return true;
}

}  // namespace taut
