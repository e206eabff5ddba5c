// What stands before the state in a snapshot.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/describe.h"
#include "world.h"

namespace taut {

constexpr uint32_t kSnapshotVersion = 1;  // of all that no list of fields tells

struct SnapshotHeader {
    char magic[8];
    uint32_t version;
    uint32_t world;     // that it is of: World::id
    uint64_t layout;    // names and sizes of all fields
    uint64_t size;      // of the whole [bytes]
    uint64_t checksum;  // of all else
};

// A shape of the host's that colliders have; none after the last.
struct UsedShape {
    uint32_t slot = kNone, generation = 0;
};
template <class Visitor, Like<UsedShape> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [slot, generation] = of;
    TAUT_FIELDS(visitor, slot, generation);
}

template <class Act>
void for_used_shapes(const World& world, Act&& act) {
    for (uint32_t slot = 0; slot < world.shapes.record.size(); ++slot)
        if (world.shapes.record[slot].users > 0) act(UsedShape{slot, world.shapes.ids.generation(slot)});
}

// Without its checksum.
SnapshotHeader header_of(const World& world, size_t size);
// Of the header but for its checksum, and of what follows: whatever changes in 8 bytes changes it.
uint64_t checksum(const SnapshotHeader& header, std::span<const std::byte> rest);

}  // namespace taut
