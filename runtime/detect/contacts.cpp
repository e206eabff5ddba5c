// Manifolds of pairs, the parts of surfaces among them, and the impulses that their points carry over.
#include <algorithm>
#include <cmath>
#include <optional>

#include "detect/detect.h"
#include "detect/impact.h"
#include "detect/surfaces.h"

namespace taut {
namespace {

// Points further apart than this are not the same point of two frames [m].
constexpr float kSamePoint = 0.02f;
constexpr uint32_t kGrain = 64;  // colliders or pairs that a thread takes at a time

// How far two bodies can approach each other in a frame, so that a fast pair meets its contacts before it overlaps.
float margin_of(const Nodes& nodes, const PairEnds& pair, double time_step) {
    double fastest = 0;
    for_sides(pair, [&](uint32_t a, uint32_t b) {
        fastest = std::max(fastest, (nodes.motion[a].v - nodes.motion[b].v).norm());
    });
    return kContactMargin + static_cast<float>(std::min(kMaxReach, fastest * time_step));
}

// Impulses of the old points onto the new ones: by feature, else by place; friction turned into the new tangents.
void carry_impulses(const collision::Manifold& old, const Impulse* from, const collision::Manifold& now, Impulse* to) {
    const Vec3f t1 = tangent_of(now.normal), t2 = now.normal.cross(t1);
    const Vec3f o1 = tangent_of(old.normal), o2 = old.normal.cross(o1);
    bool used[4] = {}, found[4] = {};
    auto take = [&](int i, int k) {
        const Vec3f friction = from[k].tangent1 * o1 + from[k].tangent2 * o2;
        to[i] = {from[k].normal, friction.dot(t1), friction.dot(t2), from[k].slip};
        used[k] = found[i] = true;
    };
    for (int i = 0; i < now.count; ++i)
        for (int k = 0; k < old.count && !found[i]; ++k)
            if (!used[k] && old.points[k].feature == now.points[i].feature) take(i, k);
    for (int i = 0; i < now.count; ++i) {
        if (found[i]) continue;
        to[i] = {};
        float nearest = kSamePoint * kSamePoint;
        int best = -1;
        for (int k = 0; k < old.count; ++k) {
            const float d = (old.points[k].position - now.points[i].position).squaredNorm();
            if (!used[k] && d < nearest) nearest = d, best = k;
        }
        if (best >= 0) take(i, best);
    }
}

// Friction torques carried over, turned into the frame of the new manifold.
void carry_turning(const collision::Manifold& old, Impulse turning, float spin_slip, Pair& pair) {
    const Vec3f n = pair.manifold.normal, t1 = tangent_of(n), o1 = tangent_of(old.normal);
    const Vec3f sum = turning.normal * old.normal + turning.tangent1 * o1 + turning.tangent2 * old.normal.cross(o1);
    pair.turning = {sum.dot(n), sum.dot(t1), sum.dot(n.cross(t1)), turning.slip};
    pair.spin_slip = spin_slip;
}

// Two shapes as they stand in a pair, or as they will where they meet later in the time ahead [s].
class Shaped {
public:
    Shaped(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
           const PairEnds& pair, bool fast, double time)
        : a_(shapes.record[colliders.record[pair.collider_a()].shape].shape),
          b_(shapes.record[colliders.record[pair.collider_b()].shape].shape),
          at_a_(&pairs.placement[pair.collider_a()]),
          at_b_(&pairs.placement[pair.collider_b()]),
          margin_(margin_of(nodes, pair, time)) {
        if (!fast) return;
        encounter_.emplace(nodes, colliders, shapes, pairs, pair);
        look_ahead(time, pair.a2 != kNone || pair.b2 != kNone);
    }
    Shaped(const Shaped&) = delete;
    Shaped& operator=(const Shaped&) = delete;

    const collision::Placement& at_a() const { return *at_a_; }
    const collision::Placement& at_b() const { return *at_b_; }

    void find_points(collision::PairCache& cache, collision::Manifold& manifold) const {
        manifold.count = 0;
        if (std::isfinite(then_)) collision::collide(a_, *at_a_, b_, *at_b_, margin_, cache, manifold);
    }
    void find_parts(collision::Parts& parts) const {
        parts.found.clear();
        if (std::isfinite(then_)) collision::collide_parts(a_, *at_a_, b_, *at_b_, margin_, parts);
    }

