// Invariants between the stages of a step, each checked by a function that returns the first flaw. Builds with checks
// (without NDEBUG, or with TAUT_SANITIZE) call them after every stage and abort at a flaw; others never do.
#pragma once

#include <optional>

#include "stages.h"
#include "state/attachments.h"
#include "state/colliders.h"
#include "state/elements.h"
#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

class Partition;
struct Group;
struct System;

#if !defined(NDEBUG) || defined(TAUT_VALIDATE)
constexpr bool kValidates = true;
#else
constexpr bool kValidates = false;
#endif

// An invariant that does not hold, and of what: the index that its validator names.
struct Flaw {
    const char* invariant;
    uint64_t index;
};
using MaybeFlaw = std::optional<Flaw>;

// Motions of live nodes: finite, rotations unit. Index: node.
MaybeFlaw validate_nodes(const Nodes& nodes);
// Near and resting pairs: sorted by key, none twice, colliders and records in range. Index: place in the list.
MaybeFlaw validate_near(const Pairs& pairs, const Colliders& colliders);
// Active pairs: nodes and records in range, as many points as their manifolds, in the order of near. Index: in active.
MaybeFlaw validate_active(const Pairs& pairs, const Nodes& nodes);
// Every node that forces move in exactly one group, and in one block at most. Index: node.
MaybeFlaw validate_members(const Partition& partition, const Nodes& nodes);
// Every active pair with such a node in exactly one of lanes, rows and blocks, its nodes in one island. Index: in
// active.
MaybeFlaw validate_pairs(const Partition& partition, const Pairs& pairs, const Nodes& nodes);
// Every contact between grains with such a node in exactly one group, its nodes in order, in one island. Index: in
// Grains::contact.
MaybeFlaw validate_grains(const Partition& partition, const Grains& grains, const Nodes& nodes);
// Every contact of surfaces in order, on nodes that differ, with weights whose sum is 0 and a unit normal; with a node
// that forces move in exactly one of lanes, rows and blocks, its nodes in one island, of a block all in that. Index: in
// SurfaceContacts::contact.
MaybeFlaw validate_surfaces(const Partition& partition, const SurfaceContacts& surfaces, const Nodes& nodes);
// Every joint with such a node solved exactly once, its nodes in one island. Index: joint.
MaybeFlaw validate_joints(const Partition& partition, const Joints& joints, const Nodes& nodes);
// Likewise every element. Index: of those of all sets, one after the other.
MaybeFlaw validate_elements(const Partition& partition, const Elements& elements, const Nodes& nodes);
// The elements of an attachment live, on the nodes of its two ends. Index: attachment.
MaybeFlaw validate_attachments(const Attachments& attachments, const Elements& elements);
// No node that forces move twice in a colour but the last. Index: node.
MaybeFlaw validate_colours(const Partition& partition, const Pairs& pairs, const Joints& joints,
                           const Elements& elements, const Nodes& nodes);
// Lanes of contacts and swept joints: no node that moves twice in a lane group, as many lanes in use as the group has
// swept pairs and joints. Index: lane group.
MaybeFlaw validate_lanes(const System& system, const Group& group);
// Impulses of swept contacts, relaxed: normal ones not negative, friction within its cone up to rounding; of direct
// ones the former alone. What is not finite is contained after the substeps (quarantine.h) and passes. Index: in
// Pairs::list.
MaybeFlaw validate_impulses(const System& system);
// Forces between steps: finite, normal ones not negative. Index: in active, or joint, or set of elements.
MaybeFlaw validate_contact_forces(const Pairs& pairs);
MaybeFlaw validate_joint_forces(const Joints& joints, const Elements& elements);

// All that hold after a stage. Aborts at a flaw, with a text that names stage, invariant and index.
void validate(const World& world, const StageEnd& end);

}  // namespace taut
