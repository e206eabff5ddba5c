// Which nodes an island is made of: those that forces move.
#pragma once

#include <span>

#include "state/nodes.h"

namespace taut {

inline bool moving(const Nodes& nodes, uint32_t node) { return node != kNone && nodes.solved(node); }

// The first of some nodes that moves, or kNone.
inline uint32_t mover(const Nodes& nodes, std::span<const uint32_t> of) {
    for (uint32_t node : of)
        if (moving(nodes, node)) return node;
    return kNone;
}

}  // namespace taut