    float then() const { return static_cast<float>(then_); }
    void bring_to_present(Pair& pair) const {
        if (pair.then > 0) encounter_->bring_to_present(pair);
    }

private:
    // The far end of a side that spans two nodes goes on when the near one is stopped: it gets its point too.
    void look_ahead(double time, bool spans) {
        then_ = encounter_->meeting(time);
        if (then_ == 0 || !std::isfinite(then_)) return;
        met_[0] = encounter_->a_after(then_);
        met_[1] = encounter_->b_after(then_);
        at_a_ = &met_[0];
        at_b_ = &met_[1];
        if (!spans) margin_ = kContactMargin;
    }

    const collision::Shape &a_, &b_;
    const collision::Placement *at_a_, *at_b_;
    float margin_;
    double then_ = 0;                     // 0: as they stand; infinite: they do not meet
    std::optional<Encounter> encounter_;  // of fast ones
    collision::Placement met_[2];         // where they meet
};

bool has_parts(const Colliders& colliders, const Shapes& shapes, const PairEnds& pair) {
    const auto of = [&](uint32_t collider) {
        return collision::has_parts(shapes.record[colliders.record[collider].shape].shape);
    };
    return of(pair.collider_a()) || of(pair.collider_b());
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

// A pair's new manifold: its place and surface, and the impulses that the record before had with the old one.
void adopt(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, const Pairs& pairs,
           const collision::Manifold& old, const Pair& before, Pair& pair) {
    const Collider &a = colliders.record[pair.collider_a()], &b = colliders.record[pair.collider_b()];
    const Vec3f from_a = offset_of(nodes, a, shaped.at_a(), shaped.then());
    for (int k = 0; k < pair.manifold.count && from_a != Vec3f::Zero(); ++k) pair.manifold.points[k].position += from_a;
    pair.rolls_a = pairs.pace[pair.collider_a()].rolls;
    pair.rolls_b = pairs.pace[pair.collider_b()].rolls;
    pair.round_a = pairs.pace[pair.collider_a()].round;
    pair.round_b = pairs.pace[pair.collider_b()].round;
    pair.then = shaped.then();
    shaped.bring_to_present(pair);
    const float friction = pair.friction, restitution = pair.restitution;
    combine_surfaces(nodes, a, b, shaped.at_a(), shaped.at_b(), from_a, pair);
    if (pair.answered) pair.friction = friction, pair.restitution = restitution;  // as the host said
    pair.asks = pairs.asks | a.asks | b.asks;
    if (old.count == 0) {
        std::fill(pair.impulse, pair.impulse + 4, Impulse{});
        pair.turning = {};
        pair.spin_slip = -1;
        return;
    }
    Impulse carried[4];
    std::copy(before.impulse, before.impulse + 4, carried);
    carry_impulses(old, carried, pair.manifold, pair.impulse);
    if (pair.turns()) carry_turning(old, before.turning, before.spin_slip, pair);
}

// Manifold of one pair, with the impulses of the last one.
void find_points(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, const Pairs& pairs,
                 collision::PairCache& cache, Pair& pair) {
    const collision::Manifold old = pair.manifold;
    shaped.find_points(cache, pair.manifold);
    if (pair.manifold.count > 0) adopt(shaped, nodes, colliders, pairs, old, pair, pair);
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

// A pair without points has no records and touches no more.
void lose_points(const Nodes& nodes, const Colliders& colliders, Pairs& pairs, NearPair& near) {
    if (near.touching) report_end(pairs, nodes, colliders, near);
    near.touching = false;
    give_slots(pairs, near);
}

// The parts that a pair with a surface touches, in place of its records of the last frame.
void find_parts(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, Pairs& pairs, NearPair& near,
                const PairEnds& ends) {
    shaped.find_parts(pairs.parts);
    if (pairs.parts.found.empty()) return lose_points(nodes, colliders, pairs, near);
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
        adopt(shaped, nodes, colliders, pairs, before ? before->manifold : nothing, before ? *before : pair, pair);
    }
}

// A part of a pair whose parts were just found again: one that is not among them loses its points.
void refresh_part(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, const Pairs& pairs,
                  Pair& pair) {
    const collision::Manifold old = pair.manifold;
    pair.manifold.count = 0;
    for (const collision::PartManifold& found : pairs.parts.found)
        if (found.part == pair.part) pair.manifold = found.manifold;
    if (pair.manifold.count > 0) adopt(shaped, nodes, colliders, pairs, old, pair, pair);
}

// The manifold of a pair without a surface, if it has a record; else whether it is to get one. That is found out with
// the cache as it was, so that whoever finds the points starts from the same.
void find_points(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, Pairs& pairs, NearPair& near) {
    if (near.pair != kNone) {
        Pair& pair = pairs.list[near.pair];
        pair.answered = false;
        find_points(shaped, nodes, colliders, pairs, near.cache, pair);
        return;
    }
    const collision::PairCache before = near.cache;
    collision::Manifold manifold;
    shaped.find_points(near.cache, manifold);
    near.arrives = manifold.count > 0;
    if (near.arrives) near.cache = before;
}

// Records of pairs that got their first points: given in the order of keys, filled side by side.
void admit_arriving(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                    double time_step) {
    Array<uint32_t>& arriving = pairs.arriving;
    arriving.clear();
    for (uint32_t i = 0; i < pairs.near.size(); ++i)
        if (pairs.near[i].arrives) arriving.push_back(i);
    reserve_slots(pairs, arriving.size());
    for (const uint32_t i : arriving) pairs.near[i].pair = take_slot(pairs, pairs.near[i].ends(colliders));
    team.for_ranges(static_cast<uint32_t>(arriving.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t k = begin; k < end; ++k) {
            NearPair& near = pairs.near[arriving[k]];
            Pair& pair = pairs.list[near.pair];
            find_points(Shaped(nodes, colliders, shapes, pairs, pair, near.fast, time_step), nodes, colliders, pairs,
                        near.cache, pair);
        }
    });
}

// The records of a near pair as it is now.
void list_active(const Nodes& nodes, const Colliders& colliders, Pairs& pairs, uint32_t index) {
    NearPair& near = pairs.near[index];
    if (near.pair != kNone && pairs.list[near.pair].manifold.count == 0) lose_points(nodes, colliders, pairs, near);
    for (uint32_t p = near.pair; p != kNone; p = pairs.list[p].next) {
        const Pair& pair = pairs.list[p];
        near.asks = pair.asks;
        pairs.active.push_back(
            {pair.a, pair.b, p, static_cast<uint32_t>(pair.manifold.count), pair.a2, pair.b2, pair.asks, index});
    }
}

}  // namespace

void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep) {
    uint64_t found = 0;  // the pair whose parts are found; its records follow one another
    for (uint32_t p : active_pairs) {
        ActivePair& active = pairs.active[p];
        Pair& pair = pairs.list[active.pair];
        for (uint32_t c : {pair.collider_a(), pair.collider_b()})
            pairs.placement[c] = placement_of(nodes, colliders.record[c], elapsed);
        const bool fast = is_fast(nodes, pairs, pair, substep);
        const Shaped shaped(nodes, colliders, shapes, pairs, pair, fast, substep);
        if (pair.part == 0) {
            find_points(shaped, nodes, colliders, pairs, pairs.near[active.near].cache, pair);
        } else {
            if (pair.key != found) shaped.find_parts(pairs.parts);
            found = pair.key;
            refresh_part(shaped, nodes, colliders, pairs, pair);
        }
        active.points = static_cast<uint32_t>(pair.manifold.count);
    }
}

