#include "detect/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "detect/surface_finder.h"
#include "state/mesh_edges.h"

namespace taut {
namespace {

constexpr uint32_t kLeaf = 4;           // triangles, at most
constexpr uint32_t kVertexGrain = 256;  // triangles or vertices that a thread takes at a time

// Halves by the middle along the axis on which middles of triangles are spread widest.
class TreeBuilder {
public:
    TreeBuilder(SurfaceMesh& mesh, std::span<const Vec3f> middle) : mesh_(mesh), middle_(middle) {}

    void build(uint32_t begin, uint32_t end) {
        const auto index = static_cast<uint32_t>(mesh_.node.size());
        mesh_.node.push_back({SurfaceBox::none(), begin, end, 0, false, false, SurfaceBox::none()});
        if (end - begin <= kLeaf) {
            mesh_.node[index].leaf = true;
        } else {
            const uint32_t half = split(begin, end);
            build(begin, half);
            build(half, end);
        }
        mesh_.node[index].next = static_cast<uint32_t>(mesh_.node.size());
    }

private:
    uint32_t split(uint32_t begin, uint32_t end) {
        SurfaceBox all = SurfaceBox::none();
        for (uint32_t k = begin; k < end; ++k) all.add(middle_[mesh_.order[k]]);
        int axis = 0;
        (all.hi - all.lo).maxCoeff(&axis);
        const uint32_t half = (begin + end) / 2;
        const auto at = [&](uint32_t k) { return mesh_.order.begin() + k; };
        std::nth_element(at(begin), at(half), at(end), [&](uint32_t one, uint32_t other) {
            const float a = middle_[one][axis], b = middle_[other][axis];
            return a != b ? a < b : one < other;
        });
        return half;
    }

