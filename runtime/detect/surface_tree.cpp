#include "detect/surface_tree.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "detect/surface_finder.h"
#include "state/mesh_edges.h"

namespace taut {
namespace {

constexpr uint32_t kRefitGrain = 16;  // leaves that a thread takes at a time

// Halves by the middle along the axis on which middles of triangles are spread widest.
class TreeBuilder {
public:
    TreeBuilder(SurfaceMesh& mesh, std::span<const Vec3f> middle) : mesh_(mesh), middle_(middle) {}

    void build(uint32_t begin, uint32_t end) {
        const auto index = static_cast<uint32_t>(mesh_.node.size());
        mesh_.node.push_back({SurfaceBox::none(), begin, end, 0});
        if (end - begin <= static_cast<uint32_t>(kLanes)) {
            add_leaf(index);
        } else {
            const uint32_t half = split(begin, end);
            build(begin, half);
            build(half, end);
        }
        mesh_.node[index].next = static_cast<uint32_t>(mesh_.node.size());
    }

private:
    void add_leaf(uint32_t node) {
        SurfaceNode& of = mesh_.node[node];
        of.leaf = static_cast<uint32_t>(mesh_.leaf.size());
        SurfaceLeaf& leaf = mesh_.leaf.emplace_back(SurfaceLeaf{});
        leaf.node = node;
        leaf.count = of.end - of.begin;
        for (uint32_t lane = 0; lane < static_cast<uint32_t>(kLanes); ++lane) {
            set_lane(leaf.way, static_cast<int>(lane), SurfaceBox::none());
            set_lane(leaf.box, static_cast<int>(lane), SurfaceBox::none());
            leaf.triangle[lane] = lane < leaf.count ? mesh_.order[of.begin + lane] : kNone;
            if (lane < leaf.count) mesh_.place_of[leaf.triangle[lane]] = of.leaf * static_cast<uint32_t>(kLanes) + lane;
        }
    }

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
    mesh.owner.assign(soft.vertices(), kNone);
    for (uint32_t i = 0; i < soft.triangle.size(); ++i) {
        uint32_t& owner = mesh.owner[soft.triangle[i]];
        if (owner != kNone) continue;
        owner = i / 3;
        mesh.owns[i / 3] = static_cast<uint8_t>(mesh.owns[i / 3] | 8u << i % 3);
    }
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
    mesh.leaf.clear();
    mesh.place_of.assign(soft.triangles(), kNone);
    TreeBuilder(mesh, middle).build(0, soft.triangles());
    mesh.normal.assign(soft.triangles(), Vec3f::Zero());
}

void list_leaves_beside(const Soft& soft, SurfaceMesh& mesh) {
    Array<std::pair<uint32_t, uint32_t>> of_vertex(mesh.order.get_allocator()), beside(mesh.order.get_allocator());
    for (uint32_t leaf = 0; leaf < mesh.leaf.size(); ++leaf)
        for (uint32_t lane = 0; lane < mesh.leaf[leaf].count; ++lane)
            for (size_t k = 0; k < 3; ++k)
                of_vertex.emplace_back(soft.triangle[3 * size_t{mesh.leaf[leaf].triangle[lane]} + k], leaf);
    std::ranges::sort(of_vertex);
    for (size_t i = 0; i < of_vertex.size(); ++i)
        for (size_t k = i + 1; k < of_vertex.size() && of_vertex[k].first == of_vertex[i].first; ++k)
            if (of_vertex[i].second != of_vertex[k].second)
                beside.emplace_back(of_vertex[i].second, of_vertex[k].second);
    std::ranges::sort(beside);
    const auto same = std::ranges::unique(beside);
    beside.erase(same.begin(), same.end());
    mesh.beside_begin.assign(mesh.leaf.size() + 1, 0);
    mesh.beside.clear();
    for (const auto& [leaf, other] : beside) {
        ++mesh.beside_begin[leaf + 1];
        mesh.beside.push_back(other);
    }
    for (size_t leaf = 0; leaf < mesh.leaf.size(); ++leaf) mesh.beside_begin[leaf + 1] += mesh.beside_begin[leaf];
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
        for (bool below = true; below && mesh.node[at].leaf == kNone;) {
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
        parts[i] = node.leaf != kNone ? node.end - node.begin : parts[i + 1] + parts[mesh.node[i + 1].next];
        for (; join != joins.end() && join->node == i; ++join) {
            const uint32_t one = root(join->one), other = root(join->other);
            parts[i] -= one != other;
            parent[std::max(one, other)] = std::min(one, other);
        }
        node.whole = parts[i] == 1;
    }
}

// Those that keep to the ways that contacts were found for go on along these; of others, or all, it begins anew.
void place_vertices(const SurfaceScene& scene, const Soft& soft, bool all, SurfaceMesh& mesh) {
    if (all) mesh.origin = scene.place_of(soft.node.front());
    mesh.x.resize(soft.vertices());
    mesh.v.resize(soft.vertices());
    mesh.way.resize(soft.vertices());
    mesh.strayed.resize(soft.vertices());
    const auto since = static_cast<float>(scene.since);
    const float most = kRenews * kRenews * mesh.margin * mesh.margin;
    mesh.drift.setZero();
    for (uint32_t i = 0; i < soft.vertices(); ++i) {
        mesh.x[i] = (scene.place_of(soft.node[i]) - mesh.origin).cast<float>();
        if (!all) mesh.way[i] += since * mesh.v[i];
        mesh.strayed[i] = all || !((mesh.x[i] - mesh.way[i]).squaredNorm() <= most);
        if (mesh.strayed[i]) {
            mesh.way[i] = mesh.x[i];
            mesh.v[i] = scene.nodes.motion[soft.node[i]].v.cast<float>();
        }
        mesh.drift += mesh.v[i];
    }
    mesh.drift *= 1 / static_cast<float>(soft.vertices());
}

Vec3f unit(const Vec3f& a) { return (1 / std::max(a.norm(), 1e-30f)) * a; }

// Whether contacts of a triangle are found anew, and for how long: what moves as it did may keep to its way as long
// again, and longer.
bool renew(const SurfaceScene& scene, const SurfaceMesh& mesh, const uint32_t* corner, float& lasted, float& left) {
    const auto since = static_cast<float>(scene.since), all = static_cast<float>(scene.time);
    lasted += since;
    left -= since;
    const bool strayed = mesh.strayed[corner[0]] || mesh.strayed[corner[1]] || mesh.strayed[corner[2]];
    if (!strayed && !is_over(left, scene.step)) return false;
    left = scene.renewed.empty() ? all : std::min(all, 2 * lasted);
    lasted = 0;
    return true;
}

// Boxes about the ways of its triangles, grown so that two that come within their margin meet.
void refit_leaf(const SurfaceScene& scene, const Soft& soft, SurfaceMesh& mesh, SurfaceLeaf& leaf) {
    SurfaceNode& node = mesh.node[leaf.node];
    node.box = node.normals = SurfaceBox::none();
    leaf.renewed = 0;
    for (uint32_t lane = 0; lane < leaf.count; ++lane) {
        const uint32_t* corner = &soft.triangle[3 * size_t{leaf.triangle[lane]}];
        if (renew(scene, mesh, corner, leaf.lasted[lane], leaf.left[lane])) leaf.renewed |= 1u << lane;
        const float time = leaf.left[lane];
        const Vec3f *x[3], *v[3];
        Vec3f then[3];
        SurfaceBox box = SurfaceBox::none(), way = SurfaceBox::none();
        for (int k = 0; k < 3; ++k) {
            x[k] = &mesh.x[corner[k]], v[k] = &mesh.v[corner[k]];
            then[k] = *x[k] + time * (*v[k] - mesh.drift);
            box.add(*x[k]);
            way.add(then[k]);
        }
        way.add(box);
        const Vec3f mean = (1.0f / 3) * (*v[0] + *v[1] + *v[2]);
        float squared = 0;
        for (int k = 0; k < 3; ++k) squared = std::max(squared, (*v[k] - mean).squaredNorm());
        const int at = static_cast<int>(lane);
        way = way.grown(mesh.radius + mesh.margin);
        set_lane(leaf.way, at, way);
        set_lane(leaf.box, at, box);
        for (int i = 0; i < 3; ++i) leaf.v[i][lane] = mean[i];
        leaf.spread[lane] = std::sqrt(squared);
        const Vec3f normal = unit((*x[1] - *x[0]).cross(*x[2] - *x[0]));
        mesh.normal[leaf.triangle[lane]] = normal;
        node.box.add(way);
        node.normals.add(normal);
        node.normals.add(unit((then[1] - then[0]).cross(then[2] - then[0])));
    }
    node.renewed = leaf.renewed != 0;
}

void refit(Team& team, const SurfaceScene& scene, const Soft& soft, SurfaceMesh& mesh) {
    team.for_ranges(static_cast<uint32_t>(mesh.leaf.size()), kRefitGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) refit_leaf(scene, soft, mesh, mesh.leaf[i]);
    });
    for (size_t i = mesh.node.size(); i-- > 0;) {
        SurfaceNode& node = mesh.node[i];
        if (node.leaf != kNone) continue;
        node.box = node.normals = SurfaceBox::none();
        node.renewed = false;
        for (const SurfaceNode* below : {&mesh.node[i + 1], &mesh.node[mesh.node[i + 1].next]}) {
            node.box.add(below->box);
            node.normals.add(below->normals);
            node.renewed = node.renewed || below->renewed;
        }
    }
    mesh.left = static_cast<float>(scene.time);
    for (const SurfaceLeaf& leaf : mesh.leaf)
        mesh.left = std::min(mesh.left, *std::min_element(leaf.left, leaf.left + leaf.count));
    uint32_t past_flat = 0;
    for (uint32_t i = 0; i < mesh.node.size(); ++i) {
        const SurfaceNode& node = mesh.node[i];
        if (i >= past_flat && node.whole && are_flat(node.normals)) past_flat = node.next;
        if (node.leaf != kNone) mesh.leaf[node.leaf].past_flat = past_flat;
    }
}

// What sleeps or stands strays from no way.
void keep_all(float time, SurfaceMesh& mesh) {
    for (SurfaceNode& node : mesh.node) node.renewed = false;
    for (SurfaceLeaf& leaf : mesh.leaf) {
        leaf.renewed = 0;
        std::ranges::fill(leaf.left, time);
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
        if (!mesh.awake && !made_anew) {
            keep_all(static_cast<float>(scene.time), mesh);
            continue;
        }
        mesh.radius = collision::ball_radius(scene.shapes[soft.shape].shape);
        mesh.margin = scene.shapes[soft.shape].margin;
        place_vertices(scene, soft, made_anew || scene.renewed.empty(), mesh);
        if (made_anew) {
            list_edges(soft, mesh);
            list_rings(soft, mesh);
            build_tree(soft, mesh);
            find_whole(mesh);
            list_leaves_beside(soft, mesh);
            mesh.version = soft.mesh_version;
        }
        refit(team, scene, soft, mesh);
    }
}

}  // namespace taut
