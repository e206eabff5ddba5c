// Exact overlap of two placed shapes, independent of any engine's contacts.
#pragma once

#include "scenes/scene.h"

namespace bench {

struct Placed {
    const scenes::Shape* shape = nullptr;
    taut_pos position{};
    taut_quat rotation{0, 0, 0, 1};
};

// Shortest translation that separates the two [m]: 0 or less when they don't overlap. Exact for boxes and hulls, boxes
// and spheres, and everything against a plane; for the other pairs of solids searched over directions, to some 0.1 mm of
// small shapes. Throws std::invalid_argument for scaled hulls, which are told as hulls, and for surfaces.
double overlap_depth(const Placed& a, const Placed& b);

// Radius of a sphere around the shape's origin; infinite for a plane.
double bounding_radius(const scenes::Shape& shape);

}  // namespace bench
