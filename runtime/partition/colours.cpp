// What is swept: groups of islands, in each of which constraints of a colour share no node that moves.
#include <algorithm>
#include <array>
#include <bit>
#include <utility>

#include "partition/partition.h"

namespace taut {
namespace {

constexpr uint32_t kMostPoints = 4, kKinds = 4;  // of a pair; of pairs by their points
constexpr uint8_t kUncoloured = kMaxColours;     // not swept, or not by colours

// Kinds follow one another to and fro, so that a lane group with pairs of two kinds has them at one place.
uint32_t along(uint32_t kind, uint32_t place) { return kind % 2 == 0 ? place : kSlices - 1 - place; }

}  // namespace

// One group for each effort that occurs, in ascending order.
void Partition::make_groups() {
    Memory& memory = *groups.get_allocator().memory;
    efforts_.clear();
    for (const Island& island : island_) {
        const auto at = std::lower_bound(efforts_.begin(), efforts_.end(), island.effort());
        if (at == efforts_.end() || *at != island.effort()) efforts_.insert(at, island.effort());
    }
    group_count = static_cast<uint32_t>(efforts_.size());
    while (groups.size() < group_count) groups.emplace_back(memory);
    for (uint32_t g = 0; g < group_count; ++g) {
        groups[g].nodes.clear();
        groups[g].blocks.clear();
        groups[g].direct_pairs.clear();
        groups[g].direct_surfaces.clear();
        groups[g].span_pairs.clear();
    }
    for (Island& island : island_) {
        island.group = static_cast<uint32_t>(std::lower_bound(efforts_.begin(), efforts_.end(), island.effort()) -
                                             efforts_.begin());
        groups[island.group].substeps = island.substeps;
        groups[island.group].sweeps = island.sweeps;
    }
}

// Along the axis on which what moves is spread widest, by mean distance from the middle: a few nodes far out take no
// more than a few places. A heap is about as wide both ways: then along the last such axis, on which bodies that were
// made in rows lie in the order of index, and always the same, for threads keep what they have at hand.
void Partition::find_places(const Nodes& nodes) {
    constexpr double kWider = 1.25;
    Vec3 middle = Vec3::Zero(), spread = Vec3::Zero();
    const double count = std::max(static_cast<double>(graph_.movers.size()), 1.0);
    for (const uint32_t node : graph_.movers) middle += nodes.motion[node].x;
    middle /= count;
    for (const uint32_t node : graph_.movers) spread += (nodes.motion[node].x - middle).cwiseAbs();
    int axis = 2;
    for (int other = 1; other >= 0; --other)
        if (spread[other] > kWider * spread[axis]) axis = other;
    const double mean = spread[axis] / count;
    constexpr double kReach = 3;  // times the mean distance; a row of bodies ends at twice of it
    const double per_length = kSlices / (2 * kReach * std::max(mean, 1e-30));
    for (const uint32_t node : graph_.movers) {
        const double at = kSlices / 2 + per_length * (nodes.motion[node].x[axis] - middle[axis]);
        place_[node] = at > 0 ? static_cast<uint8_t>(std::min(at, kSlices - 1.0)) : 0;  // not a number: 0
    }
}

// Greedy: the first colour that none of the nodes has; what finds none goes to the last.
uint8_t Partition::take_colour(std::span<const uint32_t> nodes) {
    uint64_t taken = uint64_t{1} << (kMaxColours - 1);
    for (const uint32_t node : nodes)
        if (node != kNone) taken |= used_[node];
    if (~taken == 0) return kMaxColours - 1;
    const int colour = std::countr_zero(~taken);
    for (const uint32_t node : nodes)
        if (node != kNone) used_[node] |= uint64_t{1} << colour;
    return static_cast<uint8_t>(colour);
}

// As if no block took any.
void Partition::colour_touches(const Nodes&) {
    clear_movers(used_);
    for (size_t p = 0; p < graph_.touches.size(); ++p) {
        const auto& [a, b] = graph_.touches[p];
        pair_colour_[p] = take_colour(std::array{a, b});
    }
    all_coloured_ = true;
}

// Anew where blocks or pairs with a side of two nodes change what colour_touches() found.
void Partition::colour_pairs(const Pairs& pairs) {
    const bool all = graph_.spans.empty() && std::ranges::find(pair_in_block_, 1) == pair_in_block_.end();
    if (all && all_coloured_) return;
    clear_movers(used_);
    for (size_t p = 0; p < graph_.touches.size(); ++p) {
        const auto& [a, b] = graph_.touches[p];
        const bool swept = !pair_in_block_[p] && !pairs.active[p].spans();
        pair_colour_[p] = swept ? take_colour(std::array{a, b}) : kUncoloured;
    }
    all_coloured_ = all;
}

void Partition::colour_joints() {
    clear_movers(used_);
    joint_colour_.resize(graph_.ties.size());
    for (size_t j = 0; j < graph_.ties.size(); ++j)
        joint_colour_[j] = joint_in_block_[j] ? kUncoloured : take_colour(graph_.ties[j]);
}

// As if no block took any.
void Partition::colour_elements() {
    clear_movers(used_);
    element_colour_.resize(element_.size());
    for (uint32_t e = 0; e < element_.size(); ++e) element_colour_[e] = take_colour(movers_of(e));
}

// Stage by stage, as if no block took any: a stage's colours follow those of the stages before.
void Partition::colour_fused(const Elements& elements) {
    element_pass_.assign(element_.size(), kNone);
    for (uint32_t stage = 0; stage < kMostStages; ++stage) {
        bool any = false;
        for (uint32_t e = 0; e < element_.size(); ++e) {
            const ElementSet& set = elements.set[element_[e].set];
            if (!set.fused || set.stage != stage) continue;
            if (!std::exchange(any, true)) clear_movers(used_);
            element_pass_[e] = stage * kMaxColours + take_colour(movers_of(e));
        }
    }
}

void Partition::colour_grains(const Grains& grains) {
    clear_movers(used_);
    grain_colour_.clear();
    reserve_more(grain_colour_, grains.contact.size());
    for (const GrainContact& contact : grains.contact) {
        const uint32_t ends[] = {graph_.mover(contact.a), graph_.mover(contact.b)};
        const bool rests = ends[0] == kNone && ends[1] == kNone;
        grain_colour_.push_back(rests ? kUncoloured : take_colour(ends));
    }
}

// As if no block took any.
void Partition::colour_surfaces(const SurfaceContacts& surfaces) {
    clear_movers(used_);
    surface_colour_.clear();
    reserve_more(surface_colour_, surfaces.contact.size());
    for (const SurfaceContact& contact : surfaces.contact) {
        const TouchGraph::Tie ends = movers_of(contact);
        const bool rests = std::ranges::all_of(ends, [](uint32_t node) { return node == kNone; });
        surface_colour_.push_back(rests ? kUncoloured : take_colour(ends));
    }
}

// Puts items_ in the order of their ranks, (colour * kKinds + kind) * kSlices + place, with take(at, rank, item).
// Returns how many colours there are.
template <class RankOf, class Take>
uint32_t Partition::sort_by_rank(Array<uint32_t>& begin, RankOf&& rank_of, Take&& take) {
    constexpr uint32_t kOfColour = kKinds * kSlices;
    rank_.clear();
    reserve_more(rank_, items_.size());
    rank_.resize(items_.size());
    rank_begin_.assign(1, 0);
    uint32_t most = 0;
    for (size_t i = 0; i < items_.size(); ++i) {
        rank_[i] = rank_of(items_[i]);
        const uint32_t colours_now = rank_[i] / kOfColour + 1;
        if (colours_now > most) rank_begin_.resize((most = colours_now) * kOfColour + 1, 0);
        ++rank_begin_[rank_[i] + 1];
    }
    for (uint32_t r = 0; r < most * kOfColour; ++r) rank_begin_[r + 1] += rank_begin_[r];
    begin.resize(kMaxColours + 1);
    for (uint32_t c = 0; c <= kMaxColours; ++c) begin[c] = rank_begin_[std::min(c, most) * kOfColour];
    for (size_t i = 0; i < items_.size(); ++i) take(rank_begin_[rank_[i]]++, rank_[i], items_[i]);
    return most;
}

// By colour, kind and the least place of the nodes, to and fro; the overflow colour in order of index.
uint32_t Partition::rank(uint8_t colour, uint32_t kind, std::span<const uint32_t> nodes) const {
    uint32_t place = kSlices - 1;
    for (const uint32_t node : nodes)
        if (node != kNone) place = std::min<uint32_t>(place, place_[node]);
    if (colour == kMaxColours - 1) place = 0;
    return (colour * kKinds + kind) * kSlices + along(kind, place);
}

bool Partition::is_in(uint32_t group, std::span<const uint32_t> nodes) const {
    for (const uint32_t node : nodes)
        if (node != kNone) return group_count == 1 || group_of(node) == group;
    return false;
}

void Partition::list_joints(uint32_t g) {
    Group& group = groups[g];
    items_.clear();
    for (uint32_t j = 0; j < graph_.ties.size(); ++j)
        if (joint_colour_[j] != kUncoloured && is_in(g, graph_.ties[j])) items_.push_back(j);
    group.joints.resize(items_.size());
    const uint32_t used = sort_by_rank(
        group.joint_colour_begin, [&](uint32_t j) { return rank(joint_colour_[j], 0, graph_.ties[j]); },
        [&](uint32_t at, uint32_t, uint32_t j) { group.joints[at] = j; });
    colours = std::max(colours, used);
}

void Partition::list_swept_elements(uint32_t g) {
    Group& group = groups[g];
    items_.clear();
    for (uint32_t e = 0; e < element_.size(); ++e)
        if (!element_in_block_[e] && !(lanes_ && element_pass_[e] != kNone) && is_in(g, movers_of(e)))
            items_.push_back(e);
    group.elements.resize(items_.size());
    const uint32_t used = sort_by_rank(
        group.element_colour_begin, [&](uint32_t e) { return rank(element_colour_[e], 0, movers_of(e)); },
        [&](uint32_t at, uint32_t, uint32_t e) { group.elements[at] = element_[e]; });
    colours = std::max(colours, used);
}

void Partition::list_fused_elements(uint32_t g) {
    Group& group = groups[g];
    group.fused.clear();
    group.fused_pass.clear();
    const auto fused = [](uint32_t pass) { return pass != kNone; };
    if (!lanes_ || std::ranges::none_of(element_pass_, fused)) return;
    items_.clear();
    rank_begin_.assign(kMostStages * kMaxColours + 1, 0);
    for (uint32_t e = 0; e < element_.size(); ++e) {
        if (element_pass_[e] == kNone || element_in_block_[e] || !is_in(g, movers_of(e))) continue;
        items_.push_back(e);
        ++rank_begin_[element_pass_[e] + 1];
    }
    for (uint32_t pass = 0; pass < kMostStages * kMaxColours; ++pass) {
        const uint32_t begin = rank_begin_[pass], end = rank_begin_[pass + 1] += begin;
        if (begin < end) group.fused_pass.push_back({begin, end, (pass + 1) % kMaxColours == 0});
    }
    group.fused.resize(items_.size());
    for (const uint32_t e : items_) group.fused[rank_begin_[element_pass_[e]]++] = element_[e];
}

void Partition::list_pairs(uint32_t g, const Pairs& pairs) {
    Group& group = groups[g];
    const auto sides = [&](uint32_t p) { return std::array{graph_.touches[p].a, graph_.touches[p].b}; };
    items_.clear();
    reserve_more(items_, graph_.touches.size());
    for (uint32_t p = 0; p < graph_.touches.size(); ++p)
        if (pair_colour_[p] != kUncoloured && is_in(g, sides(p))) items_.push_back(p);
    group.pairs.resize(items_.size());
    group.pair_place.resize(items_.size());
    const uint32_t used = sort_by_rank(
        group.pair_colour_begin,
        [&](uint32_t p) { return rank(pair_colour_[p], kMostPoints - pairs.active[p].points, sides(p)); },
        [&](uint32_t at, uint32_t rank, uint32_t p) {
            group.pairs[at] = p;
            group.pair_place[at] = static_cast<uint8_t>(along(rank / kSlices % kKinds, rank % kSlices));
        });
    colours = std::max(colours, used);
}

// Those of which is_own(k), by colour, and of each as they come.
template <class IsOwn>
void Partition::list_by_colour(const Array<uint8_t>& colour, IsOwn&& is_own, Array<uint32_t>& out,
                               Array<uint32_t>& begin) {
    const auto for_own = [&](auto&& act) {
        for (uint32_t k = 0; k < colour.size(); ++k)
            if (colour[k] != kUncoloured && is_own(k)) act(k);
    };
    begin.assign(kMaxColours + 1, 0);
    for_own([&](uint32_t k) { ++begin[colour[k] + 1u]; });
    for (uint32_t c = 0; c < kMaxColours; ++c) begin[c + 1] += begin[c];
    out.clear();
    reserve_more(out, begin[kMaxColours]);
    out.resize(begin[kMaxColours]);
    uint32_t next[kMaxColours];
    std::copy_n(begin.begin(), kMaxColours, next);
    for_own([&](uint32_t k) { out[next[colour[k]]++] = k; });
}

void Partition::list_grains(uint32_t g, const Grains& grains) {
    const auto is_own = [&](uint32_t k) {
        const uint32_t ends[] = {graph_.mover(grains.contact[k].a), graph_.mover(grains.contact[k].b)};
        return is_in(g, ends);
    };
    list_by_colour(grain_colour_, is_own, groups[g].grains, groups[g].grain_colour_begin);
}

// Those that push come first in their colours, so that lanes side by side have work or have none.
static void list_pushing_first(const SurfaceContacts& surfaces, Group& group) {
    for (uint32_t colour = 0; colour < kMaxColours; ++colour) {
        const auto list = group.surfaces.begin();
        uint32_t first = group.surface_colour_begin[colour], last = group.surface_colour_begin[colour + 1];
        while (first < last) {
            if (surfaces.contact[list[first]].force.normal > 0)
                ++first;
            else
                std::swap(list[first], list[--last]);
        }
    }
}

void Partition::list_surfaces(uint32_t g, const SurfaceContacts& surfaces) {
    const auto is_own = [&](uint32_t k) { return !surface_in_block_[k] && is_in(g, movers_of(surfaces.contact[k])); };
    list_by_colour(surface_colour_, is_own, groups[g].surfaces, groups[g].surface_colour_begin);
    list_pushing_first(surfaces, groups[g]);
}

// Contacts by their new numbers, without those that are no more.
static void follow(Array<uint32_t>& list, std::span<const uint32_t> successor) {
    for (uint32_t& k : list) k = successor[k];
    std::erase(list, kNone);
}

static void follow_by_colour(Array<uint32_t>& list, Array<uint32_t>& begin, std::span<const uint32_t> successor) {
    if (list.empty()) return;
    uint32_t kept = 0, first = 0;
    for (size_t c = 0; c + 1 < begin.size(); ++c) {
        const uint32_t end = begin[c + 1];
        for (; first < end; ++first)
            if (successor[list[first]] != kNone) list[kept++] = successor[list[first]];
        begin[c + 1] = kept;
    }
    list.resize(kept);
}

void Partition::renew_surfaces(uint32_t g, const SurfaceContacts& surfaces, std::span<const uint32_t> successor) {
    for (uint32_t other = 0; other < group_count; ++other) {
        if (other != g) follow_by_colour(groups[other].surfaces, groups[other].surface_colour_begin, successor);
        follow(groups[other].direct_surfaces, successor);
    }
    for (Block& block : blocks) follow(block.surfaces, successor);
    clear_movers(used_);
    surface_colour_.clear();
    reserve_more(surface_colour_, surfaces.contact.size());
    for (const SurfaceContact& contact : surfaces.contact) {
        const TouchGraph::Tie ends = movers_of(contact);
        const auto first = std::ranges::find_if(ends, [](uint32_t node) { return node != kNone; });
        surface_colour_.push_back(first != ends.end() && group_of(*first) == g ? take_colour(ends) : kUncoloured);
    }
    list_by_colour(
        surface_colour_, [](uint32_t) { return true; }, groups[g].surfaces, groups[g].surface_colour_begin);
    list_pushing_first(surfaces, groups[g]);
}

void Partition::list_spans(const Pairs& pairs) {
    auto span = graph_.spans.begin();
    for (uint32_t p = 0; p < pairs.active.size(); ++p) {
        if (!pairs.active[p].spans()) continue;
        const auto node = std::ranges::find_if(*span, [](uint32_t end) { return end != kNone; });
        if (!pair_in_block_[p] && node != span->end()) groups[group_of(*node)].span_pairs.push_back(p);
        ++span;
    }
}

void Partition::list_nodes(bool by_place) {
    const auto list = [&](uint32_t node) { groups[group_of(node)].nodes.push_back(node); };
    if (!by_place) {
        std::ranges::for_each(graph_.movers, list);
        return;
    }
    uint32_t next[kSlices + 1] = {};
    for (const uint32_t node : graph_.movers) ++next[place_[node] + 1u];
    for (uint32_t p = 0; p < kSlices; ++p) next[p + 1] += next[p];
    items_.resize(graph_.movers.size());
    for (const uint32_t node : graph_.movers) items_[next[place_[node]]++] = node;
    std::ranges::for_each(items_, list);
}

void Partition::distribute(const Pairs& pairs, bool by_place) {
    make_groups();
    list_nodes(by_place);
    for (uint32_t b = 0; b < blocks.size(); ++b) {
        Group& group = groups[group_of(blocks[b].nodes[0])];
        group.blocks.push_back(b);
        group.direct_pairs.insert(group.direct_pairs.end(), blocks[b].pairs.begin(), blocks[b].pairs.end());
        const Array<uint32_t>& of_block = blocks[b].surfaces;
        group.direct_surfaces.insert(group.direct_surfaces.end(), of_block.begin(), of_block.end());
    }
    if (!graph_.spans.empty()) list_spans(pairs);
    colours = 0;
    for (uint32_t g = 0; g < group_count; ++g) {
        list_joints(g);
        list_swept_elements(g);
        list_fused_elements(g);
        list_pairs(g, pairs);
        list_grains(g, pairs.grains);
        list_surfaces(g, pairs.surfaces);
    }
}

}  // namespace taut
