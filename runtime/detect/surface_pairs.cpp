// Surfaces of soft bodies with themselves and with each other: vertices with faces, edges with edges.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "detect/detect.h"
#include "detect/surface_finder.h"
#include "detect/surface_tree.h"
#include "detect/triangle_pairs.h"
#include "detect/untangle.h"

namespace taut {
namespace {

constexpr float kOfEdge = 0.5f;  // of the shortest edge of two features: what touches itself is no thicker

// Two surfaces, or one with itself, in the frame of the first.
class SurfacePair {
public:
    SurfacePair(SurfaceFinder& finder, uint32_t a, uint32_t b)
        : finder_(finder),
          soft_{&finder.scene().softs.record[a], &finder.scene().softs.record[b]},
          mesh_{&finder.scene().softs.mesh[a], &finder.scene().softs.mesh[b]},
          index_{a, b},
          apart_((mesh_[1]->origin - mesh_[0]->origin).cast<float>()),
          time_(static_cast<float>(finder.scene().time)),
          of_(finder.touch_of(mesh_[0]->collider, mesh_[1]->collider)) {
        of_.both = mesh_[0]->radius + mesh_[1]->radius;
        of_.margin = std::min(mesh_[0]->margin, mesh_[1]->margin);
    }

    void find() {
        for_meeting_triangles(*mesh_[0], *mesh_[1], apart_, of_.both + of_.margin, time_,
                              [&](uint32_t t, uint32_t u, float moved) { note(t, u, moved); });
        test_noted();
    }

    // One in touch before, where it is on the wrong side now; others are found.
    void pull_back(const SurfaceContact& was) {
        const int side = static_cast<uint32_t>(was.a >> 32) == index_[0] ? 0 : 1;
        const uint32_t one = index_of(was.a), other = index_of(was.b);
        if (part_of(was.a) == SurfacePart::vertex)
            find_vertex(side, one, is_itself() ? 0 : 1 - side, other, &was);
        else
            find_edges(one, other, &was);
    }

private:
    const uint32_t* corners(int side, uint32_t t) const { return &soft_[side]->triangle[3 * size_t{t}]; }
    bool is_itself() const { return index_[0] == index_[1]; }

    bool have_common_corner(uint32_t t, uint32_t u) const {
        const uint32_t *one = corners(0, t), *other = corners(1, u);
        for (int i = 0; i < 3; ++i)
            if (one[i] == other[0] || one[i] == other[1] || one[i] == other[2]) return true;
        return false;
    }

    // Neighbours that are about flat do not meet.
    void note(uint32_t t, uint32_t u, float moved) {
        const bool beside = is_itself() && have_common_corner(t, u);
        if (beside && mesh_[0]->face[t].normal.dot(mesh_[0]->face[u].normal) > kFlat) return;
        for (int side = 0; side < 2; ++side) {
            const uint32_t* corner = corners(side, side == 0 ? t : u);
            for (int k = 0; k < 3; ++k) {
                const Vec3f x = place(side, corner[k]);
                for (int i = 0; i < 3; ++i) pairs_.corner[side][k][i][noted_] = x[i];
            }
        }
        pairs_.reach[noted_] = of_.both + of_.margin + moved;
        pairs_.moved[noted_] = moved;
        noted_pair_[noted_] = {t, u, beside};
        if (++noted_ == kLanes) test_noted();
    }

    void test_noted() {
        if (noted_ == 0) return;
        for (int i = noted_; i < kLanes; ++i) pairs_.reach[i] = -1;
        triangle_pair_kernel().test(pairs_);
        const int count = std::exchange(noted_, 0);
        for (int i = 0; i < count; ++i)
            if (pairs_.near[i] != 0) find(noted_pair_[i], pairs_.near[i]);
    }

    struct Noted {
        uint32_t t, u;
        bool beside;  // with a corner in common
    };