    SurfaceMesh& mesh_;
    std::span<const Vec3f> middle_;
};

void list_edges(const Soft& soft, SurfaceMesh& mesh) {
    Array<MeshEdge> edges(mesh.edge.get_allocator());
    find_edges(soft.triangle, edges);
    mesh.edge.clear();
    mesh.edge_of.assign(soft.triangle.size(), kNone);
    mesh.owns.assign(soft.triangles(), 0);
    for (const MeshEdge& edge : edges) {
        for (const uint32_t t : edge.triangle) {
            if (t == kNone) continue;
            for (uint32_t k = 0; k < 3; ++k) {
                const uint32_t from = soft.triangle[3 * t + k], to = soft.triangle[3 * t + (k + 1) % 3];
                if (std::minmax(from, to) != std::minmax(edge.a, edge.b)) continue;
                mesh.edge_of[3 * t + k] = static_cast<uint32_t>(mesh.edge.size());
                if (t == edge.triangle[0]) mesh.owns[t] = static_cast<uint8_t>(mesh.owns[t] | 1u << k);
            }
        }
        mesh.edge.push_back({{edge.a, edge.b}, {edge.triangle[0], edge.triangle[1]}});
    }
    Array<uint8_t> owned(soft.vertices(), 0, mesh.owns.get_allocator());
    for (uint32_t i = 0; i < soft.triangle.size(); ++i)
        if (!std::exchange(owned[soft.triangle[i]], 1))
            mesh.owns[i / 3] = static_cast<uint8_t>(mesh.owns[i / 3] | 8u << i % 3);
}

void list_rings(const Soft& soft, SurfaceMesh& mesh) {
    mesh.ring_begin.assign(soft.vertices() + 1, 0);
    for (const SurfaceEdge& edge : mesh.edge)
        for (const uint32_t vertex : edge.vertex) ++mesh.ring_begin[vertex];
    for (uint32_t v = 0; v < soft.vertices(); ++v) mesh.ring_begin[v + 1] += mesh.ring_begin[v];
    mesh.ring.resize(2 * mesh.edge.size());
    for (auto e = static_cast<uint32_t>(mesh.edge.size()); e-- > 0;)
        for (const uint32_t vertex : mesh.edge[e].vertex) mesh.ring[--mesh.ring_begin[vertex]] = e;
}

void build_tree(const Soft& soft, SurfaceMesh& mesh) {
    Array<Vec3f> middle(mesh.x.get_allocator());
    middle.reserve(soft.triangles());
    mesh.order.clear();
    for (uint32_t t = 0; t < soft.triangles(); ++t) {
        Vec3f sum = Vec3f::Zero();
        for (uint32_t k = 0; k < 3; ++k) sum += mesh.x[soft.triangle[3 * t + k]];
        middle.push_back(sum);
        mesh.order.push_back(t);
    }
    mesh.node.clear();
    mesh.node.reserve(soft.triangles());
    TreeBuilder(mesh, middle).build(0, soft.triangles());
    mesh.box.assign(soft.triangles(), SurfaceBox::none());
    mesh.face.resize(soft.triangles());
}

// Which nodes' triangles hang together: each edge joins its two in the smallest node that has both, and nodes come
// after those below them.
void find_whole(SurfaceMesh& mesh) {
    Array<uint32_t> place(mesh.order.size(), 0, mesh.order.get_allocator());
    for (uint32_t k = 0; k < mesh.order.size(); ++k) place[mesh.order[k]] = k;
    struct Join {
        uint32_t node, one, other;
    };
    Array<Join> joins(mesh.edge.get_allocator());
    for (const SurfaceEdge& edge : mesh.edge) {
        if (edge.triangle[0] == kNone || edge.triangle[1] == kNone) continue;
        const auto [low, high] = std::minmax(place[edge.triangle[0]], place[edge.triangle[1]]);
        uint32_t at = 0;
        for (bool below = true; below && !mesh.node[at].leaf;) {
            below = false;
            for (const uint32_t child : {at + 1, mesh.node[at + 1].next})
                if (!below && mesh.node[child].begin <= low && high < mesh.node[child].end) at = child, below = true;
        }
        joins.push_back({at, low, high});
    }
    std::ranges::sort(joins, {}, [](const Join& join) { return std::tuple(~join.node, join.one, join.other); });
    Array<uint32_t> parent(mesh.order.size(), 0, mesh.order.get_allocator());
    for (uint32_t k = 0; k < parent.size(); ++k) parent[k] = k;
    const auto root = [&](uint32_t k) {
        while (parent[k] != k) k = parent[k] = parent[parent[k]];
        return k;
    };
    Array<uint32_t> parts(mesh.node.size(), 0, mesh.order.get_allocator());
    auto join = joins.begin();
    for (auto i = static_cast<uint32_t>(mesh.node.size()); i-- > 0;) {
        SurfaceNode& node = mesh.node[i];
        parts[i] = node.leaf ? node.end - node.begin : parts[i + 1] + parts[mesh.node[i + 1].next];
        for (; join != joins.end() && join->node == i; ++join) {
            const uint32_t one = root(join->one), other = root(join->other);
            parts[i] -= one != other;
            parent[std::max(one, other)] = std::min(one, other);
        }
        node.whole = parts[i] == 1;
    }
}

void place_vertices(Team& team, const SurfaceScene& scene, const Soft& soft, SurfaceMesh& mesh) {
    mesh.origin = scene.place_of(soft.node.front());
    mesh.x.resize(soft.vertices());
    mesh.v.resize(soft.vertices());
    team.for_ranges(soft.vertices(), kVertexGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            mesh.x[i] = (scene.place_of(soft.node[i]) - mesh.origin).cast<float>();
            mesh.v[i] = scene.nodes.motion[soft.node[i]].v.cast<float>();
        }
    });
    mesh.drift.setZero();
    for (const Vec3f& v : mesh.v) mesh.drift += v;
    mesh.drift *= 1 / static_cast<float>(soft.vertices());
}

