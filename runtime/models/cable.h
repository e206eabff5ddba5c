// Cables: a user's description -> nodes and joints, and the changes of both while the cable is reeled.
//
// Segment i lies between points i and i + 1. Particles: node i is point i with the mass of half of the segments beside
// it; joint i holds the distance of segment i. Links: node i is segment i, a capsule along its y axis; joint i holds
// link i + 1 to link i, as a ball or, with bending stiffness EI, as a fixed joint whose angular compliance is that of
// the cable between the two middles:
//   angle = moment * span / EI,   gap = force * span * stretch_compliance
// So a row of joints bends and stretches as the beam does, lumped where the links meet.
#pragma once

#include <span>

#include "world.h"

namespace taut {

constexpr double kLeastSegment = 0.01;  // [m], when a cable is made

// What an end is attached to.
struct CableTie {
    bool attached = false, clamped = false;
    uint32_t node = kNone;
    Vec3 anchor = Vec3::Zero();  // relative to the centre of mass, or in the world
};

// Adds a cable whose properties are in `plan`, whose own node, joint and length are ignored. Throws std::bad_alloc with
// nothing changed.
uint32_t add_cable(World& world, const Cable& plan, std::span<const Vec3> points, const CableTie (&tie)[2]);
// Throws std::bad_alloc with nothing changed.
void remove_cable(World& world, uint32_t cable);

// Point 0 to segments(), and the tension of a segment [N].
Vec3 cable_point(const World& world, const Cable& cable, uint32_t point);
double cable_tension(const World& world, const Cable& cable, uint32_t segment);
double cable_length(const Cable& cable);

// Before a step: pays out and hauls in at all cables' ends. Throws std::bad_alloc before any length changes.
void reel_cables(World& world);

// ---------------------------------------------------------------- for the files of this room

// The joint before or after a link or, of an end, the one that holds it.
inline const JointRef& joint_before(const Cable& c, uint32_t i) { return i == 0 ? c.end[0].joint : c.joint[i - 1]; }
inline const JointRef& joint_after(const Cable& c, uint32_t i) {
    return i + 1 == c.node.size() ? c.end[1].joint : c.joint[i];
}
// Metres of cable whose stretching and bending a joint does.
double span_before(const Cable& cable, uint32_t i);
double span_after(const Cable& cable, uint32_t i);

// Anchor of end 0 (a) or 1 (b) of a joint.
void set_softness(const Cable& cable, Joint& joint, double span);
// Joint i with its data, between nodes whose segments have their lengths.
Joint make_inner_joint(const Cable& cable, uint32_t i);

uint32_t add_cable_node(World& world, uint32_t index, const NodeMotion& motion, double length);
// Mass, inertia and shape of node i after a change of length.
void set_cable_mass(World& world, const Cable& cable, uint32_t i);
// Removes a node on which no joint ends any more. reserve_ended for it has gone before.
void drop_cable_node(World& world, uint32_t node);

// The turn from one unit vector to another by the shortest way.
Quat turn_between(const Vec3& from, const Vec3& to);

}  // namespace taut
