// What wakes sleeping islands. Whoever changes what a node does, or what it stands on, calls this; in worlds without
// sleeping nothing happens. None of these throws or takes memory: pairs come back with the next step.
#pragma once

#include "world.h"

namespace taut {

// The whole island of a node that forces move; one that is awake begins its quiet time anew. Of any other node, all
// that touches it or is tied to it, and a kinematic node itself. kNone is nobody.
void wake(World& world, uint32_t node);
void wake_all(World& world);
// What a node that forces do not move may have come to touch, by its place, shapes or filters.
void wake_near(World& world, uint32_t node);
// Both, for what changes whom a node may touch.
void wake_about(World& world, uint32_t node);
// The islands of which a collider's tight box meets this one.
void wake_box(World& world, const collision::Box& box);

// Whether a kinematic node with this velocity rests: less is what rounding leaves of a move to where it is already.
inline bool stands_still(const Vec3& v, const Vec3& w) {
    constexpr double kStill = 1e-6;  // [m/s, rad/s]
    return v.norm() <= kStill && w.norm() <= kStill;
}

}  // namespace taut
