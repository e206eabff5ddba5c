#include "detect/crowds.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace taut {
namespace {

void enter(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    grow_to(pairs.crowd_of, colliders.record.size());
    pairs.crowds.assign(colliders.active.size(), {});
    for (const NearPair& near : pairs.near)
        for (const uint32_t c : {near.collider_a(), near.collider_b()}) pairs.crowd_of[c] = kNone;
    for (uint32_t i = 0; i < pairs.crowds.size(); ++i) {
        const uint32_t c = colliders.active[i];
        const Collider& collider = colliders.record[c];
        const collision::Shape& shape = shapes[collider.shape].shape;
        if (collider.node_b != kNone || !moves_by_forces(nodes.info[collider.node].kind)) continue;
        const collision::Placement& at = pairs.placement[c];
        pairs.crowd_of[c] = i;
        pairs.crowds[i].middle = at.position + (at.rotation * collision::middle(shape).cast<float>()).cast<double>();
        pairs.crowds[i].radius = collision::thickness(shape) - static_cast<double>(pairs.travel[c].margin);
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
    // By how much the balls inside them overlap [m]; 0: not.
    float sunk() const {
        const double reach = a->radius + b->radius, squared = (a->middle - b->middle).squaredNorm();
        return reach > 0 && squared < reach * reach ? static_cast<float>(reach - std::sqrt(squared)) : 0;
    }
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
    if (pairs.near.size() <= Crowd::kMost * colliders.active.size()) return 0;
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
