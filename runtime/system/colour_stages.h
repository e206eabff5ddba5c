// How threads share out the lane groups of a colour: the same way in each loop, so that what a thread filled in and
// swept is in its cache when it comes again.
#pragma once

#include <algorithm>

#include "constraints/contact_lanes.h"
#include "partition/partition.h"
#include "threads/team.h"

namespace taut {

// Lane groups [first, first + stage.count).
struct ColourStage {
    uint32_t first;
    Team::Stage stage;
};

template <class Lanes>
ColourStage colour_stage(const Lanes& lanes, uint32_t colour, uint32_t threads) {
    constexpr uint32_t kGrain = 2;  // lane groups, a third of a microsecond each
    const uint32_t first = lanes.colour_begin[colour], count = lanes.colour_begin[colour + 1] - first;
    return {first, {count, std::max(kGrain, (count + threads - 1) / threads)}};
}

constexpr uint32_t kFewGroups = 16;  // that are done before anybody could help

// act(begin, end) over all lane groups of contacts, colour by colour; these need not come one after the other.
template <class Act>
void for_lane_groups(Team& team, const ContactLanes& lanes, Act&& act) {
    if (lanes.group.size() < kFewGroups) return act(0u, static_cast<uint32_t>(lanes.group.size()));
    Team::Stage stage[kMaxColours];
    uint32_t first[kMaxColours], used = 0;
    for (uint32_t c = 0; c < kMaxColours; ++c) {
        const ColourStage colour = colour_stage(lanes, c, team.size());
        first[used] = colour.first;
        stage[used] = colour.stage;
        used += colour.stage.count > 0;
    }
    team.for_stages({stage, used},
                    [&](uint32_t i, uint32_t begin, uint32_t end) { act(first[i] + begin, first[i] + end); });
}

}  // namespace taut
