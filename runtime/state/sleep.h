// What a world remembers about its sleeping islands; each node's share is in Nodes::rest and Nodes::sleep.
#pragma once

#include "base/describe.h"
#include "base/memory.h"

namespace taut {

struct Sleep {
    explicit Sleep(Memory& memory) : root(memory), restless(memory), settled(memory) {}

    uint32_t islands = 0;     // asleep
    uint32_t bodies = 0;      // in them
    bool recall = false;      // something woke since pairs were last brought back from Pairs::resting
    bool changed = false;     // somebody fell asleep or woke since the last events
    Array<uint32_t> root;     // scratch, by node: union-find of islands; roots are the smallest node
    Array<uint8_t> restless;  // scratch, by root: somebody in it may not fall asleep yet
    Array<uint32_t> settled;  // nodes that the last step went through for the last time, ascending
};
template <class Visitor, Like<Sleep> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [islands, bodies, recall, changed, root, restless, settled] = of;
    TAUT_FIELDS(visitor, islands, bodies, recall);
    TAUT_ASIDE(visitor, changed);
}

}  // namespace taut
