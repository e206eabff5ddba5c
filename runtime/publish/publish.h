// What steps leave for the host: events, until they are read, and the profile's counts of the last one.
#pragma once

#include "world.h"

namespace taut {

void forget_events(World& world);
// A call of the host that steps or advances: forgets the events that were read.
void begin_call(World& world);
// Around a step: what it publishes comes after what waits to be read, of which the oldest may be dropped.
void begin_events(World& world);
void end_events(World& world);

void publish_contacts(World& world);
// Null: in no quarantine.
inline taut_quarantine_reason public_reason(const FrozenNode* frozen) {
    return frozen ? static_cast<taut_quarantine_reason>(frozen->why) : TAUT_QUARANTINE_NONE;
}
void publish_motion(World& world, const Array<uint32_t>& frozen);
void publish_profile(World& world);
// Removes the joints that ended the step above their thresholds, each with an event. Last: it forgets pairs.
void break_joints(World& world);

}  // namespace taut
