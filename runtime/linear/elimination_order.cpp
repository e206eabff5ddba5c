#include "linear/elimination_order.h"

#include <algorithm>
#include <functional>
#include <queue>

#include "linear/dissection.h"

namespace taut {
namespace {

constexpr size_t kCouplingShare = 4;  // in a net, nodes for each end of a coupling between two nodes

int freedoms_of(const Unknown& node) { return node.size == 6 ? 5 : 3; }

}  // namespace

EliminationOrder::EliminationOrder(Memory& memory, std::span<const Unknown> unknowns, std::span<const uint64_t> links)
    : order(memory),
      unknowns_(unknowns),
      graph_(unknowns.size(), Array<uint32_t>(memory), memory),
      ends_(unknowns.size(), Array<uint32_t>(memory), memory),
      done_(unknowns.size(), 0, memory),
      freedoms_(unknowns.size(), 0, memory),
      neighbours_(memory),
      merged_(memory) {
    read_links(links);
    if (meshed())
        dissect();
    else
        run_greedily();
}

void EliminationOrder::run_greedily() {
    Memory& memory = *order.get_allocator().memory;
    std::priority_queue<uint64_t, Array<uint64_t>, std::greater<>> queue(std::greater<>{}, Array<uint64_t>(memory));
    for (uint32_t i = 0; i < unknowns_.size(); ++i)
        if (!unknowns_[i].multiplier) queue.push(key(i));
    while (!queue.empty()) {  // entries whose degree has changed since are out of date
        const uint64_t next = queue.top();
        queue.pop();
        const auto i = static_cast<uint32_t>(next);
        if (done_[i] || next != key(i) || !ready(i)) continue;
        eliminate(i);
        for (uint32_t j : neighbours_) queue.push(key(j));
    }
}

void EliminationOrder::read_links(std::span<const uint64_t> links) {
    for (uint64_t link : links) {
        const auto i = static_cast<uint32_t>(link >> 32), j = static_cast<uint32_t>(link);
        graph_[i].push_back(j);
        graph_[j].push_back(i);
    }
    for (uint32_t i = 0; i < unknowns_.size(); ++i) {
        std::sort(graph_[i].begin(), graph_[i].end());
        graph_[i].erase(std::unique(graph_[i].begin(), graph_[i].end()), graph_[i].end());
        freedoms_[i] = static_cast<uint8_t>(freedoms_of(unknowns_[i]));
        if (!unknowns_[i].multiplier) continue;
        std::copy_if(graph_[i].begin(), graph_[i].end(), std::back_inserter(ends_[i]),
                     [&](uint32_t j) { return !unknowns_[j].multiplier; });
    }
}

// Takes i out and ties its neighbours together.
void EliminationOrder::eliminate(uint32_t i) {
    if (unknowns_[i].multiplier) {
        const uint32_t node = node_to_claim(i);
        if (node < unknowns_.size()) freedoms_[node] = static_cast<uint8_t>(freedoms_[node] - need(i, node));
    }
    done_[i] = 1;
    order.push_back(i);
    neighbours_.swap(graph_[i]);
    for (uint32_t j : neighbours_) {
        merged_.clear();
        std::set_union(graph_[j].begin(), graph_[j].end(), neighbours_.begin(), neighbours_.end(),
                       std::back_inserter(merged_));
        merged_.erase(std::remove_if(merged_.begin(), merged_.end(), [&](uint32_t k) { return k == i || k == j; }),
                      merged_.end());
        graph_[j].assign(merged_.begin(), merged_.end());
    }
}

bool EliminationOrder::ready(uint32_t i) const {
    if (!unknowns_[i].multiplier || node_to_claim(i) < unknowns_.size()) return true;
    return std::all_of(ends_[i].begin(), ends_[i].end(), [&](uint32_t j) { return done_[j]; });
}

// A weld takes all that its node has.
int EliminationOrder::need(uint32_t multiplier, uint32_t node) const {
    return std::min<int>(unknowns_[multiplier].rows, freedoms_of(unknowns_[node]));
}

uint32_t EliminationOrder::node_to_claim(uint32_t multiplier) const {
    for (uint32_t j : ends_[multiplier])
        if (done_[j] && freedoms_[j] >= need(multiplier, j)) return j;
    return static_cast<uint32_t>(unknowns_.size());
}

bool EliminationOrder::linked(uint32_t i, uint32_t j) const {
    return std::binary_search(graph_[i].begin(), graph_[i].end(), j);
}

// Degree, where a joint and the coupling of its two nodes count as one link; multipliers first, then by number.
uint64_t EliminationOrder::key(uint32_t i) const {
    uint64_t degree = graph_[i].size();
    for (uint32_t m : graph_[i]) {
        if (unknowns_[i].multiplier || ends_[m].size() != 2) continue;
        const uint32_t other = ends_[m][0] == i ? ends_[m][1] : ends_[m][0];
        if (other != i && (ends_[m][0] == i || ends_[m][1] == i) && linked(i, other)) --degree;
    }
    return (2 * degree + !unknowns_[i].multiplier) << 32 | i;
}

// More multipliers than nodes, and few nodes tied together by anything else: a net of bodies and joints.
bool EliminationOrder::meshed() const {
    size_t nodes = 0, couplings = 0;
    for (uint32_t i = 0; i < unknowns_.size(); ++i) {
        if (unknowns_[i].multiplier) continue;
        ++nodes;
        for (uint32_t j : graph_[i]) couplings += !unknowns_[j].multiplier;
    }
    return unknowns_.size() > 2 * nodes && couplings * kCouplingShare <= nodes;
}

// All nodes first. The graph of multipliers that is left has the smaller separators (3 rows a joint against 6 freedoms
// a body): where the nodes are cut in two, the multipliers across the cut come after those of the halves.
void EliminationOrder::dissect() {
    Memory& memory = *order.get_allocator().memory;
    const auto count = static_cast<uint32_t>(unknowns_.size());
    Array<uint32_t> nodes(memory);
    Array<uint64_t> edges(memory);
    for (uint32_t i = 0; i < count; ++i) {
        if (!unknowns_[i].multiplier) nodes.push_back(i);
        const auto& tied = unknowns_[i].multiplier ? ends_[i] : graph_[i];
        for (uint32_t a : tied)
            for (uint32_t b : unknowns_[i].multiplier ? tied : Array<uint32_t>(1, i, memory))
                if (a != b && !unknowns_[a].multiplier) edges.push_back(static_cast<uint64_t>(a) << 32 | b);
    }
    std::sort(edges.begin(), edges.end());
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    const Dissection halves(memory, count, nodes, edges);
    order.assign(halves.sequence.begin(), halves.sequence.end());
    for (const auto& region : halves.regions)
        for (uint32_t at = region.begin; at < region.end; ++at)
            for (uint32_t m : graph_[halves.sequence[at]]) {
                auto inside = [&](uint32_t j) { return halves.place[j] >= region.begin && halves.place[j] < region.end; };
                if (done_[m] || !unknowns_[m].multiplier || !std::all_of(ends_[m].begin(), ends_[m].end(), inside)) continue;
                done_[m] = 1;
                order.push_back(m);
            }
}

}  // namespace taut
