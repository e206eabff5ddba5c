// Trees of boxes over the triangles of soft bodies: made once from the triangles, refitted to where these go in a
// frame.
#pragma once

#include <algorithm>

#include "detect/surface_contacts.h"

namespace taut {

// Brings Softs::mesh and listed up to date: positions, velocities and boxes of all that has a surface and touches, for
// what comes in a time. What sleeps or stands costs a look at its vertices. Within a frame those alone of which all
// vertices may be renewed are listed.
void refit_surfaces(Team& team, const SurfaceScene& scene);

constexpr float kFlat = 0.5f;  // cosine between normals: what hangs together and is bent by less does not meet itself

// Whether no triangle of a node meets another of it: unit normals that differ by d have the cosine 1 - d^2 / 2.
inline bool is_flat(const SurfaceNode& node) {
    return node.whole && (node.normals.hi - node.normals.lo).squaredNorm() < 2 * (1 - kFlat);
}

// act(leaf) for those whose boxes meet one, in the mesh's frame, from a node of the tree on.
template <class Act>
void for_leaves_in(const SurfaceMesh& mesh, const SurfaceBox& box, Act&& act, uint32_t from = 0) {
    const auto count = static_cast<uint32_t>(mesh.node.size());
    for (uint32_t i = from; i < count;) {
        const SurfaceNode& node = mesh.node[i];
        const bool meets = node.box.meets(box);
        if (meets && node.leaf) act(node);
        i = meets && !node.leaf ? i + 1 : node.next;
    }
}

// act(triangle) likewise.
template <class Act>
void for_triangles_in(const SurfaceMesh& mesh, const SurfaceBox& box, Act&& act) {
    for_leaves_in(mesh, box, [&](const SurfaceNode& leaf) {
        for (uint32_t k = leaf.begin; k < leaf.end; ++k)
            if (mesh.box[mesh.order[k]].meets(box)) act(mesh.order[k]);
    });
}

// act(triangle of a, triangle of b, by which they move past each other [m]) for those of two meshes that may come
// within a reach in a time [s]: apart: from the origin of a to that of b [m]. Of a mesh with itself each pair once, and
// no triangle with itself.
template <class Act>
void for_meeting_triangles(const SurfaceMesh& a, const SurfaceMesh& b, const Vec3f& apart, float reach, float time,
                           Act&& act) {
    const bool same = &a == &b;
    const Vec3f way = time * (a.drift - b.drift);  // of a as seen from b
    const auto meet = [&](const SurfaceNode& one, const SurfaceNode& other) {
        for (uint32_t i = one.begin; i < one.end; ++i) {
            const uint32_t t = a.order[i];
            const SurfaceBox swept = a.box[t].moved(-apart).swept(way);
            if (!swept.meets(other.box)) continue;
            const SurfaceBox box = a.face[t].box.moved(-apart);
            for (uint32_t k = &one == &other ? i + 1 : other.begin; k < other.end; ++k) {
                const uint32_t u = b.order[k];
                if (!swept.meets(b.box[u])) continue;
                const float speed = (a.face[t].v - b.face[u].v).norm() + a.face[t].spread + b.face[u].spread;
                const float moved = time * speed;
                if (!box.is_near(b.face[u].box, reach + moved)) continue;
                // Of itself in the order of the host, which no tree changes.
                if (same && u < t)
                    act(u, t, moved);
                else
                    act(t, u, moved);
            }
        }
    };
    uint32_t flat_end = 0;  // after what is below the flat node that this one is below
    for (uint32_t i = 0; i < static_cast<uint32_t>(a.node.size());) {
        const SurfaceNode& node = a.node[i];
        if (same && i >= flat_end && is_flat(node)) flat_end = node.next;
        const SurfaceBox box = node.box.moved(-apart).swept(way);
        const bool meets = same || box.meets(b.node.front().box);
        if (meets && node.leaf)
            for_leaves_in(
                b, box, [&](const SurfaceNode& leaf) { meet(node, leaf); }, same ? std::max(i, flat_end) : 0);
        i = meets && !node.leaf ? i + 1 : node.next;
    }
}

}  // namespace taut
