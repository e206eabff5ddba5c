// What a cable is made of, for the files that make, change and read cables.
#pragma once

#include <array>

#include "models/cable.h"
#include "state/constraint_view.h"

namespace taut {

inline bool links(const Cable& cable) { return cable.kind == CableKind::links; }
// From a link's centre of mass.
inline Vec3 along(double length) { return {0, length, 0}; }

// ---------------------------------------------------------------- nodes and capsules

// Metres of cable that are the mass of node i, or that bend at point i.
double share_of(const Cable& cable, uint32_t i);
uint32_t add_cable_node(World& world, uint32_t index, const NodeMotion& motion, double length);
// Mass, inertia and shape of node i after a change of length.
void set_cable_mass(World& world, const Cable& cable, uint32_t i);
// Removes a node on which no joint ends any more. reserve_ended for it has gone before.
void drop_cable_node(World& world, uint32_t node);

// Of particles, the capsule of a segment, which is its first point's; and leading it to the present end of the segment,
// with room reserved for the end events of its pairs.
void add_segment(World& world, const Cable& cable, uint32_t node, uint32_t next, double length);
void tie_segment(World& world, const Cable& cable, uint32_t segment);
// With its shape, which is its own.
void drop_capsule(World& world, uint32_t collider);

// ---------------------------------------------------------------- joints

// The joint before or after a link or, of an end, the one that holds it.
inline const JointRef& joint_before(const Cable& c, uint32_t i) { return i == 0 ? c.end[0].joint : c.joint[i - 1]; }
inline const JointRef& joint_after(const Cable& c, uint32_t i) {
    return i + 1 == c.node.size() ? c.end[1].joint : c.joint[i];
}
// Metres of cable whose stretching and bending a joint does.
double span_before(const Cable& cable, uint32_t i);
double span_after(const Cable& cable, uint32_t i);

void set_softness(const Cable& cable, Joint& joint, double span);
// Joint i between links, with its data, whose segments have their lengths.
Joint make_inner_joint(const Cable& cable, uint32_t i);
// What holds end e.
Joint make_end_joint(const World& world, const Cable& cable, int e, const CableTie& tie);

// ---------------------------------------------------------------- elements, of particles

inline ElementSet& stretch_of(World& world, const Cable& c) { return world.elements.set[c.stretch]; }
inline ElementSet& bending_of(World& world, const Cable& c) { return world.elements.set[c.bending]; }
// Empty sets of a cable's own, with its material.
void add_sets(World& world, Cable& cable);
// Segment i with its length, and the bend at a point, into their sets; there is room.
void insert_segment(World& world, const Cable& cable, uint32_t i);
void insert_bend(World& world, const Cable& cable, uint32_t point);
// Nodes, length and softness of segment i after changes beside it.
void set_segment(World& world, const Cable& cable, uint32_t i);

// What holds segment i: its element, or the joint after link i. None: it was cut.
ConstraintRef segment_ref(const World& world, const Cable& cable, uint32_t i);
// What bends at a point of particles. An end's is there where it is clamped.
ConstraintRef bend_at(const World& world, const Cable& cable, uint32_t point);
ConstraintRef ref_of(const World& world, const JointRef& joint);
inline ConstraintView view_of(const World& world, const ConstraintRef& ref) {
    return ref.index == kNone ? ConstraintView{} : view_of(world.joints, world.elements, ref);
}
// [rows]
double* lambda_of(World& world, const ConstraintRef& ref);
double* drift_of(World& world, const ConstraintRef& ref);

// The bend at a clamped end: the body that holds the end has a point a segment behind it.
Joint make_clamp(const World& world, const Cable& cable, int e, const CableTie& tie);
// Nodes and softness of the bend at a point, if there is one, after changes beside it.
void tie_bend(World& world, const Cable& cable, uint32_t point);

// Removes what has no hold any more where a joint of a cable of particles is gone: bends and capsules.
void drop_loose_parts(World& world);

}  // namespace taut
