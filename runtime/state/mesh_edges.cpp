#include "state/mesh_edges.h"

#include <algorithm>
#include <tuple>

namespace taut {

MeshFault find_edges(std::span<const uint32_t> triangles, Array<MeshEdge>& out) {
    out.clear();
    out.reserve(triangles.size());
    for (uint32_t t = 0; 3 * t < triangles.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const auto corner = [&](uint32_t n) { return triangles[3 * t + (k + n) % 3]; };
            out.push_back({corner(0), corner(1), {corner(2), kNone}, {t, kNone}});
        }
    const auto key = [](const MeshEdge& e) {
        return std::tuple(std::min(e.a, e.b), std::max(e.a, e.b), e.a > e.b, e.triangle[0]);
    };
    std::ranges::sort(out, {}, key);
    const auto same = [](const MeshEdge& e, const MeshEdge& f) {
        return std::minmax(e.a, e.b) == std::minmax(f.a, f.b);
    };
    uint32_t kept = 0;
    for (uint32_t i = 0; i < out.size(); ++kept) {
        MeshEdge edge = out[i++];
        if (i < out.size() && same(edge, out[i])) {
            if (edge.a == out[i].a) return MeshFault::not_oriented;
            edge.across[1] = out[i].across[0];
            edge.triangle[1] = out[i++].triangle[0];
        }
        if (i < out.size() && same(edge, out[i])) return MeshFault::not_manifold;
        out[kept] = edge;
    }
    out.resize(kept);
    return MeshFault::none;
}

}  // namespace taut
