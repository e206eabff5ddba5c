// Directions in which vertices and edges of a surface can be touched: within the cone of the normals of the triangles
// about them, on the side that is touched. Where these are flat that is one direction, so that nothing that slides over
// a surface catches on what is within it. What is found in another direction is nearer to some triangle.
#pragma once

#include <algorithm>

#include "base/math.h"
#include "state/softs.h"

namespace taut {

// How deep two surfaces may be in each other and still meet on the sides that look at each other [m]. both: their radii
// together. Deeper than half of that it is not known which side is which.
inline float depth_within(float both, float margin) { return std::min(0.5f * both, margin); }

// A vertex or an edge of a surface; none: of what has no such cone.
struct SurfaceFeature {
    enum class Of : uint8_t { none, vertex, edge };

    Of of = Of::none;
    const Soft* soft = nullptr;
    const SurfaceMesh* mesh = nullptr;
    uint32_t index = 0;

    // The nearest to a unit direction, away from the surface; the direction itself where it is in the cone, and where
    // the side that it goes to is the inside of a solid.
    Vec3f in_cone(const Vec3f& direction) const;
};

// The feature where no force moves it; none where one does: a surface that moves bends about what it meets, and its
// triangles are elsewhere then.
SurfaceFeature held_feature(const Nodes& nodes, const SurfaceFeature& feature);

}  // namespace taut