    void find(const Noted& noted, uint32_t near) {
        const auto [t, u, beside] = noted;
        const bool crosses = !is_itself() || soft_[0]->kind == SoftKind::cloth;  // cells of a solid resist it
        if (near & NearFeatures::cut && crosses && !beside) {
            find_crossings(0, t, 1, u);
            find_crossings(1, u, 0, t);
        }
        for (uint32_t k = 0; k < 3; ++k) {
            const int corner = static_cast<int>(k);
            if (mesh_[0]->owns[t] >> (3 + k) & 1 && near & NearFeatures::corner(corner)) {
                const uint32_t vertex = corners(0, t)[k];
                if (!beside || !has(u, vertex)) find_vertex(0, vertex, 1, u);
            }
            if (mesh_[1]->owns[u] >> (3 + k) & 1 && near & NearFeatures::other_corner(corner)) {
                const uint32_t vertex = corners(1, u)[k];
                if (!beside || !has(t, vertex)) find_vertex(1, vertex, 0, t);
            }
            if (!(mesh_[0]->owns[t] >> k & 1)) continue;
            for (uint32_t n = 0; n < 3; ++n) {
                if (!(mesh_[1]->owns[u] >> n & 1) || !(near & NearFeatures::edges(corner, static_cast<int>(n))))
                    continue;
                const uint32_t e = mesh_[0]->edge_of[3 * t + k], f = mesh_[1]->edge_of[3 * u + n];
                if (!beside || !have_common_end(e, f)) find_edges(e, f);
            }
        }
    }
    // Of one surface with itself.
    bool has(uint32_t t, uint32_t vertex) const {
        const uint32_t* corner = corners(0, t);
        return corner[0] == vertex || corner[1] == vertex || corner[2] == vertex;
    }
    bool have_common_end(uint32_t e, uint32_t f) const {
        const auto &one = mesh_[0]->edge[e].vertex, &other = mesh_[0]->edge[f].vertex;
        return one[0] == other[0] || one[0] == other[1] || one[1] == other[0] || one[1] == other[1];
    }

    Vec3f place(int side, uint32_t vertex) const {
        return side == 0 ? mesh_[0]->x[vertex] : Vec3f(apart_ + mesh_[1]->x[vertex]);
    }

    // Edges of a triangle, those that are its own, through one of the other side.
    void find_crossings(int side, uint32_t t, int other, uint32_t u) {
        const uint32_t* corner = corners(other, u);
        const Vec3f face[3] = {place(other, corner[0]), place(other, corner[1]), place(other, corner[2])};
        for (uint32_t k = 0; k < 3; ++k) {
            if (!(mesh_[side]->owns[t] >> k & 1)) continue;
            const uint32_t e = mesh_[side]->edge_of[3 * t + k];
            const uint32_t* vertex = mesh_[side]->edge[e].vertex;
            if (goes_through(place(side, vertex[0]), place(side, vertex[1]), face))
                finder_.scene().pairs.surfaces.crossing.push_back({index_[side], e, index_[other], u});
        }
    }

    void place(int side, uint32_t vertex, int at, Passing& passing, SurfaceContact& contact) const {
        passing.x[at] = place(side, vertex);
        passing.v[at] = mesh_[side]->v[vertex];
        contact.node[at] = soft_[side]->node[vertex];
    }
    // Of a triangle, where it is a solid's.
    Vec3f outward(int side, uint32_t t) const {
        if (soft_[side]->kind != SoftKind::solid || is_itself()) return Vec3f::Zero();
        const uint32_t* corner = corners(side, t);
        const Vec3f& from = mesh_[side]->x[corner[0]];
        return (mesh_[side]->x[corner[1]] - from).cross(mesh_[side]->x[corner[2]] - from);
    }

    void find_vertex(int side, uint32_t vertex, int other, uint32_t t, const SurfaceContact* through = nullptr) {
        SurfaceContact contact;
        Passing passing{};
        passing.of = Passing::Of::vertex_face;
        place(side, vertex, 0, passing, contact);
        for (int k = 0; k < 3; ++k) place(other, corners(other, t)[k], k + 1, passing, contact);
        contact.a = feature_of(index_[side], SurfacePart::vertex, vertex);
        contact.b = feature_of(index_[other], SurfacePart::face, t);
        add(passing, outward(other, t), side == 1, through, contact);
    }

    void find_edges(uint32_t e, uint32_t f, const SurfaceContact* through = nullptr) {
        SurfaceContact contact;
        Passing passing{};
        passing.of = Passing::Of::edge_edge;
        for (int k = 0; k < 2; ++k) {
            place(0, mesh_[0]->edge[e].vertex[k], k, passing, contact);
            place(1, mesh_[1]->edge[f].vertex[k], k + 2, passing, contact);
        }
        for (size_t side = 0; side < 2; ++side)
            passing.feature[side] = {SurfaceFeature::Of::edge, soft_[side], mesh_[side], side == 0 ? e : f};
        contact.a = feature_of(index_[0], SurfacePart::edge, e);
        contact.b = feature_of(index_[1], SurfacePart::edge, f);
        Vec3f facing = Vec3f::Zero();
        for (int side = 0; side < 2; ++side)
            for (const uint32_t t : mesh_[side]->edge[side == 0 ? e : f].triangle)
                if (t != kNone) facing += (side == 0 ? -1.0f : 1.0f) * outward(side, t);
        add(passing, facing, false, through, contact);
    }