void find_contacts(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step) {
    const uint32_t slots = static_cast<uint32_t>(colliders.record.size());
    pairs.placement.resize(slots);
    team.for_ranges(slots, kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c) {
            const Collider& collider = colliders.record[c];
            if (collider.node == kNone || nodes.rest[collider.node] == Rest::asleep) continue;
            pairs.placement[c] = placement_of(nodes, collider);
        }
    });
    team.for_ranges(static_cast<uint32_t>(pairs.near.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            NearPair& near = pairs.near[i];
            if (near.filtered) continue;
            const PairEnds ends = near.ends(colliders);
            near.arrives = false;
            near.fast = is_fast(nodes, pairs, ends, time_step);
            near.on_surface = has_parts(colliders, shapes, ends);
            if (!near.on_surface)
                find_points(Shaped(nodes, colliders, shapes, pairs, ends, near.fast, time_step), nodes, colliders,
                            pairs, near);
        }
    });
    admit_arriving(team, nodes, colliders, shapes, pairs, time_step);
    pairs.active.clear();
    reserve_more(pairs.active, pairs.list.size() - pairs.free.size());
    for (uint32_t i = 0; i < pairs.near.size(); ++i) {
        NearPair& near = pairs.near[i];
        if (near.filtered) continue;
        if (near.on_surface) {
            const PairEnds ends = near.ends(colliders);
            find_parts(Shaped(nodes, colliders, shapes, pairs, ends, near.fast, time_step), nodes, colliders, pairs,
                       near, ends);
        }
        list_active(nodes, colliders, pairs, i);
    }
}

}  // namespace taut
