#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "detect/detect.h"
#include "detect/impact.h"
#include "detect/mechanism.h"
#include "detect/passage.h"
#include "threads/gather.h"

namespace taut {
namespace {

constexpr double kStride = 0.25;    // of the ball inside a shape: who moved less against each other is not looked after
constexpr uint8_t kMostRounds = 6;  // where one drives another, that may have passed the next
constexpr uint32_t kColliderGrain = 64, kCastGrain = 16;  // colliders and pairs that a thread takes at a time

// Of a collider: put back by the last round, or this is the first; moved otherwise than its speed told before the step;
// is followed within the step. Of those that are not active none.
enum Mark : uint8_t { kMoved = 1, kAstray = 2, kFollowed = 4 };

// Whether a collider between two nodes was put back by either.
bool span_put_back(const Mechanisms& mechanisms, const Collider& collider, uint8_t round) {
    return collider.node_b != kNone &&
           (mechanisms.put_back[collider.node] == round || mechanisms.put_back[collider.node_b] == round);
}

bool solved(const Nodes& nodes, const Collider& collider) {
    return nodes.solved(collider.node) || (collider.node_b != kNone && nodes.solved(collider.node_b));
}

// Whether the host's function or a one-way direction may ignore a contact: what goes through on purpose is not held
// back.
bool ignorable(const Colliders& colliders, uint32_t a, uint32_t b) {
    return ((colliders.record[a].asks | colliders.record[b].asks) & (kAsksOneWay | kAsksPreSolve)) != 0;
}

// Whether a collider's middle went elsewhere than its speed told before the step, further from there than a part of its
// thickness; one that spans two nodes, which is thin, than what stays within the contact margin.
bool went_astray(const Collider& collider, const Vec3& along, const Vec3f& ahead, double thickness) {
    double stride = kStride * thickness;
    if (collider.node_b != kNone) stride = std::max(stride, 0.4 * static_cast<double>(kContactMargin));
    return (along - ahead.cast<double>()).squaredNorm() > stride * stride;
}

struct Astray {
    bool any = false, newly = false;  // newly: some that did not before the last round
};

const Course& find_course(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t c,
                          Pairs& pairs) {
    return pairs.courses[c] = course_of(nodes, colliders.record[c], shapes, pairs.pace[c]);
}

// Of active colliders, after the first round of what the last one put back; with their courses, if these are asked for.
// Whether any went astray.
Astray find_marks(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                  std::span<const uint8_t> followed, uint8_t round, bool with_courses, Pairs& pairs) {
    const auto is_followed = [&](const Collider& collider) { return !followed.empty() && followed[collider.node]; };
    std::atomic<bool> any = false, newly = false;
    pairs.marks.resize(colliders.record.size());
    if (with_courses) pairs.courses.resize(colliders.record.size());
    const std::span<const uint32_t> active = colliders.active;
    team.for_ranges(static_cast<uint32_t>(active.size()), kColliderGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t c : active.subspan(begin, end - begin)) {
            const Collider& collider = colliders.record[c];
            uint8_t& mark = pairs.marks[c];
            if (round == 1) mark = kMoved;
            if (round > 1 && span_put_back(pairs.mechanisms, collider, round - 1)) mark |= kMoved;
            if (!(mark & kMoved)) continue;
            const bool was_astray = mark & kAstray;
            mark = is_followed(collider) ? kMoved | kFollowed : kMoved;
            const Course* const course = with_courses ? &find_course(nodes, colliders, shapes, c, pairs) : nullptr;
            if (!solved(nodes, collider)) continue;
            const Vec3 along = course ? course->along : way_along(nodes, collider, shapes);
            if (!went_astray(collider, along, pairs.reach[c].ahead, pairs.pace[c].thickness)) continue;
            mark |= kAstray;
            any.store(true, std::memory_order_relaxed);
            if (!was_astray) newly.store(true, std::memory_order_relaxed);
        }
    });
    return {any.load(std::memory_order_relaxed), newly.load(std::memory_order_relaxed)};
}

