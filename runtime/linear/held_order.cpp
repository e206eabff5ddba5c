#include "linear/held_order.h"

#include <algorithm>

#include "linear/minimum_degree.h"

namespace taut {

HeldOrder::HeldOrder(Memory& memory, std::span<const Unknown> unknowns, std::span<const uint64_t> links,
                     std::span<const uint64_t> slight)
    : order(memory),
      unknowns_(unknowns),
      slight_(slight.begin(), slight.end(), memory),
      ties_(memory),
      begin_(unknowns.size() + 2, 0, memory),
      next_(memory),
      waiting_(memory),
      done_(unknowns.size(), 0, memory) {
    std::ranges::sort(slight_);
    tie_nodes(links);
    Array<uint8_t> weight(memory);
    for (const Unknown& u : unknowns) weight.push_back(u.multiplier ? 0 : u.size);
    const MinimumDegree nodes(memory, weight, ties_);
    for (const uint32_t node : nodes.order) {
        take(node);
        for (const uint32_t m : around(node))
            if (!done_[m] && unknowns_[m].rows == 0) take(m);
        take_held(node);
    }
    for (uint32_t m = 0; m < unknowns.size(); ++m)
        if (!done_[m]) take(m);
}

// Couplings, and nodes of a multiplier; who has which multipliers.
void HeldOrder::tie_nodes(std::span<const uint64_t> links) {
    const auto tie = [&](uint64_t a, uint64_t b) {
        ties_.push_back(a << 32 | b);
        ties_.push_back(b << 32 | a);
    };
    Array<uint64_t> across(ties_.get_allocator());  // from << 32 | to, one of them a multiplier
    for (const uint64_t link : links) {
        const uint64_t a = link >> 32, b = link & UINT32_MAX;
        if (!unknowns_[a].multiplier && !unknowns_[b].multiplier) {
            tie(a, b);
            continue;
        }
        across.push_back(a << 32 | b);
        across.push_back(b << 32 | a);
    }
    std::ranges::sort(across);
    across.erase(std::unique(across.begin(), across.end()), across.end());
    for (const uint64_t link : across) {
        ++begin_[(link >> 32) + 1];
        next_.push_back(static_cast<uint32_t>(link));
    }
    for (size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    for (uint32_t m = 0; m < unknowns_.size(); ++m)
        for (const uint32_t a : around(m))
            for (const uint32_t b : around(m))
                if (unknowns_[m].multiplier && a < b) tie(a, b);
    std::ranges::sort(ties_);
    ties_.erase(std::unique(ties_.begin(), ties_.end()), ties_.end());
}

void HeldOrder::take(uint32_t i) {
    done_[i] = 1;
    order.push_back(i);
}

// The multiplier that a node holds alone, and what that leaves alone on others.
void HeldOrder::take_held(uint32_t node) {
    waiting_.assign(1, node);
    while (!waiting_.empty()) {
        const uint32_t at = waiting_.back();
        waiting_.pop_back();
        const uint32_t m = only_open(at);
        if (m == unknowns_.size() || !holds(at, m)) continue;
        take(m);
        for (const uint32_t j : around(m))
            if (done_[j]) waiting_.push_back(j);
    }
}

// Of a node, or the number of unknowns.
uint32_t HeldOrder::only_open(uint32_t node) const {
    const auto none = static_cast<uint32_t>(unknowns_.size());
    uint32_t open = none;
    for (const uint32_t m : around(node)) {
        if (done_[m]) continue;
        if (open != none) return none;
        open = m;
    }
    return open;
}

bool HeldOrder::holds(uint32_t node, uint32_t multiplier) const {
    const uint64_t link = static_cast<uint64_t>(std::min(node, multiplier)) << 32 | std::max(node, multiplier);
    return unknowns_[multiplier].rows <= unknowns_[node].size && !std::ranges::binary_search(slight_, link);
}

}  // namespace taut
