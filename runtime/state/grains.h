// Contacts between grains: particles whose spheres touch. They are found each frame by detect/grains.cpp, on a path of
// their own that keeps no record of who is merely near, and swept in lanes of three freedoms; system/grain_lanes.cpp.
// Contacts of grains with all else are pairs as any other, state/pairs.h.
#pragma once

#include "base/math.h"
#include "base/memory.h"
#include "state/nodes.h"

namespace taut {

struct GrainContact {
    uint32_t a, b;     // nodes, the smaller index first
    Vec3f normal;      // from a to b
    float separation;  // as the frame began [m]
    float friction;    // of the two surfaces together
    Vec3f force;       // on b, of the last substep, with friction [N]

    bool joins_as(const GrainContact& other) const { return a == other.a && b == other.b; }
    bool pushes() const { return force.dot(normal) > 0; }
};
template <class Visitor, Like<GrainContact> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [a, b, normal, separation, friction, force] = of;
    TAUT_FIELDS(visitor, a, b, normal, separation, friction, force);
}

// A grain as the frame begins.
struct GrainBall {
    Vec3 x;                // [m]
    Vec3f lo, hi;          // box about its way in the frame, from the corner of all [m]
    float radius, margin;  // [m]
    uint32_t node, collider;
    int32_t level;  // its box fits a cell of 2^level m
};

// Of a ball, in the grid of a level: z, y, x of the cell that holds the middle of its box, 21 bits each, from 1 on.
struct GrainCell {
    uint64_t key;
    uint32_t ball;
};

struct Grains {
    explicit Grains(Memory& memory)
        : contact(memory),
          gone(memory),
          before(memory),
          first(memory),
          by_a(memory),
          ball(memory),
          targets(memory),
          seekers(memory),
          spare(memory) {}

    Array<GrainContact> contact;  // in the order of place; find_grain_contacts()
    Array<uint32_t> gone;         // nodes removed since: what contacts say of these means nothing
    uint64_t version = 0;         // counts changes of who touches whom
    uint64_t rules = 0;           // version of filters, joints and materials that the contacts were found by

    // Scratch of find_grain_contacts(): the contacts before, where those of each node a begin, and which these are;
    Array<GrainContact> before;
    Array<uint32_t> first, by_a;
    Array<GrainBall> ball;
    Array<GrainCell> targets, seekers, spare;
};
template <class Visitor, Like<Grains> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [contact, gone, version, rules, before, first, by_a, ball, targets, seekers, spare] = of;
    TAUT_FIELDS(visitor, contact, gone);
    TAUT_ASIDE(visitor, version);
    // rules: asked again by the next step; all others are scratch.
}

}  // namespace taut
