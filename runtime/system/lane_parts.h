// Which pairs stand side by side in lanes, and which thread takes them: the same in each loop, so that what a thread
// filled in and swept is in its cache when it comes again.
#pragma once

#include "constraints/contact_lanes.h"
#include "partition/partition.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

// Lane groups of all colours with their pairs and nodes, a part of each colour for each thread. Parts vote for
// the homes of their pairs.
void share_out(Team& team, System& system, Pairs& pairs, const Group& group);

constexpr uint32_t kFewGroups = 16;  // that are done before anybody could help

// Team::for_parts(), but for few lane groups by the caller.
template <class Run>
void for_parts(Team& team, const ContactLanes& lanes, std::span<const uint32_t> after, Run&& run) {
    if (lanes.group.size() >= kFewGroups) return team.for_parts(after, run);
    for (uint32_t stage = 0; stage < after.size(); ++stage)
        for (uint32_t part = 0; part < lanes.parts; ++part) run(stage, part);
}

// act(i) over the parts of all colours, in any order: those of a thread one after the other.
template <class Act>
void for_lane_parts(Team& team, const ContactLanes& lanes, Act&& act) {
    constexpr uint32_t kAtOnce[] = {0};
    for_parts(team, lanes, kAtOnce, [&](uint32_t, uint32_t part) { lanes.for_colours(part, act); });
}

}  // namespace taut
