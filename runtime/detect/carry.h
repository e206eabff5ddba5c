// What the solver found out about a pair's points goes from its last manifold to the next.
#pragma once

#include "state/pairs.h"

namespace taut {

// Forces of the record before, which go with its manifold `old`, onto the points of a pair: by feature, else by
// place; those of points of round shapes that are gone go to all, with the force and moment that they had. All turned
// into the tangents of the new normal. before may be the pair itself.
void carry(const collision::Manifold& old, const Pair& before, Pair& pair);

// The same for a manifold whose points are those of the last frame, with the normal that they had.
void carry_on(const Vec3f& old_normal, Pair& pair);

}  // namespace taut
