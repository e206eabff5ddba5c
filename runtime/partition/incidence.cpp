#include "partition/incidence.h"

#include <algorithm>
#include <numeric>

#include "state/nodes.h"

namespace taut {

void Incidence::build(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes) {
    if (nodes.empty()) {  // no memory by node in worlds without elements
        begin_.clear();
        ends_.clear();
        colour_begin_.clear();
        return;
    }
    find_ends(slots, element_begin, nodes);
    find_colours(slots, element_begin, nodes);
}

void Incidence::find_ends(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes) {
    // Counted two places on, so that what is filled below ends as where each node begins.
    begin_.assign(slots + 2, 0);
    for (const uint32_t node : nodes)
        if (node != kNone) ++begin_[node + 2];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    ends_.resize(begin_.back());
    for (uint32_t e = 0; e + 1 < element_begin.size(); ++e)
        for (uint32_t i = element_begin[e]; i < element_begin[e + 1]; ++i)
            if (nodes[i] != kNone) ends_[begin_[nodes[i] + 1]++] = {e, i - element_begin[e]};
}

// Greedy: of each node the least colour that none of its neighbours has.
void Incidence::find_colours(uint32_t slots, std::span<const uint32_t> element_begin, std::span<const uint32_t> nodes) {
    colour_.assign(slots, kNone);
    Array<uint32_t> taken(colour_.get_allocator());  // by colour: the node, and one, that it was last taken for
    for (uint32_t node = 0; node < slots; ++node) {
        if (of(node).empty()) continue;
        for (const End& end : of(node))
            for (uint32_t i = element_begin[end.element]; i < element_begin[end.element + 1]; ++i)
                if (nodes[i] != kNone && colour_[nodes[i]] != kNone) taken[colour_[nodes[i]]] = node + 1;
        const auto free = std::ranges::find_if(taken, [&](uint32_t by) { return by != node + 1; });
        colour_[node] = static_cast<uint32_t>(free - taken.begin());
        if (free == taken.end()) taken.push_back(0);
    }
    colour_begin_.assign(taken.size() + 2, 0);
    for (const uint32_t colour : colour_)
        if (colour != kNone) ++colour_begin_[colour + 2];
    std::partial_sum(colour_begin_.begin(), colour_begin_.end(), colour_begin_.begin());
    by_colour_.resize(colour_begin_.back());
    for (uint32_t node = 0; node < slots; ++node)
        if (colour_[node] != kNone) by_colour_[colour_begin_[colour_[node] + 1]++] = node;
    colour_begin_.pop_back();
}

}  // namespace taut
