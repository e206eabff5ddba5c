// Which pairs stand side by side in lanes, and which thread takes them: the same in each loop, so that what a thread
// filled in and swept is in its cache when it comes again.
#pragma once

#include "constraints/contact_lanes.h"
#include "partition/partition.h"
#include "threads/team.h"

namespace taut {

// Lane groups of all colours with their pairs and nodes, a part of each colour for each thread. inverse_mass: by node
// + 1.
void share_out(Team& team, ContactLanes& lanes, const Pairs& pairs, const Group& group,
               const Array<SweepMass>& inverse_mass);

constexpr uint32_t kFewGroups = 16;  // that are done before anybody could help

// act(k) for each of lanes.parts, in any order.
template <class Act>
void for_parts_of(Team& team, const ContactLanes& lanes, Act&& act) {
    const auto act_on = [&](uint32_t begin, uint32_t end) {
        for (uint32_t k = begin; k < end; ++k) act(k);
    };
    if (lanes.group.size() < kFewGroups) return act_on(0, lanes.parts);
    team.for_ranges(lanes.parts, 1, act_on);
}

// act(part) over the parts of all colours, in any order: those of a thread one after the other.
template <class Act>
void for_lane_parts(Team& team, const ContactLanes& lanes, Act&& act) {
    for_parts_of(team, lanes, [&](uint32_t k) {
        for (uint32_t i = k; i < lanes.part.size(); i += lanes.parts) act(i);
    });
}

}  // namespace taut
