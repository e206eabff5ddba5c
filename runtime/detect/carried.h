// What kinematic bodies carry by friction stays where it lies on them.
#pragma once

#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

// Friction holds speeds: what a straight substep leaves of an arc, (w h)^2 r / 2, and what rounding and the order of
// points leave of a slip add up, and a load creeps from its place. So it is noted where it lies on its carrier while it
// sticks, and friction drives it back there within the frame, at the speed
//   v_b - v_a = -d / T,  d: tangential way of its points since then, T: the frame.
// It counts as sticking while one point bears within its cone, while it did not roll on its carrier, and while it is no
// further off than friction takes it in a frame from rest. After find_contacts().
void hold_carried(const Nodes& nodes, Pairs& pairs, double time_step);

}  // namespace taut
