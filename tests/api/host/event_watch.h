// Keeps the books of one world's events: what begins ends once, and the world agrees with what its events told.
#pragma once

#include <algorithm>
#include <set>
#include <span>
#include <utility>

#include "host.h"

namespace taut_test {

class EventWatch {
public:
    using Broken = std::function<void(bool condition, const char* what)>;

    // After any steps, with the bodies that are known. whole: each pair has been asked for its beginnings and ends
    // since the world was made.
    void check(const taut_events& events, const std::vector<taut_body>& bodies, const std::vector<taut_collider>& known,
               bool whole, const Broken& expect) {
        expect(events.dropped_steps == 0, "events that were not waited for");
        Lists left(events);
        for (uint32_t step = 0; step < events.steps; ++step) check_step(step, left, whole, expect);
        expect(left.none(), "events of no step");
        check_visits(known, expect);
        for (taut_body body : bodies)
            if (taut_body_is_valid(body)) expect(awake(body) != (asleep_.count(body.bits) == 1), "who sleeps untold");
    }

private:
    using Two = std::pair<uint64_t, uint64_t>;

    static Two pair(const taut_contact_event& event) {
        return std::minmax(event.collider_a.bits, event.collider_b.bits);
    }
    static bool awake(taut_body body) {
        uint32_t out = 1;
        return taut_body_get_awake(body, &out) != TAUT_OK || out == 1;
    }
    // What is left of each list to go through.
    struct Lists {
        explicit Lists(const taut_events& e)
            : end(e.end, e.end_count),
              begin(e.begin, e.begin_count),
              persist(e.persist, e.persist_count),
              leave(e.sensor_leave, e.sensor_leave_count),
              enter(e.sensor_enter, e.sensor_enter_count),
              fell_asleep(e.fell_asleep, e.fell_asleep_count),
              woke(e.woke, e.woke_count) {}
        bool none() const {
            return end.empty() && begin.empty() && persist.empty() && leave.empty() && enter.empty() &&
                   fell_asleep.empty() && woke.empty();
        }
        std::span<const taut_contact_event> end, begin, persist;
        std::span<const taut_sensor_event> leave, enter;
        std::span<const taut_sleep_event> fell_asleep, woke;
    };
    // act(event) for those of a step, which leave the list.
    template <class Event, class Act>
    static void take(uint32_t step, std::span<const Event>& list, Act&& act) {
        for (; !list.empty() && list.front().step == step; list = list.subspan(1)) act(list.front());
    }

    // Ends first: where a call changed a collider, a pair may end and begin in one step.
    void check_step(uint32_t step, Lists& left, bool whole, const Broken& expect) {
        take(step, left.end, [&](const taut_contact_event& e) {
            expect(touching_.erase(pair(e)) == 1 || !whole, "a touch that ends and never began");
        });
        take(step, left.begin, [&](const taut_contact_event& e) {
            expect(touching_.insert(pair(e)).second || !whole, "a touch that begins twice");
        });
        take(step, left.persist, [&](const taut_contact_event& e) {
            expect(touching_.count(pair(e)) == 1 || !whole, "a touch that goes on unbegun");
        });
        take(step, left.leave, [&](const taut_sensor_event& e) {
            expect(visits_.erase({e.sensor.bits, e.visitor.bits}) == 1, "who leaves and never came");
        });
        take(step, left.enter, [&](const taut_sensor_event& e) {
            expect(visits_.insert({e.sensor.bits, e.visitor.bits}).second, "who comes twice");
        });
        take(step, left.woke,
             [&](const taut_sleep_event& e) { expect(asleep_.erase(e.body.bits) == 1, "who wakes and never slept"); });
        take(step, left.fell_asleep,
             [&](const taut_sleep_event& e) { expect(asleep_.insert(e.body.bits).second, "who falls asleep twice"); });
    }
    void check_visits(const std::vector<taut_collider>& known, const Broken& expect) const {
        for (taut_collider sensor : known) {
            uint32_t count = 0;
            const taut_result result = taut_collider_get_overlaps(sensor, nullptr, 0, &count);
            if (result != TAUT_OK && result != TAUT_TOO_SMALL) continue;
            const auto first = visits_.lower_bound({sensor.bits, 0}),
                       last = visits_.upper_bound({sensor.bits, UINT64_MAX});
            expect(count == static_cast<uint32_t>(std::distance(first, last)), "overlaps that are not the visits told");
        }
    }

    std::set<Two> touching_;     // colliders, the smaller handle first
    std::set<Two> visits_;       // sensor and visitor
    std::set<uint64_t> asleep_;  // bodies
};

}  // namespace taut_test
