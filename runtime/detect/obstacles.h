// What vertices of soft bodies may not enter where a solver takes no contacts but ways out: the shapes of all that
// forces do not move, as level sets. For minimisation.
#pragma once

#include "collision/level_set.h"
#include "state/colliders.h"
#include "state/shapes.h"
#include "state/softs.h"

namespace taut {

// A shape at a moment of the frame.
struct Obstacle {
    const collision::Shape* shape;
    uint32_t collider, node;
    Vec3 position = Vec3::Zero();                             // of the shape's origin [m]
    Mat3 rotation = Mat3::Identity();                         // world from shape
    Vec3 centre = Vec3::Zero();                               // of mass of its node [m]
    Vec3 v = Vec3::Zero(), w = Vec3::Zero();                  // of that [m/s, rad/s]
    Vec3 surface_v = Vec3::Zero(), surface_w = Vec3::Zero();  // of its surface against the node: v + w x p, world axes
    Vec3 lo = Vec3::Zero(), hi = Vec3::Zero();                // box [m]

    bool may_hold(const Vec3& x, double radius) const {
        return ((x - lo).array() > -radius).all() && ((hi - x).array() > -radius).all();
    }
    // Of the shape grown by a radius, with gradient and curvature in world axes.
    collision::LevelSet level(const Vec3& x, double radius) const {
        collision::LevelSet out = collision::level_set(*shape, rotation.transpose() * (x - position));
        out.distance -= radius;
        out.gradient = rotation * out.gradient;
        out.curvature = rotation * out.curvature * rotation.transpose();
        return out;
    }
    Vec3 velocity_at(const Vec3& x) const {
        return v + w.cross(x - centre) + surface_v + surface_w.cross(x - position);
    }
};

// Of a soft body: whom its vertices may meet.
struct Meeting {
    uint32_t obstacle;  // in Obstacles::list
    double friction;
};

// What a vertex pushes an obstacle by in a substep.
struct PointPush {
    uint32_t node, collider, other;  // of the vertex; the obstacle and its node
    Vec3 lever;                      // of the vertex, from the centre of mass of that [m]
    Vec3 normal;                     // out of the obstacle
    double impulse;                  // along that, on the vertex [N s]
    Vec3 rubbed;                     // of friction, likewise
    double approach;                 // how fast the two closed before [m/s]
};

struct Obstacles {
    explicit Obstacles(Memory& memory)
        : list(memory), met(memory), first(memory), count(memory), radius(memory), push(memory) {}

    std::span<const Meeting> of(uint32_t soft) const { return {met.data() + first[soft], count[soft]}; }
    bool any() const { return !met.empty(); }

    Array<Obstacle> list;
    Array<Meeting> met;
    // By soft body.
    Array<uint32_t> first, count;  // in met
    Array<double> radius;          // of its vertices [m]
    Array<PointPush> push;         // of the frame so far; solvers
};

// Those of a frame.
void find_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
                    Obstacles& out);
// Where they are `elapsed` after the start of the frame [s].
void place_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, double elapsed,
                     Obstacles& obstacles);

}  // namespace taut
