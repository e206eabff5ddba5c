// Signed distance to shapes, as a level set with two derivatives and in double precision: what minimisation keeps its
// points out by.
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

// Whether it is known in closed form, so that x - phi grad phi is on the surface: of all but surfaces, which have one
// where it was sampled.
inline bool is_exact(const Shape& shape) { return shape.kind != ShapeKind::surface; }
inline bool has_level_set(const Shape& shape) { return is_exact(shape) || shape.distance != nullptr; }

// At a point in the shape's frame [m], of one that has it.
LevelSet level_set(const Shape& shape, const Vec3& at);

}  // namespace taut::collision
