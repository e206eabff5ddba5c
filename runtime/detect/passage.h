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
// Hold its shape as it is; as it is and as it was before the step [m].
collision::Box bounds_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes);
collision::Box box_along(const Nodes& nodes, const Collider& collider, const Shapes& shapes);
Course course_of(const Nodes& nodes, const Collider& collider, const Shapes& shapes, const Pace& pace);
// Whether the core of the one that reaches less far may have met the ball about the other: false spares the rest.
bool may_pass(const Course& one, const Course& other);

// A collider in a step.
struct Passage {
    const Collider& collider;
    const ShapeRecord& record;
    const Course& course;

    bool spans() const { return collider.node_b != kNone; }
};
// The one that reaches further, a, is as it was; the other goes along.
class Couple {
public:
    Couple(const Colliders& colliders, const Shapes& shapes, const Array<Course>& courses, const AskedPair& pair);

    const Passage a, b;

private:
    Couple(const Passage& one, const Passage& other);
};

// What is too much of two ways.
struct Excess {
    double share = 0;            // of each
    Vec3 normal = Vec3::Zero();  // of the surface met, at the present poses
    Vec3 way = Vec3::Zero();     // of the point of b that met it [m],
    Vec3 seen = Vec3::Zero();    // and of the same as a sees it

    double depth() const { return share * std::abs(normal.dot(seen)); }
};

// Of b's core, whose way is as a sees it, which turns as well; about its middle, and of a segment between two particles
// also about its ends: one that hits by its end is stopped there, and what keeps its length pushes it on.
Excess excess_of(const Nodes& nodes, const Couple& couple);

}  // namespace taut
