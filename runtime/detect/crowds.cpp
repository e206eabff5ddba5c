#include "detect/crowds.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut {
namespace {

InnerBall inner_ball(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
                     uint32_t c) {
    const Collider& collider = colliders.record[c];
    if (collider.node_b != kNone || !moves_by_forces(nodes.info[collider.node].kind)) return {};
    const collision::Shape& shape = shapes[collider.shape].shape;
    const collision::Placement& at = pairs.placement[c];
    return {at.position + (at.rotation * collision::middle(shape).cast<float>()).cast<double>(),
            std::max(0.0, collision::thickness(shape) - static_cast<double>(pairs.travel[c].margin))};
}

// By how much two balls overlap [m]; 0: not.
float overlap(const InnerBall& a, const InnerBall& b) {
    if (a.radius == 0 || b.radius == 0) return 0;
    const double reach = a.radius + b.radius, squared = (a.middle - b.middle).squaredNorm();
    return squared < reach * reach ? static_cast<float>(reach - std::sqrt(squared)) : 0;
}

// Whether a collider has more than Crowd::kMost sunk into it of those after it in the order of keys. Where none has, no
// more pairs are sunk than Crowd::kMost for each collider, among any of them.
bool any_crowd(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs) {
    const NearPairs& near = pairs.near;
    for (size_t begin = 0, end = 0; begin < near.size(); begin = end) {
        const uint32_t first = near[begin].collider_a();
        while (end < near.size() && near[end].collider_a() == first) ++end;
        if (end - begin <= Crowd::kMost) continue;
        const InnerBall ball = inner_ball(nodes, colliders, shapes, pairs, first);
        uint32_t sunk = 0;
        for (size_t i = begin; ball.radius > 0 && i < end; ++i)
            if (!near[i].filtered)
                sunk += overlap(ball, inner_ball(nodes, colliders, shapes, pairs, near[i].collider_b())) > 0;
        if (sunk > Crowd::kMost) return true;
    }
    return false;
}

void enter(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    grow_to(pairs.crowd_of, colliders.record.size());
    pairs.crowds.assign(colliders.active.size(), {});
    for (const NearPair& near : pairs.near)
        for (const uint32_t c : {near.collider_a(), near.collider_b()}) pairs.crowd_of[c] = kNone;
    for (uint32_t i = 0; i < pairs.crowds.size(); ++i) {
        const uint32_t c = colliders.active[i];
        pairs.crowds[i].ball = inner_ball(nodes, colliders, shapes, pairs, c);
        if (pairs.crowds[i].ball.radius > 0) pairs.crowd_of[c] = i;
    }
}

// The two sides of a pair, where both yield; else null.
struct Sides {
    Crowd *a = nullptr, *b = nullptr;

    Sides(Pairs& pairs, const NearPair& near) {
        const uint32_t of_a = pairs.crowd_of[near.collider_a()], of_b = pairs.crowd_of[near.collider_b()];
        if (near.filtered || of_a == kNone || of_b == kNone) return;
        a = &pairs.crowds[of_a], b = &pairs.crowds[of_b];
    }
    float sunk() const { return overlap(a->ball, b->ball); }
};

void take(Crowd& crowd, float depth) {
    if (crowd.count++ >= Crowd::kMost) {
        if (depth <= crowd.depth[0]) return;
        std::copy(crowd.depth + 1, crowd.depth + Crowd::kMost, crowd.depth);
    }
    uint32_t at = std::min(crowd.count, Crowd::kMost) - 1;
    for (; at > 0 && crowd.depth[at - 1] > depth; --at) crowd.depth[at] = crowd.depth[at - 1];
    crowd.depth[at] = depth;
}

// How many of those are as deep as the least of them: of the equally deep, the first in the list stay.
void count_least(Crowd& crowd) {
    crowd.least = 0;
    while (crowd.least < std::min(crowd.count, Crowd::kMost) && crowd.depth[crowd.least] == crowd.depth[0])
        ++crowd.least;
}

bool is_crowded(const Crowd& crowd) { return crowd.count > Crowd::kMost; }

bool keeps(Crowd& crowd, float depth) {
    if (depth != crowd.depth[0]) return depth > crowd.depth[0];
    if (crowd.least == 0) return false;
    --crowd.least;
    return true;
}

void leave_out(Pairs& pairs, NearPair& near) {
    near.crowded = true;
    for_parts(pairs, near, [](Pair& pair) { pair.manifold.count = 0; });
}

}  // namespace

uint32_t thin_crowds(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    if (std::exchange(pairs.any_crowded, false))
        for (NearPair& near : pairs.near) near.crowded = false;
    if (!any_crowd(nodes, colliders, shapes, pairs)) return 0;
    enter(nodes, colliders, shapes, pairs);
    for (const NearPair& near : pairs.near) {
        const Sides sides(pairs, near);
        if (!sides.a) continue;
        const float depth = sides.sunk();
        if (!(depth > 0)) continue;
        take(*sides.a, depth);
        take(*sides.b, depth);
    }
    for (Crowd& crowd : pairs.crowds) count_least(crowd);
    uint32_t left_out = 0;
    for (NearPair& near : pairs.near) {
        const Sides sides(pairs, near);
        if (!sides.a || !is_crowded(*sides.a) || !is_crowded(*sides.b)) continue;
        const float depth = sides.sunk();
        const bool of_a = keeps(*sides.a, depth), of_b = keeps(*sides.b, depth);
        if (of_a || of_b) continue;
        leave_out(pairs, near);
        ++left_out;
    }
    pairs.any_crowded = left_out > 0;
    return left_out;
}

}  // namespace taut
