#include "system/lane_parts.h"

#include <algorithm>

namespace taut {
namespace {

// The overflow colour takes one pair at a time.
uint32_t width_of(uint32_t colour) { return colour + 1 == kMaxColours ? 1 : kLanes; }

// The part that each place is of: stretches in which pairs have about as many points.
struct Cut {
    uint32_t part[kSlices];

    Cut(const Group& group, const Pairs& pairs, uint32_t parts) {
        uint64_t points[kSlices] = {}, all = 0, before = 0;
        for (size_t i = 0; i < group.pairs.size(); ++i) {
            const uint32_t count = pairs.active[group.pairs[i]].points;
            points[group.pair_place[i]] += count;
            all += count;
        }
        for (uint32_t place = 0; place < kSlices; ++place) {
            const uint64_t twice_middle = 2 * before + points[place];
            part[place] = static_cast<uint32_t>(twice_middle * parts / (2 * all + 1));
            before += points[place];
        }
    }
};

// The pairs of a colour by part, of the overflow colour all in one; in a part as the group has them: those with the
// most points first, so that there are few empty places in lane groups, then by place.
void add_colour(ContactLanes& lanes, const Group& group, uint32_t colour, const Cut& cut) {
    const uint32_t begin = group.pair_colour_begin[colour], end = group.pair_colour_begin[colour + 1];
    const uint32_t width = width_of(colour);
    const auto part_of = [&](uint32_t i) { return width == 1 ? 0 : cut.part[group.pair_place[i]]; };
    uint32_t groups = lanes.part.empty() ? 0 : lanes.part.back().end, pairs = begin;
    lanes.part.resize(lanes.part.size() + lanes.parts);
    LanePart* const part = lanes.part.data() + lanes.part.size() - lanes.parts;
    for (uint32_t i = begin; i < end; ++i) ++part[part_of(i)].pairs_end;
    for (uint32_t k = 0; k < lanes.parts; ++k) {
        const uint32_t count = part[k].pairs_end;
        part[k] = {groups, groups, groups + (count + width - 1) / width, pairs, pairs};
        pairs += count;
        groups = part[k].end;
    }
    for (uint32_t i = begin; i < end; ++i) lanes.pairs[part[part_of(i)].pairs_end++] = i;
}

// The pairs of a lane group.
void choose_pairs(LaneGroup& g, const System& system, const Pairs& pairs, const Group& group,
                  std::span<const uint32_t> chosen) {
    g.points = pairs.active[group.pairs[chosen.front()]].points;
    for (uint32_t lane = 0; lane < kLanes; ++lane) {
        const ActivePair* const active = lane < chosen.size() ? &pairs.active[group.pairs[chosen[lane]]] : nullptr;
        g.pair[lane] = active ? active->pair : kNone;
        g.a[lane] = active ? system.at(active->a) : 0;
        g.b[lane] = active ? system.at(active->b) : 0;
    }
}

// For the homes of a part's pairs.
void vote(const ContactLanes& lanes, const Group& group, uint32_t part, Pairs& pairs) {
    lanes.for_colours(part, [&](uint32_t i) {
        for (uint32_t k = lanes.part[i].pairs_begin; k < lanes.part[i].pairs_end; ++k)
            pairs.homes.vote(part, pairs.active[group.pairs[lanes.pairs[k]]].near);
    });
}

// The lane groups of part i, in the order of the place of their middle pair.
void choose_pairs(System& system, const Pairs& pairs, const Group& group, uint32_t i) {
    ContactLanes& lanes = system.contacts;
    const LanePart& part = lanes.part[i];
    const uint32_t width = width_of(i / lanes.parts);
    const auto chosen = [&](uint32_t g) {
        const uint32_t from = part.pairs_begin + g * width;
        return std::span(&lanes.pairs[from], std::min(width, part.pairs_end - from));
    };
    const auto place_of = [&](uint32_t g) { return group.pair_place[chosen(g)[chosen(g).size() / 2]]; };
    const uint32_t count = part.end - part.begin;
    uint32_t next[kSlices + 1] = {};
    for (uint32_t g = 0; g < count; ++g) ++next[place_of(g) + 1u];
    for (uint32_t p = 0; p < kSlices; ++p) next[p + 1] += next[p];
    for (uint32_t g = 0; g < count; ++g)
        choose_pairs(lanes.group[part.begin + next[place_of(g)]++], system, pairs, group, chosen(g));
}

// Which parts have lane groups at which nodes.
class Meetings {
public:
    explicit Meetings(System& system)
        : lanes_(system.contacts), met_(lanes_.met), sweep_(system.sweep), nodes_(sweep_.size()) {
        met_.resize(nodes_ * lanes_.parts);
    }
    void note(uint32_t part) {
        uint8_t* const met = &met_[nodes_ * part];
        std::fill_n(met, nodes_, uint8_t{0});
        lanes_.for_colours(part, [&](uint32_t i) {
            for (uint32_t g = lanes_.part[i].begin; g < lanes_.part[i].end; ++g)
                for (uint32_t lane = 0; lane < kLanes; ++lane)
                    met[lanes_.group[g].a[lane]] = met[lanes_.group[g].b[lane]] = 1;
        });
    }
    // In each part of a colour the groups at the border come first.
    void put_borders_first(uint32_t part) {
        lanes_.for_colours(part, [&](uint32_t i) {
            LanePart& of = lanes_.part[i];
            for (uint32_t g = of.begin; g < of.end; ++g)
                if (is_border(lanes_.group[g], part)) swap_choice(lanes_.group[g], lanes_.group[of.inner++]);
        });
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
        lanes.for_colours(k, [&](uint32_t i) {
            for (uint32_t g = lanes.part[i].begin; g < lanes.part[i].end; ++g)
                lanes.group[g].point = lanes.point.take(lanes.group[g].points);
        });
}

}  // namespace

void share_out(Team& team, System& system, Pairs& pairs, const Group& group) {
    ContactLanes& lanes = system.contacts;
    lanes.group.clear();
    lanes.point.clear();
    lanes.part.clear();
    lanes.parts = team.size();
    lanes.pairs.clear();
    reserve_more(lanes.pairs, group.pairs.size());
    lanes.pairs.resize(group.pairs.size());
    const Cut cut(group, pairs, lanes.parts);
    for (uint32_t c = 0; c < kMaxColours; ++c) add_colour(lanes, group, c, cut);
    const size_t groups = lanes.part.back().end;
    reserve_more(lanes.group, groups);
    lanes.group.resize(groups);
    Meetings meetings(system);
    const auto choose = [&](uint32_t part) {
        lanes.for_colours(part, [&](uint32_t i) { choose_pairs(system, pairs, group, i); });
        if (lanes.parts == 1) return;
        meetings.note(part);
        vote(lanes, group, part, pairs);
    };
    constexpr uint32_t kAfter[] = {0, 1};  // borders once all have noted
    for_parts(team, lanes, {kAfter, lanes.parts > 1 ? 2u : 1u}, [&](uint32_t stage, uint32_t part) {
        if (stage == 0) return choose(part);
        meetings.put_borders_first(part);
    });
    place_points(lanes);
}

}  // namespace taut
