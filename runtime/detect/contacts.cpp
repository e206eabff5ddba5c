// Contacts of all pairs: who is asked, who gets and loses records, and the list of those with points.
#include <algorithm>
#include <atomic>

#include "base/prefetch.h"
#include "detect/carried.h"
#include "detect/carry.h"
#include "detect/detect.h"
#include "detect/impact.h"
#include "detect/internal_faces.h"
#include "detect/manifolds.h"
#include "detect/reuse.h"
#include "threads/gather.h"

namespace taut {
namespace {

constexpr uint32_t kTogether = 8;      // runs of pairs that a thread takes at a time: enough to find many side by side
constexpr uint32_t kArrivalGrain = 8;  // pairs that a thread takes at a time
constexpr uint32_t kFewArriving = 32, kMostArriving = 1024;
constexpr uint32_t kSoon = 4;  // pairs that a loop asks the memory for ahead of itself

bool has_parts(const Detection& of, const NearPair& near) {
    const auto has = [&](uint32_t collider) {
        return collision::has_parts(of.shapes[of.colliders.record[collider].shape].shape);
    };
    return has(near.collider_a()) || has(near.collider_b());
}

// Of a run of pairs, those that are asked. All are written, and counted if so: which are would be mispredicted.
class Asked {
public:
    static constexpr uint32_t kTogether = 64;

    Asked(Pairs& pairs, uint32_t begin, uint32_t end) : pairs_(pairs) {
        for (uint32_t i = begin; i < end; ++i) {
            NearPair& near = pairs.near[i];
            near.arrives = near.fast = near.reused = false;
            near.changes = near.pair != kNone;  // a record may have lost its points since it was asked
            index_[count_] = i;
            const bool left_out = near.filtered | near.crowded, stays_clear = stay_clear(pairs, near);
            count_ += !(left_out | stays_clear);
        }
    }
    uint32_t count() const { return count_; }
    // Asks the memory for the record of one that comes soon.
    NearPair& take(uint32_t k) const {
        if (const uint32_t soon = k + kSoon < count_ ? at(k + kSoon).pair : kNone; soon != kNone)
            prefetch(pairs_.list[soon]);
        return at(k);
    }

private:
    NearPair& at(uint32_t k) const { return pairs_.near[index_[k]]; }

    Pairs& pairs_;
    uint32_t index_[kTogether], count_ = 0;
};

// Finds what a pair needs on its own.
void look_at(const Detection& of, Arrivals& arrivals, Findings& findings, NearPair& near) {
    near.fast = may_be_fast(of.pairs, near) && is_fast(of.nodes, of.pairs, near.ends(of.colliders), of.time);
    near.reused = !near.fast && reuse(of, near);
    if (near.reused) return;
    near.on_surface = has_parts(of, near);
    if (near.on_surface) return;
    if (near.pair == kNone) {
        near.arrives = gets_points(of, arrivals, near);
        return;
    }
    Pair& pair = of.pairs.list[near.pair];
    near.changed = near.changed || pair.answered;
    pair.answered = false;
    findings.find(near.fast, near, pair);
}

bool seeks_parts(const NearPair& near) { return near.on_surface && !near.reused && !near.filtered && !near.crowded; }
bool lost_points(const Pairs& pairs, const NearPair& near) {
    return near.pair != kNone && pairs.list[near.pair].manifold.count == 0;
}

// Looks at all pairs, and picks those whose records come or go.
void look_at_all(Team& team, const Detection& of, Arrivals& arrivals) {
    Pairs& pairs = of.pairs;
    std::atomic<bool> any_fast = false;
    const auto count = static_cast<uint32_t>(pairs.near.size());
    team.for_runs(count, Homes::kRun, kTogether, pairs.homes, [&](const Team::Runs& runs) {
        Findings findings(of);
        runs.for_each([&](uint32_t begin, uint32_t end) {
            for (uint32_t next = begin; next < end; next += Asked::kTogether) {
                const Asked asked(pairs, next, std::min(next + Asked::kTogether, end));
                for (uint32_t k = 0; k < asked.count(); ++k) {
                    NearPair& near = asked.take(k);
                    look_at(of, arrivals, findings, near);
                    near.changes = near.arrives || seeks_parts(near) || lost_points(pairs, near);
                    if (near.fast) any_fast.store(true, std::memory_order_relaxed);
                }
            }
        });
        findings.take_over();
    });
    pairs.any_fast = any_fast.load(std::memory_order_relaxed);
    gather(
        team, count, pairs.picked, [&](uint32_t i) { return pairs.near[i].changes; }, pairs.homes);
}

// Room for about so many arrivals, if they are not few.
void prepare_arrivals(uint32_t number, Array<Arrival>& arriving) {
    const uint32_t wanted = std::min(number, kMostArriving);
    if (4 * wanted < arriving.size()) {
        arriving.clear();
        Array<Arrival>(arriving.get_allocator()).swap(arriving);
    } else if (wanted > arriving.size() && wanted >= kFewArriving) {
        arriving.clear();
        arriving.resize(std::min(wanted + wanted / 4, kMostArriving));
    }
}

// Records of pairs that got their first points: given in the order of keys, filled side by side.
void admit_arriving(Team& team, const Detection& of, Arrivals& arrivals) {
    Pairs& pairs = of.pairs;
    const uint32_t number = arrivals.number();
    if (number == 0) return;
    reserve_slots(pairs, number);
    const std::span<const Arrival> found = arrivals.sort();
    auto next = found.begin();
    for (const uint32_t i : pairs.picked) {
        NearPair& near = pairs.near[i];
        if (!near.arrives) continue;
        near.pair = take_slot(pairs, near.ends(of.colliders));
        if (next == found.end() || next->key != near.key) continue;
        Pair& pair = pairs.list[near.pair];
        pair.manifold = next->manifold;
        pair.cache = next->cache;
        pair.then = next->then;
        ++next;
    }
    team.for_ranges(static_cast<uint32_t>(pairs.picked.size()), kArrivalGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t k = begin; k < end; ++k) {
            NearPair& near = pairs.near[pairs.picked[k]];
            if (near.arrives) admit(of, near, pairs.list[near.pair]);
        }
    });
}

