// Begin, persist, end and hit: pair by pair in the order of the list, which is that of the keys; between them soft
// bodies, each as one whatever parts of it touch.
#include <algorithm>

#include "base/prefetch.h"
#include "detect/surface_point.h"
#include "publish/publish.h"
#include "publish/soft_touches.h"
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

    void tell(const Touch& touch) {
        NearPair& pair = touch.pair;
        const uint32_t asks = world_.pairs.active[touch.begin].asks;
        taut_contact_event event = event_of(world_, pair.collider_a(), pair.collider_b());
        event.step = world_.window.steps;
        pair.hit = tell(event, asks, pair.touched, pair.touching, pair.hit,
                        [&](auto&& act) { for_points(touch, false, act); });
    }

    // All parts of one; before: null where it did not touch in the last step.
    SoftTouch tell(std::span<const TouchPart> parts, const SoftTouch* before) {
        SoftTouch touch = begin_touch(world_, parts);
        taut_contact_event event = touch.event;
        event.step = world_.window.steps;
        touch.hit = tell(event, touch.asks, before != nullptr, true, before && before->hit, [&](auto&& act) {
            for (const TouchPart& part : parts) for_points(part, act);
        });
        return touch;
    }

private:
    // Sums of a body in quarantine may be no numbers.
    static float finite(float x) { return std::isfinite(x) ? x : 0.0f; }

    // for_all(act(taut_contact_point)): its points. Whether it hit.
    template <class ForAll>
    bool tell(taut_contact_event& event, uint32_t asks, bool before, bool now, bool hit_before, ForAll&& for_all) {
        Array<taut_contact_event>* list = nullptr;
        if (now != before && (asks & TAUT_CONTACT_EVENTS_BEGIN_END))
            list = now ? &world_.contact_begin : &world_.contact_end;
        else if (now && before && (asks & TAUT_CONTACT_EVENTS_PERSIST))
            list = &world_.contact_persist;
        Array<taut_contact_point>& points = world_.contact_points;
        event.first_point = static_cast<uint32_t>(points.size());
        if (list) {
            if (now && (asks & TAUT_CONTACT_EVENTS_POINTS))
                for_all([&](const taut_contact_point& point) { points.push_back(point); });
            event.point_count = static_cast<uint32_t>(points.size()) - event.first_point;
            list->push_back(event);
        }
        return now && !hit_before && (asks & TAUT_CONTACT_EVENTS_HIT) && tell_hit(event, for_all);
    }

    template <class ForAll>
    bool tell_hit(const taut_contact_event& event, ForAll&& for_all) {
        taut_hit_event hit{event.body_a, event.body_b, event.collider_a, event.collider_b, {}, {}, 0, 0, event.step};
        hit.approach_speed = world_.def.hit_speed;
        bool any = false;
        for_all([&](const taut_contact_point& point) {
            hit.normal_impulse += point.normal_impulse;
            if (!(point.normal_impulse > 0 && point.approach_speed > hit.approach_speed)) return;
            hit.position = point.position;
            hit.normal = point.normal;
            hit.approach_speed = point.approach_speed;
            any = true;
        });
        if (any) world_.hits.push_back(hit);
        return any;
    }

    // act(point) for those of the parts that touch. turned: the event has a and b the other way round.
    template <class Act>
    void for_points(const Touch& touch, bool turned, Act&& act) {
        for (size_t i = touch.begin; i < touch.end; ++i) {
            const uint32_t index = world_.pairs.active[i].pair;
            const Pair& part = world_.pairs.list[index];
            const WatchedPair* watched = find_watched(world_.watch, index);
            if (!part.touching || !watched) continue;
            // Those that went in the last substep too, for what they gave before.
            for (int k = 0; k < std::max(part.manifold.count, watched->count); ++k)
                act(point_of(part, *watched, k, turned));
        }
    }
    template <class Act>
    void for_points(const TouchPart& part, Act&& act) {
        if (part.surface) return act(point_of(world_.pairs.surfaces.contact[part.index], part));
        const Touch touch = Touch::from(world_.pairs, part.index);
        for_points(touch, told(world_, touch.pair.collider_a()) > told(world_, touch.pair.collider_b()), act);
    }

    static taut_vec3 way(const Vec3f& normal, bool turned) {
        const Vec3f n = turned ? Vec3f(-normal) : normal;
        return {n.x(), n.y(), n.z()};
    }

    taut_contact_point point_of(const Pair& pair, const WatchedPair& watched, int k, bool turned) const {
        const collision::ContactPoint& point = pair.manifold.points[k];
        const Vec3 at = world_.nodes.origin(pair.a) + point.position.cast<double>();
        // All that was pushed, the way in which the pushes of the substeps together went.
        const float push = k < watched.count ? watched.push[k].norm() : 0;
        const Vec3f normal = push > 0 ? Vec3f((1 / push) * watched.push[k]) : pair.manifold.normal;
        return {{at.x(), at.y(), at.z()},
                way(normal, turned),
                point.separation,
                finite(push),
                finite(k < watched.count ? watched.friction[k].norm() : 0),
                watched.before.approach(point.position, pair.manifold.normal),
                0};
    }

    taut_contact_point point_of(const SurfaceContact& contact, const TouchPart&) const {
        const auto side = [&](float sign) {
            return side_of(world_.nodes, world_.colliders, world_.shapes, contact, sign).at;
        };
        const Vec3 at = 0.5 * (side(-1) + side(1));
        // Its normal goes from the side with weights < 0, collider 1, to the other.
        const bool turned = told(world_, contact.collider[1]) > told(world_, contact.collider[0]);
        const float push = contact.push.norm();
        const Vec3f normal = push > 0 ? Vec3f((1 / push) * contact.push) : contact.normal;
        return {{at.x(), at.y(), at.z()},
                way(normal, turned),
                contact.gap,
                finite(push),
                finite(contact.rubbed.norm()),
                contact.approach,
                0};
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
    const bool softs = world.softs.ids.count() > 0 || !pairs.surfaces.touch.empty();
    const auto has_news = [&](uint32_t i) {
        constexpr uint32_t kSoon = 4;
        if (i + kSoon < pairs.active.size())
            prefetch(pairs.list[pairs.active[i + kSoon].pair], sizeof(Pair) - Pair::kSought);
        if (!Touch::begins(pairs, i)) return false;
        const Touch touch = Touch::from(pairs, i);
        const bool news = update_touching(pairs, touch);
        return softs && is_of_soft(world, touch.pair) ? touch.pair.touching : news;
    };
    gather(world.team, static_cast<uint32_t>(pairs.active.size()), pairs.picked, has_news,
           [&](uint32_t i) { return pairs.homes(pairs.active[i].near); });
    Publisher publisher(world);
    pairs.surfaces.part.clear();
    if (softs) list_soft_parts(world);
    SoftTouches touches(world);
    for (const uint32_t i : pairs.picked) {
        const Touch touch = Touch::from(pairs, i);
        touches.before(touch.pair.key, publisher);
        publisher.tell(touch);
    }
    touches.rest(publisher);
    sort_by_slots(world.contact_end, ends_before);
}

}  // namespace taut
