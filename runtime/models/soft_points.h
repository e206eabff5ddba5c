// Points of soft bodies: which triangle or cell is nearest to a place, and with which weights of its corners.
#pragma once

#include "models/soft_reading.h"

namespace taut {

struct SoftPoint {
    uint32_t element = kNone;  // triangle of a cloth, cell of a solid; without a mesh its triangle or vertex
    uint32_t count = 0;        // of corners
    uint32_t node[4] = {kNone, kNone, kNone, kNone};
    double weight[4] = {};  // not negative, of sum 1
    double squared = 0;     // distance [m^2]
};

// The nearest, of like ones the first. In a hexahedron that of the tetrahedra of its corners, of which it holds five.
// Of a solid without a mesh on its surface; without that too it is a vertex.
SoftPoint nearest_point(const World& world, const Soft& soft, const Vec3& to);

// Nearest to `to` of a triangle or tetrahedron: weights of its corners.
void nearest_of_triangle(const Vec3 (&x)[3], const Vec3& to, double (&weight)[3]);
void nearest_of_tetrahedron(const Vec3 (&x)[4], const Vec3& to, double (&weight)[4]);

}  // namespace taut
