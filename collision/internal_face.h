// Faces inside of what several solids make up together: see narrowphase/internal_face.cpp.
#pragma once

#include "collision/collide.h"

namespace taut::collision {

// A contact as one of its two sides has it: in the frame of its shape, with the normal out of it and the points on it.
struct SolidContact {
    Vec3f normal;
    int count = 0;
    Vec3f points[4];
};

// What holds a body off: the plane normal . p = offset of its contact with one solid, in the frame of another's shape.
struct Cover {
    Vec3f normal;  // unit, towards the body
    float offset;  // [m]
    Vec3f middle;  // of the contact's points
    Vec3f body;    // middle of a ball that holds the body, and its radius with all that is near [m]
    float reach;
};

// How exactly faces have to lie in one plane to go on from one solid to the next under a convex body [m].
float flush_tolerance(const Shape& body);

// Whether the contact of a convex body with a solid, or a part of it, is with a face, or along the normal of a face,
// that is inside of what the solid and that of the cover make up together, as at the seams of a floor: the body cannot
// meet it while the cover holds.
bool is_internal(const Shape& body, const Shape& solid, uint32_t part, const SolidContact& contact, const Cover& cover);
// As collide(), with the faces of a box or hull that are not internal: the body's contact in place of such a one; of
// other solids none.
void collide_open(const Shape& body, const Placement& at_body, const Shape& solid, const Placement& at_solid,
                  const SolidContact& contact, const Cover& cover, bool solid_is_b, float margin, Manifold& out);

}  // namespace taut::collision
