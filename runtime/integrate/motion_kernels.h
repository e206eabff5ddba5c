// Motion over a substep of kBodies nodes side by side, in two builds of one source with the same bits: for every
// machine and for AVX2. Each node comes out as it would with any others beside it.
#pragma once

#include <cstdint>

namespace taut {

constexpr int kBodies = 4;

// A node's numbers as the kernels see them. Plain ones, for inline functions of Eigen must not come from a build for
// one processor; integrate.cpp holds them against the types that they are.
struct MotionRow {  // NodeMotion
    double x[3], pad, q[4], v[3], w[3], slow_v[3], slow_w[3];
};
struct MassRow {  // NodeMass up to its numbers' end
    double mass, inv_mass, inertia[6], inv_inertia[6], centre[3], gravity_scale;
};
struct PairRow {  // Velocity, NodeLoad
    double linear[3], angular[3];
};
struct PoseRow {  // Pose, R by columns
    double x[3], R[9];
};
struct FoundRow {  // System::Found
    double x[3], pad, q[4];
};
struct FloatRow {  // SweepShift, SweepPose, SweepVelocity
    float linear[4], angular[4];
};
struct SweepRow {  // SweepNode
    FloatRow velocity;
    float mass[8];
};

struct NodeRows {
    MotionRow* motion;    // by Batch::motion
    const PairRow* load;  // by node; null where nothing was put on any
    // By seat.
    PoseRow* pose;
    PairRow* velocity;
    PairRow* start;
    const FoundRow* found;
    FloatRow* shift;
    SweepRow* sweep;
    FloatRow* sweep_pose;  // null where there are no joints
};

// A bit for each of kBodies nodes.
using Bodies = uint32_t;

// Nodes that are worked on side by side. Where there are fewer the last stands for what is missing: it comes out the
// same each time.
struct Batch {
    uint32_t node[kBodies], seat[kBodies], motion[kBodies];
    uint32_t count;
};

struct Prediction {
    double h, gravity[3];  // [s, m/s^2]
    double turn;           // [rad]
    // w after h of gyroscopic torque in body axes, of links of blocks and where the midpoint rule is not solved.
    void (*damp)(double w[3], const double inertia[6], double h, bool damped);
};

// exp(theta) for turns of more than half a radian.
using Rotate = void (*)(const double theta[3], double q[4]);

struct Keeping {
    double h, turn;      // [s], [rad]
    double kappa, most;  // [1]; [m/s, rad/s]
    Rotate rotate;
};

struct MotionKernels {
    // Poses from motions; v* = v + h (g + f/m), beside it in the sweeps the inverse mass; of `turning` w* = m, the mean
    // spin of the substep, by the implicit midpoint rule in body axes, I (w - w0) + h m x I m = 0, m = (w + w0)/2, or w
    // by damp(). Starts: v and w*. Gives those that turned by more than `turn` from where their contacts were found.
    Bodies (*predict)(const NodeRows&, const Batch&, const MassRow* const mass[kBodies], const Prediction&,
                      Bodies turning, Bodies damped);
    // x += h v, q = exp(h w) q, and how far that is from where contacts were found.
    void (*commit)(const NodeRows&, const Batch&, double h, Rotate rotate);
    // Solved velocities into motions; of `turning` that turned by more than `turn` [rad] in this substep the spin at
    // its end, which keeps I w in the world but for what the solver gave; `damped` as predicted. kappa: of the
    // low-passed velocities of those `slow`. Gives those whose motion is finite and not faster than `most` [m/s,
    // rad/s].
    Bodies (*store)(const NodeRows&, const Batch&, const MassRow* const mass[kBodies], const Keeping&, Bodies turning,
                    Bodies damped, Bodies slow);
    // The same of nodes that are all particles, which have no rotation: the same bits for less.
    void (*predict_points)(const NodeRows&, const Batch&, const MassRow* const mass[kBodies], const Prediction&);
    void (*commit_points)(const NodeRows&, const Batch&, double h);
    Bodies (*store_points)(const NodeRows&, const Batch&, const Keeping&, Bodies slow);
};

extern const MotionKernels kMotionKernelsBase, kMotionKernelsAvx2;
// The wider that this machine runs.
const MotionKernels& motion_kernels();

}  // namespace taut
