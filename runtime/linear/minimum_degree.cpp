#include "linear/minimum_degree.h"

#include <algorithm>

namespace taut {
namespace {

constexpr uint32_t kNobody = ~0u;

}  // namespace

MinimumDegree::MinimumDegree(Memory& memory, std::span<const uint8_t> weight, std::span<const uint64_t> edges)
    : order(memory),
      pool_(memory),
      adjacency_(weight.size(), Adjacency{}, memory),
      weight_(weight.begin(), weight.end(), memory),
      degree_(weight.size(), 0, memory),
      element_(weight.size(), 0, memory),
      first_(memory),
      next_(weight.size(), kNobody, memory),
      previous_(weight.size(), kNobody, memory),
      absorbed_(weight.size(), kNobody, memory),
      last_(weight.size(), 0, memory),
      seen_(weight.size(), kNobody, memory),
      outside_(weight.size(), 0, memory),
      mark_(weight.size(), 0, memory),
      alike_(memory) {
    read(edges);
    while (left_ > 0) eliminate(take_least());
}

void MinimumDegree::read(std::span<const uint64_t> edges) {
    for (uint64_t edge : edges) {
        const auto from = static_cast<uint32_t>(edge >> 32), to = static_cast<uint32_t>(edge);
        if (adjacency_[from].variables++ == 0) adjacency_[from].begin = pool_.size();
        degree_[from] += weight_[to];
        pool_.push_back(to);
    }
    for (uint32_t weight : weight_) left_ += weight;
    first_.assign(left_ + 1, kNobody);
    for (auto i = static_cast<uint32_t>(weight_.size()); i-- > 0;) {  // the lowest number is first in its list
        last_[i] = i;
        if (live(i)) insert(i);
    }
}

void MinimumDegree::insert(uint32_t i) {
    uint32_t& first = first_[degree_[i]];
    next_[i] = first;
    previous_[i] = kNobody;
    if (first != kNobody) previous_[first] = i;
    first = i;
    least_ = std::min(least_, degree_[i]);
}

void MinimumDegree::remove(uint32_t i) {
    (previous_[i] == kNobody ? first_[degree_[i]] : next_[previous_[i]]) = next_[i];
    if (next_[i] != kNobody) previous_[next_[i]] = previous_[i];
}

uint32_t MinimumDegree::take_least() {
    while (first_[least_] == kNobody) ++least_;
    const uint32_t pivot = first_[least_];
    remove(pivot);
    return pivot;
}

void MinimumDegree::eliminate(uint32_t pivot) {
    left_ -= weight_[pivot];
    form_element(pivot);
    const Adjacency element = adjacency_[pivot];
    measure_elements(element);
    alike_.clear();
    for (size_t at = element.begin; at < element.end(); ++at) update(pivot, pool_[at]);
    merge_alike();
    close_element(pivot);
    for (uint32_t i = pivot; i != kNobody; i = absorbed_[i]) order.push_back(i);
}

// The variables next to the pivot become one element, which absorbs the elements that the pivot was in.
void MinimumDegree::form_element(uint32_t pivot) {
    const Adjacency around = adjacency_[pivot];
    weight_[pivot] = 0;
    element_[pivot] = 1;
    adjacency_[pivot] = {pool_.size(), 0, 0};
    degree_[pivot] = 0;
    for (size_t at = around.begin; at < around.begin + around.elements; ++at) {
        const uint32_t e = pool_[at];
        if (!element_[e]) continue;
        element_[e] = 0;
        for (size_t k = adjacency_[e].begin; k < adjacency_[e].end(); ++k) add_to_element(pivot, pool_[k]);
    }
    for (size_t at = around.begin + around.elements; at < around.end(); ++at) add_to_element(pivot, pool_[at]);
}

void MinimumDegree::add_to_element(uint32_t pivot, uint32_t i) {
    if (!live(i) || seen_[i] == pivot) return;
    seen_[i] = pivot;
    remove(i);
    ++adjacency_[pivot].variables;
    degree_[pivot] += weight_[i];
    pool_.push_back(i);
}

// Of each element that has variables in common with the newest, the weight of the others.
void MinimumDegree::measure_elements(const Adjacency& element) {
    const uint64_t stamp = ++stamp_ << 32;
    for (size_t at = element.begin; at < element.end(); ++at) {
        const uint32_t i = pool_[at];
        const Adjacency& around = adjacency_[i];
        for (size_t k = around.begin; k < around.begin + around.elements; ++k) {
            const uint32_t e = pool_[k];
            if (outside_[e] < stamp) outside_[e] = stamp | degree_[e];
            outside_[e] -= weight_[i];
        }
    }
}

// The newest element takes the place of those within it and of variables in it. A variable with nothing else around
// it is eliminated with the pivot at no cost.
void MinimumDegree::update(uint32_t pivot, uint32_t i) {
    Adjacency& around = adjacency_[i];
    const size_t variables = around.begin + around.elements, end = around.end();
    size_t to = around.begin;
    uint64_t sum = pivot;
    uint32_t beyond = 0;
    const auto keep = [&](uint32_t j, uint32_t weight) {
        beyond += weight;
        sum += j;
        pool_[to++] = j;
    };
    for (size_t at = around.begin; at < variables; ++at) {
        const uint32_t e = pool_[at];
        if (!element_[e]) continue;
        const auto outside = static_cast<uint32_t>(outside_[e]);
        outside > 0 ? keep(e, outside) : void(element_[e] = 0);
    }
    const size_t kept = to;
    for (size_t at = variables; at < end; ++at)
        if (const uint32_t j = pool_[at]; live(j) && seen_[j] != pivot) keep(j, weight_[j]);
    if (to == around.begin) {
        left_ -= weight_[i];
        degree_[pivot] -= weight_[i];
        absorb(pivot, i);
        return;
    }
    pool_[to] = pool_[kept];  // room for one is there: the pivot, or an element that it absorbed, was in the list
    pool_[kept] = pool_[around.begin];
    pool_[around.begin] = pivot;
    around.elements = static_cast<uint32_t>(kept - around.begin) + 1;
    around.variables = static_cast<uint32_t>(to - kept);
    degree_[i] = std::min(degree_[i], beyond);
    alike_.emplace_back(sum, i);
}

// Variables with the same neighbours stay together from now on.
void MinimumDegree::merge_alike() {
    std::sort(alike_.begin(), alike_.end());
    for (size_t a = 0; a < alike_.size(); ++a) {
        const uint32_t i = alike_[a].second;
        bool marked = false;
        for (size_t b = a + 1; b < alike_.size() && alike_[b].first == alike_[a].first; ++b) {
            const uint32_t j = alike_[b].second;
            if (!live(i) || !live(j)) continue;
            if (!marked) {
                ++stamp_;
                for (size_t at = adjacency_[i].begin; at < adjacency_[i].end(); ++at) mark_[pool_[at]] = stamp_;
                marked = true;
            }
            if (alike(i, j)) absorb(i, j);
        }
    }
}

// Whether j, too, is next to what was marked around i.
bool MinimumDegree::alike(uint32_t i, uint32_t j) const {
    const Adjacency &a = adjacency_[i], &b = adjacency_[j];
    if (a.elements != b.elements || a.variables != b.variables) return false;
    return std::all_of(pool_.begin() + static_cast<ptrdiff_t>(b.begin), pool_.begin() + static_cast<ptrdiff_t>(b.end()),
                       [&](uint32_t k) { return mark_[k] == stamp_; });
}

void MinimumDegree::absorb(uint32_t into, uint32_t i) {
    if (!element_[into]) weight_[into] += weight_[i];
    weight_[i] = 0;
    absorbed_[last_[into]] = i;
    last_[into] = last_[i];
}

// What is left of the newest element, and the degrees of its variables: at most what each had and the element adds.
void MinimumDegree::close_element(uint32_t pivot) {
    Adjacency& element = adjacency_[pivot];
    size_t to = element.begin;
    for (size_t at = element.begin; at < element.end(); ++at)
        if (live(pool_[at])) pool_[to++] = pool_[at];
    element.variables = static_cast<uint32_t>(to - element.begin);
    pool_.resize(to);
    if (element.variables == 0) element_[pivot] = 0;
    for (size_t at = element.begin; at < to; ++at) {
        const uint32_t i = pool_[at];
        degree_[i] = std::min(degree_[i] + degree_[pivot], left_) - weight_[i];
        insert(i);
    }
}

}  // namespace taut
