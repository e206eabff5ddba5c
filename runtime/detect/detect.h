// From poses to contact pairs: boxes, pairs, manifolds with the impulses that their points carry over.
#pragma once

#include "state/joints.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Tight boxes reaching as far as the nodes move in a frame, into the broadphase.
void update_bounds(const Nodes& nodes, const Shapes& shapes, collision::Broadphase& broadphase, double time_step);

// Pair records after the broadphase's pairs: old ones kept, new ones asked whether they may collide.
void update_pairs(const Nodes& nodes, const Joints& joints, collision::Broadphase& broadphase, Pairs& pairs);

// Manifolds of all pairs at the present poses; impulses follow their features.
void find_contacts(const Nodes& nodes, const Shapes& shapes, Pairs& pairs, double time_step);

}  // namespace taut
