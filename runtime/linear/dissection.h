// Nested dissection: a graph is halved again and again where few edges cross.
#pragma once

#include <span>

#include "base/memory.h"

namespace taut {

class Dissection {
public:
    struct Region {  // of the sequence: a single node or two halves
        uint32_t begin, middle, end;
        bool single() const { return begin == middle; }
    };

    // edges: from << 32 | to, each in both directions, ascending; nodes: those to be ordered.
    Dissection(Memory& memory, uint32_t numbers, std::span<const uint32_t> nodes, std::span<const uint64_t> edges);

    std::span<const uint32_t> next_to(uint32_t i) const { return {&next_[begin_[i]], &next_[begin_[i + 1]]}; }

    Array<uint32_t> sequence, place;  // the nodes, and the place of each in it
    Array<Region> regions;            // halves before their whole

private:
    void divide(uint32_t begin, uint32_t end);
    uint32_t halve(uint32_t begin, uint32_t end);
    uint32_t measure(uint32_t begin, uint32_t end, uint32_t from, Array<int32_t>& distance);
    uint32_t third_corner(uint32_t begin, uint32_t end) const;
    void try_between(uint32_t begin, uint32_t end, int u, int v, int w);

    Array<uint32_t> begin_, next_;  // neighbours of each node
    Array<int32_t> distance_[3];    // in edges, from three corners
    Array<uint32_t> rank_, trial_, best_;
    Array<std::pair<uint64_t, uint32_t>> keys_;
    uint32_t best_middle_ = 0, best_crossing_ = 0;
};

}  // namespace taut
