// What the materials and surface velocities of two colliders make of their contact.
#pragma once

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/pairs.h"

namespace taut {

// Of two surfaces together.
float friction_of(const taut_material& a, const taut_material& b);
float static_friction_of(const ColliderTraits& a, const ColliderTraits& b);
float restitution_of(const taut_material& a, const taut_material& b);

// Friction, restitution, arms and drive of a pair. from_a: of the origin of a's shape from that of its node [m].
void combine_surfaces(const Nodes& nodes, const ColliderTraits& a, const ColliderTraits& b,
                      const collision::Placement& at_a, const collision::Placement& at_b, const Vec3f& from_a,
                      Pair& pair);

}  // namespace taut