    void add(const Passing& passing, const Vec3f& facing, bool turned, const SurfaceContact* through,
             SurfaceContact& contact) {
        if (std::ranges::none_of(contact.node, [&](uint32_t node) { return finder_.scene().nodes.solved(node); }))
            return;
        SurfaceTouch of = of_;
        if (is_itself()) of.both = std::min(of.both, kOfEdge * passing.size());
        if (turned) std::swap(of.collider[0], of.collider[1]);
        if (!through && stay_apart(passing, of.both + of.margin, time_)) return;
        const SurfaceContact* was = through ? through : finder_.before(contact.a, contact.b);
        if (was && is_through(passing, *was) != (through != nullptr)) return;
        const std::span<const uint32_t> nodes = contact.node;
        const auto first = static_cast<size_t>(passing.first());
        if (touch(passing, of, time_, was, facing, contact) && !finder_.tied(nodes.first(first), nodes.subspan(first)))
            finder_.add(contact);
    }

    SurfaceFinder& finder_;
    const Soft* soft_[2];
    const SurfaceMesh* mesh_[2];
    uint32_t index_[2];
    Vec3f apart_;
    float time_;
    SurfaceTouch of_;
    TrianglePairs pairs_{};
    Noted noted_pair_[kLanes];
    int noted_ = 0;  // of pairs_, that are to be tested
};

bool may_touch(const SurfaceScene& scene, uint32_t a, uint32_t b) {
    const SurfaceMesh &one = scene.softs.mesh[a], &other = scene.softs.mesh[b];
    if (!one.awake && !other.awake) return false;
    return filters_agree(scene.colliders.traits[one.collider].filter, scene.colliders.traits[other.collider].filter);
}

// Along x, about the way of all of a mesh.
SurfaceSpan span_of(const SurfaceScene& scene, uint32_t soft) {
    const SurfaceMesh& mesh = scene.softs.mesh[soft];
    const SurfaceBox box = mesh.node.front().box.swept(static_cast<float>(scene.time) * mesh.drift);
    return {mesh.origin.x() + static_cast<double>(box.lo.x()), mesh.origin.x() + static_cast<double>(box.hi.x()), soft};
}

// Those in touch before that went through each other.
void pull_back(SurfaceFinder& finder) {
    const Softs& softs = finder.scene().softs;
    const auto soft_of = [](uint64_t feature) { return static_cast<uint32_t>(feature >> 32); };
    std::optional<SurfacePair> pair;
    uint32_t first = kNone, second = kNone;
    for (const SurfaceContact& was : finder.all_before()) {
        if (is_of_shape(was.b) || part_of(was.a) == SurfacePart::cut || !finder.renews(was)) continue;
        const uint32_t one = soft_of(was.a), other = soft_of(was.b);
        const uint32_t a = std::min(one, other), b = std::max(one, other);
        const bool apart = a == b ? !softs.record[a].self || !softs.mesh[a].awake : !may_touch(finder.scene(), a, b);
        if (softs.mesh[a].version == 0 || softs.mesh[b].version == 0 || apart) continue;
        if (a != first || b != second) pair.emplace(finder, first = a, second = b);
        pair->pull_back(was);
    }
}

}  // namespace

void find_surface_pairs(SurfaceFinder& finder) {
    pull_back(finder);
    Softs& softs = finder.scene().softs;
    Array<SurfaceSpan>& spans = finder.scene().pairs.surfaces.span;
    spans.clear();
    for (const uint32_t s : softs.listed) {
        if (softs.record[s].self && softs.mesh[s].awake) SurfacePair(finder, s, s).find();
        spans.push_back(span_of(finder.scene(), s));
    }
    std::ranges::sort(spans, {}, [](const SurfaceSpan& span) { return std::pair(span.lo, span.soft); });
    for (size_t i = 0; i < spans.size(); ++i)
        for (size_t k = i + 1; k < spans.size() && spans[k].lo <= spans[i].hi; ++k) {
            const auto [a, b] = std::minmax(spans[i].soft, spans[k].soft);
            if (may_touch(finder.scene(), a, b)) SurfacePair(finder, a, b).find();
        }
}

}  // namespace taut
