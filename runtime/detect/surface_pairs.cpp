// Surfaces of soft bodies with themselves and with each other: vertices with faces, edges with edges.
#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>
#include <utility>

#include "detect/detect.h"
#include "detect/near_features.h"
#include "detect/surface_finder.h"

namespace taut {
namespace {

constexpr uint32_t kFeatureGrain = 64;  // pairs of features that a thread takes at a time

// Two surfaces, or one with itself, in the frame of the first.
class SurfacePair {
public:
    SurfacePair(SurfaceFinder& finder, uint32_t a, uint32_t b)
        : finder_(finder),
          sides_{{&finder.scene().softs.record[a], &finder.scene().softs.record[b]},
                 {&finder.scene().softs.mesh[a], &finder.scene().softs.mesh[b]},
                 {a, b},
                 Vec3f::Zero(),
                 finder.scene().pairs.joined},
          time_(static_cast<float>(finder.scene().time)),
          of_(finder.touch_of(sides_.mesh[0]->collider, sides_.mesh[1]->collider)) {
        sides_.apart = (sides_.mesh[1]->origin - sides_.mesh[0]->origin).cast<float>();
        of_.both = sides_.mesh[0]->radius + sides_.mesh[1]->radius;
        of_.margin = std::min(sides_.mesh[0]->margin, sides_.mesh[1]->margin);
    }

    void find(Team& team) {
        SurfaceContacts& out = finder_.scene().pairs.surfaces;
        find_near_features(team, sides_, of_.both, of_.margin, time_, out);
        const std::span<const SurfaceCrossing> cut = out.cut.all();
        out.crossing.insert(out.crossing.end(), cut.begin(), cut.end());
        const std::span<const NearFeature> near = out.near_feature.all();
        do {
            out.touching.clear();
            team.for_ranges(static_cast<uint32_t>(near.size()), kFeatureGrain, [&](uint32_t begin, uint32_t end) {
                SharedListPart<SurfaceContact> touching(out.touching);
                for (uint32_t i = begin; i < end; ++i) {
                    SurfaceContact contact;
                    if (touch(near[i], contact)) touching.add(contact);
                }
            });
        } while (out.touching.lacked_room());
        for (const SurfaceContact& contact : out.touching.all()) finder_.add(contact);
    }

    // One in touch before, where it is on the wrong side now; others are found.
    void pull_back(const SurfaceContact& was) {
        const int side = static_cast<uint32_t>(was.a >> 32) == sides_.index[0] ? 0 : 1;
        const uint32_t one = index_of(was.a), other = index_of(was.b);
        SurfaceContact contact;
        const bool touches = part_of(was.a) == SurfacePart::vertex
                                 ? touch_vertex(side, one, sides_.is_one() ? 0 : 1 - side, other, time_, &was, contact)
                                 : touch_edges(one, other, time_, &was, contact);
        if (touches) finder_.add(contact);
    }

private:
    bool touch(const NearFeature& near, SurfaceContact& contact) const {
        if (near.of == NearFeature::Of::vertex_face)
            return touch_vertex(0, near.one, 1, near.other, near.time, nullptr, contact);
        if (near.of == NearFeature::Of::face_vertex)
            return touch_vertex(1, near.other, 0, near.one, near.time, nullptr, contact);
        return touch_edges(near.one, near.other, near.time, nullptr, contact);
    }

    void place(int side, uint32_t vertex, int at, Passing& passing, SurfaceContact& contact) const {
        passing.x[at] = sides_.place(side, vertex);
        passing.v[at] = sides_.mesh[side]->v[vertex];
        contact.node[at] = sides_.soft[side]->node[vertex];
    }
    // Of a triangle, where it is a solid's.
    Vec3f outward(int side, uint32_t t) const {
        if (sides_.soft[side]->kind != SoftKind::solid || sides_.is_one()) return Vec3f::Zero();
        const uint32_t* corner = sides_.corners(side, t);
        const Array<Vec3f>& x = sides_.mesh[side]->x;
        return (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]);
    }