// Boxes about the ways of triangles, grown so that two that come within their margin meet.
void refit(Team& team, const Soft& soft, float time, SurfaceMesh& mesh) {
    const float about = mesh.radius + mesh.margin;
    team.for_ranges(soft.triangles(), kVertexGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t t = begin; t < end; ++t) {
            SurfaceFace& face = mesh.face[t];
            face.box = SurfaceBox::none();
            face.v = Vec3f::Zero();
            Vec3f then[3];
            SurfaceBox box = SurfaceBox::none();
            const uint32_t* corner = &soft.triangle[3 * size_t{t}];
            for (int k = 0; k < 3; ++k) {
                face.box.add(mesh.x[corner[k]]);
                then[k] = mesh.x[corner[k]] + time * (mesh.v[corner[k]] - mesh.drift);
                box.add(then[k]);
                face.v += (1.0f / 3) * mesh.v[corner[k]];
            }
            const Vec3f& from = mesh.x[corner[0]];
            face.normal = (mesh.x[corner[1]] - from).cross(mesh.x[corner[2]] - from);
            face.normal *= 1 / std::max(face.normal.norm(), 1e-30f);
            face.later = (then[1] - then[0]).cross(then[2] - then[0]);
            face.later *= 1 / std::max(face.later.norm(), 1e-30f);
            float squared = 0;
            for (int k = 0; k < 3; ++k) squared = std::max(squared, (mesh.v[corner[k]] - face.v).squaredNorm());
            face.spread = std::sqrt(squared);
            box.add(face.box);
            mesh.box[t] = box.grown(about);
        }
    });
    for (size_t i = mesh.node.size(); i-- > 0;) {
        SurfaceNode& node = mesh.node[i];
        node.box = node.normals = SurfaceBox::none();
        if (node.leaf) {
            for (uint32_t k = node.begin; k < node.end; ++k) {
                const uint32_t t = mesh.order[k];
                node.box.add(mesh.box[t]);
                node.normals.add(mesh.face[t].normal);
                node.normals.add(mesh.face[t].later);
            }
        } else {
            for (const SurfaceNode* below : {&mesh.node[i + 1], &mesh.node[mesh.node[i + 1].next]}) {
                node.box.add(below->box);
                node.normals.add(below->normals);
            }
        }
    }
}

}  // namespace

void refit_surfaces(Team& team, const SurfaceScene& scene) {
    const Nodes& nodes = scene.nodes;
    Softs& softs = scene.softs;
    softs.listed.clear();
    while (softs.mesh.size() < softs.record.size()) softs.mesh.emplace_back(*softs.mesh.get_allocator().memory);
    for (uint32_t s = 0; s < softs.record.size(); ++s) {
        const Soft& soft = softs.record[s];
        SurfaceMesh& mesh = softs.mesh[s];
        if (soft.shape == kNone || soft.triangle.empty()) {
            if (mesh.version != 0) mesh = SurfaceMesh(*softs.mesh.get_allocator().memory);
            continue;
        }
        mesh.awake = std::ranges::any_of(soft.node, [&](uint32_t node) { return moves_now(nodes, node); });
        mesh.collider = nodes.info[soft.node[soft.triangle.front()]].collider;
        if (mesh.collider == kNone) continue;
        if (!std::ranges::all_of(soft.node, [&](uint32_t node) { return scene.may_renew(node); })) continue;
        softs.listed.push_back(s);
        const bool made_anew = mesh.version != soft.mesh_version;
        if (!mesh.awake && !made_anew) continue;
        place_vertices(team, scene, soft, mesh);
        if (made_anew) {
            list_edges(soft, mesh);
            list_rings(soft, mesh);
            build_tree(soft, mesh);
            find_whole(mesh);
            mesh.version = soft.mesh_version;
        }
        mesh.radius = collision::ball_radius(scene.shapes[soft.shape].shape);
        mesh.margin = scene.shapes[soft.shape].margin;
        refit(team, soft, static_cast<float>(scene.time), mesh);
    }
}

}  // namespace taut
