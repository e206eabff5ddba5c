// What vertices of soft bodies may not enter where a solver takes no contacts but ways out: the shapes of all that
// forces do not move, as level sets, and the cells of soft bodies. For minimisation.
#pragma once

#include "collision/box_tree.h"
#include "collision/level_set.h"
#include "state/colliders.h"
#include "state/elements.h"
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

    bool exact() const { return collision::is_exact(*shape); }
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
    double stiffness;  // of the penalty within one that is not exact [Pa]
};

// Two soft bodies, or one and itself: vertices of the first may come into cells of the second.
struct SoftMeeting {
    uint32_t one, other;  // in Obstacles::softs
    double friction;
    double stiffness;  // of what gives way more, of the penalty within [Pa]
};

// What a soft body that meets some is made of, by nodes.
struct SoftShape {
    explicit SoftShape(Memory& memory)
        : vertex(memory), triangle(memory), cell(memory), surface(memory), cells(memory) {}

    uint32_t soft = kNone;
    uint64_t mesh_version = 0;          // by which it is known to be as it was
    Array<uint32_t> vertex;             // on its surface
    Array<uint32_t> triangle;           // [3] of that
    Array<uint32_t> cell;               // [4] tetrahedra, into which hexahedra are cut; none of cloths
    collision::BoxTree surface, cells;  // of these, to be refitted
    collision::ItemBox swept;           // where it is and, as it moves, goes in the frame [m]
    bool tied = false;                  // is in Obstacles::tie
    uint32_t first = 0, meetings = 0;   // in Obstacles::between: of its vertices
};

// What a vertex pushes an obstacle by in a substep, or a point of the surface of a soft body.
struct PointPush {
    uint32_t node, collider;  // of the vertex; of the other
    uint32_t other[3];        // nodes: the first is the obstacle's, alone, or a triangle's
    float weight[3];          // of these, in sum 1
    Vec3 lever;               // of the vertex, from the obstacle's centre of mass [m]
    Vec3 normal;              // out of the other
    double gap;               // [m]
    double impulse;           // along the normal, on the vertex [N s]
    Vec3 rubbed;              // of friction, likewise
    double approach;          // how fast the two closed before [m/s]
};

struct Obstacles {
    explicit Obstacles(Memory& memory)
        : list(memory),
          met(memory),
          first(memory),
          count(memory),
          radius(memory),
          softs(memory),
          between(memory),
          tie(memory),
          push(memory) {}

    std::span<const Meeting> of(uint32_t soft) const { return {met.data() + first[soft], count[soft]}; }
    bool any() const { return !met.empty() || !between.empty(); }

    Array<Obstacle> list;
    Array<Meeting> met;
    bool penalties = false;  // some of them are not exact
    // By soft body.
    Array<uint32_t> first, count;  // in met
    Array<double> radius;          // of its vertices [m]
    Array<SoftShape> softs;        // those that meet some
    Array<SoftMeeting> between;    // by the first
    Array<uint32_t> tie;           // pairs of nodes of soft bodies that meet: they are solved together
    Array<PointPush> push;         // of the frame so far; solvers
};

// Those of a frame.
struct ObstacleScene {
    const Nodes& nodes;
    const Colliders& colliders;
    const Shapes& shapes;
    const Softs& softs;
    const Elements& elements;
    double time;   // of the frame [s]
    Vec3 gravity;  // [m/s^2]
};
void find_obstacles(const ObstacleScene& scene, Obstacles& out);
// Where they are `elapsed` after the start of the frame [s].
void place_obstacles(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, double elapsed,
                     Obstacles& obstacles);

}  // namespace taut