void find_courses(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    pairs.courses.resize(colliders.record.size());
    const std::span<const uint32_t> active = colliders.active;
    team.for_ranges(static_cast<uint32_t>(active.size()), kColliderGrain, [&](uint32_t begin, uint32_t end) {
        for (const uint32_t c : active.subspan(begin, end - begin))
            if (pairs.marks[c] & kMoved) find_course(nodes, colliders, shapes, c, pairs);
    });
}

bool any_astray(const Pairs& pairs, uint32_t a, uint32_t b) {
    return ((pairs.marks[a] | pairs.marks[b]) & kAstray) != 0;
}

// Whether a pair is looked after: two that were fast, or of which one went astray.
bool is_asked(const Colliders& colliders, const Pairs& pairs, const NearPair& near) {
    const uint32_t a = near.collider_a(), b = near.collider_b();
    return (near.fast | any_astray(pairs, a, b)) && !near.filtered && !near.crowded && !ignorable(colliders, a, b);
}

// Whether it moved further against each other than a part of its thickness.
bool strides(const Pairs& pairs, const AskedPair& pair) {
    if (!pair.fast && !any_astray(pairs, pair.a, pair.b)) return false;
    const Course &one = pairs.courses[pair.a], &other = pairs.courses[pair.b];
    const float thin = std::min(one.thickness, other.thickness), thick = std::max(one.thickness, other.thickness);
    if (thick == std::numeric_limits<float>::infinity()) return false;
    const double stride = kStride * static_cast<double>(thin > 0 ? thin : thick);
    return (one.along - other.along).squaredNorm() > stride * stride;
}

bool moved(const Pairs& pairs, const AskedPair& pair) { return (pairs.marks[pair.a] | pairs.marks[pair.b]) & kMoved; }

bool may_pass(const Pairs& pairs, const AskedPair& pair) {
    return may_pass(pairs.courses[pair.a], pairs.courses[pair.b]);
}

// What stands has one only where it is asked for.
const Course& course_at(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t c,
                        Pairs& pairs) {
    const bool stands = nodes.rest[colliders.record[c].node] == Rest::asleep;
    return stands ? find_course(nodes, colliders, shapes, c, pairs) : pairs.courses[c];
}

// Adds a collider's pairs with what its box meets and it may have passed, but for those that are near.
void add_late(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
              const collision::Broadphase& broadphase, uint32_t c, Pairs& pairs) {
    struct Found final : collision::Visitor {
        Found(const Nodes& n, const Colliders& all, const Shapes& its, uint32_t one, Pairs& to)
            : nodes(n), colliders(all), shapes(its), c(one), pairs(to) {}
        void visit(uint32_t other, collision::Probe&) override {
            if (other == c || !may_pass(pairs.courses[c], course_at(nodes, colliders, shapes, other, pairs))) return;
            const uint64_t key = pair_key(c, other);
            if (find_pair(pairs.near, key) || find_pair(pairs.late, key)) return;
            reserve_more(pairs.late, 1);
            const NearPair pair = new_pair(nodes, colliders, pairs, key);
            pairs.late.insert(std::ranges::upper_bound(pairs.late, key, {}, &NearPair::key), pair);
        }
        const Nodes& nodes;
        const Colliders& colliders;
        const Shapes& shapes;
        uint32_t c;
        Pairs& pairs;
    };
    const collision::Box& box = pairs.reach[c].box;
    const Vec3 middle = 0.5 * (box.lo + box.hi).cast<double>();
    Found found(nodes, colliders, shapes, c, pairs);
    broadphase.visit({middle, Vec3::Zero(), box.lo.cast<double>() - middle, box.hi.cast<double>() - middle}, found);
}

// What left the box by which the broadphase foresaw it, as when a joint whips it, gets one about the way that it took,
// and its pairs with what is there go into Pairs::late.
void find_late(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
               collision::Broadphase& broadphase) {
    gather(team, std::span<const uint32_t>(colliders.active), pairs.picked, [&](uint32_t c) {
        const Collider& collider = colliders.record[c];
        return (pairs.marks[c] & kMoved) && (pairs.marks[c] & kAstray) &&
               !broadphase.holds(c, bounds_of(nodes, collider, shapes));
    });
    // All boxes before any looks about itself: two of them may have met.
    for (const uint32_t c : pairs.picked) {
        Reach& reach = pairs.reach[c];
        reach.box = box_along(nodes, colliders.record[c], shapes);
        reach.made = std::numeric_limits<double>::infinity();
        broadphase.update(c, reach.box, Vec3f::Zero());
    }
    for (const uint32_t c : pairs.picked) add_late(nodes, colliders, shapes, broadphase, c, pairs);
}

