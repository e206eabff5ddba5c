// The stored convex hull behind Shape::hull.
#pragma once

#include <memory>
#include <vector>

#include "collision/polytope.h"

namespace taut::collision {

struct Hull {
    std::vector<Vec3f> vertices;  // sorted by x, then y, then z [m]
    std::vector<Face> faces;      // sorted by their loops, each loop from its smallest vertex on
    std::vector<uint8_t> loops;
    std::vector<Side> sides;
    std::vector<Edge> edges;  // sorted by (from, to), from < to
    std::vector<Fan> fans;
    std::vector<uint8_t> around;
    std::vector<FloatLanes> corners, planes;  // columns of the vertices and faces
    Vec3f centre = Vec3f::Zero();             // mean of the vertices [m]
    float inner_radius = 0;
    float outer_radius = 0;

    Polytope polytope;  // all of the above in one view, as it was when last laid out

    void lay_out();
    const Polytope& view() const { return polytope; }
};

// Corner loops of a closed convex surface, counter-clockwise from outside; indices into some list of points.
using Loops = std::vector<std::vector<int>>;

// Merges faces within tolerance [m] of one plane and drops points that no longer lie on an edge's end. Null
// where the merged surface would not be closed. Points must be sorted; at most kMaxVertices of them are used.
std::shared_ptr<const Hull> hull_of_surface(const std::vector<Vec3f>& points, const Loops& surface, double tolerance);

}  // namespace taut::collision