// Pairs with a surface, and those that lost their points.
void settle_changing(const Detection& of) {
    for (const uint32_t i : of.pairs.picked) {
        NearPair& near = of.pairs.near[i];
        if (seeks_parts(near)) find_parts(of, near);
        if (lost_points(of.pairs, near)) lose_points(of, near);
    }
}

// The records of all near pairs as they are now.
void list_active(Team& team, Pairs& pairs) {
    const auto count_of = [&](uint32_t index) {
        const NearPair& near = pairs.near[index];
        if (!near.on_surface) return near.pair != kNone ? 1u : 0u;  // without a look at the record
        uint32_t count = 0;
        for_parts(pairs, near, [&](const Pair&) { ++count; });
        return count;
    };
    const auto write = [&](uint32_t index, ActivePair* to) {
        NearPair& near = pairs.near[index];
        for (uint32_t p = near.pair; p != kNone; p = pairs.list[p].next) {
            const Pair& pair = pairs.list[p];
            near.asks = pair.asks;
            const auto points = static_cast<uint8_t>(pair.manifold.count);
            const float borne = push_of(pair.manifold, pair.force);
            *to++ = {pair.a, pair.b, p, points, pair.asks, pair.loaded, pair.in_block, pair.a2, pair.b2, borne, index};
        }
    };
    write_list(team, static_cast<uint32_t>(pairs.near.size()), pairs.active, count_of, write, pairs.homes);
}

// Bodies that lost a push have lost what held it too: see note_lost().
void forget_unheld(Pairs& pairs) {
    if (!pairs.any_unheld) return;
    for (const ActivePair& active : pairs.active) {
        Pair& pair = pairs.list[active.pair];
        if ((pairs.unheld[active.a] || pairs.unheld[active.b]) && !pair.in_block) forget_forces(pair);
    }
}

// All pairs, resting ones too, take over what the host changed of colliders since they were asked last.
void note_changes(const Colliders& colliders, Pairs& pairs) {
    if (pairs.colliders_version == colliders.version) return;
    pairs.colliders_version = colliders.version;
    for_near(pairs, [](NearPair& near) { near.changed = true; });
}

}  // namespace

void find_contacts_again(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         std::span<const uint32_t> active_pairs, double elapsed, double substep) {
    const Detection of{nodes, colliders, shapes, pairs, substep, 0};
    uint64_t found = 0;  // the pair whose parts are found; its records follow one another
    for (uint32_t p : active_pairs) {
        ActivePair& active = pairs.active[p];
        Pair& pair = pairs.list[active.pair];
        NearPair& near = pairs.near[active.near];
        if (elapsed == 0 && (pair.patch == 0 || near.kept || near.fast)) continue;
        for (uint32_t c : {pair.collider_a(), pair.collider_b()})
            place_collider(nodes, shapes, colliders.record[c], elapsed, pairs, c);
        const bool fast = is_fast(nodes, pairs, pair, substep);
        if (pair.part == 0) {
            if (fast || !near.kept || !reuse(of, near, pair)) find_points(of, fast, near, pair);
        } else {
            const Shaped shaped(of, pair, fast);
            const bool is_first = pair.key != found;
            if (is_first) shaped.find_parts(pairs.parts);
            found = pair.key;
            near.kept = refresh_part(shaped, of, pair) && (is_first || near.kept);
        }
        active.points = static_cast<uint8_t>(pair.manifold.count);
    }
    open_internal_faces_again(of, active_pairs);
}

void find_contacts(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                   double time_step, double lead) {
    const Detection of{nodes, colliders, shapes, pairs, time_step, lead};
    note_changes(colliders, pairs);
    pairs.unheld.assign(nodes.motion.size(), 0);  // what substeps noted is over
    pairs.any_unheld = 0;
    const bool is_first = pairs.list.size() == 0;
    if (is_first) prepare_arrivals(static_cast<uint32_t>(pairs.near.size()), pairs.arriving);
    Arrivals arrivals(pairs.arriving);
    pairs.homes.settle(team.size(), static_cast<uint32_t>(pairs.near.size()));
    look_at_all(team, of, arrivals);
    admit_arriving(team, of, arrivals);
    prepare_arrivals(is_first ? 0 : arrivals.number(), pairs.arriving);
    settle_changing(of);
    order_slots(pairs);
    list_active(team, pairs);
    forget_unheld(pairs);
    hold_carried(nodes, pairs, time_step);
}

}  // namespace taut
