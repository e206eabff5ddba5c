#include "detect/near_features.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "detect/surface_tree.h"
#include "detect/triangle_pairs.h"
#include "detect/untangle.h"

namespace taut {
namespace {

constexpr uint32_t kLeafGrain = 8;  // leaves that a thread takes at a time

// Of leaves of the first surface.
class NearFeatureFinder {
public:
    NearFeatureFinder(const SurfaceSides& sides, float both, float margin, float time, SurfaceContacts& out)
        : sides_(sides),
          mesh_{sides.mesh[0], sides.mesh[1]},
          reach_(both + margin),
          way_(time * (mesh_[0]->drift - mesh_[1]->drift)),
          near_(out.near_feature),
          cut_(out.cut) {
        for (FeatureBatch& batch : batch_) {
            batch.lanes.both = both;
            batch.lanes.margin = margin;
            batch.lanes.of_size = sides.is_one() ? kOfEdge : std::numeric_limits<float>::infinity();
        }
    }
    ~NearFeatureFinder() {
        test_noted();
        for (FeatureBatch& batch : batch_) test_batch(batch);
    }
    NearFeatureFinder(const NearFeatureFinder&) = delete;
    NearFeatureFinder& operator=(const NearFeatureFinder&) = delete;

    void look_from(const SurfaceLeaf& leaf) {
        const SurfaceNode& node = mesh_[0]->node[leaf.node];
        const SurfaceBox box = seen(node.box);
        const uint32_t from = sides_.is_one() ? std::max(leaf.node, leaf.past_flat) : 0;
        for_leaves_in(
            *mesh_[1], box,
            [&](const SurfaceLeaf& other) {
                if (!sides_.is_one() || !is_flat_with(leaf, other)) meet(leaf, other);
            },
            from, !node.renewed);
    }

private:
    // From the second.
    SurfaceBox seen(const SurfaceBox& box) const { return box.moved(-sides_.apart).swept(way_); }

    // What hangs together and is bent by little.
    bool is_flat_with(const SurfaceLeaf& one, const SurfaceLeaf& other) const {
        const SurfaceMesh& mesh = *mesh_[0];
        const SurfaceNode &a = mesh.node[one.node], &b = mesh.node[other.node];
        if (&one == &other || !a.whole || !b.whole) return false;
        SurfaceBox normals = a.normals;
        normals.add(b.normals);
        if (!are_flat(normals)) return false;
        const auto begin = mesh.beside.begin();
        return std::ranges::binary_search(begin + mesh.beside_begin[a.leaf], begin + mesh.beside_begin[a.leaf + 1],
                                          b.leaf);
    }

    void meet(const SurfaceLeaf& one, const SurfaceLeaf& other) {
        const bool itself = &one == &other;
        const SurfaceBox& about = mesh_[1]->node[other.node].box;
        for (uint32_t lane = 0; lane < one.count; ++lane) {
            const int at = static_cast<int>(lane);
            const unsigned may_meet = one.renewed >> lane & 1 ? kAllLanes : other.renewed;
            if (may_meet == 0) continue;
            const SurfaceBox way = seen(box_of_lane(one.way, at));
            if (!way.meets(about)) continue;
            const PassingTriangle by{ends_of(way),
                                     ends_of(box_of_lane(one.box, at).moved(-sides_.apart)),
                                     {one.v[0][lane], one.v[1][lane], one.v[2][lane]},
                                     one.spread[lane],
                                     reach_,
                                     one.left[lane]};
            alignas(64) float moved[kLanes];
            unsigned met = may_meet & triangle_pair_kernel().passes(other, by, moved);
            if (itself) met &= ~((2u << lane) - 1);  // those after it
            for (; met != 0; met &= met - 1) {
                const int k = std::countr_zero(met);
                note(one.triangle[lane], other.triangle[k], std::min(one.left[lane], other.left[k]), moved[k]);
            }
        }
    }

    bool have_common_corner(uint32_t t, uint32_t u) const {
        const uint32_t *one = sides_.corners(0, t), *other = sides_.corners(1, u);
        for (int i = 0; i < 3; ++i)
            if (one[i] == other[0] || one[i] == other[1] || one[i] == other[2]) return true;
        return false;
    }

