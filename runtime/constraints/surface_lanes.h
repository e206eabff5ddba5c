// Contacts of surfaces in lanes: kLanes of one colour side by side, of which no two share a moving node. Of up to four
// nodes the first may turn, and has a lever then; the others are particles, of which v alone counts:
//   C = n . sum w_i p_i,  J_i = w_i n^T (I, -hat lever),  1 / k = sum w_i^2 / m_i + w_0^2 (lever x n) . I^-1 (lever x
//   n)
// 124 bytes a contact, and 48 more where a lane of its group has a lever.
#pragma once

#include "constraints/contact_lanes.h"

namespace taut {

constexpr uint32_t kSurfaceNodes = 4;

struct alignas(64) SurfaceGroup {
    uint32_t node[kSurfaceNodes][kLanes];   // seats; 0 in an empty lane and where there is none
    uint32_t contact[kLanes];               // in SurfaceContacts::contact, kNoLanes in an empty lane
    float weight[kSurfaceNodes][kLanes];    // 0 where there is no node
    float inv_mass[kSurfaceNodes][kLanes];  // of the nodes [1/kg]
    float normal[3][kLanes], tangent[3][kLanes];
    float gap0[kLanes];  // as the frame began [m]
    float gap[kLanes];   // at the start of the substep; the first biased sweep measures it
    float friction[kLanes];
    float normal_mass[kLanes];  // 1 / k along the normal [kg]
    float drive[2][kLanes];     // what friction drives the slip along the tangents to [m/s]
    float impulse[3][kLanes];   // normal, tangent 1, tangent 2 [N s]
    float peak[kLanes];         // largest normal impulse of the frame [N s]
    float approach[kLanes];     // normal velocity before the frame's forces [m/s], negative when closing
    float restitution[kLanes];
    uint32_t turning = kNoLanes;  // in SurfaceTurning; kNoLanes: no first node of a lane turns
    uint32_t bounces = 0;         // 1: some contact has restitution
};

struct alignas(64) SurfaceTurning {  // of first nodes; lanes of particles have zero levers
    float lever[3][kLanes];          // from the centre of mass, world axes [m]
    float skin[3][kLanes];           // the part of it that does not turn; state/levers.h [m]
    float friction_mass[3][kLanes];  // inverse of the 2x2 tangential block: 11, 22, 12 [kg]
    float isotropic_mass[kLanes];    // 1 / its larger eigenvalue [kg]
    float coupling[2][kLanes];       // slip along the tangents by a normal impulse of one [1/kg]
};

// What the kernels see.
struct SurfaceView {
    SurfaceGroup* group;
    SurfaceTurning* turning;
};

// Lane groups of one colour.
struct SurfacePass {
    uint32_t begin, end;    // in SurfaceLanes::group
    bool overflow;          // they share moving nodes
    uint32_t first, count;  // in Group::surfaces
};

struct SurfaceLanes {
    explicit SurfaceLanes(Memory& memory) : group(memory), turning(memory), pass(memory) {}

    UnsetArray<SurfaceGroup> group;
    UnsetArray<SurfaceTurning> turning;
    Array<SurfacePass> pass;
    bool bounces = false;  // some contact has restitution

    SurfaceView view() { return {group.data(), turning.data()}; }
};

// The sweeps of lanes [begin, end): the same rows as those of contacts (contact_sweep.inl). Four builds of one source
// give the same bits.
struct SurfaceKernels {
    const char* name;
    // Effective masses and approach speeds from the geometry that assembly filled in.
    void (*prepare)(SurfaceView, uint32_t begin, uint32_t end, const SweepNode*);
    // Of one group within the frame: levers turn with the first nodes that did, 1 in turned, and the gaps go on from
    // the new ones; then the same in those lanes alone, as of contacts. Of shifts, the rotation.
    void (*turn)(SurfaceView, uint32_t group, const float (&turned)[kLanes], const SweepShift*, const SweepNode*);
    void (*warm_start)(SurfaceView, uint32_t begin, uint32_t end, SweepNode*);
    // shifts: gaps follow from them; null: they are as measured before.
    void (*sweep_biased)(SurfaceView, uint32_t begin, uint32_t end, SweepNode*, const SweepShift*, const SweepTerms&);
    void (*sweep_relaxed)(SurfaceView, uint32_t begin, uint32_t end, SweepNode*, const SweepTerms&);
};

extern const SurfaceKernels kSurfaceKernelsScalar, kSurfaceKernelsBase, kSurfaceKernelsAvx2, kSurfaceKernelsAvx512;
// The widest that this machine runs.
const SurfaceKernels& surface_kernels();

}  // namespace taut
