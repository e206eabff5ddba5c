// Trees of boxes over the triangles of soft bodies: made once from the triangles, refitted to where these go in a
// frame.
#pragma once

#include <bit>

#include "detect/surface_contacts.h"
#include "detect/triangle_pairs.h"

namespace taut {

// Brings Softs::mesh and listed up to date: positions, velocities and boxes of all that has a surface and touches, for
// what comes in a time. What sleeps or stands costs a look at its vertices. Within a frame those alone of which all
// vertices may be renewed are listed.
void refit_surfaces(Team& team, const SurfaceScene& scene);

constexpr float kFlat = 0.5f;  // cosine between normals: what hangs together and is bent by less does not meet itself

// Whether unit normals between bounds differ by little: by d they have the cosine 1 - d^2 / 2.
inline bool are_flat(const SurfaceBox& normals) { return (normals.hi - normals.lo).squaredNorm() < 2 * (1 - kFlat); }

// act(leaf) for those whose boxes meet one, in the mesh's frame, from a node of the tree on; renewed: those alone whose
// contacts are found anew.
template <class Act>
void for_leaves_in(const SurfaceMesh& mesh, const SurfaceBox& box, Act&& act, uint32_t from = 0, bool renewed = false) {
    const auto count = static_cast<uint32_t>(mesh.node.size());
    for (uint32_t i = from; i < count;) {
        const SurfaceNode& node = mesh.node[i];
        const bool meets = node.box.meets(box) && (node.renewed || !renewed);
        const bool is_leaf = node.leaf != kNone;
        if (meets && is_leaf) act(mesh.leaf[node.leaf]);
        i = meets && !is_leaf ? i + 1 : node.next;
    }
}

// act(triangle) likewise.
template <class Act>
void for_triangles_in(const SurfaceMesh& mesh, const SurfaceBox& box, Act&& act) {
    const SurfaceBoxEnds ends = ends_of(box);
    for_leaves_in(mesh, box, [&](const SurfaceLeaf& leaf) {
        for (unsigned met = triangle_pair_kernel().meets(leaf.way, ends); met != 0; met &= met - 1)
            act(leaf.triangle[std::countr_zero(met)]);
    });
}

}  // namespace taut
