// Two colliders in a step, from where they were to where they are, and how far one passed the other.
#pragma once

#include <cmath>

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Of a collider's middle in this step, but for the turn of a slow one [m].
Vec3 way_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes);

// A collider in a step.
struct Passage {
    Passage(const Nodes& nodes, const Collider& collider, const ShapeRecord& record);

    Vec3 middle(const collision::Placement& at) const {
        return at.position + at.rotation.cast<double>() * collision::middle(record.shape);
    }
    Vec3 way() const { return middle(now) - middle(before); }

    const Collider& collider;
    const ShapeRecord& record;
    collision::Placement before, now;
};

// The one that reaches further, a, is as it was; the other goes along.
class Couple {
public:
    Couple(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const NearPair& near)
        : Couple(nodes, colliders.record[near.collider_a()], colliders.record[near.collider_b()], shapes) {}

    const Passage a, b;

private:
    Couple(const Nodes& nodes, const Collider& one, const Collider& other, const Shapes& shapes)
        : Couple(nodes, shapes, reach_of(one, shapes) < reach_of(other, shapes), one, other) {}
    Couple(const Nodes& nodes, const Shapes& shapes, bool swapped, const Collider& one, const Collider& other)
        : a(nodes, swapped ? other : one, shapes.record[(swapped ? other : one).shape]),
          b(nodes, swapped ? one : other, shapes.record[(swapped ? one : other).shape]) {}
    static double reach_of(const Collider& collider, const Shapes& shapes);
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
