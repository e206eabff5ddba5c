// Swept joints in lanes: kLanes of one colour and type side by side, no two of which share a moving node. The rows that
// lock are solved as one block a joint, stops, drives and friction after them one by one.
#pragma once

#include "constraints/contact_lanes.h"
#include "constraints/sizes.h"

namespace taut {

struct ConstraintType;

struct alignas(64) LaneScalar {
    float value[kLanes];
};

// By seat, as SweepVelocity.
struct alignas(32) SweepPose {
    float dx[3] = {0, 0, 0};    // translation since the frame began [m]
    float inv_mass = 0;         // of SweepMass, for who wants no more [1/kg]
    float q[4] = {0, 0, 0, 1};  // world from body: x, y, z, w
};

// JointFrames in lanes. An end that stays where it is in this frame, which may be far from its node, is in `apart`.
struct alignas(32) LaneFrames {
    float anchor[2][3][kLanes];  // relative to the centre of mass, body axes [m]; of such an end 0
    float frame[2][4][kLanes];   // body from joint frame: x, y, z, w
    float apart[3][kLanes];      // as the frame began, from node to node [m]; from the anchor of such an end
};

struct JointGroup {
    const ConstraintType* type;
    uint32_t node[kMaxNodes][kLanes];  // index into arrays by seat
    uint32_t block[kLanes];            // in Rows::block, kNoLanes for an empty lane
    uint32_t nodes, rows;              // of the type
    uint32_t held;                     // rows up to the last that a lane locks
    uint32_t first_turn;               // rows from here on move nothing, they turn alone: J_b = -J_a = (0, g)
    uint32_t first_row;                // in LaneRow
    uint32_t first_jacobian;           // in jacobian: [node][row][6]
    uint32_t first_factor;             // in factor: S + c = L D L^T, row by row the lower triangle, 1/D on the diagonal
    uint32_t first_compliance;         // in compliance: c, likewise; kNoLanes: no row of a lane is elastic
    uint32_t first_axis, axes;         // in LaneAxis and LaneAxisLaw
    uint32_t first_frames;             // in LaneFrames, one; kNoLanes: the type is not evaluated in lanes
};

struct alignas(64) LaneRow {
    float locked[kLanes];     // 1: solved with the block
    float bias[kLanes];       // of locked rows J v + c p while positions are corrected [m/s]; zero for the others
    float kept_bias[kLanes];  // likewise of the velocity that is kept
    float own[kLanes];        // J W J^T [1/kg or 1/(kg m^2)]
    float impulse[kLanes];    // of the row, stops, drive and friction included [N s]
    float kept[kLanes];       // what it is once the positions are corrected [N s]
};

// What a row's bias comes from.
struct alignas(32) LaneCoordinate {
    float value[kLanes];         // C [m or rad]; prepare() adds what of the drift has come
    float rate[kLanes];          // of elastic rows, J v + c p = -rate C [1/s]; 0 for the others
    float drift[kLanes];         // of C in this frame [m or rad] ...
    float damped_drift[kLanes];  // ... and what damping adds; see evaluate_rows()
};

// K of a group's forces against the turning of its ends, at most [N m].
struct alignas(64) LaneStiffness {
    float of[2][kLanes];
};

constexpr uint32_t kDriving = 2, kRubbing = 3;  // AxisRow::part
constexpr float kUnlimited = 1e30f;             // LaneAxis::most

// A stop, drive or friction along a row: sign J v + c mu = target, least <= mu <= most. Empty places have no mass.
// c = max(compliance, softness J W J^T) of its law.
struct alignas(64) LaneAxis {
    float sign[kLanes];
    float mass[kLanes];  // 1 / (k + c); 0 where it does nothing in this substep
    float compliance[kLanes];
    float target[kLanes], relaxed_target[kLanes];  // [m/s]
    float least[kLanes], most[kLanes];             // [N s]
    float impulse[kLanes], kept[kLanes];           // [N s]
    float* force[kLanes];                          // where impulse / h belongs, null for an empty place
    uint32_t row;
    uint32_t part;  // AxisRow::part
    uint32_t used;  // 0: in no lane in this substep
};

// How its target follows C, taken in the turn that is nearest to `near`:
//   gap = sign (C - at),   target = min(base - rate gap, push),   rate = open where gap > 0, else closed or relaxed
struct alignas(32) LaneAxisLaw {
    float filled[kLanes];                                 // 0: an empty place
    float near[kLanes], turn[kLanes];                     // [m or rad]; turn: 2 pi, or 0 where C is taken as it is
    float at[kLanes];                                     // [m or rad]
    float base[kLanes], push[kLanes];                     // [m/s]
    float open[kLanes], closed[kLanes], relaxed[kLanes];  // [1/s]
    float friction[kLanes];                               // of a part that is one: most torque or force, by h [N s]
    float reach[kLanes];                                  // with a larger gap and no impulse it does nothing [m or rad]
    float compliance[kLanes], softness[kLanes];           // [1/kg], [1]
};

// What the kernels see.
struct JointView {
    const JointGroup* group;
    LaneRow* row;
    LaneCoordinate* coordinate;
    LaneAxis* axis;
    const LaneAxisLaw* law;
    const LaneScalar* jacobian;
    LaneScalar* factor;
    const LaneScalar* compliance;
    LaneStiffness* stiffness;
};

// What groups have of one kind in this frame, one after the other.
template <class T>
class LanePlaces {
public:
    explicit LanePlaces(Memory& memory) : all_(memory) {}

