// How much of a line is over a facet.
#pragma once

#include <algorithm>

#include "collision/narrowphase/segment.h"
#include "collision/narrowphase/surface.h"

namespace taut::collision {

// By the line's parameters, joined over a facet's triangles; empty: enter > leave.
struct Stretch {
    float enter = 2, leave = -1;

    bool is_empty() const { return enter > leave; }
    // Adds what planes through the triangle's edges along the facet's normal leave of the line. seam: room beyond
    // them, for a line over the seam of two triangles is over both [m].
    void join(const Segment& line, float seam, const Facet& facet, const SurfaceView::Triangle& triangle) {
        const Vec3f end = line.at(1);
        float first = 0, last = 1;
        for (int e = 0; e < 3; ++e) {
            const Vec3f& corner = triangle.at[e];
            Vec3f outward = (triangle.at[next_corner(e)] - corner).cross(facet.normal).normalized();
            if (facet.flipped) outward = -outward;
            const float from = outward.dot(line.from - corner) - seam;
            const float to = outward.dot(end - corner) - seam;
            if (from > 0 && to > 0) return;
            if (from > 0) first = std::max(first, from / (from - to));
            if (to > 0) last = std::min(last, from / (from - to));
        }
        if (first > last) return;
        enter = std::min(enter, first);
        leave = std::max(leave, last);
    }
};

}  // namespace taut::collision
