// Which elements end on each node, and colours of the nodes: for solvers that go from node to node. Made where the
// graph of elements changes.
#pragma once

#include <cstdint>
#include <span>

#include "base/memory.h"

namespace taut {

class Incidence {
public:
    // An element by its place in the list, and which of its nodes the node is.
    struct End {
        uint32_t element, node;
        bool operator==(const End&) const = default;
    };

    explicit Incidence(Memory& memory)
        : begin_(memory), ends_(memory), colour_(memory), colour_begin_(memory), by_colour_(memory) {}

    // nodes: of all elements one after the other, kNone in place of those that do not count; element e has those from
    // element_begin[e] on. slots: of nodes.
    void build(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes);

    // In the order of elements.
    std::span<const End> of(uint32_t node) const {
        if (begin_.empty()) return {};
        return {ends_.data() + begin_[node], begin_[node + 1] - begin_[node]};
    }
    // No two nodes of a colour share an element; nodes on no element have none. Ascending within a colour.
    uint32_t colours() const { return colour_begin_.empty() ? 0 : static_cast<uint32_t>(colour_begin_.size()) - 1; }
    std::span<const uint32_t> nodes_of(uint32_t colour) const {
        return {by_colour_.data() + colour_begin_[colour], colour_begin_[colour + 1] - colour_begin_[colour]};
    }

private:
    void find_ends(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes);
    void find_colours(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes);

    Array<uint32_t> begin_;  // by node, and one past the last
    Array<End> ends_;
    Array<uint32_t> colour_;  // by node
    Array<uint32_t> colour_begin_, by_colour_;
};

}  // namespace taut
