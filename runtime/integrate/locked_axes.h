// Motion of bodies with locked axes within a substep: what of it is not free, and spins about two axes of the world.
#pragma once

#include "integrate/motion_kernels.h"
#include "partition/partition.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

// v* and w* of a group's bodies with locked axes, without what gravity and loads would give there; and of those that
// turn about two axes the mean spin of the substep, half way between that at its begin and that at its end. After the
// kernels' prediction; motion: by seat where motions are lent, else by node.
void hold_velocities(Team& team, System& system, const Group& group, const Nodes& nodes, const NodeMotion* motion);

// Velocities that a solver found, without what is locked: a direct solve has that as something heavy.
void hold_solution(Team& team, const System& system, const Group& group, const Nodes& nodes, Array<Velocity>& velocity);

// Spins at the end of a substep of a batch's bodies that turn about two axes; made before the kernels overwrite those
// at its begin.
struct HeldSpins {
    HeldSpins(const System& system, const Nodes& nodes, const Batch& batch, const NodeMotion* motion);
    void put(const Batch& batch, NodeMotion* motion) const;

private:
    Bodies some_ = 0;
    Vec3 w_[kBodies];
};

// Rotations of a batch's bodies that do not turn at all, which even a unit quaternion's rounding leaves as they are.
struct HeldTurns {
    HeldTurns(const Nodes& nodes, const Batch& batch, const NodeMotion* motion);
    void put(const Batch& batch, NodeMotion* motion) const;

private:
    Bodies some_ = 0;
    Quat q_[kBodies];
};

}  // namespace taut
