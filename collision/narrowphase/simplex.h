// The point of a triangle, tetrahedron or less that is nearest to the origin.
#pragma once

#include "collision/narrowphase/gjk.h"

namespace taut::collision {

struct Simplex {
    int count = 0;
    DifferencePoint points[4];
    double weights[4] = {};  // of the nearest point; they sum to 1

    // Drops the points that do not bear the nearest one, which it returns. False if the origin is inside.
    bool reduce(Vec3& nearest);
    Vec3 on_a() const;
};

}  // namespace taut::collision
