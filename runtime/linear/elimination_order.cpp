#include "linear/elimination_order.h"

#include <algorithm>
#include <functional>
#include <queue>

#include "linear/minimum_degree.h"

namespace taut {
namespace {

constexpr size_t kLeastNet = 300;  // unknowns
constexpr size_t kMostTies = 16;   // of a node of a net

constexpr size_t kCouplingShare = 8;  // of the nodes of a net, as many as there may be couplings between them

// Couplings of particles, such as elements of cloth and solids make.
size_t couplings_of_particles(std::span<const Unknown> unknowns, const Array<Array<uint32_t>>& graph) {
    size_t count = 0;
    for (uint32_t i = 0; i < unknowns.size(); ++i)
        for (uint32_t j : graph[i])
            count += j > i && !unknowns[i].multiplier && !unknowns[j].multiplier &&
                     std::min(unknowns[i].size, unknowns[j].size) == 3;
    return count;
}

int freedoms_of(const Unknown& node) { return node.size == 6 ? 5 : 3; }

}  // namespace

EliminationOrder::EliminationOrder(Memory& memory, std::span<const Unknown> unknowns, std::span<const uint64_t> links,
                                   double most)
    : order(memory),
      unknowns_(unknowns),
      graph_(unknowns.size(), Array<uint32_t>(memory), memory),
      ends_(unknowns.size(), Array<uint32_t>(memory), memory),
      done_(unknowns.size(), 0, memory),
      freedoms_(unknowns.size(), 0, memory),
      ties_(memory),
      most_(most),
      neighbours_(memory),
      merged_(memory) {
    read_links(links);
    tie_nodes();
    if (multipliers_ == 0 || couplings_of_particles(unknowns, graph_) > multipliers_)
        run_by_nodes();
    else if (meshed())
        dissect();
    else
        run_greedily();
}

// Nodes that are tied to each other, by couplings or a joint.
void EliminationOrder::tie_nodes() {
    auto tie = [&](uint32_t a, uint32_t b) {
        ties_.push_back(static_cast<uint64_t>(a) << 32 | b);
        ties_.push_back(static_cast<uint64_t>(b) << 32 | a);
    };
    for (uint32_t i = 0; i < unknowns_.size(); ++i) {
        multipliers_ += unknowns_[i].multiplier;
        for (uint32_t j : graph_[i])
            if (j > i && !unknowns_[i].multiplier && !unknowns_[j].multiplier) tie(i, j);
    }
    couplings_ = ties_.size() / 2;
    for (const auto& ends : ends_)
        for (size_t a = 0; a < ends.size(); ++a)
            for (size_t b = 0; b < a; ++b) tie(ends[a], ends[b]);
    std::sort(ties_.begin(), ties_.end());
    ties_.erase(std::unique(ties_.begin(), ties_.end()), ties_.end());
}

// The nodes' own graph decides what fills in; a multiplier comes as soon as it may.
void EliminationOrder::run_by_nodes() {
    Array<uint8_t> weight(order.get_allocator());
    for (const Unknown& u : unknowns_) weight.push_back(u.multiplier ? 0 : u.size);
    const MinimumDegree nodes(*order.get_allocator().memory, weight, ties_);
    for (uint32_t node : nodes.order) {
        take(node);
        for (uint32_t m : graph_[node])
            if (unknowns_[m].multiplier && !done_[m] && ready(m)) take(m);
    }
}

void EliminationOrder::run_greedily() {
    Memory& memory = *order.get_allocator().memory;
    std::priority_queue<uint64_t, Array<uint64_t>, std::greater<>> queue(std::greater<>{}, Array<uint64_t>(memory));
    for (uint32_t i = 0; i < unknowns_.size(); ++i)
        if (!unknowns_[i].multiplier) queue.push(key(i));
    while (!queue.empty() && is_found()) {  // entries whose degree has changed since are out of date
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

void EliminationOrder::take(uint32_t i) {
    if (unknowns_[i].multiplier) {
        const uint32_t node = node_to_claim(i);
        if (node < unknowns_.size()) freedoms_[node] = static_cast<uint8_t>(freedoms_[node] - need(i, node));
    }
    done_[i] = 1;
    order.push_back(i);
}

// Takes i and ties its neighbours together.
void EliminationOrder::eliminate(uint32_t i) {
    take(i);
    neighbours_.swap(graph_[i]);
    double below = 0;
    for (const uint32_t j : neighbours_) below += unknowns_[j].size;
    cost_ += elimination_cost(unknowns_[i].size, below);
    if (!is_found()) return;
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

// More multipliers than nodes, and many of both: a net. On small ones the greedy order fills less (a wheel of 56 bodies
// and 81 hinges factors three times faster), and where many joints meet in one body, such as a hub, which may not come
// early (a wheel of 134 bodies: 80 times). Where the nodes are cut in two, what lies on the cut comes after the halves.
bool EliminationOrder::meshed() const {
    size_t nodes = 0, most = 0;
    for (size_t i = 0; i < unknowns_.size(); ++i) {
        if (unknowns_[i].multiplier) continue;
        ++nodes;
        most = std::max(most, graph_[i].size());
    }
    return unknowns_.size() > kLeastNet && unknowns_.size() > 2 * nodes && most <= kMostTies;
}

void EliminationOrder::dissect() {
    Array<uint32_t> nodes(order.get_allocator());
    for (uint32_t i = 0; i < unknowns_.size(); ++i)
        if (!unknowns_[i].multiplier) nodes.push_back(i);
    const Dissection halves(*order.get_allocator().memory, static_cast<uint32_t>(unknowns_.size()), nodes, ties_);
    couplings_* kCouplingShare > nodes.size() ? cut_at_nodes(halves) : cut_at_multipliers(halves);
}

// A node of the second half with a neighbour in the first lies on the cut. Multipliers come as soon as they may.
void EliminationOrder::cut_at_nodes(const Dissection& halves) {
    Array<uint64_t> last(halves.sequence.size(), 0, order.get_allocator());  // region waited for << 32 | place
    for (uint32_t r = 0; r < halves.regions.size(); ++r) {
        const Dissection::Region& region = halves.regions[r];
        auto in_first = [&](uint32_t j) { return halves.place[j] >= region.begin && halves.place[j] < region.middle; };
        for (uint32_t at = region.middle; at < region.end; ++at) {
            const auto around = halves.next_to(halves.sequence[at]);
            if (region.single() || std::any_of(around.begin(), around.end(), in_first))
                last[at] = static_cast<uint64_t>(r) << 32 | at;
        }
    }
    std::sort(last.begin(), last.end());
    for (uint64_t entry : last) {
        const uint32_t node = halves.sequence[static_cast<uint32_t>(entry)];
        take(node);
        for (uint32_t m : graph_[node])
            if (unknowns_[m].multiplier && !done_[m] && ready(m)) take(m);
    }
}

// All nodes first: the graph of multipliers that is left has the smaller cuts (3 rows a joint against 6 freedoms a
// body). A multiplier lies on the cut that parts its nodes.
void EliminationOrder::cut_at_multipliers(const Dissection& halves) {
    for (uint32_t node : halves.sequence) take(node);
    for (const Dissection::Region& region : halves.regions) {
        auto inside = [&](uint32_t j) { return halves.place[j] >= region.begin && halves.place[j] < region.end; };
        for (uint32_t at = region.begin; at < region.end; ++at)
            for (uint32_t m : graph_[halves.sequence[at]])
                if (unknowns_[m].multiplier && !done_[m] && std::all_of(ends_[m].begin(), ends_[m].end(), inside))
                    take(m);
    }
}

}  // namespace taut
