// Cables: a user's description -> nodes, joints and elements, and the changes of these while the cable is reeled.
//
// Segment i lies between points i and i + 1. Particles: node i is point i with the mass of half of the segments beside
// it; element i of its set of links holds the distance of segment i, and with bending stiffness bend i of another set
// resists at point i + 1; what holds an end is a joint, and so is the bend where that is clamped. Links: node i
// is segment i, a capsule along its y axis; joint i holds link i + 1 to link i, as a ball or, with bending stiffness
// EI, as a fixed joint whose angular compliance is that of the cable between the two middles:
//   angle = moment * span / EI,   gap = force * span * stretch_compliance
// So a row of joints bends and stretches as the beam does, lumped where the links meet. A bend of particles has the
// same softness, its span being half of the segments beside it. At a clamped end of particles it is between the end
// segment and a point of the body that holds the end, a segment behind it.
#pragma once

#include <span>

#include "world.h"

namespace taut {

constexpr double kLeastSegment = 0.01;  // [m], when a cable is made
constexpr double kLeastReeled = 0.2;    // of the nominal segment, when it is hauled in

// What an end is attached to.
struct CableTie {
    bool attached = false, clamped = false;
    uint32_t node = kNone;
    Vec3 anchor = Vec3::Zero();  // relative to the centre of mass, or in the world
};

// What a cable of so many segments consists of.
struct CableParts {
    size_t nodes, colliders, joints;
};
CableParts parts_of(const Cable& plan, uint32_t segments, const CableTie (&tie)[2]);

// Adds a cable whose properties are in `plan`, whose own node, joint and length are ignored. Throws std::bad_alloc with
// nothing changed.
uint32_t add_cable(World& world, const Cable& plan, std::span<const Vec3> points, const CableTie (&tie)[2]);
// Throws std::bad_alloc with nothing changed.
void remove_cable(World& world, uint32_t cable);

// Whether a segment is still tied: of particles, or between link i and the next.
bool is_whole(const World& world, const Cable& cable, uint32_t segment);
// Where it is, from the next step on.
void cut_cable(World& world, uint32_t cable, uint32_t segment);

// Point 0 to segments(), and the tension of a segment [N].
Vec3 cable_point(const World& world, const Cable& cable, uint32_t point);
double cable_tension(const World& world, const Cable& cable, uint32_t segment);
double cable_length(const Cable& cable);

// Before a step: pays out and hauls in at all cables' ends. Throws std::bad_alloc before any length changes.
void reel_cables(World& world);

}  // namespace taut