// All pairs that are looked after, in the order of their keys.
void ask_pairs(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    gather(team, static_cast<uint32_t>(pairs.near.size()), pairs.picked,
           [&](uint32_t i) { return is_asked(colliders, pairs, pairs.near[i]); });
    pairs.asked.clear();
    reserve_more(pairs.asked, pairs.picked.size() + pairs.late.size());
    auto late = pairs.late.begin();
    const auto add_late_before = [&](uint64_t key) {
        for (; late != pairs.late.end() && late->key < key; ++late)
            if (is_asked(colliders, pairs, *late)) pairs.asked.emplace_back(*late);
    };
    for (const uint32_t i : pairs.picked) {
        add_late_before(pairs.near[i].key);
        pairs.asked.emplace_back(pairs.near[i]);
    }
    add_late_before(std::numeric_limits<uint64_t>::max());
    for (const AskedPair& pair : pairs.asked)
        for (const uint32_t c : {pair.a, pair.b}) course_at(nodes, colliders, shapes, c, pairs);
}

// Those of them that stride into picked.
void pick_striding(Team& team, Pairs& pairs) {
    gather(team, static_cast<uint32_t>(pairs.asked.size()), pairs.picked,
           [&](uint32_t i) { return strides(pairs, pairs.asked[i]); });
}

// Whether one of two that passed each other was followed along its way, and is clear of the other: it went round.
bool went_round(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Pairs& pairs,
                const AskedPair& pair) {
    if (!((pairs.marks[pair.a] | pairs.marks[pair.b]) & kFollowed)) return false;
    const Collider &a = colliders.record[pair.a], &b = colliders.record[pair.b];
    const collision::Shape &one = shapes[a.shape].shape, &other = shapes[b.shape].shape;
    if (collision::has_parts(one) || collision::has_parts(other)) return false;
    collision::PairCache cache;
    collision::Manifold manifold;
    collision::collide(one, placement_of(nodes, a), other, placement_of(nodes, b), 0, cache, manifold);
    return std::none_of(manifold.points, manifold.points + manifold.count,
                        [](const collision::ContactPoint& point) { return point.separation < 0; });
}

// Each goes back along its way; in the last round it stays where it was, unless it is driven. Whether it may.
bool go_back(const Couple& pair, const Excess& excess, uint8_t round, Mechanism& of_a, Mechanism& of_b) {
    if (round < kRounds || of_a.is_driven() || of_b.is_driven()) {
        of_a.go_back(excess.share, pair.a.course.along, excess.normal, round);
        of_b.go_back(excess.share, excess.way, excess.normal, round);
        return true;
    }
    if (round > kRounds) return false;
    const bool a_may = of_a.may_stay(), b_may = of_b.may_stay();
    if (!a_may || !b_may) return false;
    of_a.stay(round);
    of_b.stay(round);
    return true;
}

// Parts a pair that had passed; what stands has the last word. Whether it did.
bool part(const Couple& pair, const Excess& excess, const Colliders& colliders, const Shapes& shapes,
          const Joints& joints, const Elements& elements, uint8_t round, Pairs& pairs, Nodes& nodes) {
    if (!(excess.share > 0)) return false;
    Mechanisms& mechanisms = pairs.mechanisms;
    if (!mechanisms.found) find_mechanisms(nodes, joints, elements, mechanisms);
    const uint32_t a = pair.a.collider.node, b = pair.b.collider.node;
    Mechanism of_a(nodes, joints, elements, mechanisms, a), of_b(nodes, joints, elements, mechanisms, b);
    if (of_a.has(b)) return false;
    const bool may_drive = round < kMostRounds;
    if (may_drive && of_b.goes_along_with(of_a))
        of_b.go_along_with(of_a, -excess.share * excess.seen, excess.normal, round);
    else if (may_drive && of_a.goes_along_with(of_b))
        of_a.go_along_with(of_b, excess.share * excess.seen, excess.normal, round);
    else if ((of_a.is_driven() && of_b.is_driven()) || !go_back(pair, excess, round, of_a, of_b))
        return false;
    for (const Mechanism* of : {&of_a, &of_b})
        of->for_nodes([&](uint32_t node) {
            for_colliders(nodes, colliders, node, [&](uint32_t c) {
                pairs.marks[c] |= kMoved;
                find_course(nodes, colliders, shapes, c, pairs);
            });
        });
    return true;
}

