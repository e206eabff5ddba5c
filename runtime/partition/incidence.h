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
        : range_(memory), ends_(memory), colour_(memory), colour_begin_(memory), by_colour_(memory) {}

    // nodes: of all elements one after the other, kNone in place of those that do not count; element e has those from
    // element_begin[e] on. all: nodes that may count, ascending.
    void build(std::span<const uint32_t> all, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes);

    // In the order of elements.
    std::span<const End> of(uint32_t node) const {
        if (range_.empty()) return {};
        return {ends_.data() + range_[node].begin, range_[node].end - range_[node].begin};
    }
    // No two nodes of a colour share an element; nodes on no element have none. Ascending within a colour.
    uint32_t colours() const { return colour_begin_.empty() ? 0 : static_cast<uint32_t>(colour_begin_.size()) - 1; }
    std::span<const uint32_t> nodes_of(uint32_t colour) const {
        return {by_colour_.data() + colour_begin_[colour], colour_begin_[colour + 1] - colour_begin_[colour]};
    }

private:
    struct Range {
        uint32_t begin = 0, end = 0;
    };

    void find_ends(std::span<const uint32_t> all, std::span<const uint32_t> element_begin,
                   std::span<const uint32_t> nodes);
    void find_colours(std::span<const uint32_t> all, std::span<const uint32_t> element_begin,
                      std::span<const uint32_t> nodes);

    Array<Range> range_;  // by node: in ends_
    Array<End> ends_;
    Array<uint32_t> colour_;  // by node
    Array<uint32_t> colour_begin_, by_colour_;
};

}  // namespace taut
