#include "detect/manifolds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "detect/carry.h"
#include "detect/lead.h"
#include "detect/reuse.h"
#include "detect/surfaces.h"

namespace taut {
namespace {

// How fast two nodes of a pair move against each other at most [m/s].
double fastest_nodes(const Nodes& nodes, const PairEnds& pair) {
    double squared = 0;
    for_sides(pair, [&](uint32_t a, uint32_t b) {
        squared = std::max(squared, (nodes.motion[a].v - nodes.motion[b].v).squaredNorm());
    });
    return std::sqrt(squared);
}

// How far points of two colliders come nearer to each other in a time, at most [m]. Against what does not yield the
// turning of the other counts too; of two that yield it would make the worst step of a heap that lands a third longer.
double closing_way(const Detection& of, const PairEnds& pair, double time) {
    const double way = time * fastest_nodes(of.nodes, pair);
    if (pair.spans() || !is_against_fixed(of.nodes, pair)) return way;
    const auto swing = [&](uint32_t node, uint32_t collider) {
        return moves_by_forces(of.nodes.info[node].kind) ? swing_of(of.pairs.stance[collider], static_cast<float>(time))
                                                         : 0;
    };
    const float both = swing(pair.a, pair.collider_a()) + swing(pair.b, pair.collider_b());
    return way +
           static_cast<double>(beyond_margin(both, contact_margin(of.pairs, pair.collider_a(), pair.collider_b())));
}

// So that a fast pair meets its contacts before it overlaps.
float margin_of(const Detection& of, const PairEnds& pair, double time) {
    return contact_margin(of.pairs, pair.collider_a(), pair.collider_b()) +
           static_cast<float>(std::min(kMaxReach, closing_way(of, pair, time)));
}

// Of the origin of a collider's shape, which the narrowphase knows, from that of its node.
Vec3f offset_of(const Nodes& nodes, const Collider& a, const collision::Placement& at, float then) {
    if (a.node_b != kNone) {
        const Vec3& x = nodes.motion[a.node].x;
        if (then == 0) return (at.position - x).cast<float>();
        return static_cast<float>(0.5 * (nodes.motion[a.node_b].x - x).norm()) * at.rotation.col(1);
    }
    if (a.position == Vec3::Zero()) return Vec3f::Zero();
    const Mat3f body_rotation = at.rotation * a.rotation.conjugate().toRotationMatrix().cast<float>();
    return body_rotation * a.position.cast<float>();
}

// What the two surfaces do to each other. What the host said of friction and restitution in this step stays.
void meet(const Detection& of, const collision::Placement& at_a, const collision::Placement& at_b, const Vec3f& from_a,
          Pair& pair) {
    const uint32_t a = pair.collider_a(), b = pair.collider_b();
    const float friction = pair.friction, restitution = pair.restitution;
    combine_surfaces(of.nodes, of.colliders.traits[a], of.colliders.traits[b], at_a, at_b, from_a, pair);
    if (pair.answered) answer(friction, restitution, pair);
    pair.asks = of.pairs.asks | of.colliders.record[a].asks | of.colliders.record[b].asks;
}

// What is wedged is pushed by what would throw it out at a hundred metres a second, from both sides. Where one side
// slips off, or pushes another way from now on, a substep's sweeps take no more than most of the other's away, and as
// contacts do not pull, the rest stays; direct solves do not lag. Bodies that lose more than this speed [m/s] of a
// push, and this part of it, begin without any. Pushes are along the normals [N].
void note_lost(const Detection& of, const PairEnds& pair, float push, const Vec3f& normal, const Vec3f& left) {
    constexpr double kLost = 3;
    constexpr float kPart = 0.1f;
    const Vec3f lost = push * normal - left;
    if (!(lost.squaredNorm() > kPart * kPart * push * push)) return;
    const auto mark = [](uint8_t& flag) { std::atomic_ref(flag).store(1, std::memory_order_relaxed); };
    for (const uint32_t node : {pair.a, pair.b}) {
        const double impulse = of.substep() * static_cast<double>(lost.norm());
        if (!(impulse * of.nodes.mass[node].inv_mass > kLost)) continue;
        mark(of.pairs.unheld[node]);
        mark(of.pairs.any_unheld);
    }
}

// What contacts ask of the two shapes.
void note_shapes(const Pairs& pairs, Pair& pair) {
    const Pace &a = pairs.pace[pair.collider_a()], &b = pairs.pace[pair.collider_b()];
    pair.rolls_a = a.rolls;
    pair.rolls_b = b.rolls;
    pair.round_a = a.round;
    pair.round_b = b.round;
    pair.patch = patch_of(pairs, pair);
}

// A pair's new manifold: its place, its surface unless that is known, and the forces that the record before had with
// the old one. Whether it is kept.
bool adopt(const Shaped& shaped, const Detection& of, bool known, const collision::Manifold& old, const Pair& before,
           Pair& pair) {
    const Vec3f from_a = offset_of(of.nodes, of.colliders.record[pair.collider_a()], shaped.at_a(), shaped.then());
    if (!known) note_shapes(of.pairs, pair);
    if (shaped.lead() > 0)
        bring_back(of, shaped.lead(), from_a, pair);
    else
        for (int k = 0; k < pair.manifold.count && from_a != Vec3f::Zero(); ++k)
            pair.manifold.points[k].position += from_a;
    pair.then = shaped.then();
    shaped.bring_to_present(pair);
    if (!known) meet(of, shaped.at_a(), shaped.at_b(), from_a, pair);
    const float push = before.in_block ? 0 : push_of(old, before.force);
    carry(old, before, pair);
    if (push > 0) note_lost(of, pair, push, old.normal, push_of(pair.manifold, pair.force) * pair.manifold.normal);
    return shaped.can_be_kept() && keep_manifold(of.pairs, of.time, pair);
}

void keep_cache(const collision::PairCache& cache, NearPair& near) {
    std::copy_n(cache.words, near.cache.size(), near.cache.begin());
}
void keep_cache(const collision::PairCache& cache, PointsCache& of_points) {
    std::copy_n(cache.words + std::size(cache.words) - of_points.size(), of_points.size(), of_points.begin());
}

// Whether a record that had this manifold knows its surface, unless the host changed it since. Moving ones turn with
// their bodies.
bool is_known(const collision::Manifold& old, const Pair& pair) {
    return old.count > 0 && !pair.driven && !pair.directed;
}

// What was found for a pair without a surface, and is in its record.
void take_over(const Shaped& shaped, const Detection& of, const collision::Manifold& old, NearPair& near, Pair& pair) {
    const bool known = is_known(old, pair) && !near.changed;
    near.kept = pair.manifold.count > 0 && adopt(shaped, of, known, old, pair, pair);
    near.changed = false;
    if (pair.manifold.count > 0) return;
    if (old.count > 0 && !pair.in_block) note_lost(of, pair, push_of(old, pair.force), old.normal, Vec3f::Zero());
}

// Whether the axis that parted two last still does.
bool held_apart(const Detection& of, const PairEnds& pair, const collision::PairCache& cache, NearPair& near) {
    const auto shape = [&](uint32_t c) -> const collision::Shape& {
        return of.shapes[of.colliders.record[c].shape].shape;
    };
    const uint32_t a = pair.collider_a(), b = pair.collider_b();
    const collision::Placement &at_a = of.pairs.placement[a], &at_b = of.pairs.placement[b];
    const float gap = collision::held_apart(shape(a), at_a, shape(b), at_b, cache);
    if (!(gap > margin_of(of, pair, of.time))) return false;
    note_clear(of.pairs, pair.spans() ? 0 : gap, near);
    return true;
}

// The record that a part takes over: its own; else, as where a body slides from facet to facet, that of a part no
// longer touched that looked about the same way. Null if there is none.
const Pair* find_old(std::span<const Pair> old, const collision::Parts& parts, const collision::PartManifold& part) {
    constexpr float kAlike = 0.95f;  // cosine between the normals
    const auto now = [&](uint32_t number) {
        const auto at = std::lower_bound(parts.found.begin(), parts.found.end(), number,
                                         [](const auto& found, uint32_t p) { return found.part < p; });
        return at != parts.found.end() && at->part == number;
    };
    const Pair* like = nullptr;
    float most = kAlike;
    for (const Pair& pair : old) {
        if (pair.part == part.part) return &pair;
        const float along = pair.manifold.normal.dot(part.manifold.normal);
        if (pair.manifold.count == 0 || along <= most || now(pair.part)) continue;
        most = along;
        like = &pair;
    }
    return like;
}

}  // namespace

Shaped::Shaped(const Detection& of, const PairEnds& pair)
    : a_(of.shapes[of.colliders.record[pair.collider_a()].shape].shape),
      b_(of.shapes[of.colliders.record[pair.collider_b()].shape].shape),
      at_a_(&of.pairs.placement[pair.collider_a()]),
      at_b_(&of.pairs.placement[pair.collider_b()]),
      margin_(margin_of(of, pair, of.time)),
      spans_(pair.spans()) {}

Shaped::Shaped(const Detection& of, const PairEnds& pair, bool fast, double lead) : Shaped(of, pair) {
    lead_ = lead;
    if (lead > 0) {
        encounter_.emplace(of.nodes, of.colliders, of.shapes, of.pairs, pair);
        place_after(lead);
    }
    if (!fast) return;
    if (stay_apart(of.nodes, of.pairs, pair, of.time)) {
        then_ = std::numeric_limits<float>::infinity();
        return;
    }
    encounter_.emplace(of.nodes, of.colliders, of.shapes, of.pairs, pair);
    look_ahead(of, pair);
}

Shaped::Shaped(const Detection& of, const PairEnds& pair, Met met) : Shaped(of, pair) {
    then_ = met.then;
    if (then_ == 0) return;
    encounter_.emplace(of.nodes, of.colliders, of.shapes, of.pairs, pair);
    place_after(then_);
}

// What comes down in the rest of the frame gets its point too: one corner alone would turn the body over. The far end
// of a side that spans two nodes goes its own way when the near one is stopped.
void Shaped::look_ahead(const Detection& of, const PairEnds& pair) {
    then_ = static_cast<float>(encounter_->meeting(of.time));
    if (then_ == 0 || !std::isfinite(then_)) return;
    place_after(then_);
    if (!spans_) margin_ = margin_of(of, pair, of.time - then_);
}

void Shaped::place_after(double time) {
    met_[0] = encounter_->a_after(time);
    met_[1] = encounter_->b_after(time);
    at_a_ = &met_[0];
    at_b_ = &met_[1];
}

float Shaped::find_points(collision::PairCache& cache, collision::Manifold& manifold) const {
    if (!std::isfinite(then_)) {
        manifold.count = 0;
        return 0;
    }
    const float gap = collision::collide(a_, *at_a_, b_, *at_b_, margin_, cache, manifold);
    return can_be_kept() ? gap : 0;
}

void Shaped::find_parts(collision::Parts& parts) const {
    parts.found.clear();
    if (std::isfinite(then_)) collision::collide_parts(a_, *at_a_, b_, *at_b_, margin_, parts);
}

void Shaped::find_open_points(bool solid_is_b, const collision::SolidContact& contact, const collision::Cover& cover,
                              collision::Manifold& manifold) const {
    if (solid_is_b)
        collision::collide_open(a_, *at_a_, b_, *at_b_, contact, cover, true, margin_, manifold);
    else
        collision::collide_open(b_, *at_b_, a_, *at_a_, contact, cover, false, margin_, manifold);
}

Finding::Finding(const Detection& of, bool fast, NearPair& near, Pair& pair)
    : Finding(of, fast, fast ? 0 : lead_of(of, pair), near, pair) {}

Finding::Finding(const Detection& of, bool fast, double lead, NearPair& near, Pair& pair)
    : near_(near), pair_(pair), old_(pair.manifold), shaped_(of, pair, fast, lead) {
    collision::PairCache cache;
    std::ranges::copy(pair.cache, std::ranges::copy(near.cache, cache.words).out);
    const float gap = shaped_.find_points(cache, pair.manifold);
    keep_cache(cache, near);
    keep_cache(cache, pair.cache);
    note_clear(of.pairs, gap, near);
}

void Finding::take_over(const Detection& of) const { taut::take_over(shaped_, of, old_, near_, pair_); }

bool gets_points(const Detection& of, Arrivals& arrivals, NearPair& near) {
    collision::PairCache cache;
    std::ranges::copy(near.cache, cache.words);
    const PairEnds ends = near.ends(of.colliders);
    if (!near.fast && held_apart(of, ends, cache, near)) return false;
    collision::Manifold manifold;
    const Shaped shaped(of, ends, near.fast);
    const float gap = shaped.find_points(cache, manifold);
    if (manifold.count > 0) {
        Arrival* const arrival = arrivals.take();
        if (!arrival) return true;
        arrival->key = near.key;
        arrival->manifold = manifold;
        arrival->then = shaped.then();
        keep_cache(cache, arrival->cache);
    }
    keep_cache(cache, near);
    note_clear(of.pairs, gap, near);
    return manifold.count > 0;
}

void admit(const Detection& of, NearPair& near, Pair& pair) {
    if (pair.manifold.count == 0) return find_points(of, near.fast, near, pair);
    take_over(Shaped(of, pair, Shaped::Met{pair.then}), of, {}, near, pair);
}

void find_parts(const Detection& of, NearPair& near) {
    Pairs& pairs = of.pairs;
    const PairEnds ends = near.ends(of.colliders);
    const Shaped shaped(of, ends, near.fast);
    shaped.find_parts(pairs.parts);
    near.kept = true;
    near.changed = false;
    if (pairs.parts.found.empty()) return lose_points(of, near);
    reserve_slots(pairs, pairs.parts.found.size());
    Pair old[collision::kMaxParts];
    size_t count = 0;
    for_parts(pairs, near, [&](const Pair& pair) { old[count++] = pair; });
    give_slots(pairs, near);
    collision::Manifold nothing;
    uint32_t* link = &near.pair;
    for (const collision::PartManifold& found : pairs.parts.found) {
        const Pair* before = find_old({old, count}, pairs.parts, found);
        *link = take_slot(pairs, ends);
        Pair& pair = pairs.list[*link];
        link = &pair.next;
        pair.part = found.part;
        pair.manifold = found.manifold;
        pair.touching = before && before->part == found.part && before->touching;
        if (!adopt(shaped, of, false, before ? before->manifold : nothing, before ? *before : pair, pair))
            near.kept = false;
    }
}

bool refresh_part(const Shaped& shaped, const Detection& of, Pair& pair) {
    const collision::Manifold old = pair.manifold;
    pair.manifold.count = 0;
    for (const collision::PartManifold& found : of.pairs.parts.found)
        if (found.part == pair.part) pair.manifold = found.manifold;
    return pair.manifold.count > 0 && adopt(shaped, of, is_known(old, pair), old, pair, pair);
}

Vec3 origin_of_points(const Detection& of, const Pair& pair) {
    if (pair.a2 != kNone) return of.nodes.motion[pair.a].x;
    const uint32_t a = pair.collider_a();
    return of.pairs.placement[a].position - of.pairs.stance[a].from_node.cast<double>();
}

void find_open_points(const Detection& of, bool solid_is_b, const collision::SolidContact& contact,
                      const collision::Cover& cover, Pair& pair) {
    const Shaped shaped(of, pair, Shaped::Met{pair.then});
    shaped.find_open_points(solid_is_b, contact, cover, pair.manifold);
    const Vec3f from_a = offset_of(of.nodes, of.colliders.record[pair.collider_a()], shaped.at_a(), shaped.then());
    for (int k = 0; k < pair.manifold.count; ++k) pair.manifold.points[k].position += from_a;
    shaped.bring_to_present(pair);
    forget_forces(pair);
}

bool reuse(const Detection& of, const NearPair& near, Pair& pair) {
    const Vec3f old_normal = pair.manifold.normal;
    if (!reuse_manifold(of.pairs, of.time, pair)) return false;
    if (near.changed || pair.driven || pair.directed) {
        const uint32_t a = pair.collider_a();
        meet(of, of.pairs.placement[a], of.pairs.placement[pair.collider_b()], of.pairs.stance[a].from_node, pair);
    }
    carry_on(old_normal, pair);
    return true;
}

bool reuse(const Detection& of, NearPair& near) {
    if (!near.kept) return false;
    for (uint32_t p = near.pair; p != kNone; p = of.pairs.list[p].next) {
        Pair& pair = of.pairs.list[p];
        near.changed = near.changed || pair.answered;
        pair.answered = false;
        if (!reuse(of, near, pair)) return false;
    }
    near.changed = false;
    return near.pair != kNone;
}

void lose_points(const Detection& of, NearPair& near) {
    if (near.touching) report_end(of.pairs, of.nodes, of.colliders, near);
    near.touching = false;
    give_slots(of.pairs, near);
}

}  // namespace taut
