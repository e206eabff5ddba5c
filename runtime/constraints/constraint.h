// The contract between constraints and everything that solves them.
//
// A constraint type answers, for one instance and at any poses a solver asks about:
//   C(x)        coordinates: what a row locks at 0, limits or drives (axis.h)   [m, rad or 1]     rows
//   J = dC/dx   Jacobian                        [1 or m]          nodes x rows x 6
//   K = -dJ^T/dx lambda   geometric stiffness   [N/m .. N m]      (6 nodes) x (6 nodes)
// and knows no solver. Adding one is one file and one line in list.cpp. Coordinates of a node are its
// translation and a rotation vector on the left (world axes), v and w in rates; a particle uses the first
// three. lambda is a force: J^T lambda [N, N m] acts on the nodes (Tournier et al. 2015, eq. 7 and 21).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/math.h"
#include "constraints/sizes.h"
#include "simd/width.h"

namespace taut {

// Where a node is: centre of mass and rotation. A particle and the world have R = I; the world has x = 0.
struct Pose {
    Vec3 x = Vec3::Zero();
    Mat3 R = Mat3::Identity();
};

// Which part of the geometric stiffness to return.
enum class Curvature {
    raw,       // exact -dJ^T/dx lambda; not symmetric for rotations (Tournier et al. 2015, eq. 22)
    positive,  // symmetric, positive semi-definite and not below the symmetric part of raw: that part's positive
               // projection, or a bound of it where the projection has no closed form
};

// What lambda may be.
enum class Bound : uint8_t {
    free,  // equality: any lambda
    cone,  // row 0 >= 0, rows 1 and 2 within friction * row 0
    load,  // row 0, and rows 1 and 2, each within an arm times the normal impulses of the contact that they belong to
};

// The line that a constraint keeps taut between two nodes: from the end of a lever on a to the end of one on b [m].
struct Line {
    Vec3 span, lever_a, lever_b;
};

struct LaneFrames;  // joint_lanes.h
struct LaneScalar;

struct ConstraintType {
    const char* name;
    int rows;          // 1 to 6
    int nodes;         // 1 to 4; of elements to 8
    size_t data_size;  // of plain numbers without gaps between them: its bytes are hashed and saved
    Bound bound;
    bool couples_nodes;  // K has blocks between different nodes, beside the diagonal ones
    uint8_t angular;     // bit r: row r is an angle [rad], its lambda a torque [N m]

    // error: rows; jacobian: [nodes][rows][6], may be null when only the error is asked for.
    void (*evaluate)(const void* data, const Pose* x, double* error, double* jacobian);
    // k: [6 nodes][6 nodes], row-major, overwritten.
    void (*stiffness)(const void* data, const Pose* x, const double* lambda, Curvature part, double* k);
    // Compliance of the rows as one block [rows][rows], row-major [m/N], that outlives the step; symmetric and
    // positive definite. Null: the owner gives one number for all rows, 0 when rigid.
    const double* (*compliance)(const void* data);
    // An instance with random but valid data and poses around it, for the tests that loop over the list.
    void (*sample)(uint64_t seed, void* data, Pose* x);
    // Where K resists the turning of a line between its nodes, which their own rotations do not describe; else null.
    Line (*line)(const void* data, const Pose* x) = nullptr;
    // Of types whose data are JointFrames, or BallData where they have no angles, and whose angles, the last rows, turn
    // their nodes against each other alone: J_b = -J_a = (0, g). C and J of kLanes instances at once, in floats; else
    // null. pose: of both ends in each lane, a SweepPose. jacobian: [2][rows][6], of which the zeros of rows that turn
    // are not written.
    void (*evaluate_lanes)(const LaneFrames& frames, const float* const (&pose)[2][kLanes], LaneScalar* error,
                           LaneScalar* jacobian) = nullptr;
    // Bit r: sweeps leave out stops, drives and friction along row r. Its direction may turn about from one substep to
    // the next, and what they carry over is then a push.
    uint8_t unswept = 0;
    // Of types whose coordinates count turns, which poses do not tell: their past, within data; else null. restart: C
    // is 0 at these poses. follow: the nodes came to these by turns within the last substep [rad, world axes], [nodes].
    void (*restart)(void* data, const Pose* x) = nullptr;
    void (*follow)(void* data, const Pose* x, const Vec3* turned) = nullptr;

    bool swept(uint32_t r) const { return (unswept >> r & 1) == 0; }
};

// Every type there is; tests, hash and assembly loop over it.
std::span<const ConstraintType* const> constraint_types();

extern const ConstraintType kBall;
extern const ConstraintType kDistance;
extern const ConstraintType kBend;
extern const ConstraintType kContact;
extern const ConstraintType kSpanContact;
extern const ConstraintType kRolling;
// Between joint frames (joint_frames.h); their coordinates are stated in their files.
extern const ConstraintType kFixed;
extern const ConstraintType kHinge;
extern const ConstraintType kSlider;
extern const ConstraintType kCylindrical;
extern const ConstraintType kUniversal;
extern const ConstraintType kConeTwist;
extern const ConstraintType kSixDof;
extern const ConstraintType kWheel;
// Between two bodies and the one that guides both, the third node (coupled_pair.h).
extern const ConstraintType kGear;
extern const ConstraintType kRackPinion;
extern const ConstraintType kPulley;

}  // namespace taut
