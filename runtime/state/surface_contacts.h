// Contacts of the surfaces of soft bodies between their vertices: of edges and triangles with all that has a shape, and
// of vertices, edges and triangles of surfaces with each other. They are found by detect/surface_contacts.cpp, on a
// path of their own without records of who is merely near, and swept in lanes; system/surface_lanes.cpp. Contacts of
// vertices with shapes are pairs as any other, state/pairs.h.
#pragma once

#include "base/math.h"
#include "base/memory.h"
#include "collision/collide.h"
#include "state/contact_force.h"
#include "state/nodes.h"

namespace taut {

// A point of one side against one of the other. Each is on a body, or shares the motion of up to three particles:
//   C = n . sum w_i p_i + offset [m], p_0 = x_0 + lever, p_i = x_i, sum w_i = 0;  J_i = w_i n^T (I, -hat lever)
struct SurfaceContact {
    uint64_t a = 0, b = 0;                            // the two features, by which it is known again
    uint32_t node[4] = {kNone, kNone, kNone, kNone};  // the first alone may turn; kNone: no weight
    float weight[4] = {};
    Vec3f lever = Vec3f::Zero();   // of the first, world axes as it was found [m]; 0 of particles
    Vec3f skin = Vec3f::Zero();    // the part of it that does not turn: where what is round ends; state/levers.h [m]
    Vec3f normal = Vec3f::Zero();  // unit: the way in which C grows
    float gap = 0;                 // C as it was found: the distance of the two surfaces, thickness counted [m]
    float friction = 0, restitution = 0;
    Vec3f drive = Vec3f::Zero();            // sum w_i v_i that friction drives across the normal [m/s]
    uint32_t collider[2] = {kNone, kNone};  // whose materials and filters it has: of the sides that weights > 0, < 0
    ContactForce force;                     // of the last substep, tangents as tangent_of(normal)
    bool in_block = false;                  // of the last substep

    bool pushes() const { return force.normal > 0; }
};
template <class Visitor, Like<SurfaceContact> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [a, b, node, weight, lever, skin, normal, gap, friction, restitution, drive, collider, force, in_block] = of;
    TAUT_FIELDS(visitor, a, b);
    for (int i = 0; i < 4; ++i) TAUT_FIELDS(visitor, node[i], weight[i]);
    TAUT_FIELDS(visitor, lever, skin, normal, gap, friction, restitution, drive, collider[0], collider[1], force,
                in_block);
}

// Of all of a surface along one axis [m].
struct SurfaceSpan {
    double lo, hi;
    uint32_t soft;
};

// An edge of a surface that goes through a triangle of the same or another.
struct SurfaceCrossing {
    uint32_t soft, edge;  // of which
    uint32_t other, face;
};

struct SurfaceContacts {
    explicit SurfaceContacts(Memory& memory)
        : contact(memory),
          gone(memory),
          found(memory),
          order(memory),
          near(memory),
          colliders(memory),
          corner(memory),
          span(memory),
          crossing(memory) {}

    Array<SurfaceContact> contact;  // ascending by a, then b; find_surface_contacts()
    Array<uint32_t> gone;           // nodes removed since: what contacts say of these means nothing
    uint64_t version = 0;           // counts changes of who touches whom

    // Scratch of find_surface_contacts().
    Array<SurfaceContact> found;
    Array<uint32_t> order, near, colliders;
    Array<collision::Corner> corner;
    Array<SurfaceSpan> span;
    Array<SurfaceCrossing> crossing;
};
template <class Visitor, Like<SurfaceContacts> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [contact, gone, version, found, order, near, colliders, corner, span, crossing] = of;
    TAUT_FIELDS(visitor, contact, gone);
    TAUT_ASIDE(visitor, version);
}

}  // namespace taut
