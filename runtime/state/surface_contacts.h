// Contacts of the surfaces of soft bodies between their vertices: of edges and triangles with all that has a shape, and
// of vertices, edges and triangles of surfaces with each other. They are found by detect/surface_contacts.cpp, on a
// path of their own without records of who is merely near, and swept in lanes; system/surface_lanes.cpp. Contacts of
// vertices with shapes are pairs as any other, state/pairs.h.
#pragma once

#include <taut/event.h>

#include "base/math.h"
#include "base/memory.h"
#include "base/shared_list.h"
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
    // Of the step that is under way or was the last: impulses summed over its substeps, in world axes those along the
    // normals that it had, and friction's [N s], and how fast the two closed before it, where somebody asks [m/s].
    // publish/contact_watch.h
    float pushed = 0;
    Vec3f push = Vec3f::Zero(), rubbed = Vec3f::Zero();
    float approach = 0;

    bool pushes() const { return force.normal > 0; }
    // What hits and is off again within the step did.
    bool touches() const { return gap <= 0 || pushes() || pushed > 0; }
};
template <class Visitor, Like<SurfaceContact> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [a, b, node, weight, lever, skin, normal, gap, friction, restitution, drive, collider, force, in_block,
           pushed, push, rubbed, approach] = of;  // push, rubbed, approach: within a step
    TAUT_FIELDS(visitor, a, b);
    for (int i = 0; i < 4; ++i) TAUT_FIELDS(visitor, node[i], weight[i]);
    TAUT_FIELDS(visitor, lever, skin, normal, gap, friction, restitution, drive, collider[0], collider[1], force,
                in_block, pushed);
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

// Two features of surfaces that may come near.
struct NearFeature {
    enum class Of : uint8_t { vertex_face, face_vertex, edge_edge } of;  // of the first and the second surface
    uint32_t one, other;
    float time;  // in which they do [s]
};

// By what a contact is known, and where it is in a list.
struct SurfaceContactName {
    uint64_t a, b;
    uint32_t index;
};

// A soft body and a collider that touch, or two soft bodies, by whichever vertices, edges and triangles; soft bodies as
// the collider of their first vertex that has one. publish/soft_touches.h
struct SoftTouch {
    taut_contact_event event;  // handles alone, which stay what they were when a side is gone
    uint8_t asks = 0;          // bits of contact events, of all parts
    bool hit = false;          // gave a hit event in the last step
};
template <class Visitor, Like<SoftTouch> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [event, asks, hit] = of;
    TAUT_FIELDS(visitor, event, asks, hit);
}

// A pair of a vertex or a contact of a surface, that touches.
struct TouchPart {
    uint64_t key;  // of the two colliders of the SoftTouch
    bool surface;  // index: into SurfaceContacts::contact; else into Pairs::active, of the first with its pair
    uint32_t index;
};

struct SurfaceContacts {
    explicit SurfaceContacts(Memory& memory)
        : contact(memory),
          touch(memory),
          touch_now(memory),
          part(memory),
          gone(memory),
          found(memory),
          near_feature(memory),
          touching(memory),
          cut(memory),
          name_before(memory),
          order(memory),
          name_found(memory),
          name_merged(memory),
          near(memory),
          colliders(memory),
          corner(memory),
          span(memory),
          crossing(memory) {}

    Array<SurfaceContact> contact;  // ascending by a, then b; find_surface_contacts()
    Array<SoftTouch> touch;         // after the last step; ascending by slots of the two; publish_contacts()
    Array<SoftTouch> touch_now;     // scratch of that,
    Array<TouchPart> part;          // likewise
    Array<uint32_t> gone;           // nodes removed since: what contacts say of these means nothing
    uint64_t version = 0;           // counts changes of who touches whom

    // Scratch of find_surface_contacts().
    Array<SurfaceContact> found;
    SharedList<NearFeature> near_feature;
    SharedList<SurfaceContact> touching;
    SharedList<SurfaceCrossing> cut;
    Array<SurfaceContactName> name_before;  // of contact
    Array<SurfaceContactName> order;        // of found
    Array<SurfaceContactName> name_found, name_merged;
    Array<uint32_t> near, colliders;
    Array<collision::Corner> corner;
    Array<SurfaceSpan> span;
    Array<SurfaceCrossing> crossing;
};
template <class Visitor, Like<SurfaceContacts> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [contact, touch, touch_now, part, gone, version, found, near_feature, touching, cut, name_before, order,
           name_found, name_merged, near, colliders, corner, span, crossing] = of;
    TAUT_FIELDS(visitor, contact, gone);
    TAUT_ASIDE(visitor, version, touch);  // events change no motion
}

}  // namespace taut
