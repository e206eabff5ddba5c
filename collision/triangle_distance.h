// How far a point is from a triangle.
#pragma once

#include "constraints/point_penalty.h"

namespace taut::collision {

// Square of the least distance [m^2].
inline double distance_squared(const Vec3& point, const Vec3 (&triangle)[3]) {
    const TrianglePoint nearest = nearest_on_triangle(point, triangle);
    Vec3 apart = point;
    for (int i = 0; i < 3; ++i) apart -= nearest.weight[i] * triangle[i];
    return apart.squaredNorm();
}

}  // namespace taut::collision
