// Who moves, who touches whom and who is tied to whom: all that islands, levels and colours of contacts follow from.
// Once things rest, it stays the same for most frames, though points of contact come and go.
#pragma once

#include <array>
#include <span>

#include "state/elements.h"
#include "state/pairs.h"
#include "threads/team.h"

namespace taut {

// Touches of each node that moves, by slot: index in TouchGraph::touches, as in Pairs::active.
struct Adjacency {
    struct Range {
        uint32_t begin = 0, end = 0;
    };
    std::span<const Range> range;
    std::span<const uint32_t> touches;

    std::span<const uint32_t> of(uint32_t node) const {
        return touches.subspan(range[node].begin, range[node].end - range[node].begin);
    }
};

class TouchGraph {
public:
    explicit TouchGraph(Memory& memory)
        : moves(memory), movers(memory), touches(memory), spans(memory), ties(memory), now_(memory) {}

    // As it is in this frame. False: just as in the last one.
    bool update(Team& team, const Nodes& nodes, const Joints& joints, const Elements& elements, const Pairs& pairs);

    // The next frame is not as any before.
    void forget();

    // Ends that forces move; kNone in place of all others.
    struct Touch {
        uint32_t a, b;  // the sides of a pair, of which each is the first of its nodes
        uint32_t other(uint32_t end) const { return end == a ? b : a; }
        bool operator==(const Touch&) const = default;
    };
    using Tie = std::array<uint32_t, kMaxEnds>;

    Array<uint8_t> moves;    // by slot of a node: forces move it, and it is awake
    Array<uint32_t> movers;  // slots of those, ascending
    Array<Touch> touches;    // by index in Pairs::active
    Array<Tie> spans;        // all ends of the pairs with a side of two nodes; with any, each frame counts as changed
    Array<Tie> ties;         // by slot of a joint; elements keep their own, which move by their version

    uint32_t mover(uint32_t node) const { return node != kNone && moves[node] ? node : kNone; }

private:
    bool update_moves(Team& team, const Nodes& nodes);
    bool update_touches(Team& team, const Pairs& pairs);
    bool update_ties(Team& team, const Joints& joints);

    Array<uint32_t> now_;  // scratch: movers before
    uint64_t elements_version_ = 0, grains_version_ = 0, surfaces_version_ = 0;
};

}  // namespace taut
