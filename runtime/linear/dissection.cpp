#include "linear/dissection.h"

#include <algorithm>
#include <cstdlib>

namespace taut {
namespace {

constexpr int32_t kFar = 1 << 20;  // from what cannot be reached

}  // namespace

Dissection::Dissection(Memory& memory, uint32_t numbers, std::span<const uint32_t> nodes,
                       std::span<const uint64_t> edges)
    : sequence(nodes.begin(), nodes.end(), memory),
      place(numbers, ~0u, memory),
      regions(memory),
      begin_(numbers + 1, 0, memory),
      next_(memory),
      distance_{Array<int32_t>(numbers, 0, memory), Array<int32_t>(numbers, 0, memory),
                Array<int32_t>(numbers, 0, memory)},
      rank_(numbers, 0, memory),
      trial_(memory),
      best_(memory),
      keys_(memory) {
    for (uint64_t edge : edges) {
        ++begin_[(edge >> 32) + 1];
        next_.push_back(static_cast<uint32_t>(edge));
    }
    for (uint32_t i = 0; i < numbers; ++i) begin_[i + 1] += begin_[i];
    next_.push_back(0);  // an end to point to
    for (uint32_t i = 0; i < sequence.size(); ++i) place[sequence[i]] = i;
    if (!sequence.empty()) divide(0, static_cast<uint32_t>(sequence.size()));
}

void Dissection::divide(uint32_t begin, uint32_t end) {
    uint32_t middle = begin;
    if (end - begin > 1) {
        middle = halve(begin, end);
        divide(begin, middle);
        divide(middle, end);
    }
    regions.push_back({begin, middle, end});
}

// Two far corners and a third far from both. What is nearer to one of two corners than to the other lies on one side
// of a line between them: in a rectangular net, a straight one between corners of the same side.
uint32_t Dissection::halve(uint32_t begin, uint32_t end) {
    const uint32_t a = measure(begin, end, sequence[begin], distance_[0]);
    const uint32_t b = measure(begin, end, a, distance_[0]);
    measure(begin, end, b, distance_[1]);
    measure(begin, end, third_corner(begin, end), distance_[2]);
    best_crossing_ = ~0u;
    try_between(begin, end, 0, 1, 2);
    try_between(begin, end, 0, 2, 1);
    try_between(begin, end, 1, 2, 0);
    for (uint32_t i = begin; i < end; ++i) {
        sequence[i] = best_[i - begin];
        place[sequence[i]] = i;
    }
    return begin + best_middle_;
}

// Breadth first; the last node reached.
uint32_t Dissection::measure(uint32_t begin, uint32_t end, uint32_t from, Array<int32_t>& distance) {
    for (uint32_t i = begin; i < end; ++i) distance[sequence[i]] = kFar;
    distance[from] = 0;
    trial_.assign(1, from);
    for (uint32_t at = 0; at < trial_.size(); ++at)
        for (uint32_t j : next_to(trial_[at])) {
            if (place[j] < begin || place[j] >= end || distance[j] != kFar) continue;
            distance[j] = distance[trial_[at]] + 1;
            trial_.push_back(j);
        }
    return trial_.back();
}

// Of several, one with few neighbours.
uint32_t Dissection::third_corner(uint32_t begin, uint32_t end) const {
    auto rank = [&](uint32_t i) {
        return std::make_pair(-std::min(distance_[0][i], distance_[1][i]), next_to(i).size());
    };
    return *std::min_element(sequence.begin() + begin, sequence.begin() + end, [&](uint32_t i, uint32_t j) {
        return std::make_pair(rank(i), i) < std::make_pair(rank(j), j);
    });
}

// Sorts by how much nearer to corner u than to corner v, then to w, and cuts the middle third where it is thinnest.
void Dissection::try_between(uint32_t begin, uint32_t end, int u, int v, int w) {
    keys_.clear();
    for (uint32_t i = begin; i < end; ++i) {
        const uint32_t node = sequence[i];
        const auto nearer = static_cast<uint64_t>(distance_[u][node] - distance_[v][node] + kFar);
        keys_.emplace_back(nearer << 32 | static_cast<uint32_t>(distance_[w][node]), node);
    }
    std::sort(keys_.begin(), keys_.end());
    const uint32_t count = end - begin, margin = std::max(1u, count / 3);
    for (uint32_t i = 0; i < count; ++i) rank_[keys_[i].second] = i;
    bool better = false;
    for (uint32_t i = 0, crossing = 0; i + margin < count; ++i) {
        for (uint32_t j : next_to(keys_[i].second))
            if (place[j] >= begin && place[j] < end) crossing += rank_[j] > i ? 1 : -1u;
        const auto off_middle = [&](uint32_t middle) {
            return std::abs(2 * static_cast<int>(middle) - static_cast<int>(count));
        };
        if (i + 1 < margin || crossing > best_crossing_) continue;
        if (crossing == best_crossing_ && off_middle(i + 1) >= off_middle(best_middle_)) continue;
        best_crossing_ = crossing;
        best_middle_ = i + 1;
        better = true;
    }
    if (!better) return;
    best_.clear();
    for (const auto& key : keys_) best_.push_back(key.second);
}

}  // namespace taut
