// What is swept: groups of islands, in each of which constraints of a colour share no node that moves.
#include <algorithm>
#include <bit>

#include "partition/partition.h"

namespace taut {
namespace {

constexpr uint32_t kMostPoints = 4, kKinds = 4;  // of a pair; of pairs by their points

// Kinds follow one another to and fro, so that a lane group with pairs of two kinds has them at one place.
uint32_t along(uint32_t kind, uint32_t place) { return kind % 2 == 0 ? place : kSlices - 1 - place; }

}  // namespace

// One group for each effort that occurs, in ascending order.
void Partition::make_groups() {
    Memory& memory = *groups.get_allocator().memory;
    scratch_.clear();
    for (const Island& island : island_) {
        const auto at = std::lower_bound(scratch_.begin(), scratch_.end(), island.effort());
        if (at == scratch_.end() || *at != island.effort()) scratch_.insert(at, island.effort());
    }
    group_count = static_cast<uint32_t>(scratch_.size());
    while (groups.size() < group_count) groups.emplace_back(memory);
    for (uint32_t g = 0; g < group_count; ++g) {
        groups[g].nodes.clear();
        groups[g].blocks.clear();
        groups[g].direct_pairs.clear();
        groups[g].span_pairs.clear();
    }
    for (Island& island : island_) {
        island.group = static_cast<uint32_t>(std::lower_bound(scratch_.begin(), scratch_.end(), island.effort()) -
                                             scratch_.begin());
        groups[island.group].substeps = island.substeps;
        groups[island.group].sweeps = island.sweeps;
    }
}

// Along the axis on which what moves is spread widest, by mean distance from the middle: a few nodes far out take no
// more than a few places.
void Partition::find_places(const Nodes& nodes) {
    Vec3 middle = Vec3::Zero(), spread = Vec3::Zero();
    uint32_t count = 0;
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) middle += nodes.motion[i].x, ++count;
    middle /= std::max(count, 1u);
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) spread += (nodes.motion[i].x - middle).cwiseAbs();
    int axis = 0;
    const double mean = spread.maxCoeff(&axis) / std::max(count, 1u);
    constexpr double kReach = 3;  // times the mean distance; a row of bodies ends at twice of it
    const double per_length = kSlices / (2 * kReach * std::max(mean, 1e-30));
    place_.resize(nodes.slots());
    for (uint32_t i = 0; i < nodes.slots(); ++i) {
        if (island_of_[i] == kNone) continue;
        const double at = kSlices / 2 + per_length * (nodes.motion[i].x[axis] - middle[axis]);
        place_[i] = at > 0 ? static_cast<uint8_t>(std::min(at, kSlices - 1.0)) : 0;  // not a number: 0
    }
}

// Greedy: each item takes the first colour that none of its nodes has; what finds none goes to the last colour.
template <class Ends, class Kind>
uint32_t Partition::colour(const Array<uint32_t>& items, Array<uint32_t>& begin, Ends ends, Kind kind) {
    constexpr uint32_t kOfColour = kKinds * kSlices;
    rank_.resize(items.size());
    rank_begin_.assign(1, 0);
    uint32_t most = 0;  // colours
    for (size_t i = 0; i < items.size(); ++i) {
        const auto nodes = ends(items[i]);
        uint64_t taken = uint64_t{1} << (kMaxColours - 1);
        uint32_t place = kSlices - 1;
        for (uint32_t node : nodes) {
            if (node == kNone || island_of_[node] == kNone) continue;
            taken |= used_[node];
            place = std::min<uint32_t>(place, place_[node]);
        }
        uint32_t c = kMaxColours - 1;
        if (~taken != 0) {
            c = static_cast<uint32_t>(std::countr_zero(~taken));
            for (uint32_t node : nodes)
                if (node != kNone && island_of_[node] != kNone) used_[node] |= uint64_t{1} << c;
        } else {
            place = 0;
        }
        if (c >= most) rank_begin_.resize((most = c + 1) * kOfColour + 1, 0);
        rank_[i] = c * kOfColour + kind(items[i]) * kSlices + along(kind(items[i]), place);
        ++rank_begin_[rank_[i] + 1];
    }
    for (uint32_t r = 0; r < most * kOfColour; ++r) rank_begin_[r + 1] += rank_begin_[r];
    begin.resize(kMaxColours + 1);
    for (uint32_t c = 0; c <= kMaxColours; ++c) begin[c] = rank_begin_[std::min(c, most) * kOfColour];
    return most;
}

// Calls take(at, item, place) for what colour() went through last.
template <class Take>
void Partition::sort_coloured(const Array<uint32_t>& items, Take&& take) {
    for (size_t i = 0; i < items.size(); ++i)
        take(rank_begin_[rank_[i]]++, items[i], static_cast<uint8_t>(along(rank_[i] / kSlices, rank_[i] % kSlices)));
}

void Partition::distribute(const Nodes& nodes, const Joints& joints, const Pairs& pairs) {
    make_groups();
    for (uint32_t i = 0; i < nodes.slots(); ++i)
        if (island_of_[i] != kNone) groups[group_of(i)].nodes.push_back(i);
    find_places(nodes);
    for (uint32_t b = 0; b < blocks.size(); ++b) {
        Group& group = groups[group_of(blocks[b].nodes[0])];
        group.blocks.push_back(b);
        group.direct_pairs.insert(group.direct_pairs.end(), blocks[b].pairs.begin(), blocks[b].pairs.end());
    }

    used_.resize(nodes.slots());
    colours = 0;
    Array<uint32_t>& items = queue_;
    for (uint32_t g = 0; g < group_count; ++g) {
        Group& group = groups[g];
        auto here = [&](std::span<const uint32_t> of) {
            for (uint32_t node : of)
                if (node != kNone && island_of_[node] != kNone) return group_of(node) == g;
            return false;
        };
        items.clear();
        for (uint32_t j = 0; j < joints.record.size(); ++j) {
            if (!joint_in_block_[j] && here(joints.record[j].nodes())) items.push_back(j);
        }
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_joints = colour(
            items, group.joint_colour_begin, [&](uint32_t j) { return joints.record[j].nodes(); },
            [](uint32_t) { return 0u; });
        group.joints.resize(items.size());
        sort_coloured(items, [&](uint32_t at, uint32_t j, uint8_t) { group.joints[at] = j; });
        items.clear();
        for (uint32_t p = 0; p < pairs.active.size(); ++p) {
            if (pair_in_block_[p] || !here(pairs.active[p].nodes())) continue;
            (pairs.active[p].spans() ? group.span_pairs : items).push_back(p);
        }
        for (uint32_t node : group.nodes) used_[node] = 0;
        const uint32_t of_pairs = colour(
            items, group.pair_colour_begin, [&](uint32_t p) { return pairs.active[p].sides(); },
            [&](uint32_t p) { return kMostPoints - pairs.active[p].points; });
        group.pairs.resize(items.size());
        group.pair_place.resize(items.size());
        sort_coloured(items, [&](uint32_t at, uint32_t p, uint8_t place) {
            group.pairs[at] = p;
            group.pair_place[at] = place;
        });
        colours = std::max({colours, of_joints, of_pairs});
    }
}

}  // namespace taut
