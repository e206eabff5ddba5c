// Where contacts of surfaces are in the world, and how fast they close.
#pragma once

#include "state/colliders.h"
#include "state/shapes.h"
#include "state/surface_contacts.h"

namespace taut {

// Of one side: its node that counts most, and where its point is now, on its surface [m].
struct SurfaceSide {
    uint32_t node = kNone;
    Vec3 at = Vec3::Zero();
};
// That whose weights have a sign, 1 or -1.
SurfaceSide side_of(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const SurfaceContact& contact,
                    float sign);

// How fast the gap closes now [m/s].
float closing_speed(const Nodes& nodes, const SurfaceContact& contact);

// Whether some node of it is awake, and moves by forces or as its host says.
bool is_awake(const Nodes& nodes, const SurfaceContact& contact);

}  // namespace taut
