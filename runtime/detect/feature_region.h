// Voronoi regions of the edges and vertices of a surface: what is nearest to an edge lies beyond both of its faces, to
// a vertex beyond all of its edges. So a normal belongs to one feature, and nothing catches on an edge within what is
// flat.
#pragma once

#include "state/softs.h"

namespace taut {

constexpr float kRegion = 1e-3f;  // sine by which a direction may lean into another feature's: rounding

// direction: unit, away from the edge.
inline bool is_in_region_of_edge(const Soft& soft, const SurfaceMesh& mesh, uint32_t edge, const Vec3f& direction,
                                 float slack = kRegion) {
    const SurfaceEdge& of = mesh.edge[edge];
    const Vec3f &from = mesh.x[of.vertex[0]], along = mesh.x[of.vertex[1]] - from;
    for (const uint32_t t : of.triangle) {
        if (t == kNone) continue;
        const uint32_t* corner = &soft.triangle[3 * size_t{t}];
        uint32_t opposite = corner[0];
        for (int k = 1; k < 3; ++k)
            if (opposite == of.vertex[0] || opposite == of.vertex[1]) opposite = corner[k];
        const Vec3f across = mesh.x[opposite] - from;
        const Vec3f inwards = across - (across.dot(along) / std::max(along.squaredNorm(), 1e-30f)) * along;
        if (direction.dot(inwards) > slack * inwards.norm()) return false;
    }
    return true;
}

inline bool is_in_region_of_vertex(const SurfaceMesh& mesh, uint32_t vertex, const Vec3f& direction) {
    for (uint32_t k = mesh.ring_begin[vertex]; k < mesh.ring_begin[vertex + 1]; ++k) {
        const uint32_t* ends = mesh.edge[mesh.ring[k]].vertex;
        const Vec3f along = mesh.x[ends[0] == vertex ? ends[1] : ends[0]] - mesh.x[vertex];
        if (direction.dot(along) > kRegion * along.norm()) return false;
    }
    return true;
}

}  // namespace taut
