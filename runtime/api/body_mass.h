// Mass properties of a body from its def.
#pragma once

#include "api/access.h"

namespace taut {

// Fills out for a dynamic body: mass and inertia as given, or from shape (null: none) and density. Check holds the
// refusal of what does not suffice.
void set_body_mass(Check& check, const taut_body_def& def, const collision::Shape* shape, NodeMass& out);

}  // namespace taut
