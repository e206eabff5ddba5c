// Two colliders in a step, from where they were to where they are, and how far one passed the other.
#pragma once

#include <cmath>

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Of a collider's middle in this step, but for the turn of a slow one [m].
Vec3 way_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes);
// Whether the ball inside the one may have met the ball about the other, which reaches further: false spares the rest.
// Thickness of either [m].
bool may_pass(const Nodes& nodes, const Collider& a, double thickness_a, const Collider& b, double thickness_b,
              const Shapes& shapes);

// A collider in a step.
struct Passage {
    const Collider& collider;
    const ShapeRecord& record;
    Vec3 from, along;                  // of its middle [m]
    collision::Placement before, now;  // where the step had it
};

// The one that reaches further, a, is as it was; the other goes along.
class Couple {
public:
    Couple(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const NearPair& near);

    const Passage a, b;

private:
    Couple(const Passage& one, const Passage& other);
    Couple(const Passage& one, const Passage& other, double reach_of_one, double reach_of_other);
};

// What is too much of two ways.
struct Excess {
    double share = 0;            // of each
    Vec3 normal = Vec3::Zero();  // of the surface met, at the present poses
    Vec3 way = Vec3::Zero();     // of the point of b that met it [m]

    double depth() const { return share * std::abs(normal.dot(way)); }
};

// Of b's core, whose way is as a sees it, which turns as well; about its middle, and of a segment between two particles
// also about its ends: one that hits by its end is stopped there, and what keeps its length pushes it on.
Excess excess_of(const Nodes& nodes, const Couple& couple);

}  // namespace taut
