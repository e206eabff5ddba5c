#include <atomic>
#include <cmath>

#include "detect/impact.h"
#include "detect/mechanism.h"
#include "detect/passage.h"
#include "threads/gather.h"

namespace taut {
namespace {

constexpr double kStride = 0.25;  // of the ball inside a shape: who moved less against each other is not looked after
constexpr uint8_t kRounds = 3;    // where a mechanism was put back, other parts of it may have passed
constexpr uint32_t kGrain = 64, kCastGrain = 16;  // colliders and pairs that a thread takes at a time

// By the host's function or a one-way direction: what goes through on purpose is not held back.
bool may_be_ignored(const Colliders& colliders, const NearPair& pair) {
    const unsigned asks = colliders.record[pair.collider_a()].asks | colliders.record[pair.collider_b()].asks;
    return (asks & (kAsksOneWay | kAsksPreSolve)) != 0;
}

bool put_back(const Mechanisms& mechanisms, const Collider& collider, uint8_t round) {
    return mechanisms.put_back[collider.node] == round ||
           (collider.node_b != kNone && mechanisms.put_back[collider.node_b] == round);
}

// Marks what went elsewhere than its speed told before the step, further from there than a part of its thickness: of
// all, after the first round of what the last one put back. Whether anything did.
bool find_astray(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint8_t round,
                 Pairs& pairs) {
    std::atomic<bool> any = false;
    team.for_ranges(static_cast<uint32_t>(pairs.pace.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c) {
            const Collider& collider = colliders.record[c];
            Pace& pace = pairs.pace[c];
            if (collider.node == kNone) continue;
            pace.moved = round == 1 || put_back(pairs.mechanisms, collider, round - 1);
            if (!pace.moved) continue;
            if (collider.node_b != kNone || !nodes.solved(collider.node)) continue;
            const double stride = kStride * pace.thickness;
            const Vec3 off = way_along(nodes, collider, shapes) - pairs.reach[c].ahead.cast<double>();
            pace.astray = off.squaredNorm() > stride * stride;
            if (pace.astray) any.store(true, std::memory_order_relaxed);
        }
    });
    return any.load(std::memory_order_relaxed);
}

void find_courses(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    pairs.courses.resize(pairs.pace.size());
    team.for_ranges(static_cast<uint32_t>(pairs.pace.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t c = begin; c < end; ++c)
            if (colliders.record[c].node != kNone && pairs.pace[c].moved)
                pairs.courses[c] = course_of(nodes, colliders.record[c], shapes, pairs.pace[c]);
    });
}

// Whether a pair that may have passed moved further against each other than a part of its thickness.
bool strides(const Colliders& colliders, const Pairs& pairs, const NearPair& near) {
    const uint32_t a = near.collider_a(), b = near.collider_b();
    if (!(near.fast || pairs.pace[a].astray || pairs.pace[b].astray) || near.filtered) return false;
    const Course &one = pairs.courses[a], &other = pairs.courses[b];
    if (std::isinf(one.thickness + other.thickness)) return false;  // not to be looked for
    const float thinner = one.thickness > 0 && other.thickness > 0 ? std::min(one.thickness, other.thickness)
                                                                   : std::max(one.thickness, other.thickness);
    const double stride = kStride * static_cast<double>(thinner);
    return (one.along - other.along).squaredNorm() > stride * stride && !may_be_ignored(colliders, near);
}

bool moved(const Pairs& pairs, const NearPair& near) {
    return pairs.pace[near.collider_a()].moved || pairs.pace[near.collider_b()].moved;
}

bool may_pass(const Pairs& pairs, const NearPair& near) {
    return may_pass(pairs.courses[near.collider_a()], pairs.courses[near.collider_b()]);
}

// Whether a pair had passed; in the last round it stays where it was.
bool part(const Couple& pair, const Excess& excess, const Joints& joints, uint8_t round, Mechanisms& mechanisms,
          Nodes& nodes) {
    if (!(excess.share > 0)) return false;
    if (mechanisms.root.empty()) find_mechanisms(nodes, joints, mechanisms);
    Mechanism of_a(nodes, mechanisms, pair.a.collider.node), of_b(nodes, mechanisms, pair.b.collider.node);
    if (of_a.has(pair.b.collider.node)) return false;
    if (round == kRounds) {
        const bool a_may = of_a.may_stay(), b_may = of_b.may_stay();
        if (!a_may || !b_may) return false;
        of_a.stay(round);
        of_b.stay(round);
    } else {
        of_a.go_back(excess.share * way_of(nodes, pair.a), excess.normal, round);
        of_b.go_back(excess.share * excess.way, excess.normal, round);
    }
    return true;
}

// Picks the pairs that may have passed, and finds those that did and of which a side moved.
void find_passed(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    gather(team, static_cast<uint32_t>(pairs.near.size()), pairs.picked, [&](uint32_t i) {
        NearPair& near = pairs.near[i];
        if (moved(pairs, near)) near.strides = strides(colliders, pairs, near);
        return near.strides;
    });
    team.for_ranges(static_cast<uint32_t>(pairs.picked.size()), kCastGrain, [&](uint32_t begin, uint32_t end) {
        // Apart from the casts, so that processors work on several at once.
        for (uint32_t i = begin; i < end; ++i) {
            NearPair& near = pairs.near[pairs.picked[i]];
            near.passed = moved(pairs, near) && may_pass(pairs, near);
        }
        for (uint32_t i = begin; i < end; ++i) {
            NearPair& near = pairs.near[pairs.picked[i]];
            if (near.passed) near.passed = excess_of(nodes, Couple(colliders, shapes, pairs.courses, near)).share > 0;
        }
    });
}

}  // namespace

// Who passed is found for all pairs at once, after the first round for those alone of which a side was put back in the
// last. They are put back one after the other, where those of which a side was put back already are asked again.
void hold_back(Team& team, const Colliders& colliders, const Shapes& shapes, const Joints& joints, Pairs& pairs,
               Nodes& nodes) {
    Mechanisms& mechanisms = pairs.mechanisms;
    mechanisms.root.clear();
    bool again = true;
    for (uint8_t round = 1; again && round <= kRounds; ++round) {
        again = false;
        const bool any_astray = find_astray(team, nodes, colliders, shapes, round, pairs);
        if (round == 1 && !any_astray && !pairs.any_fast) {
            let_go(pairs.courses);
            break;
        }
        find_courses(team, nodes, colliders, shapes, pairs);
        find_passed(team, nodes, colliders, shapes, pairs);
        for (const uint32_t i : pairs.picked) {
            const NearPair& near = pairs.near[i];
            bool anew = false;
            for (const uint32_t c : {near.collider_a(), near.collider_b()}) {
                const Collider& collider = colliders.record[c];
                if (!again || !put_back(mechanisms, collider, round)) continue;
                pairs.courses[c] = course_of(nodes, collider, shapes, pairs.pace[c]);
                anew = true;
            }
            if (!near.passed && !(anew && may_pass(pairs, near))) continue;
            const Couple pair(colliders, shapes, pairs.courses, near);
            again = part(pair, excess_of(nodes, pair), joints, round, mechanisms, nodes) || again;
        }
    }
    end_stays(mechanisms);
}

}  // namespace taut