    // Of itself in the order of the host, which no tree changes.
    void note(uint32_t t, uint32_t u, float time, float moved) {
        if (sides_.is_one() && u < t) std::swap(t, u);
        const bool beside = sides_.is_one() && have_common_corner(t, u);
        if (beside && mesh_[0]->normal[t].dot(mesh_[0]->normal[u]) > kFlat) return;
        for (int side = 0; side < 2; ++side) {
            const uint32_t* corner = sides_.corners(side, side == 0 ? t : u);
            for (int k = 0; k < 3; ++k) {
                const Vec3f x = sides_.place(side, corner[k]);
                for (int i = 0; i < 3; ++i) pairs_.corner[side][k][i][noted_] = x[i];
            }
        }
        pairs_.reach[noted_] = reach_ + moved;
        pairs_.moved[noted_] = moved;
        noted_pair_[noted_] = {t, u, time, beside};
        if (++noted_ == kLanes) test_noted();
    }

    void test_noted() {
        if (noted_ == 0) return;
        for (int i = noted_; i < kLanes; ++i) pairs_.reach[i] = -1;
        triangle_pair_kernel().test(pairs_);
        const int count = std::exchange(noted_, 0);
        for (int i = 0; i < count; ++i)
            if (pairs_.near[i] != 0) list(noted_pair_[i], pairs_.near[i]);
    }

    struct Noted {
        uint32_t t, u;
        float time;   // [s]
        bool beside;  // with a corner in common
    };

    void list(const Noted& noted, uint32_t near) {
        const auto [t, u, time, beside] = noted;
        const bool crosses = !sides_.is_one() || sides_.soft[0]->kind == SoftKind::cloth;  // cells of a solid resist it
        if (near & NearFeatures::cut && crosses && !beside && !are_sewn(t, u)) {
            list_cuts(0, t, 1, u);
            list_cuts(1, u, 0, t);
        }
        const uint32_t owns[2] = {mesh_[0]->owns[t], mesh_[1]->owns[u]};
        for (uint32_t k = 0; k < 3; ++k) {
            const int corner = static_cast<int>(k);
            if (owns[0] >> (3 + k) & 1 && near & NearFeatures::corner(corner)) {
                const uint32_t vertex = sides_.corners(0, t)[k];
                if (!beside || !has(u, vertex)) add({NearFeature::Of::vertex_face, vertex, u, time});
            }
            if (owns[1] >> (3 + k) & 1 && near & NearFeatures::other_corner(corner)) {
                const uint32_t vertex = sides_.corners(1, u)[k];
                if (!beside || !has(t, vertex)) add({NearFeature::Of::face_vertex, t, vertex, time});
            }
            if (!(owns[0] >> k & 1)) continue;
            for (uint32_t n = 0; n < 3; ++n) {
                if (!(owns[1] >> n & 1) || !(near & NearFeatures::edges(corner, static_cast<int>(n)))) continue;
                const uint32_t e = mesh_[0]->edge_of[3 * t + k], f = mesh_[1]->edge_of[3 * u + n];
                if (!beside || !have_common_end(e, f)) add({NearFeature::Of::edge_edge, e, f, time});
            }
        }
    }

    // Triangles with corners that a joint holds together are beside each other.
    bool are_sewn(uint32_t t, uint32_t u) const {
        const auto node = [&](int side, uint32_t triangle, int k) {
            return sides_.soft[side]->node[sides_.corners(side, triangle)[k]];
        };
        for (int k = 0; k < 3 && !sides_.joined.empty(); ++k)
            for (int n = 0; n < 3; ++n)
                if (std::ranges::binary_search(sides_.joined, pair_key(node(0, t, k), node(1, u, n)))) return true;
        return false;
    }

    // Of one kind.
    struct FeatureBatch {
        FeatureLanes lanes{};
        NearFeature of[kLanes];
        int count = 0;

        void put(int point, const Vec3f& x, const Vec3f& v) {
            for (int i = 0; i < 3; ++i) lanes.x[point][i][count] = x[i], lanes.v[point][i][count] = v[i];
        }
    };

