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
float margin_of(const Nodes& nodes, const Pair& pair, double time_step) {
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
    Shaped(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs, const Pair& pair,
           double time)
        : a_(shapes.record[colliders.record[pair.collider_a()].shape].shape),
          b_(shapes.record[colliders.record[pair.collider_b()].shape].shape),
          at_a_(&pairs.placement[pair.collider_a()]),
          at_b_(&pairs.placement[pair.collider_b()]),
          margin_(margin_of(nodes, pair, time)) {
        if (!pair.fast) return;
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

bool has_parts(const Colliders& colliders, const Shapes& shapes, const Pair& pair) {
    const auto of = [&](uint32_t collider) {
        return collision::has_parts(shapes.record[colliders.record[collider].shape].shape);
    };
    return of(pair.collider_a()) || of(pair.collider_b());
}

// By the host's function or a one-way direction: what goes through on purpose is not held back.
bool may_be_ignored(const Colliders& colliders, const Pair& pair) {
    const unsigned asks = colliders.record[pair.collider_a()].asks | colliders.record[pair.collider_b()].asks;
    return (asks & (kAsksOneWay | kAsksPreSolve)) != 0;
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
void find_points(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, const Pairs& pairs, Pair& pair) {
    const collision::Manifold old = pair.manifold;
    shaped.find_points(pair.cache, pair.manifold);
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

// The parts that a pair with a surface touches, into pairs.fresh; old: its records of the last frame.
void find_parts(const Shaped& shaped, const Nodes& nodes, const Colliders& colliders, Pairs& pairs,
                std::span<Pair> old) {
    Pair& first = old[0];
    first.manifold.count = 0;
    shaped.find_parts(pairs.parts);
    for (const collision::PartManifold& found : pairs.parts.found) {
        const Pair* before = find_old(old.subspan(1), pairs.parts, found);
        Pair& pair = pairs.fresh.emplace_back();
        pair.key = first.key;
        pair.a = first.a;
        pair.b = first.b;
        pair.a2 = first.a2;
        pair.b2 = first.b2;
        pair.part = found.part;
        pair.manifold = found.manifold;
        pair.touching = before && before->part == found.part && before->touching;
        adopt(shaped, nodes, colliders, pairs, before ? before->manifold : first.manifold, before ? *before : first,
              pair);
    }
}

ActivePair active_of(const Pair& pair, uint32_t index) {
    return {pair.a, pair.b, index, static_cast<uint32_t>(pair.manifold.count), pair.a2, pair.b2, pair.asks};
}

// The fresh parts in place of the old ones, and the active pairs anew.
void replace_parts(Pairs& pairs) {
    reserve_pairs(pairs.list, pairs.fresh.size());
    std::erase_if(pairs.list, [](const Pair& pair) { return pair.part != 0; });
    merge_pairs(
        pairs.list, pairs.fresh.size(), [&] { return pairs.fresh.back().key; },
        [&] {
            const Pair pair = pairs.fresh.back();
            pairs.fresh.pop_back();
            return pair;
        });
    pairs.active.clear();
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        const Pair& pair = pairs.list[i];
        if (!pair.filtered && pair.manifold.count > 0) pairs.active.push_back(active_of(pair, i));
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

}  // namespace

void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep) {
    uint64_t found = 0;  // the pair whose parts are found; its records follow one another
    for (uint32_t p : active_pairs) {
        ActivePair& active = pairs.active[p];
        Pair& pair = pairs.list[active.pair];
        for (uint32_t c : {pair.collider_a(), pair.collider_b()})
            pairs.placement[c] = placement_of(nodes, colliders.record[c], elapsed);
        pair.fast = is_fast(nodes, pairs, pair, substep);
        const Shaped shaped(nodes, colliders, shapes, pairs, pair, substep);
        if (pair.part == 0) {
            find_points(shaped, nodes, colliders, pairs, pair);
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
    team.for_ranges(static_cast<uint32_t>(pairs.list.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            Pair& pair = pairs.list[i];
            if (pair.filtered || pair.part != 0) continue;
            pair.answered = false;
            pair.fast = is_fast(nodes, pairs, pair, time_step);
            pair.on_surface = has_parts(colliders, shapes, pair);
            if (!pair.on_surface)
                find_points(Shaped(nodes, colliders, shapes, pairs, pair, time_step), nodes, colliders, pairs, pair);
        }
    });
    pairs.active.clear();
    pairs.fresh.clear();
    pairs.fast.clear();
    bool parts = false;
    for (uint32_t i = 0; i < pairs.list.size(); ++i) {
        Pair& pair = pairs.list[i];
        parts = parts || pair.part != 0;
        if (pair.filtered || pair.part != 0) continue;
        if (pair.fast && !may_be_ignored(colliders, pair)) pairs.fast.push_back(pair.key);
        const size_t fresh = pairs.fresh.size();
        if (pair.on_surface) {
            size_t end = i + 1;
            while (end < pairs.list.size() && pairs.list[end].part != 0) ++end;
            find_parts(Shaped(nodes, colliders, shapes, pairs, pair, time_step), nodes, colliders, pairs,
                       std::span(pairs.list).subspan(i, end - i));
        }
        if (pair.manifold.count > 0) {
            pairs.active.push_back(active_of(pair, i));
        } else if (pairs.fresh.size() == fresh && pair.touching) {
            report_end(pairs, nodes, colliders, pair);
            pair.touching = false;
        }
    }
    if (parts || !pairs.fresh.empty()) replace_parts(pairs);
}

}  // namespace taut
