// What a surface tells of itself as a whole.
#include "collision/surface.h"

namespace taut::collision {

SurfaceCounts surface_counts(const Shape& shape) { return shape.surface->counts; }

void surface_triangles(const Shape& shape, PointSink& points) {
    const Surface& surface = *shape.surface;
    const bool mirrored = shape.size.prod() < 0;
    for (uint32_t t = 0; t < surface.slots(); ++t) {
        if (!surface.has(t)) continue;
        Corners corners = surface.corners(t);
        if (mirrored) std::swap(corners[1], corners[2]);
        for (const uint32_t corner : corners) points.take(surface.vertex(corner).cwiseProduct(shape.size));
    }
}

}  // namespace taut::collision