    // through: their contact before, where they went through each other since; null: they are to come into touch.
    bool touch_vertex(int side, uint32_t vertex, int other, uint32_t t, float time, const SurfaceContact* through,
                      SurfaceContact& contact) const {
        Passing passing{};
        passing.of = Passing::Of::vertex_face;
        place(side, vertex, 0, passing, contact);
        for (int k = 0; k < 3; ++k) place(other, sides_.corners(other, t)[k], k + 1, passing, contact);
        contact.a = feature_of(sides_.index[side], SurfacePart::vertex, vertex);
        contact.b = feature_of(sides_.index[other], SurfacePart::face, t);
        return touch(passing, outward(other, t), side == 1, time, through, contact);
    }

    bool touch_edges(uint32_t e, uint32_t f, float time, const SurfaceContact* through, SurfaceContact& contact) const {
        Passing passing{};
        passing.of = Passing::Of::edge_edge;
        for (int k = 0; k < 2; ++k) {
            place(0, sides_.mesh[0]->edge[e].vertex[k], k, passing, contact);
            place(1, sides_.mesh[1]->edge[f].vertex[k], k + 2, passing, contact);
        }
        for (size_t side = 0; side < 2; ++side)
            passing.feature[side] = held_feature(finder_.scene().nodes, {SurfaceFeature::Of::edge, sides_.soft[side],
                                                                         sides_.mesh[side], side == 0 ? e : f});
        contact.a = feature_of(sides_.index[0], SurfacePart::edge, e);
        contact.b = feature_of(sides_.index[1], SurfacePart::edge, f);
        Vec3f facing = Vec3f::Zero();
        for (int side = 0; side < 2; ++side)
            for (const uint32_t t : sides_.mesh[side]->edge[side == 0 ? e : f].triangle)
                if (t != kNone) facing += (side == 0 ? -1.0f : 1.0f) * outward(side, t);
        return touch(passing, facing, false, time, through, contact);
    }

    bool touch(const Passing& passing, const Vec3f& facing, bool turned, float time, const SurfaceContact* through,
               SurfaceContact& contact) const {
        if (std::ranges::none_of(contact.node, [&](uint32_t node) { return finder_.scene().nodes.solved(node); }))
            return false;
        SurfaceTouch of = of_;
        if (sides_.is_one()) of.both = std::min(of.both, kOfEdge * passing.size());
        if (turned) std::swap(of.collider[0], of.collider[1]);
        const SurfaceContact* was = through ? through : finder_.before(contact.a, contact.b);
        if (was && is_through(passing, *was) != (through != nullptr)) return false;
        const std::span<const uint32_t> nodes = contact.node;
        const auto first = static_cast<size_t>(passing.first());
        return taut::touch(passing, of, time, was, facing, contact) &&
               !finder_.tied(nodes.first(first), nodes.subspan(first));
    }

    SurfaceFinder& finder_;
    SurfaceSides sides_;
    float time_;
    SurfaceTouch of_;
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

void find_surface_pairs(Team& team, SurfaceFinder& finder) {
    pull_back(finder);
    Softs& softs = finder.scene().softs;
    Array<SurfaceSpan>& spans = finder.scene().pairs.surfaces.span;
    spans.clear();
    for (const uint32_t s : softs.listed) {
        if (softs.record[s].self && softs.mesh[s].awake) SurfacePair(finder, s, s).find(team);
        spans.push_back(span_of(finder.scene(), s));
    }
    std::ranges::sort(spans, {}, [](const SurfaceSpan& span) { return std::pair(span.lo, span.soft); });
    for (size_t i = 0; i < spans.size(); ++i)
        for (size_t k = i + 1; k < spans.size() && spans[k].lo <= spans[i].hi; ++k) {
            const auto [a, b] = std::minmax(spans[i].soft, spans[k].soft);
            if (may_touch(finder.scene(), a, b)) SurfacePair(finder, a, b).find(team);
        }
    std::ranges::sort(finder.scene().pairs.surfaces.crossing, {},
                      [](const SurfaceCrossing& of) { return std::tuple(of.soft, of.edge, of.other, of.face); });
}

}  // namespace taut
