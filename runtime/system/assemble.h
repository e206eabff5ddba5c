// State to system: rows of joints (and of contacts, for solvers without lanes), lanes of contacts and swept joints.
#pragma once

#include "partition/partition.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

constexpr uint32_t kLaneGrain = 8;  // lane groups that a thread takes at a time

inline uint32_t size_of(const auto& array) { return static_cast<uint32_t>(array.size()); }

// Once a frame and group: which rows there are, in the order that the solver wants them: block by block when joints
// are solved directly, colour by colour when they are swept; contact points after them when they come as rows.
// Energies: elements come in Rows::elastic instead, in order.
void build_rows(System& system, const Group& group, Array<Block>& blocks, Joints& joints, Elements& elements,
                Pairs& pairs, const Nodes& nodes, bool contacts_as_rows, bool energies = false);
// Once a substep: rows of the contacts that blocks own, after those of joints, at system.pose.
void build_block_contacts(System& system, const Group& group, Array<Block>& blocks, Pairs& pairs, const Nodes& nodes);
// Once a substep: C and J at system.pose; impulses from the forces of the last substep. frame_left: share of the
// frame [s] that is left after this substep, of which the drift of C is still to come.
void evaluate_rows(Team& team, System& system, double frame_left, double frame);
// Largest |J v + c mu - target| of the equality rows [m/s or rad/s].
double row_residual(System& system, const JointKernels& kernels);
// Between a pair's forces and its rows' impulses, before a substep and after it.
void load_contact_rows(System& system);
void store_contact_rows(const System& system);

// Once a frame and group: contacts by colour into lanes, with effective masses.
void build_lanes(Team& team, System& system, const Group& group, Pairs& pairs, const Nodes& nodes,
                 const ContactKernels& kernels);
// Once a substep: levers and effective masses of contacts on bodies that turned.
void turn_lanes(Team& team, System& system, const Group& group, const ContactKernels& kernels);
// Between the pairs' forces and the impulses in lanes.
void load_lanes(Team& team, System& system, const Pairs& pairs);
void store_lanes(Team& team, const System& system, Pairs& pairs);

// Once a frame and group: swept joints and elements by colour into lanes.
void build_joint_lanes(Team& team, System& system, const Group& group, double frame);
// Once a substep, after evaluate_rows(): C and J of their rows;
void evaluate_joint_lanes(Team& team, System& system);
// the geometric stiffness of the forces of the last substep, as inertia that the slow spin of their ends is spared;
void stiffen_joints(Team& team, System& system, const Nodes& nodes, const JointKernels& kernels, bool filters);
// and their rows, stops, drives and friction.
void prepare_joint_lanes(Team& team, System& system, const JointKernels& kernels);
// Once a frame and group: their forces back into the joints.
void store_joint_lanes(Team& team, const System& system);

// Once a frame and group: elements of sets with a fused sweep into lanes; their forces back into the sets.
void build_element_lanes(Team& team, System& system, const Group& group, Elements& elements);
void store_element_lanes(Team& team, const System& system);
void store_element_yields(const System& system);

// Once a frame and group: contacts between grains by colour into lanes; their forces back.
void build_grain_lanes(Team& team, System& system, const Group& group, const Grains& grains);
void store_grain_lanes(Team& team, const System& system, Grains& grains);
// Impulses of substeps of another length.
void rescale_grain_lanes(System& system, double factor);

// The same of contacts of surfaces, with effective masses.
void build_surface_lanes(Team& team, System& system, const Group& group, SurfaceContacts& surfaces,
                         const SurfaceKernels& kernels);
void store_surface_lanes(Team& team, const System& system, SurfaceContacts& surfaces);
// Within a frame, what lanes know of hits by now, by contact, and gaps as they are now; and hits back into such that
// were built anew since.
struct SurfaceHit {
    float peak = 0, approach = 0;  // as of SurfaceGroup
};
void store_surface_hits(const System& system, SurfaceContacts& surfaces, std::span<SurfaceHit> hits);
void load_surface_hits(System& system, const SurfaceContacts& surfaces, std::span<const SurfaceHit> hits);
void rescale_surface_lanes(System& system, double factor);
// Once a substep, before turn_lanes(): levers and effective masses of those on bodies that turned.
void turn_surface_lanes(Team& team, System& system, const SurfaceKernels& kernels);

// Where the next substep has another length: forces stay.
void change_length(Team& team, System& system, const Group& group, Pairs& pairs, double h, double frame);

}  // namespace taut