    void clear() { taken_ = 0; }
    uint32_t taken() const { return taken_; }
    // The next places, with whatever an earlier frame left there; the first of them.
    uint32_t take(uint32_t count) {
        const uint32_t first = taken_;
        taken_ += count;
        if (all_.size() < taken_) all_.resize(taken_);
        return first;
    }
    T& operator[](uint32_t place) { return all_[place]; }
    const T& operator[](uint32_t place) const { return all_[place]; }
    T* data() { return all_.data(); }

private:
    Array<T> all_;
    uint32_t taken_ = 0;
};

struct JointLanes {
    explicit JointLanes(Memory& memory)
        : group(memory),
          row(memory),
          coordinate(memory),
          axis(memory),
          law(memory),
          frames(memory),
          jacobian(memory),
          factor(memory),
          compliance(memory),
          stiffness(memory),
          colour_begin(memory),
          node_stiffness(memory) {}

    Array<JointGroup> group;
    LanePlaces<LaneRow> row;
    LanePlaces<LaneCoordinate> coordinate;  // one for each row
    LanePlaces<LaneAxis> axis;
    LanePlaces<LaneAxisLaw> law;  // one for each axis
    LanePlaces<LaneFrames> frames;
    LanePlaces<LaneScalar> jacobian, factor, compliance;
    LanePlaces<LaneStiffness> stiffness;  // one for each group
    Array<uint32_t> colour_begin;  // first group of each colour, of joints, then of elements; and one past the last
    Array<float> node_stiffness;   // by seat [N m], -1: applied; stiffen_joints()

    JointView view() {
        return {group.data(),    row.data(),    coordinate.data(), axis.data(),     law.data(),
                jacobian.data(), factor.data(), compliance.data(), stiffness.data()};
    }
};

// Of a lower triangle kept row by row.
constexpr uint32_t triangle(uint32_t row, uint32_t column) { return row * (row + 1) / 2 + column; }

// The sweep over lanes [begin, end) of groups. Four builds of one source give the same bits: scalar, SSE2,
// AVX2, AVX-512.
struct JointKernels {
    const char* name;
    // From impulses and Jacobian, for substeps of length h [s].
    void (*stiffen)(JointView, uint32_t begin, uint32_t end, float h);
    // From coordinates, Jacobian and compliance: biases, targets, factors and masses. frame_left: share of the frame
    // after this substep.
    void (*prepare)(JointView, uint32_t begin, uint32_t end, const SweepNode*, float frame_left, const SweepTerms&);
    void (*warm_start)(JointView, uint32_t begin, uint32_t end, SweepNode*);
    // Towards the velocity that is kept.
    void (*sweep)(JointView, uint32_t begin, uint32_t end, SweepNode*);
    // From there to the velocity that moves the positions, with what closes gaps and the push of stops: before the
    // first of these sweeps what is kept is noted; and, after the positions moved, the way back to it.
    void (*keep)(JointView, uint32_t begin, uint32_t end);
    void (*correct)(JointView, uint32_t begin, uint32_t end, SweepNode*);
    void (*take_back)(JointView, uint32_t begin, uint32_t end, SweepNode*);
    // Largest |J v + c p - bias| of the locked rows [m/s or rad/s].
    float (*residual)(JointView, uint32_t begin, uint32_t end, const SweepNode*);
};

extern const JointKernels kJointKernelsScalar, kJointKernelsBase, kJointKernelsAvx2, kJointKernelsAvx512;
// The widest that this machine runs.
const JointKernels& joint_kernels();

}  // namespace taut
