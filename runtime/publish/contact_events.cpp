// Begin, persist, end and hit: pair by pair in the order of the list, which is that of the keys.
#include <algorithm>

#include "base/prefetch.h"
#include "publish/publish.h"
#include "threads/gather.h"

namespace taut {
namespace {

// What hits and is off again within the step did.
bool touches(const Pair& pair) {
    for (int k = 0; k < pair.manifold.count; ++k)
        if (pair.manifold.points[k].separation <= 0) return true;
    return pair.pushed;
}

// Active pairs with one key: a pair, or the parts of one with a surface.
struct Touch {
    NearPair& pair;
    uint32_t begin, end;

    static Touch from(Pairs& pairs, uint32_t begin) {
        const Array<ActivePair>& active = pairs.active;
        uint32_t end = begin + 1;
        while (end < active.size() && active[end].near == active[begin].near) ++end;
        return {pairs.near[active[begin].near], begin, end};
    }
    static bool begins(const Pairs& pairs, uint32_t i) {
        return i == 0 || pairs.active[i - 1].near != pairs.active[i].near;
    }
};

// Notes whether a pair touches, by any of its parts. True: there is something to tell, or a hit to forget.
bool update_touching(Pairs& pairs, const Touch& touch) {
    bool now = false;
    for (uint32_t i = touch.begin; i < touch.end; ++i) {
        Pair& part = pairs.list[pairs.active[i].pair];
        const bool touching = touches(part);
        if (touching != part.touching) part.touching = touching;  // else another thread may go on reading the record
        now = now || touching;
    }
    NearPair& pair = touch.pair;
    pair.touched = pair.touching;
    pair.touching = now;
    if (!now && !pair.touched) return false;
    const uint32_t news = now != pair.touched ? TAUT_CONTACT_EVENTS_BEGIN_END : TAUT_CONTACT_EVENTS_PERSIST;
    const uint32_t asks = pairs.active[touch.begin].asks;
    return pair.hit || (asks & news) || (now && (asks & TAUT_CONTACT_EVENTS_HIT));
}

class Publisher {
public:
    explicit Publisher(World& world) : world_(world) {}

    // Sums of a body in quarantine may be no numbers.
    static float finite(float x) { return std::isfinite(x) ? x : 0.0f; }

    void tell(const Touch& touch) {
        const NearPair& pair = touch.pair;
        const bool before = pair.touched;
        const PairEnds ends = pair.ends(world_.colliders);
        const uint32_t asks = world_.pairs.active[touch.begin].asks;
        taut_contact_event event{world_.body_handle(ends.a),
                                 world_.body_handle(ends.b),
                                 world_.collider_handle(pair.collider_a()),
                                 world_.collider_handle(pair.collider_b()),
                                 static_cast<uint32_t>(world_.contact_points.size()),
                                 0,
                                 world_.window.steps,
                                 0};
        Array<taut_contact_event>* list = nullptr;
        if (pair.touching != before && (asks & TAUT_CONTACT_EVENTS_BEGIN_END))
            list = pair.touching ? &world_.contact_begin : &world_.contact_end;
        else if (pair.touching && before && (asks & TAUT_CONTACT_EVENTS_PERSIST))
            list = &world_.contact_persist;
        if (list) {
            if (pair.touching && (asks & TAUT_CONTACT_EVENTS_POINTS)) add_points(touch);
            event.point_count = static_cast<uint32_t>(world_.contact_points.size()) - event.first_point;
            list->push_back(event);
        }
        const bool hit_before = touch.pair.hit;
        touch.pair.hit = false;
        if (pair.touching && !hit_before && (asks & TAUT_CONTACT_EVENTS_HIT)) tell_hit(touch, event);
    }

private:
    // act(pair, watched, point) for the points of the parts that touch.
    template <class Act>
    void for_points(const Touch& touch, Act&& act) {
        for (size_t i = touch.begin; i < touch.end; ++i) {
            const uint32_t index = world_.pairs.active[i].pair;
            const Pair& part = world_.pairs.list[index];
            const WatchedPair* watched = find_watched(world_.watch, index);
            if (!part.touching || !watched) continue;
            for (int k = 0; k < part.manifold.count; ++k) act(part, *watched, k);
        }
    }

