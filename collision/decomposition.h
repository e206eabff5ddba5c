// Approximate convex decomposition: a solid as the union of few convex hulls that depart from it by a length.
#pragma once

#include <memory>

#include "collision/closed_solid.h"
#include "collision/hull.h"

namespace taut::collision {

struct DecompositionSettings {
    double tolerance = 0;  // [m]
    uint32_t max_parts = 0;
    int max_vertices = 0;  // of a hull
    float thickness = 0;   // of hulls, at least [m]
};

struct ConvexPart {
    std::shared_ptr<const Hull> hull;
    double departure = 0;  // of the hull's points from the solid, at most [m]
    double shortfall = 0;  // of the solid's points of this part over the hull's faces, at most [m]
};

// Parts that hold the solid together: its pieces in boxes, halved where they depart most, then joined again as long as
// that stays within the tolerance or there are more than max_parts. They depend on the solid alone; empty where no
// piece is as thick as a hull must be.
Array<ConvexPart> decompose(const TriangleSoup& soup, const ClosedSolid& solid, const DecompositionSettings& settings,
                            Memory& memory);

}  // namespace taut::collision
