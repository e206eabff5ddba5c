// The direction along which two convex shapes are furthest apart, or overlap least.
#pragma once

#include "collision/narrowphase/gjk.h"

namespace taut::collision {

struct Push {
    Vec3 normal = Vec3::UnitY();  // unit, from a to b, a's frame
    double separation = -1e300;   // of the shapes along it [m], negative is overlap
    Vec3 on_a = Vec3::Zero();     // nearest, or deepest, point of a's core [m]
};

// hint: a unit vector to start from, such as last frame's normal; zero for none. Beyond enough [m] any direction that
// separates by so much is returned.
Push least_push(const Solid& a, const Solid& b, const Pair& pair, const Vec3& hint, double enough);

}  // namespace taut::collision
