// Between the velocities of the state and those that a scheme solves for (system/scheme.h). A scheme of one step, in
// which they are the same, needs none of this.
#pragma once

#include "partition/partition.h"
#include "system/system.h"

namespace taut {

// Once a frame: room for what a scheme remembers.
void make_room_for_scheme(System& system, Nodes& nodes);
// After predict(), from v_n + h a in System::exact: u* in its place.
void begin_scheme(System& system, const Group& group, Nodes& nodes);
// After positions moved by h u, from u in System::exact, and in kept of nodes in blocks: v' in its place, with springs'
// forces at the positions reached.
void end_scheme(System& system, const Group& group, const Nodes& nodes);
// After store_velocity(): what the next substep has to know.
void remember_scheme(const System& system, const Group& group, Nodes& nodes);

}  // namespace taut
