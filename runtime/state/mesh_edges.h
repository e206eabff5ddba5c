// Edges of a triangle mesh, with the triangles beside them.
#pragma once

#include <span>

#include "base/memory.h"
#include "state/nodes.h"

namespace taut {

// Triangle (a, b, across[0]) on its left and, but at the rim, (b, a, across[1]) on its right.
struct MeshEdge {
    uint32_t a, b;
    uint32_t across[2];    // vertices; the second kNone at the rim
    uint32_t triangle[2];  // likewise
};

enum class MeshFault : uint8_t { none, not_manifold, not_oriented };

// Sorted by the lesser and the greater of their ends. A fault: more than two triangles at an edge, or two that go along
// it in the same direction; out is then undefined.
MeshFault find_edges(std::span<const uint32_t> triangles, Array<MeshEdge>& out);

}  // namespace taut
