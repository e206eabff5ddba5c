#include "queries/queries.h"

#include <algorithm>

namespace taut {
namespace {

using collision::Gap;
using collision::Hit;
using collision::Placement;
using collision::Probe;
using collision::Shape;

// Hits so close to the best in fraction may be the same single-precision number, and then the slots decide.
constexpr double kTie = 1e-6;

const Shape& shape_of(const World& world, uint32_t collider) {
    return world.shapes[world.colliders.record[collider].shape].shape;
}
Placement placement_of(const World& world, uint32_t collider) {
    return placement_of(world.nodes, world.colliders.record[collider]);
}
taut_body body_of(const World& world, uint32_t collider) {
    return world.body_handle(world.colliders.record[collider].node);
}

taut_pos public_pos(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
taut_vec3 public_vec(const Vec3& v) { return {float(v.x()), float(v.y()), float(v.z())}; }

taut_query_hit public_hit(const World& world, uint32_t collider, const Hit& hit) {
    return {body_of(world, collider),
            world.collider_handle(collider),
            public_pos(hit.point),
            public_vec(hit.normal),
            float(hit.fraction),
            hit.feature,
            hit.inside};
}

taut_distance public_distance(const World& world, uint32_t b, const Gap& gap) {
    return {body_of(world, b),    world.collider_handle(b), public_pos(gap.on_a),
            public_pos(gap.on_b), public_vec(gap.normal),   float(gap.distance)};
}

// Asks an act about each collider that a query comes by and sees.
template <class Act>
void for_seen(const Sight& sight, const Probe& probe, Act&& act) {
    struct Seen final : collision::Visitor {
        Seen(const Sight& s, Act& a) : sight(s), act(a) {}
        void visit(uint32_t id, Probe& at) override {
            if (sight.sees(id)) act(id, at);
        }
        const Sight& sight;
        Act& act;
    };
    Seen seen(sight, act);
    sight.world().broadphase.visit(probe, seen);
}

// Whether this number, or with the same number this collider, comes before the best.
struct Best {
    uint32_t collider = kNone;
    float number = 0;

    bool improve(uint32_t other, float by) {
        if (collider != kNone && (by > number || (by == number && other > collider))) return false;
        collider = other;
        number = by;
        return true;
    }
};

template <class List, class Handle>
bool names(const List* list, uint32_t count, Handle handle) {
    return std::any_of(list, list + count, [&](const Handle& each) { return each.bits == handle.bits; });
}

}  // namespace

bool Sight::sees(uint32_t collider) const {
    const Collider& c = world_.colliders.record[collider];
    if (!(filter_.kinds >> static_cast<uint32_t>(world_.nodes.info[c.node].kind) & 1)) return false;
    if (c.sensor && !(filter_.kinds & TAUT_QUERY_SENSOR)) return false;
    const taut_filter& own = world_.colliders.traits[collider].filter;
    if (!(filter_.category & own.mask) || !(own.category & filter_.mask)) return false;
    if (filter_.ignored_body_count == 0 && filter_.ignored_collider_count == 0 && !filter_.accept) return true;
    const taut_body body = world_.body_handle(c.node);
    const taut_collider handle = world_.collider_handle(collider);
    if (names(filter_.ignored_bodies, filter_.ignored_body_count, body)) return false;
    if (names(filter_.ignored_colliders, filter_.ignored_collider_count, handle)) return false;
    return !filter_.accept || filter_.accept(body, handle, filter_.user_data) != 0;
}

bool Sight::sees_node(uint32_t node) const {
    const NodeInfo& info = world_.nodes.info[node];
    if (info.collider != kNone) return sees(info.collider);
    return filter_.kinds >> static_cast<uint32_t>(info.kind) & 1;
}

// The shape's box about its origin, which far from the world's is exact only so.
Probe CastQuery::probe() const {
    const collision::Box box = collision::bounds(shape, {Vec3::Zero(), from.rotation});
    return {from.position, along, box.lo.cast<double>(), box.hi.cast<double>()};
}

bool BoxQuery::meets(const Shape& other, const Placement& at) const {
    const collision::Box box = collision::bounds(other, {at.position - middle, at.rotation});
    return (box.lo.cast<double>().array() <= half.array()).all() &&
           (box.hi.cast<double>().array() >= -half.array()).all();
}

taut_query_hit hit_on(const World& world, uint32_t collider, const RayQuery& query) {
    Hit hit;
    if (query.meets(shape_of(world, collider), placement_of(world, collider), 1, hit))
        return public_hit(world, collider, hit);
    taut_query_hit none{};
    none.fraction = 1;
    return none;
}

template <class Query>
bool is_met(const World& world, uint32_t collider, const Query& query) {
    return query.meets(shape_of(world, collider), placement_of(world, collider));
}
template bool is_met(const World&, uint32_t, const PointQuery&);
template bool is_met(const World&, uint32_t, const ShapeQuery&);

Bounds bounds_of(const World& world, uint32_t collider) {
    const Placement at = placement_of(world, collider);
    const collision::Box box = collision::bounds(shape_of(world, collider), {Vec3::Zero(), at.rotation});
    return {at.position + box.lo.cast<double>(), at.position + box.hi.cast<double>()};
}

template <class Query>
taut_query_hit first_hit(const Sight& sight, const Query& query) {
    const World& world = sight.world();
    Best best;
    Hit first;
    for_seen(sight, query.probe(), [&](uint32_t collider, Probe& probe) {
        Hit hit;
        if (!query.meets(shape_of(world, collider), placement_of(world, collider), probe.limit, hit)) return;
        if (!best.improve(collider, float(hit.fraction))) return;
        first = hit;
        probe.limit = std::min(1.0, hit.fraction + kTie);
    });
    if (best.collider != kNone) return public_hit(world, best.collider, first);
    taut_query_hit none{};
    none.fraction = 1;
    return none;
}
template taut_query_hit first_hit(const Sight&, const RayQuery&);
template taut_query_hit first_hit(const Sight&, const CastQuery&);

bool any_hit(const Sight& sight, const RayQuery& query) {
    const World& world = sight.world();
    bool found = false;
    for_seen(sight, query.probe(), [&](uint32_t collider, Probe& probe) {
        Hit hit;
        if (found || !query.meets(shape_of(world, collider), placement_of(world, collider), 1, hit)) return;
        found = true;
        probe.limit = -1;
    });
    return found;
}

template <class Query>
void all_hits(const Sight& sight, const Query& query, Sink<taut_query_hit>& sink) {
    const World& world = sight.world();
    for_seen(sight, query.probe(), [&](uint32_t collider, Probe&) {
        Hit hit;
        if (query.meets(shape_of(world, collider), placement_of(world, collider), 1, hit))
            sink.take(public_hit(world, collider, hit));
    });
}
template void all_hits(const Sight&, const RayQuery&, Sink<taut_query_hit>&);
template void all_hits(const Sight&, const CastQuery&, Sink<taut_query_hit>&);

template <class Query>
void all_overlaps(const Sight& sight, const Query& query, Sink<taut_collider>& sink) {
    const World& world = sight.world();
    for_seen(sight, query.probe(), [&](uint32_t collider, Probe&) {
        if (query.meets(shape_of(world, collider), placement_of(world, collider)))
            sink.take(world.collider_handle(collider));
    });
}
template void all_overlaps(const Sight&, const PointQuery&, Sink<taut_collider>&);
template void all_overlaps(const Sight&, const BoxQuery&, Sink<taut_collider>&);
template void all_overlaps(const Sight&, const ShapeQuery&, Sink<taut_collider>&);

taut_distance nearest(const Sight& sight, const ShapeQuery& query, float within) {
    const World& world = sight.world();
    Best best;
    Gap least;
    Probe start = query.probe();
    start.reach = double(within);
    for_seen(sight, start, [&](uint32_t collider, Probe& probe) {
        const Gap gap =
            collision::find_gap(query.shape, query.at, shape_of(world, collider), placement_of(world, collider));
        if (gap.distance > double(within) || !best.improve(collider, float(gap.distance))) return;
        least = gap;
        probe.reach = std::max(0.0, gap.distance * (1 + kTie));
    });
    return best.collider == kNone ? taut_distance{} : public_distance(world, best.collider, least);
}

taut_distance distance_between(const World& world, uint32_t a, uint32_t b) {
    return public_distance(
        world, b,
        collision::find_gap(shape_of(world, a), placement_of(world, a), shape_of(world, b), placement_of(world, b)));
}

taut_distance distance_to_point(const World& world, const Vec3& point, uint32_t b) {
    return public_distance(world, b, collision::find_gap(point, shape_of(world, b), placement_of(world, b)));
}

}  // namespace taut