    void put_vertex(FeatureBatch& batch, int side, uint32_t vertex, int point) const {
        batch.put(point, sides_.place(side, vertex), mesh_[side]->v[vertex]);
    }
    void add(const NearFeature& near) {
        const bool edges = near.of == NearFeature::Of::edge_edge;
        FeatureBatch& batch = batch_[edges];
        if (edges) {
            for (int k = 0; k < 2; ++k) {
                put_vertex(batch, 0, mesh_[0]->edge[near.one].vertex[k], k);
                put_vertex(batch, 1, mesh_[1]->edge[near.other].vertex[k], k + 2);
            }
        } else {
            const int side = near.of == NearFeature::Of::face_vertex;
            put_vertex(batch, side, side == 0 ? near.one : near.other, 0);
            const uint32_t* corner = sides_.corners(1 - side, side == 0 ? near.other : near.one);
            for (int k = 0; k < 3; ++k) put_vertex(batch, 1 - side, corner[k], k + 1);
        }
        batch.of[batch.count] = near;
        batch.lanes.time[batch.count] = near.time;
        if (++batch.count == kLanes) test_batch(batch);
    }
    void test_batch(FeatureBatch& batch) {
        const TrianglePairKernel& kernel = triangle_pair_kernel();
        const unsigned filled = (1u << std::exchange(batch.count, 0)) - 1;
        unsigned met =
            filled & (&batch == &batch_[1] ? kernel.meet_edges(batch.lanes) : kernel.meet_faces(batch.lanes));
        for (; met != 0; met &= met - 1) near_.add(batch.of[std::countr_zero(met)]);
    }

    // Of one surface with itself.
    bool has(uint32_t t, uint32_t vertex) const {
        const uint32_t* corner = sides_.corners(0, t);
        return corner[0] == vertex || corner[1] == vertex || corner[2] == vertex;
    }
    bool have_common_end(uint32_t e, uint32_t f) const {
        const auto &one = mesh_[0]->edge[e].vertex, &other = mesh_[0]->edge[f].vertex;
        return one[0] == other[0] || one[0] == other[1] || one[1] == other[0] || one[1] == other[1];
    }

    // Edges of a triangle, those that are its own, through one of the other side.
    void list_cuts(int side, uint32_t t, int other, uint32_t u) {
        const uint32_t* corner = sides_.corners(other, u);
        const Vec3f face[3] = {sides_.place(other, corner[0]), sides_.place(other, corner[1]),
                               sides_.place(other, corner[2])};
        for (uint32_t k = 0; k < 3; ++k) {
            if (!(mesh_[side]->owns[t] >> k & 1)) continue;
            const uint32_t e = mesh_[side]->edge_of[3 * t + k];
            const uint32_t* vertex = mesh_[side]->edge[e].vertex;
            if (goes_through(sides_.place(side, vertex[0]), sides_.place(side, vertex[1]), face))
                cut_.add({sides_.index[side], e, sides_.index[other], u});
        }
    }

    const SurfaceSides& sides_;
    const SurfaceMesh* mesh_[2];
    float reach_;
    Vec3f way_;  // of the first, as seen from the second
    SharedListPart<NearFeature> near_;
    SharedListPart<SurfaceCrossing> cut_;
    TrianglePairs pairs_{};
    FeatureBatch batch_[2];  // of vertices with faces, of edges
    Noted noted_pair_[kLanes];
    int noted_ = 0;  // of pairs_, that are to be tested
};

}  // namespace

void find_near_features(Team& team, const SurfaceSides& sides, float both, float margin, float time,
                        SurfaceContacts& out) {
    const Array<SurfaceLeaf>& leaves = sides.mesh[0]->leaf;
    const auto look = [&](uint32_t begin, uint32_t end) {
        NearFeatureFinder finder(sides, both, margin, time, out);
        for (uint32_t i = begin; i < end; ++i) finder.look_from(leaves[i]);
    };
    bool lacked_room = true;
    while (lacked_room) {
        out.near_feature.clear();
        out.cut.clear();
        team.for_ranges(static_cast<uint32_t>(leaves.size()), kLeafGrain, look);
        lacked_room = out.near_feature.lacked_room();
        lacked_room = out.cut.lacked_room() || lacked_room;
    }
}

}  // namespace taut
