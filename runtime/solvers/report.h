// What the solves of a step leave, in metres and joules, by island and substep, beside what the partition decided.
// Measured after the fact and only where a world asks for it: it goes through all rows once more.
//
//   yield          s h^2 w |f|   by which a swept row gives way under its force f; w = J W J^T, s: softness of the
//                                sweeps, .405 of contacts and .025 of joints (constraints/soft_contact.h)
//   residual       h |dv|        dv: what one more pass would change of J v along a row, its own bounds kept. Of direct
//                                rows |J v + c mu - target|; that of direct contacts, which rounds end, is not known
//   linearisation  |C(x + h v) - C(x) - h J v|   of locked rows, and of contacts that bear something
//   energy         KE+ - KE - W  W: work of gravity and loads, of springs, drives and stops, and of kinematic bodies.
//                                What rigid rows take away, and plain damping, makes it negative
//
// Rows that are angles have no length and are left out, but for their energy.
#pragma once

#include "partition/partition.h"
#include "state/joints.h"
#include "system/system.h"

namespace taut {

struct IslandReport {
    uint32_t island = 0, substep = 0;
    uint32_t bodies = 0, rows = 0, direct_rows = 0;
    uint32_t substeps = 0, sweeps = 0;       // that the partition gave it
    uint8_t reasons = 0;                     // why rows are direct: bits, Partition::find_reasons()
    double h = 0;                            // [s]
    double yield = 0;                        // largest of swept rows [m]
    double direct_yield = 0;                 // likewise of direct rows, had they been swept with the same force [m]
    double residual = 0, linearisation = 0;  // largest [m]
    double energy = 0;                       // [J]
};

// A joint or a contact point that bears something.
struct RowYield {
    uint32_t island, substep;
    bool direct, contact;
    float yield;   // largest of its rows, as if swept [m]
    float margin;  // contact margin of its pair; of a joint 0 [m]
};

// What a substep is measured by; see Substep.
struct Measured {
    const System& system;
    const Group& group;
    const Partition& partition;
    const Nodes& nodes;
    const Pairs& pairs;
    Vec3 gravity;
    uint32_t substep;
};

class SolveReports {
public:
    explicit SolveReports(Memory& memory)
        : islands(memory), rows(memory), reasons_(memory), open_(memory), before_(memory), mean_(memory) {}

    void begin_step(const Partition& partition, const Joints& joints, const Elements& elements);
    // Before forces act; once more where a substep is taken again.
    void begin(const Measured& m);
    // After the solve, before positions move.
    void solved(const Measured& m);
    // With the velocities that are kept.
    void end(const Measured& m);

    Array<IslandReport> islands;  // of the step: those with rows, substep by substep of each group
    Array<RowYield> rows;         // likewise

private:
    struct Measure;

    Array<uint8_t> reasons_;         // by island
    Array<IslandReport> open_;       // by island, of this substep
    Array<Velocity> before_, mean_;  // by seat: at the start of the substep; of that and of its end the middle
};

}  // namespace taut
