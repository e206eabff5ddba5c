// The surface of a body's colliders as triangles in the world, read by the calls of the interface.
#pragma once

#include <taut/collider.h>
#include <taut/shape.h>

#include "api/access.h"

namespace taut {

struct SurfaceTriangle {
    Vec3 corner[3];  // [m], relative to some origin; counter-clockwise from outside
};

// Those of a shape in its own frame; none of planes, meshes and height fields, which have no volume.
taut_result read_surface(taut_shape shape, Array<SurfaceTriangle>& out);
// Those of a collider at the pose of its body, relative to an origin.
taut_result read_surface(taut_collider collider, const Vec3& body_position, const Quat& body_rotation,
                         Array<SurfaceTriangle>& out);

}  // namespace taut
