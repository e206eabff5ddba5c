// What a joint says at the present poses: coordinates, rates, errors, what it carries. For reading, not for the solve.
#pragma once

#include "state/joints.h"

namespace taut {

// What the data of joints begins with, an anchor for each of its nodes: relative to the centre of mass, body axes;
// world position of a null end [m]. A type that takes particles alone may have none.
struct JointAnchors {
    Vec3 a, b;
};
Vec3 anchor_of(const Joint& joint, int end);
void set_anchor(Joint& joint, int end, const Vec3& anchor);

// Pose of a node; kNone and particles are unturned.
Pose pose_of(const Nodes& nodes, uint32_t node);
Vec3 world_anchor(const Nodes& nodes, const Joint& joint, int end);

struct JointReading {
    Pose pose[kMaxEnds];
    double value[kMaxRows] = {};                       // coordinates [m or rad]
    double jacobian[kMaxEnds * kMaxRows * kDof] = {};  // [end][row][6]
};

JointReading read_joint(const Nodes& nodes, const Joint& joint);

// Of a joint whose type counts turns: it begins anew where it is.
void restart(const Nodes& nodes, Joint& joint);
// The joint's ends did not come to their poses by motion: it begins anew there, angles between stops are read anew.
void place_anew(const Nodes& nodes, Joint& joint);

inline bool is_angle(const Joint& joint, int row) { return (joint.type->angular >> row & 1) != 0; }
inline bool is_locked(const Joint& joint, int row) { return joint.axis[row].mode == AxisMode::locked; }
// Of a locked row [m/N or rad/(N m)].
inline double row_compliance(const Joint& joint, int row) {
    return is_angle(joint, row) ? joint.angular_compliance : joint.compliance;
}
inline bool is_rigid(const Joint& joint, int row) { return is_locked(joint, row) && row_compliance(joint, row) == 0; }

// d(coordinate)/dt [m/s or rad/s].
double rate_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row);
// J W J^T of one row: inverse of the mass that its nodes alone set against it [1/kg or 1/(kg m^2)].
double inverse_mass_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row);
// Whether a row moves nothing of what it would without locked axes.
bool is_blocked(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row);
// The same while the joint's locked rows hold: what is left of J W J^T when they are eliminated. Of a hinge's angle:
// the inertia about the hinge, not that about the centre of mass.
double held_inverse_mass_of(const Nodes& nodes, const Joint& joint, const JointReading& reading, int row);
// How far a coordinate is beyond the stops of its row, an angle in the turn that it came to; 0 within.
double overrun_of(const Joint& joint, const double* value, int row);

// Of locked rows their coordinates, of limited rows their overrun.
struct JointError {
    double linear, angular;  // [m], [rad]
};
JointError error_of(const Joint& joint, const JointReading& reading);
// JointError::linear without a reading, at the present poses [m].
double gap_of(const Nodes& nodes, const Joint& joint);

// On end b about its anchor, world axes, of a joint of two nodes; zero of one that was not solved yet.
struct Wrench {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  // [N], [N m]
};
Wrench wrench_of(const Joint& joint, const JointReading& reading);

}  // namespace taut
