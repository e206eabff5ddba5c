// Contacts between grains in lanes: kLanes of one colour side by side, of which no two share a moving node. Nothing
// turns, so that the effective mass is the same all ways, 1/(1/m_a + 1/m_b), and friction is a vector across the
// normal. 68 bytes a contact.
#pragma once

#include "constraints/contact_lanes.h"

namespace taut {

struct alignas(64) GrainGroup {
    uint32_t a[kLanes], b[kLanes];  // seats; 0 in an empty lane
    uint32_t contact[kLanes];       // in Grains::contact, kNoLanes in an empty lane
    float normal[3][kLanes];        // from a to b
    float inv_mass[2][kLanes];      // of a and b [1/kg]
    float gap0[kLanes];             // as the frame began [m]
    float gap[kLanes];              // at the start of the substep; the first biased sweep measures it
    float friction[kLanes];
    float hits[kLanes];      // 1: approached faster than SweepTerms::hit before the frame's forces
    float impulse[kLanes];   // along the normal [N s]
    float slide[3][kLanes];  // of friction, world axes [N s]
};

// Lane groups of one colour.
struct GrainPass {
    uint32_t begin, end;    // in GrainLanes::group
    bool overflow;          // they share moving nodes
    uint32_t first, count;  // in Group::grains
};

struct GrainLanes {
    explicit GrainLanes(Memory& memory) : group(memory), pass(memory) {}

    UnsetArray<GrainGroup> group;
    Array<GrainPass> pass;
};

// The sweeps of lanes [begin, end): the same rows as those of contacts (contact_sweep.inl), of points that do not turn.
// Four builds of one source give the same bits.
struct GrainKernels {
    const char* name;
    void (*warm_start)(const GrainGroup*, uint32_t begin, uint32_t end, SweepNode*);
    // shifts: gaps follow from them; null: they are as measured before.
    void (*sweep_biased)(GrainGroup*, uint32_t begin, uint32_t end, SweepNode*, const SweepShift*, const SweepTerms&);
    void (*sweep_relaxed)(GrainGroup*, uint32_t begin, uint32_t end, SweepNode*, const SweepTerms&);
};

extern const GrainKernels kGrainKernelsScalar, kGrainKernelsBase, kGrainKernelsAvx2, kGrainKernelsAvx512;
// The widest that this machine runs.
const GrainKernels& grain_kernels();

}  // namespace taut
