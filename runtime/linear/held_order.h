// Order of elimination for meshes of nodes with few multipliers between them, such as joints on cloths and solids.
//
// Nodes go by approximate minimum degree. A multiplier comes after a node of its own: one whose other multipliers have
// all come. On such nodes the rows of multipliers that make a forest are block triangular, whatever lies in a line with
// what, so that no pivot vanishes; two rods in a line, right after the knot between them, are the same row. What a loop
// of multipliers holds finds no such node and comes last: its rows have to give way.
#pragma once

#include <span>

#include "linear/elimination_order.h"

namespace taut {

class HeldOrder {
public:
    // links: pairs of unknowns, smaller << 32 | larger. slight: of these a multiplier and a node that holds hardly any
    // of it, which is none of its own.
    HeldOrder(Memory& memory, std::span<const Unknown> unknowns, std::span<const uint64_t> links,
              std::span<const uint64_t> slight);

    Array<uint32_t> order;  // unknowns, first eliminated first

private:
    void tie_nodes(std::span<const uint64_t> links);
    void take(uint32_t i);
    void take_held(uint32_t node);
    uint32_t only_open(uint32_t node) const;
    bool holds(uint32_t node, uint32_t multiplier) const;
    std::span<const uint32_t> around(uint32_t i) const { return {&next_[begin_[i]], begin_[i + 1] - begin_[i]}; }

    std::span<const Unknown> unknowns_;
    Array<uint64_t> slight_;        // ascending
    Array<uint64_t> ties_;          // from << 32 | to of nodes, each in both directions, ascending
    Array<uint32_t> begin_, next_;  // of each node its multipliers, of each multiplier its nodes
    Array<uint32_t> waiting_;       // nodes of which multipliers came
    Array<uint8_t> done_;
};

}  // namespace taut
