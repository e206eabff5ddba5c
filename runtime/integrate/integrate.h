// Time integration around the solve: implicit Euler on velocities, positions from the solved ones.
#pragma once

#include "partition/partition.h"
#include "system/impacts.h"
#include "threads/team.h"

namespace taut {

// Once a frame: seats of what it goes through and of System::reached, their poses, still shifts, inverse masses of
// nodes that do not turn theirs.
void begin_frame(Team& team, System& system, const Partition& partition, const Nodes& nodes, bool tied);
// Within it, of what is reached since.
void seat_reached(System& system, const Nodes& nodes);

// While it lasts, the motions of a group are not in the state but where threads do not meet: System::motion. Blocks and
// loads need them in the state.
class MotionLoan {
public:
    MotionLoan(Team& team, System& system, const Group& group, Nodes& nodes)
        : team_(team), system_(system), group_(group), nodes_(nodes) {}
    ~MotionLoan() { end(); }
    MotionLoan(const MotionLoan&) = delete;
    MotionLoan& operator=(const MotionLoan&) = delete;

    void begin();  // where it has not; throws std::bad_alloc
    void end();    // where it lasts

private:
    Team& team_;
    System& system_;
    const Group& group_;
    Nodes& nodes_;
};

// v* = v + h (g + f/m); w* = w + h I^-1 torque, with the gyroscopic torque implicit; damped and limited where nodes
// are.
void predict(Team& team, System& system, const Group& group, Nodes& nodes, const Vec3& gravity);

// Of nodes whose paths impacts moved: x to where they begin, or shifts as they were.
void commit_strikes(System& system, const Impacts& impacts, Nodes& nodes);
void drop_strikes(System& system, const Impacts& impacts);

// x += h v, q = exp(h w) q; what the contacts' anchors need to follow.
void commit(Team& team, System& system, const Group& group, Nodes& nodes);

// x += dx, q = exp(dq) q for nodes of blocks marked corrected.
void correct(System& system, const Group& group, const Array<Block>& blocks, Nodes& nodes);

// Pose at a seat where a substep begins or ends: as it is in the state, or that of a kinematic node now.
Pose pose_between(const System& system, const Nodes& nodes, uint32_t at);
// Joints whose types follow the turns of their nodes, which commit() made.
void follow_joints(const System& system, const Nodes& nodes);

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
