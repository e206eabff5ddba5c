// Mass properties of a body: as given, or from its colliders.
#pragma once

#include <span>

#include "api/access.h"

namespace taut {

// What a def says of a mass, in range.
Check& check_mass(Check& check, float mass, const taut_vec3& centre_of_mass, const taut_sym3& inertia);

// Sum over the colliders at their densities, about the common centre, body axes.
collision::MassProperties mass_of(const Shapes& shapes, std::span<const ColliderPlan> colliders);

// Fills out for a dynamic body: mass, centre and inertia as given, or from the colliders. Check holds the refusal of
// what does not suffice.
void set_body_mass(Check& check, const taut_body_def& def, const Shapes& shapes,
                   std::span<const ColliderPlan> colliders, NodeMass& out);
// The same from the colliders alone.
void set_body_mass(Check& check, const Shapes& shapes, std::span<const ColliderPlan> colliders, NodeMass& out);

// Of a body that forces move no more: its mass, which is kept for when they do.
SpareMass put_aside(uint32_t node, NodeMass& mass);
// Of one that they move again.
void take_back(Check& check, const SpareMass& spare, NodeMass& mass);

}  // namespace taut
