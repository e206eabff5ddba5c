// How colliders stand and move, as contacts are looked for.
#pragma once

#include <algorithm>
#include <limits>

#include "base/math.h"
#include "base/memory.h"
#include "collision/collide.h"

namespace taut {

using Quatf = Eigen::Quaternion<float, Eigen::DontAlign>;

// Where a collider may be until the next frame.
struct Reach {
    collision::Box box = {
        Vec3f::Zero(),
        Vec3f::Zero()};  // tight, grown by its contact margin, of which kBoxLag may be used up, and the motion [m]
    Vec3f ahead = Vec3f::Zero();                            // the motion, of the middle [m]
    bool left = false;                                      // is outside its fat box
    double made = std::numeric_limits<double>::infinity();  // Travel::way then; infinite: to be made anew
};
template <class Visitor, Like<Reach> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [box, ahead, left, made] = of;  // left: within a step
    TAUT_FIELDS(visitor, box, ahead, made);
}

// How a collider's shape stands and moves; place_collider().
struct Stance {
    Quatf turn = Quatf::Identity();                        // world from shape
    Vec3f velocity = Vec3f::Zero(), spin = Vec3f::Zero();  // of its origin [m/s]; [rad/s]
    Vec3f from_node = Vec3f::Zero();                       // from the node's origin to its own, world axes [m]
    float reach = 0, size = 0;                             // as in ShapeRecord [m]
    bool placed = false;                                   // else all of this is yet to come
};
template <class Visitor, Like<Stance> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [turn, velocity, spin, from_node, reach, size, placed] = of;
    TAUT_FIELDS(visitor, turn, velocity, spin, from_node, reach, size, placed);
}

// How far a shape's points may swing about its origin in a time [s] as it turns [m].
inline float swing_of(const Stance& stance, float time) {
    return std::min(time * stance.spin.norm(), 2.0f) * stance.reach;
}

// What a collider's points covered so far, and may cover.
struct Travel {
    double way = 0;       // of its furthest point, at least as long as from each place to the next [m]
    float ahead = 0;      // the same of the next frame, by its velocities [m]
    float thickness = 0;  // as in Pace [m]
    float swing = 0;      // of its furthest point about its origin in the next frame, if forces move it [m]
    float margin = 0;     // how far apart it gets contact points [m]
};
template <class Visitor, Like<Travel> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [way, ahead, thickness, swing, margin] = of;
    TAUT_FIELDS(visitor, way, ahead, thickness, swing, margin);
}

// How far a collider gets of itself in a frame, for what is looked for along its way; impact.h.
struct Pace {
    double thickness = 0;  // [m]; infinite: not to be looked for
    double turning = 0;    // how far what reaches out of it gets as it turns [m]
    float round = 0;       // collision::ball_radius() [m]
    bool rolls = false;    // collision::rolls()
};

// Where a collider's middle went in this step, for what may have gone through each other; course_of().
struct Course {
    Vec3 from = Vec3::Zero(), along = Vec3::Zero();  // [m]
    float thickness = 0;                             // as in Pace [m]
    float reach = 0;                                 // of its core about its origin [m]
    float round = 0;                                 // reach and this: of a ball about the middle that holds it [m]
    float chord = 0;                                 // of its turn, at least, at radius 1; infinite: its ends go apart
};

// A mechanism that hold_back() leaves where it was before the step.
struct Stay {
    uint32_t root;
    uint32_t frames;  // one after another
    bool now;         // in this one too
};
template <class Visitor, Like<Stay> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [root, frames, now] = of;  // now: within a step
    TAUT_FIELDS(visitor, root, frames);
}

// A joint by its slot, set kNone, or an element of a set.
struct ConstraintRef {
    uint32_t set = kNone, index = kNone;
};

// Of Mechanisms::tie.
struct TieRange {
    uint32_t begin = 0, end = 0;
};

// Nodes that joints and elements tie together, by node; hold_back().
struct Mechanisms {
    explicit Mechanisms(Memory& memory)
        : root(memory),
          next(memory),
          ties_of(memory),
          tie(memory),
          open(memory),
          ties(memory),
          drive(memory),
          put_back(memory),
          stays(memory) {}

    bool found = false;         // in this step; what follows is of nodes that are active
    Array<uint32_t> root;       // the least of them
    Array<uint32_t> next;       // of the ring of them
    Array<TieRange> ties_of;    // by node, of a root
    Array<ConstraintRef> tie;   // root by root, joints before elements
    Array<ConstraintRef> open;  // scratch: to be closed
    Array<uint8_t> ties;        // of a root; detect/mechanism.h
    Array<float> drive;         // of a root; detect/mechanism.h [kg]
    bool any_drives = false;    // any of them others, in this step
    Array<uint8_t> put_back;    // the last round in which it was; 0: none
    Array<Stay> stays;          // outlive the step
};
template <class Visitor, Like<Mechanisms> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [found, root, next, ties_of, tie, open, ties, drive, any_drives, put_back, stays] = of;
    TAUT_FIELDS(visitor, stays);  // all else is found by each step
}

}  // namespace taut
