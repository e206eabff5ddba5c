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

// act(part) over the parts of all colours, in any order: those of a thread one after the other.
template <class Act>
void for_lane_parts(Team& team, const ContactLanes& lanes, Act&& act) {
    const auto act_on = [&](uint32_t begin, uint32_t end) {
        for (uint32_t k = begin; k < end; ++k)
            for (uint32_t i = k; i < lanes.part.size(); i += lanes.parts) act(i);
    };
    if (lanes.group.size() < kFewGroups) return act_on(0, lanes.parts);
    team.for_ranges(lanes.parts, 1, act_on);
}

}  // namespace taut
