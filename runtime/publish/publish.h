// What a step leaves for the host: events and the profile's counts.
#pragma once

#include "world.h"

namespace taut {

void publish_contacts(World& world);
void publish_motion(World& world, const Array<uint32_t>& frozen);
void publish_profile(World& world);
// Removes the joints that ended the step above their thresholds, each with an event. Last: it forgets pairs.
void break_joints(World& world);

}  // namespace taut
