// Questions to the triangles of cloths and solids. One after the other, past boxes of each: a tree would have to be
// refitted where a query may write nothing.
#pragma once

#include "queries/queries.h"

namespace taut {

// The first that a ray meets, or a hit of nothing.
taut_surface_hit first_surface(const Sight& sight, const RayQuery& query);
// The nearest to a point, within a distance [m], or a hit of nothing.
taut_surface_hit nearest_surface(const Sight& sight, const Vec3& point, double within);
// All within a distance of a point, in order.
void all_surfaces(const Sight& sight, const Vec3& point, double within, Sink<taut_surface_hit>& sink);

}  // namespace taut
