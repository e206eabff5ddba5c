// From poses to contact pairs: boxes, pairs, manifolds with the impulses that their points carry over.
#pragma once

#include <span>

#include "state/colliders.h"
#include "state/elements.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/shapes.h"
#include "threads/team.h"

namespace taut {

// A capsule's y axis from one point to another.
NodePose pose_between(const Vec3& from, const Vec3& to);
collision::Placement placement_of(const NodePose& pose);
// Where a collider's shape is, `elapsed` after the start of the frame: kinematic bodies move at its end.
collision::Placement placement_of(const Nodes& nodes, const Collider& collider, double elapsed = 0);
// Brings Pairs::placement, stance and way of a collider to that moment.
void place_collider(const Nodes& nodes, const Shapes& shapes, const Collider& collider, double elapsed, Pairs& pairs,
                    uint32_t index);
// The shape's box at the node's pose, grown by the contact margin.
collision::Box contact_box(const Nodes& nodes, const Shapes& shapes, const Collider& collider);

// Where colliders are, and tight boxes reaching as far as the nodes move in a frame, into the broadphase. Capsules
// between two nodes take their length.
void update_bounds(Team& team, const Nodes& nodes, const Colliders& colliders, Shapes& shapes, Pairs& pairs,
                   collision::Broadphase& broadphase, double time_step);

// After a step: which colliders' leaves do not hold them, for the queries. Those of nodes that the step froze get new
// leaves, for no later step will ask.
void note_strays(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                 std::span<const uint32_t> frozen, Pairs& pairs, collision::Broadphase& broadphase);

// Whether filters, joints and kinds let two colliders collide; Pairs::joined is up to date.
bool may_collide(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, const PairEnds& pair);

// A record for two colliders, after update_pairs() of this step or within it: asked whether they may collide.
NearPair new_pair(const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, uint64_t key);

// Pair records after the broadphase's pairs: old ones kept, new ones asked whether they may collide.
void update_pairs(Team& team, const Nodes& nodes, const Colliders& colliders, const Joints& joints,
                  const Elements& elements, collision::Broadphase& broadphase, Pairs& pairs);

// Manifolds of all pairs in the list at the present poses, or where contacts move over their surfaces as they will be
// in a lead time [s]; impulses follow their features.
void find_contacts(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step, double lead);

// The same within a frame, `elapsed` after its start, for some of Pairs::active: those of blocks, whose light links
// turn far in a substep; at its start, those that were found with a lead. A pair or part may lose its points, none is
// added to the list.
void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep);

}  // namespace taut
