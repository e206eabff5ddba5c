// Handles: what a host holds instead of a pointer.
#pragma once

#include <cstdint>

namespace taut {

// Bits of a handle: index 24, generation 16, world 24 (slot 10, generation 14: state/world_slot.h). Index is stored
// plus one, so that zero is null. A world's own handle has the world bits alone.
struct HandleBits {
    uint32_t index, generation, world;
};

constexpr uint32_t kMaxSlots = (1u << 24) - 2;
constexpr int kWorldBits = 24, kIndexShift = 40;

constexpr uint64_t pack_handle(HandleBits parts) {
    return (static_cast<uint64_t>(parts.index) + 1) << kIndexShift |
           static_cast<uint64_t>(parts.generation & 0xffff) << kWorldBits | (parts.world & 0xffffff);
}

// False for null and for a world's handle.
constexpr bool unpack_handle(uint64_t bits, HandleBits& out) {
    const uint32_t index = static_cast<uint32_t>(bits >> kIndexShift);
    if (index == 0) return false;
    out = {index - 1, static_cast<uint32_t>(bits >> kWorldBits & 0xffff), static_cast<uint32_t>(bits & 0xffffff)};
    return true;
}

}  // namespace taut
