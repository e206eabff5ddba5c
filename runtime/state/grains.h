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
    float strain;      // by which it yielded of late in substeps of h, in parts of what it may: strain h^2 [1/s^2]

    bool pushes() const { return force.dot(normal) > 0; }
};
template <class Visitor, Like<GrainContact> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [a, b, normal, separation, friction, force, strain] = of;
    TAUT_FIELDS(visitor, a, b, normal, separation, friction, force, strain);
}

// What stays of a contact, by node a.
struct GrainMemory {
    uint32_t b;
    uint32_t index;  // in Grains::contact then
    float friction, strain;
    Vec3f force;
};

// About the way of a grain in the frame, from the corner of all [m].
struct GrainBox {
    Vec3f lo, hi;

    bool meets(const GrainBox& other) const {
        int meet = 1;  // without branches: every fifth one does
        for (int i = 0; i < 3; ++i)
            meet &= static_cast<int>(lo[i] <= other.hi[i]) & static_cast<int>(other.lo[i] <= hi[i]);
        return meet != 0;
    }
};

// A grain as the frame begins.
struct GrainBall {
    Vec3 x;   // [m]
    Vec3f v;  // [m/s]
    GrainBox box;
    float radius, margin;  // [m]
    float inv_mass;        // [1/kg]
    uint32_t node, collider;
    int32_t level;  // its box fits a cell of 2^level m
};

// Of a ball, in the grid of a level: z, y, x of the cell that holds the middle of its box, 21 bits each, from 1 on.
struct GrainCell {
    uint64_t key;
    uint32_t ball;
};

// Balls in the order of their cells, and their boxes in that order.
struct GrainCells {
    explicit GrainCells(Memory& memory) : cell(memory), box(memory) {}

    Array<GrainCell> cell;
    Array<GrainBox> box;
};

struct Grains {
    explicit Grains(Memory& memory)
        : contact(memory),
          gone(memory),
          before(memory),
          first(memory),
          ball(memory),
          targets(memory),
          seekers(memory),
          spare(memory) {}

    Array<GrainContact> contact;  // in the order of place; find_grain_contacts()
    Array<uint32_t> gone;         // nodes removed since: what contacts say of these means nothing
    uint64_t version = 0;         // counts changes of who touches whom
    uint64_t rules = 0;           // version of filters, joints and materials that the contacts were found by

    // Scratch of find_grain_contacts(): the contacts before, and where those of each node a begin.
    Array<GrainMemory> before;
    Array<uint32_t> first;
    Array<GrainBall> ball;
    GrainCells targets, seekers;
    Array<GrainCell> spare;
};
template <class Visitor, Like<Grains> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [contact, gone, version, rules, before, first, ball, targets, seekers, spare] = of;
    TAUT_FIELDS(visitor, contact, gone);
    TAUT_ASIDE(visitor, version);
    // rules: asked again by the next step; all others are scratch.
}

}  // namespace taut
