// The convex hull of points, triangle by triangle, in double precision.
#pragma once

#include <array>

#include "collision/hull.h"

namespace taut::collision {

// Triangles counter-clockwise from outside, sorted, each from its smallest corner on; indices into points. From four
// corners that span a volume: takes the point furthest outside until there are most corners, or the rest lies outside
// by no more than near [m]. Decisions are those of exact arithmetic but for what lies within rounding of a plane.
Loops quickhull(std::span<const Vec3f> points, const std::array<int, 4>& simplex, size_t most, double near,
                Memory& memory);

}  // namespace taut::collision
