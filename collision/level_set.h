// Signed distance to the shapes that are known in closed form, as a level set with two derivatives and in double
// precision: what minimisation projects its points by.
#pragma once

#include "collision/collide.h"

namespace taut::collision {

// phi(x) [m], negative inside, its gradient, unit, and its second derivative [1/m], symmetric. On ridges, where two
// ways out are equally short, the derivatives are those of one side.
struct LevelSet {
    double distance = 0;
    Vec3 gradient = Vec3::Zero();
    Mat3 curvature = Mat3::Zero();
};

// Whether a shape has one: all but surfaces.
inline bool has_level_set(const Shape& shape) { return shape.kind != ShapeKind::surface; }

// At a point in the shape's frame [m].
LevelSet level_set(const Shape& shape, const Vec3& at);

}  // namespace taut::collision
