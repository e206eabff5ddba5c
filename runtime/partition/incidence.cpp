#include "partition/incidence.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "state/nodes.h"

namespace taut {

void Incidence::build(std::span<const uint32_t> all, std::span<const uint32_t> element_begin,
                      std::span<const uint32_t> nodes) {
    if (nodes.empty()) {  // no memory by node in worlds without elements
        range_.clear();
        ends_.clear();
        colour_begin_.clear();
        return;
    }
    find_ends(all, element_begin, nodes);
    find_colours(all, element_begin, nodes);
}

void Incidence::find_ends(std::span<const uint32_t> all, std::span<const uint32_t> element_begin,
                          std::span<const uint32_t> nodes) {
    range_.resize(all.back() + size_t{1});
    for (const uint32_t node : all) range_[node] = {};
    for (const uint32_t node : nodes)
        if (node != kNone) ++range_[node].end;
    uint32_t count = 0;
    for (const uint32_t node : all) {
        const uint32_t begin = std::exchange(count, count + range_[node].end);
        range_[node] = {begin, begin};
    }
    ends_.resize(count);
    for (uint32_t e = 0; e + 1 < element_begin.size(); ++e)
        for (uint32_t i = element_begin[e]; i < element_begin[e + 1]; ++i)
            if (nodes[i] != kNone) ends_[range_[nodes[i]].end++] = {e, i - element_begin[e]};
}

// Greedy: of each node the least colour that none of its neighbours has.
void Incidence::find_colours(std::span<const uint32_t> all, std::span<const uint32_t> element_begin,
                             std::span<const uint32_t> nodes) {
    colour_.resize(range_.size());
    for (const uint32_t node : all) colour_[node] = kNone;
    Array<uint32_t> taken(colour_.get_allocator());  // by colour: the node, and one, that it was last taken for
    for (const uint32_t node : all) {
        if (of(node).empty()) continue;
        for (const End& end : of(node))
            for (uint32_t i = element_begin[end.element]; i < element_begin[end.element + 1]; ++i)
                if (nodes[i] != kNone && colour_[nodes[i]] != kNone) taken[colour_[nodes[i]]] = node + 1;
        const auto free = std::ranges::find_if(taken, [&](uint32_t by) { return by != node + 1; });
        colour_[node] = static_cast<uint32_t>(free - taken.begin());
        if (free == taken.end()) taken.push_back(0);
    }
    colour_begin_.assign(taken.size() + 2, 0);
    for (const uint32_t node : all)
        if (colour_[node] != kNone) ++colour_begin_[colour_[node] + 2];
    std::partial_sum(colour_begin_.begin(), colour_begin_.end(), colour_begin_.begin());
    by_colour_.resize(colour_begin_.back());
    for (const uint32_t node : all)
        if (colour_[node] != kNone) by_colour_[colour_begin_[colour_[node] + 1]++] = node;
    colour_begin_.pop_back();
}

}  // namespace taut
