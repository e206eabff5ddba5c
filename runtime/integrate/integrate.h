// Time integration around the solve: implicit Euler on velocities, positions from the solved ones.
#pragma once

#include "partition/partition.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

// Once a frame: seats, poses of all nodes but those long asleep, which keep theirs, still shifts, inverse masses of
// nodes that do not turn theirs.
void begin_frame(Team& team, System& system, const Partition& partition, const Nodes& nodes, const Joints& joints);

// From where a group's motions are, for its substeps, to where threads do not meet (System::motion), and back; what
// there is to do and was not done. Blocks and loads need them where they are.
void lend_motion(Team& team, System& system, const Group& group, const Nodes& nodes);
void return_motion(Team& team, System& system, const Group& group, Nodes& nodes);

// v* = v + h (g + f/m); w* = w + h I^-1 torque, with the gyroscopic torque implicit.
void predict(Team& team, System& system, const Group& group, Nodes& nodes, const Vec3& gravity);

// x += h v, q = exp(h w) q; what the contacts' anchors need to follow.
void commit(Team& team, System& system, const Group& group, Nodes& nodes);

// x += dx, q = exp(dq) q for nodes of blocks marked corrected.
void correct(System& system, const Group& group, const Array<Block>& blocks, Nodes& nodes);

// The kept velocity back into the state; s += kappa (v - s) for nodes in blocks. False: some motion is not sane.
bool store_velocity(Team& team, System& system, const Group& group, Nodes& nodes, double velocity_filter);

// Kinematic nodes that begin_frame() found awake move at their own velocity: how far they turned by a substep's begin,
// for the levers of what they touch in the group being solved, ...
void turn_kinematic(System& system, const Nodes& nodes, double time);
// ... where they are after `time` of the frame, as the solvers see them, ...
void shift_kinematic(System& system, const Nodes& nodes, double time);
// ... and, once all groups are done, in the state.
void commit_kinematic(const System& system, Nodes& nodes, double time_step);

}  // namespace taut
