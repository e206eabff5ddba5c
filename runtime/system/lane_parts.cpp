#include "system/lane_parts.h"

#include <algorithm>

namespace taut {
namespace {

// The overflow colour takes one pair at a time.
uint32_t width_of(uint32_t colour) { return colour + 1 == kMaxColours ? 1 : kLanes; }

uint32_t count_groups(const Group& group, uint32_t colour) {
    const uint32_t width = width_of(colour);
    return (group.pair_colour_begin[colour + 1] - group.pair_colour_begin[colour] + width - 1) / width;
}

void reserve_groups(ContactLanes& lanes, const Group& group) {
    size_t groups = 0;
    for (uint32_t c = 0; c < kMaxColours; ++c) groups += count_groups(group, c);
    if (groups > lanes.group.capacity()) lanes.group.reserve(with_slack(groups));
}

// Lane groups of one colour, whose pairs come with the most points first, so that there are few empty places; in the
// order of the place of their middle pair. A thread takes a stretch of them, of the overflow colour one takes all.
void add_colour(ContactLanes& lanes, const Group& group, uint32_t colour) {
    const uint32_t width = width_of(colour);
    const uint32_t begin = group.pair_colour_begin[colour], end = group.pair_colour_begin[colour + 1];
    const uint32_t count = count_groups(group, colour), first = static_cast<uint32_t>(lanes.group.size());
    const auto place_of = [&](uint32_t i) {
        const uint32_t from = begin + i * width, to = std::min(from + width, end);
        return group.pair_place[(from + to) / 2];
    };
    uint32_t next[kSlices + 1] = {};
    for (uint32_t i = 0; i < count; ++i) ++next[place_of(i) + 1u];
    for (uint32_t p = 0; p < kSlices; ++p) next[p + 1] += next[p];
    lanes.group.resize(first + count);
    lanes.first_pair.resize(first + count);
    for (uint32_t i = 0; i < count; ++i) lanes.first_pair[first + next[place_of(i)]++] = begin + i * width;
    const uint32_t parts = colour + 1 == kMaxColours ? 1 : lanes.parts;
    for (uint32_t k = 0; k < lanes.parts; ++k) {
        const auto from = [&](uint32_t part) { return first + std::min(part, parts) * count / parts; };
        lanes.part.push_back({from(k), from(k), from(k + 1)});
    }
}

// The pairs of a lane group, from one on in the order of the group.
void choose_pairs(LaneGroup& g, const Pairs& pairs, const Group& group, uint32_t colour, uint32_t from) {
    const uint32_t filled = std::min(width_of(colour), group.pair_colour_begin[colour + 1] - from);
    g.points = pairs.active[group.pairs[from]].points;
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
        const ActivePair* const active = lane < filled ? &pairs.active[group.pairs[from + lane]] : nullptr;
        g.pair[lane] = active ? active->pair : kNone;
        g.a[lane] = active ? active->a + 1 : 0;
        g.b[lane] = active ? active->b + 1 : 0;
    }
}

// Which parts have lane groups at which nodes.
class Meetings {
public:
    Meetings(ContactLanes& lanes, const Array<SweepNode>& nodes)
        : lanes_(lanes), met_(lanes.met), sweep_(nodes), nodes_(nodes.size()) {
        met_.resize(nodes_ * lanes.parts);
    }
    void note(uint32_t part) {
        uint8_t* const met = &met_[nodes_ * part];
        std::fill_n(met, nodes_, uint8_t{0});
        for (uint32_t i = part; i < lanes_.part.size(); i += lanes_.parts)
            for (uint32_t g = lanes_.part[i].begin; g < lanes_.part[i].end; ++g)
                for (uint32_t lane = 0; lane < kLanes; ++lane)
                    met[lanes_.group[g].a[lane]] = met[lanes_.group[g].b[lane]] = 1;
    }
    // In each part of a colour the groups at the border come first.
    void put_borders_first(uint32_t part) {
        for (uint32_t i = part; i < lanes_.part.size(); i += lanes_.parts) {
            LanePart& of = lanes_.part[i];
            for (uint32_t g = of.begin; g < of.end; ++g)
                if (is_border(lanes_.group[g], part)) swap_choice(lanes_.group[g], lanes_.group[of.inner++]);
        }
    }

private:
    // Whether a node that moves is of other parts too.
    bool is_border(const LaneGroup& g, uint32_t part) const {
        for (const auto& side : {g.a, g.b})
            for (uint32_t lane = 0; lane < kLanes; ++lane)
                if (others_meet(side[lane], part) && sweep_[side[lane]].mass.inv_mass > 0) return true;
        return false;
    }
    bool others_meet(uint32_t node, uint32_t part) const {
        for (uint32_t other = 0; other < lanes_.parts; ++other)
            if (other != part && met_[nodes_ * other + node]) return true;
        return false;
    }
    static void swap_choice(LaneGroup& one, LaneGroup& other) {
        std::swap(one.points, other.points);
        std::swap(one.pair, other.pair);
        std::swap(one.a, other.a);
        std::swap(one.b, other.b);
    }

    ContactLanes& lanes_;
    Array<uint8_t>& met_;
    const Array<SweepNode>& sweep_;
    size_t nodes_;
};

// The points of the groups that a thread works on lie together, colour after colour: processors fetch ahead of what is
// read, and would take what another thread writes.
void place_points(ContactLanes& lanes) {
    for (uint32_t k = 0; k < lanes.parts; ++k)
        for (uint32_t i = k; i < lanes.part.size(); i += lanes.parts)
            for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g)
                lanes.group[g].point = lanes.point.take(lanes.group[g].points);
}

}  // namespace

void share_out(Team& team, ContactLanes& lanes, const Pairs& pairs, const Group& group, const Array<SweepNode>& nodes) {
    lanes.group.clear();
    lanes.point.clear();
    lanes.part.clear();
    lanes.parts = team.size();
    reserve_groups(lanes, group);
    lanes.first_pair.clear();
    for (uint32_t c = 0; c < kMaxColours; ++c) add_colour(lanes, group, c);
    Meetings meetings(lanes, nodes);
    const auto choose = [&](uint32_t part) {
        for (uint32_t i = part; i < lanes.part.size(); i += lanes.parts)
            for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g)
                choose_pairs(lanes.group[g], pairs, group, i / lanes.parts, lanes.first_pair[g]);
        if (lanes.parts > 1) meetings.note(part);
    };
    constexpr uint32_t kAfter[] = {0, 1};  // borders once all have noted
    for_parts(team, lanes, {kAfter, lanes.parts > 1 ? 2u : 1u}, [&](uint32_t stage, uint32_t part) {
        if (stage == 0) return choose(part);
        meetings.put_borders_first(part);
    });
    place_points(lanes);
}

}  // namespace taut
