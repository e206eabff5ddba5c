// Swept joints in lanes: kLanes of one colour and type side by side, no two of which share a moving node. The rows that
// lock are solved as one block a joint, stops, drives and friction after them one by one.
#pragma once

#include "constraints/constraint.h"
#include "constraints/contact_lanes.h"

namespace taut {

struct alignas(64) LaneScalar {
    float value[kLanes];
};

struct JointGroup {
    uint32_t node[kMaxNodes][kLanes];  // index into arrays by node
    uint32_t block[kLanes];            // in Rows::block, kNoLanes for an empty lane
    uint32_t nodes, rows;              // of the type
    uint32_t first_row;                // in LaneRow
    uint32_t first_jacobian;           // in jacobian: [node][row][6]
    uint32_t first_factor;             // in factor: S + c = L D L^T, row by row the lower triangle, 1/D on the diagonal
    uint32_t first_compliance;         // in compliance: c, likewise; kNoLanes: no row of a lane is elastic
    uint32_t first_axis, axes;         // in LaneAxis
};

struct alignas(64) LaneRow {
    float locked[kLanes];   // 1: solved with the block
    float rigid[kLanes];    // 1: locked without compliance, so softened while positions are corrected
    float bias[kLanes];     // J v that is wanted: locked rows against it [m/s]; zero for the others
    float impulse[kLanes];  // of the row, stops, drive and friction included [N s]
};

// A stop, drive or friction along a row: sign J v + c mu = target, least <= mu <= most. Empty places have no mass.
struct alignas(64) LaneAxis {
    float sign[kLanes];
    float mass[kLanes];  // 1 / (k + c); before prepare(): 1 in a filled place
    float compliance[kLanes];
    float target[kLanes], relaxed_target[kLanes];  // [m/s]
    float least[kLanes], most[kLanes];             // [N s]
    float impulse[kLanes];                         // [N s]
    float* force[kLanes];                          // where impulse / h belongs, null for an empty place
    uint32_t row;
    uint32_t part;  // AxisRow::part
    uint32_t used;  // 0: in no lane in this substep
};

// What the kernels see.
struct JointView {
    const JointGroup* group;
    LaneRow* row;
    LaneAxis* axis;
    const LaneScalar* jacobian;
    LaneScalar* factor;
    const LaneScalar* compliance;
};

struct JointLanes {
    explicit JointLanes(Memory& memory)
        : group(memory),
          row(memory),
          axis(memory),
          jacobian(memory),
          factor(memory),
          compliance(memory),
          colour_begin(memory) {}

    Array<JointGroup> group;
    Array<LaneRow> row;
    Array<LaneAxis> axis;
    Array<LaneScalar> jacobian, factor, compliance;
    Array<uint32_t> colour_begin;  // first group of each colour, and one past the last

    JointView view() {
        return {group.data(), row.data(), axis.data(), jacobian.data(), factor.data(), compliance.data()};
    }
};

// Of a lower triangle kept row by row.
constexpr uint32_t triangle(uint32_t row, uint32_t column) { return row * (row + 1) / 2 + column; }

// The sweep over lanes [begin, end) of groups. Three builds of one source give the same bits: scalar, SSE2, AVX2.
struct JointKernels {
    const char* name;
    // Factors and masses from the Jacobian and the compliance.
    void (*prepare)(JointView, uint32_t begin, uint32_t end, const SweepMass*);
    void (*warm_start)(JointView, uint32_t begin, uint32_t end, SweepVelocity*, const SweepMass*);
    void (*sweep_biased)(JointView, uint32_t begin, uint32_t end, SweepVelocity*, const SweepMass*, const SweepTerms&);
    // Same rows without the bias and softness of rigid ones and the push of stops.
    void (*sweep_relaxed)(JointView, uint32_t begin, uint32_t end, SweepVelocity*, const SweepMass*);
};

extern const JointKernels kJointKernelsScalar, kJointKernelsSse2, kJointKernelsAvx2;
// The widest that this machine runs.
const JointKernels& joint_kernels();

}  // namespace taut
