#include "system/lane_parts.h"

#include <algorithm>

namespace taut {
namespace {

// The overflow colour takes one pair at a time.
uint32_t width_of(uint32_t colour) { return colour + 1 == kMaxColours ? 1 : kLanes; }

// A colour's lane groups of at least k points are those that its pairs of as many fill, the last one in part.
void reserve_lanes(ContactLanes& lanes, const Pairs& pairs, const Group& group) {
    size_t groups = 0, points = 0;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const uint32_t width = width_of(c);
        for (uint32_t i = group.pair_colour_begin[c]; i < group.pair_colour_begin[c + 1]; i += width, ++groups)
            points += pairs.active[group.pairs[i]].points;
    }
    const auto reserve = [](auto& empty, size_t needed) {
        if (needed > empty.capacity()) empty.reserve(with_slack(needed));
    };
    reserve(lanes.group, groups);
    reserve(lanes.point, points);
}

void choose_pairs(LaneGroup& g, std::span<const uint32_t> items, const Pairs& pairs) {
    g.points = pairs.active[items[0]].points;
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
        const bool used = lane < items.size();
        const ActivePair* active = used ? &pairs.active[items[lane]] : nullptr;
        g.pair[lane] = used ? active->pair : kNone;
        g.a[lane] = used ? active->a + 1 : 0;
        g.b[lane] = used ? active->b + 1 : 0;
    }
}

// Lane groups of one colour, whose pairs come with the most points first, so that there are few empty places; in the
// order of the place of their middle pair. A thread takes a stretch of them, of the overflow colour one takes all.
void add_colour(ContactLanes& lanes, const Pairs& pairs, const Group& group, uint32_t colour) {
    const uint32_t width = width_of(colour);
    const uint32_t begin = group.pair_colour_begin[colour], end = group.pair_colour_begin[colour + 1];
    const uint32_t count = (end - begin + width - 1) / width, first = static_cast<uint32_t>(lanes.group.size());
    const auto last_of = [&](uint32_t i) { return std::min(begin + (i + 1) * width, end); };
    const auto place_of = [&](uint32_t i) { return group.pair_place[(begin + i * width + last_of(i)) / 2]; };
    uint32_t next[kSlices + 1] = {};
    for (uint32_t i = 0; i < count; ++i) ++next[place_of(i) + 1u];
    for (uint32_t p = 0; p < kSlices; ++p) next[p + 1] += next[p];
    lanes.group.resize(first + count);
    for (uint32_t i = 0; i < count; ++i)
        choose_pairs(lanes.group[first + next[place_of(i)]++],
                     {&group.pairs[begin + i * width], &group.pairs[last_of(i) - 1] + 1}, pairs);
    const uint32_t parts = colour + 1 == kMaxColours ? 1 : lanes.parts;
    for (uint32_t k = 0; k < lanes.parts; ++k) {
        const auto from = [&](uint32_t part) { return first + std::min(part, parts) * count / parts; };
        lanes.part.push_back({from(k), from(k), from(k + 1)});
    }
}

// Which part a node's lane groups are in, or that several parts meet at it.
class Owners {
public:
    Owners(Array<uint32_t>& owner, const Array<SweepMass>& inverse_mass) : owner_(owner), inverse_mass_(inverse_mass) {
        owner_.assign(inverse_mass.size(), kNone);
    }
    void note(const LaneGroup& g, uint32_t part) {
        for (const auto& side : {g.a, g.b})
            for (uint32_t lane = 0; lane < kLanes; ++lane) {
                uint32_t& owner = owner_[side[lane]];
                owner = owner == kNone || owner == part ? part : kSeveral;
            }
    }
    // Whether a node that moves is of several parts.
    bool is_border(const LaneGroup& g) const {
        for (const auto& side : {g.a, g.b})
            for (uint32_t lane = 0; lane < kLanes; ++lane)
                if (owner_[side[lane]] == kSeveral && inverse_mass_[side[lane]].inv_mass > 0) return true;
        return false;
    }

private:
    static constexpr uint32_t kSeveral = kNone - 1;
    Array<uint32_t>& owner_;
    const Array<SweepMass>& inverse_mass_;
};

void swap_choice(LaneGroup& one, LaneGroup& other) {
    std::swap(one.points, other.points);
    std::swap(one.pair, other.pair);
    std::swap(one.a, other.a);
    std::swap(one.b, other.b);
}

// In each part the groups at its border come first.
void put_borders_first(ContactLanes& lanes, const Array<SweepMass>& inverse_mass) {
    Owners owners(lanes.owner, inverse_mass);
    for (uint32_t i = 0; i < lanes.part.size(); ++i)
        for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g) owners.note(lanes.group[g], i % lanes.parts);
    for (LanePart& part : lanes.part)
        for (uint32_t g = part.begin; g < part.end; ++g)
            if (owners.is_border(lanes.group[g])) swap_choice(lanes.group[g], lanes.group[part.inner++]);
}

// The points of the groups that a thread works on lie together, colour after colour: processors fetch ahead of what is
// read, and would take what another thread writes.
void place_points(ContactLanes& lanes) {
    uint32_t points = 0;
    for (uint32_t k = 0; k < lanes.parts; ++k)
        for (uint32_t i = k; i < lanes.part.size(); i += lanes.parts)
            for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g) {
                lanes.group[g].first_point = points;
                points += lanes.group[g].points;
            }
    lanes.point.resize(points);
}

}  // namespace

void share_out(ContactLanes& lanes, const Pairs& pairs, const Group& group, const Array<SweepMass>& inverse_mass,
               uint32_t parts) {
    lanes.group.clear();
    lanes.point.clear();
    lanes.part.clear();
    lanes.parts = parts;
    reserve_lanes(lanes, pairs, group);
    for (uint32_t c = 0; c < kMaxColours; ++c) add_colour(lanes, pairs, group, c);
    if (parts > 1) put_borders_first(lanes, inverse_mass);
    place_points(lanes);
}

}  // namespace taut
