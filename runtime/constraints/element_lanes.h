// Elements between particles in lanes: kLanes of one set side by side, no two of which share a moving node. Their fused
// sweep evaluates them where it moves them to, x_n + h u, and solves the rows of each as one block (nonlinear
// Gauss-Seidel; Macklin et al. 2016, XPBD, in impulses):
//   dmu = -(S (h + d) + c)^-1 (C(x_n + h u) + d J u + c mu),   u += W J^T dmu,   S = J W J^T,   c = C / t
// with d and t as in scheme.h. mu begins each substep at 0: carried over it would sum up what sweeps leave of C, as
// joint_sweep.inl tells. A substep therefore yields by what its sweeps leave, which falls as h^2.
#pragma once

#include "constraints/element_kernels.h"
#include "constraints/joint_lanes.h"

namespace taut {

struct ElementSet;

constexpr uint32_t kMostLaneNodes = 4, kMostLaneRows = 3;  // of types with a fused sweep
constexpr uint32_t kMostLaneSquare = triangle(kMostLaneRows, 0);

// Lanes of numbers follow each other: where nodes 1, 2, ... were against node 0 as the frame began [3], the type's
// numbers, softness, impulses of rows, yield: by how much what a row carries has moved its nodes within the substep, as
// a strain.
struct ElementGroup {
    uint32_t node[kMostLaneNodes][kLanes];  // seats; 0 in an empty lane
    uint32_t element[kLanes];               // of the set, kNoLanes in an empty lane
    uint32_t set;                           // in ElementLanes::set and material
    uint32_t first;                         // in ElementLanes::number
};

// What the lanes of a set have in common.
struct LaneMaterial {
    float compliance[kMostLaneSquare];  // of a unit of the material, lower triangle [m/N per unit]
    float relaxation;                   // d [s]
    float pulls;                        // 1: lambda <= 0
};

struct ElementView {
    const ElementGroup* group;
    const LaneMaterial* material;
    LaneScalar* number;
};

// Of a substep.
struct ElementTerms {
    float h, inv_act;  // [s], 1/t [1/s]
    bool first;        // impulses are 0 before this sweep
};

// Lane groups that share no moving node, of one type.
struct ElementPass {
    ElementSweep ElementKernels::*sweep;
    uint32_t begin, end;  // in ElementLanes::group
    bool overflow;        // they share moving nodes after all
};

struct ElementLanes {
    explicit ElementLanes(Memory& memory)
        : group(memory), number(memory), material(memory), set(memory), pass(memory) {}

    Array<ElementGroup> group;
    LanePlaces<LaneScalar> number;
    Array<LaneMaterial> material;  // of each set of the world
    Array<ElementSet*> set;        // likewise
    Array<ElementPass> pass;       // in the order of a sweep

    ElementView view() { return {group.data(), material.data(), number.data()}; }
};

}  // namespace taut