    taut_pos place_of(const Pair& pair, int k) const {
        const Vec3 at = world_.nodes.origin(pair.a) + pair.manifold.points[k].position.cast<double>();
        return {at.x(), at.y(), at.z()};
    }

    static float approach_of(const Pair& pair, const WatchedPair& watched, int k) {
        return watched.before.approach(pair.manifold.points[k].position, pair.manifold.normal);
    }

    void add_points(const Touch& touch) {
        for_points(touch, [&](const Pair& pair, const WatchedPair& watched, int k) {
            const Vec3f& n = pair.manifold.normal;
            world_.contact_points.push_back({place_of(pair, k),
                                             {n.x(), n.y(), n.z()},
                                             pair.manifold.points[k].separation,
                                             finite(watched.normal[k]),
                                             finite(watched.friction[k].norm()),
                                             approach_of(pair, watched, k),
                                             0});
        });
    }

    void tell_hit(const Touch& touch, const taut_contact_event& event) {
        taut_hit_event hit{event.body_a, event.body_b, event.collider_a, event.collider_b, {}, {}, 0, 0, event.step};
        hit.approach_speed = world_.def.hit_speed;
        for_points(touch, [&](const Pair& pair, const WatchedPair& watched, int k) {
            hit.normal_impulse += finite(watched.normal[k]);
            const float approach = approach_of(pair, watched, k);
            if (!(watched.normal[k] > 0 && approach > hit.approach_speed)) return;
            const Vec3f& n = pair.manifold.normal;
            hit.position = place_of(pair, k);
            hit.normal = {n.x(), n.y(), n.z()};
            hit.approach_speed = approach;
            touch.pair.hit = true;
        });
        if (touch.pair.hit) world_.hits.push_back(hit);
    }

    World& world_;
};

// Those from `first` on.
void sort_by_slots(Array<taut_contact_event>& events, size_t first) {
    const auto begin = events.begin() + static_cast<ptrdiff_t>(first);
    std::sort(begin, events.end(), [](const taut_contact_event& a, const taut_contact_event& b) {
        return a.collider_a.bits != b.collider_a.bits ? a.collider_a.bits < b.collider_a.bits
                                                      : a.collider_b.bits < b.collider_b.bits;
    });
}

// Ends of touching pairs that were forgotten since the step before. Throws std::bad_alloc with nothing changed.
void take_ended(World& world) {
    Array<taut_contact_event>& ended = world.pairs.ended;
    reserve_more(world.contact_end, ended.size());
    for (taut_contact_event& event : ended) {
        event.step = world.window.steps;
        world.contact_end.push_back(event);
    }
    ended.clear();
}

}  // namespace

void publish_contacts(World& world) {
    const size_t ends_before = world.contact_end.size();
    take_ended(world);
    Pairs& pairs = world.pairs;
    const auto has_news = [&](uint32_t i) {
        constexpr uint32_t kSoon = 4;
        if (i + kSoon < pairs.active.size())
            prefetch(pairs.list[pairs.active[i + kSoon].pair], sizeof(Pair) - Pair::kSought);
        return Touch::begins(pairs, i) && update_touching(pairs, Touch::from(pairs, i));
    };
    gather(world.team, static_cast<uint32_t>(pairs.active.size()), pairs.picked, has_news,
           [&](uint32_t i) { return pairs.homes(pairs.active[i].near); });
    Publisher publisher(world);
    for (const uint32_t i : world.pairs.picked) publisher.tell(Touch::from(pairs, i));
    sort_by_slots(world.contact_end, ends_before);
}

}  // namespace taut
