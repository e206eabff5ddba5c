// Mass properties of a body: as given, or from its colliders.
#pragma once

#include <span>

#include "api/access.h"

namespace taut {

// Sum over the colliders at their densities, about the common centre, body axes.
collision::MassProperties mass_of(const Shapes& shapes, std::span<const ColliderPlan> colliders);

// Fills out for a dynamic body: mass, centre and inertia as given, or from the colliders. Check holds the refusal of
// what does not suffice.
void set_body_mass(Check& check, const taut_body_def& def, const Shapes& shapes,
                   std::span<const ColliderPlan> colliders, NodeMass& out);
// The same from the colliders alone.
void set_body_mass(Check& check, const Shapes& shapes, std::span<const ColliderPlan> colliders, NodeMass& out);

}  // namespace taut
