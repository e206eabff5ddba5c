// Trees of boxes over the triangles of soft bodies: made once from the triangles, refitted to where these go in a
// frame.
#pragma once

#include <span>

#include "state/colliders.h"
#include "state/shapes.h"
#include "state/softs.h"
#include "threads/team.h"

namespace taut {

// Brings Softs::mesh and listed up to date: positions, velocities and boxes of all that has a surface and touches, for
// what comes in a time [s]. What sleeps or stands costs a look at its vertices.
void refit_surfaces(Team& team, const Nodes& nodes, const Shapes& shapes, double time, Softs& softs);

// act(triangle) for those whose boxes meet one, in the mesh's frame.
template <class Act>
void for_triangles_in(const SurfaceMesh& mesh, const SurfaceBox& box, Act&& act) {
    const auto count = static_cast<uint32_t>(mesh.node.size());
    for (uint32_t i = 0; i < count;) {
        const SurfaceNode& node = mesh.node[i];
        const bool meets = node.box.meets(box);
        if (meets && node.leaf)
            for (uint32_t k = node.begin; k < node.end; ++k)
                if (mesh.box[mesh.order[k]].meets(box)) act(mesh.order[k]);
        // A node without children in the way is followed by what comes after it.
        i = meets && !node.leaf ? i + 1 : node.next;
    }
}

// act(triangle of a, triangle of b) for those of two meshes whose boxes meet; apart: from the origin of a to that of b
// [m], within a time [s]. Of a mesh with itself each pair once, and no triangle with itself.
template <class Act>
void for_meeting_triangles(const SurfaceMesh& a, const SurfaceMesh& b, const Vec3f& apart, float time, Act&& act) {
    const bool same = &a == &b;
    const Vec3f way = time * (a.drift - b.drift);  // of a as seen from b
    const auto count = static_cast<uint32_t>(a.node.size());
    for (uint32_t i = 0; i < count;) {
        const SurfaceNode& leaf = a.node[i];
        const bool meets = same || leaf.box.moved(-apart).swept(way).meets(b.node.front().box);
        if (meets && leaf.leaf) {
            for (uint32_t k = leaf.begin; k < leaf.end; ++k) {
                const uint32_t t = a.order[k];
                for_triangles_in(b, a.box[t].moved(-apart).swept(way), [&](uint32_t u) {
                    if (!same || t < u) act(t, u);
                });
            }
        }
        i = meets && !leaf.leaf ? i + 1 : leaf.next;
    }
}

}  // namespace taut