// Whether a collider was put back in this round; its course follows.
bool anew(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, uint32_t c, uint8_t round,
          Pairs& pairs) {
    if (colliders.record[c].node_b == kNone) return pairs.marks[c] & kMoved;
    if (!span_put_back(pairs.mechanisms, colliders.record[c], round)) return false;
    find_course(nodes, colliders, shapes, c, pairs);
    return true;
}

// Puts back what passed, one after the other; what was put back already is asked again. Whether anything was.
bool part_passed(const Colliders& colliders, const Shapes& shapes, const Joints& joints, const Elements& elements,
                 uint8_t round, Pairs& pairs, Nodes& nodes) {
    for (const uint32_t c : colliders.active) pairs.marks[c] &= static_cast<uint8_t>(~kMoved);
    bool any = false;
    for (const uint32_t i : pairs.picked) {
        const AskedPair& asked = pairs.asked[i];
        bool ask = asked.passed;
        if (any) {
            const bool a_anew = anew(nodes, colliders, shapes, asked.a, round, pairs),
                       b_anew = anew(nodes, colliders, shapes, asked.b, round, pairs);
            ask = ask || ((a_anew || b_anew) && may_pass(pairs, asked));
        }
        if (!ask || went_round(nodes, colliders, shapes, pairs, asked)) continue;
        const Couple pair(colliders, shapes, pairs.courses, asked);
        any = part(pair, excess_of(nodes, pair), colliders, shapes, joints, elements, round, pairs, nodes) || any;
    }
    return any;
}

// Of the pairs that stride, those that passed and of which a side moved.
void find_passed(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs) {
    team.for_ranges(static_cast<uint32_t>(pairs.picked.size()), kCastGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            AskedPair& pair = pairs.asked[pairs.picked[i]];
            pair.passed = moved(pairs, pair) && may_pass(pairs, pair) &&
                          excess_of(nodes, Couple(colliders, shapes, pairs.courses, pair)).share > 0 &&
                          !went_round(nodes, colliders, shapes, pairs, pair);
        }
    });
}

}  // namespace

// Who passed is found for all pairs at once, after the first round for those alone of which a side was put back in the
// last. They are put back one after the other, where those of which a side was put back already are asked again.
void hold_back(Team& team, const Colliders& colliders, const Shapes& shapes, const Joints& joints,
               const Elements& elements, std::span<const uint8_t> followed, Pairs& pairs,
               collision::Broadphase& broadphase, Nodes& nodes) {
    Mechanisms& mechanisms = pairs.mechanisms;
    mechanisms.any_drives = false;
    bool again = true;
    for (uint8_t round = 1; again && round <= (mechanisms.any_drives ? kMostRounds : kRounds); ++round) {
        const bool asks_some = round > 1 || pairs.any_fast;
        const Astray astray = find_marks(team, nodes, colliders, shapes, followed, round, asks_some, pairs);
        if (!asks_some && !astray.any) {
            let_go(pairs.courses);
            let_go(pairs.asked);
            break;
        }
        if (!asks_some) find_courses(team, nodes, colliders, shapes, pairs);
        const size_t late = pairs.late.size();
        if (astray.any) find_late(team, nodes, colliders, shapes, pairs, broadphase);
        if (round == 1 || astray.newly || pairs.late.size() > late) ask_pairs(team, nodes, colliders, shapes, pairs);
        pick_striding(team, pairs);
        find_passed(team, nodes, colliders, shapes, pairs);
        again = part_passed(colliders, shapes, joints, elements, round, pairs, nodes);
    }
    for (const uint32_t c : colliders.active) pairs.marks[c] = 0;
    let_go(pairs.late);
    end_mechanisms(nodes, mechanisms);
}

}  // namespace taut
