#include "detect/surface_cone.h"

#include <algorithm>
#include <limits>
#include <span>

namespace taut {
namespace {

// The normals about one edge, an arc of a circle across it: from the one triangle's, n_1 = e x t_1, to the other's,
// n_2 = t_2 x e, t: across the edge into the triangle, all unit; at a rim from n_1 over -t_1 to -n_1.
class EdgeArc {
public:
    EdgeArc(const Soft& soft, const SurfaceMesh& mesh, const SurfaceEdge& edge) {
        const Vec3f& from = mesh.x[edge.vertex[0]];
        along_ = (mesh.x[edge.vertex[1]] - from).normalized();
        for (const uint32_t t : edge.triangle) {
            if (t == kNone) continue;
            const uint32_t* corner = &soft.triangle[3 * size_t{t}];
            uint32_t other = corner[0];
            for (int k = 1; k < 3 && (other == edge.vertex[0] || other == edge.vertex[1]); ++k) other = corner[k];
            into_[count_] = across(mesh.x[other] - from).normalized();
            normal_[count_] = count_ == 0 ? along_.cross(into_[0]) : into_[1].cross(along_);
            ++count_;
        }
        if (soft.kind != SoftKind::solid) return;
        const uint32_t* corner = &soft.triangle[3 * size_t{edge.triangle[0]}];
        const Vec3f &x = mesh.x[corner[0]], outward = (mesh.x[corner[1]] - x).cross(mesh.x[corner[2]] - x);
        outward_ = normal_[0].dot(outward) < 0 ? -1.0f : 1.0f;
    }

    // Unit; 0 where the direction is along the edge, or goes into a solid.
    Vec3f nearest(const Vec3f& direction) const {
        const Vec3f d = across(direction);
        const float length = d.norm();
        if (!(length > 0)) return Vec3f::Zero();
        const Vec3f unit = (1 / length) * d;
        if (count_ == 1) {
            if (!(unit.dot(into_[0]) > 0)) return unit;
            return unit.dot(normal_[0]) < 0 ? Vec3f(-normal_[0]) : normal_[0];
        }
        const float sign = unit.dot(normal_[0] + normal_[1]) < 0 ? -1.0f : 1.0f;
        if (sign * outward_ < 0) return Vec3f::Zero();
        const float one = unit.dot(into_[0]), other = unit.dot(into_[1]);
        if (one * other >= 0) return unit;  // off both triangles, or over both
        const bool first = sign * unit.dot(normal_[0] - normal_[1]) > 0;
        return sign * normal_[first ? 0 : 1];
    }

private:
    Vec3f across(const Vec3f& way) const { return way - way.dot(along_) * along_; }

    Vec3f along_, into_[2] = {Vec3f::Zero(), Vec3f::Zero()}, normal_[2] = {Vec3f::Zero(), Vec3f::Zero()};
    int count_ = 0;
    float outward_ = 0;  // sign of the normals that point out of a solid; 0: of a sheet
};

Vec3f in_cone_of_edge(const Soft& soft, const SurfaceMesh& mesh, uint32_t edge, const Vec3f& direction) {
    const Vec3f nearest = EdgeArc(soft, mesh, mesh.edge[edge]).nearest(direction);
    return nearest == Vec3f::Zero() ? direction : nearest;
}

Vec3f in_cone_of_vertex(const Soft& soft, const SurfaceMesh& mesh, uint32_t vertex, const Vec3f& direction) {
    const std::span<const uint32_t> ring(mesh.ring.data() + mesh.ring_begin[vertex],
                                         mesh.ring_begin[vertex + 1] - mesh.ring_begin[vertex]);
    // Off all edges, as the normals at what is convex are, or over all, as at what is hollow.
    float least = std::numeric_limits<float>::infinity(), most = -least;
    for (const uint32_t e : ring) {
        const uint32_t* end = mesh.edge[e].vertex;
        const float over = direction.dot(mesh.x[end[end[0] == vertex ? 1 : 0]] - mesh.x[vertex]);
        least = std::min(least, over);
        most = std::max(most, over);
    }
    if (!(most > 0 && least < 0)) return direction;
    Vec3f best = direction;
    float nearest = -1;
    for (const uint32_t e : ring) {
        const Vec3f of = EdgeArc(soft, mesh, mesh.edge[e]).nearest(direction);
        if (of == Vec3f::Zero() || !(of.dot(direction) > nearest)) continue;
        nearest = of.dot(direction);
        best = of;
    }
    return best;
}

}  // namespace

SurfaceFeature held_feature(const Nodes& nodes, const SurfaceFeature& feature) {
    const auto moves = [&](uint32_t vertex) { return nodes.solved(feature.soft->node[vertex]); };
    if (feature.of == SurfaceFeature::Of::vertex && moves(feature.index)) return {};
    if (feature.of == SurfaceFeature::Of::edge && std::ranges::any_of(feature.mesh->edge[feature.index].vertex, moves))
        return {};
    return feature;
}

Vec3f SurfaceFeature::in_cone(const Vec3f& direction) const {
    switch (of) {
        case Of::vertex:
            return in_cone_of_vertex(*soft, *mesh, index, direction);
        case Of::edge:
            return in_cone_of_edge(*soft, *mesh, index, direction);
        case Of::none:
            break;
    }
    return direction;
}

}  // namespace taut
