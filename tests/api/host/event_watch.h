// Keeps the books of one world's events: what begins ends once, and the world agrees with what its events told.
#pragma once

#include <algorithm>
#include <set>
#include <utility>

#include "host.h"

namespace taut_test {

class EventWatch {
public:
    using Broken = std::function<void(bool condition, const char* what)>;

    // After one step, with the bodies that are known. whole: each pair has been asked for its beginnings and ends since
    // the world was made.
    void check(const taut_events& events, const std::vector<taut_body>& bodies, const std::vector<taut_collider>& known,
               bool whole, const Broken& expect) {
        // Ends first: where a call changed a collider, a pair may end and begin in one step.
        for (uint32_t i = 0; i < events.end_count; ++i)
            expect(touching_.erase(pair(events.end[i])) == 1 || !whole || missed_, "a touch that ends and never began");
        for (uint32_t i = 0; i < events.begin_count; ++i)
            expect(touching_.insert(pair(events.begin[i])).second || !whole, "a touch that begins twice");
        for (uint32_t i = 0; i < events.persist_count; ++i)
            expect(touching_.count(pair(events.persist[i])) == 1 || !whole || missed_, "a touch that goes on unbegun");
        check_visits(events, known, expect);
        check_sleep(events, bodies, expect);
    }
    // Several steps at once: of all but the last the events are gone.
    void miss(const std::vector<taut_body>& bodies) {
        missed_ = true;
        touching_.clear();
        visits_.clear();
        asleep_.clear();
        for (taut_body body : bodies)
            if (!awake(body)) asleep_.insert(body.bits);
    }

private:
    using Two = std::pair<uint64_t, uint64_t>;

    static Two pair(const taut_contact_event& event) {
        return std::minmax(event.collider_a.bits, event.collider_b.bits);
    }
    static bool awake(taut_body body) {
        uint32_t out = 1;
        return taut_body_is_awake(body, &out) != TAUT_OK || out == 1;
    }
    void check_visits(const taut_events& events, const std::vector<taut_collider>& known, const Broken& expect) {
        for (uint32_t i = 0; i < events.sensor_leave_count; ++i) {
            const taut_sensor_event& event = events.sensor_leave[i];
            expect(visits_.erase({event.sensor.bits, event.visitor.bits}) == 1 || missed_, "who leaves and never came");
        }
        for (uint32_t i = 0; i < events.sensor_enter_count; ++i) {
            const taut_sensor_event& event = events.sensor_enter[i];
            expect(visits_.insert({event.sensor.bits, event.visitor.bits}).second || missed_, "who comes twice");
        }
        if (missed_) return;
        for (taut_collider sensor : known) {
            uint32_t count = 0;
            const taut_result result = taut_collider_get_overlaps(sensor, nullptr, 0, &count);
            if (result != TAUT_OK && result != TAUT_TOO_SMALL) continue;
            const auto first = visits_.lower_bound({sensor.bits, 0}),
                       last = visits_.upper_bound({sensor.bits, UINT64_MAX});
            expect(count == static_cast<uint32_t>(std::distance(first, last)), "overlaps that are not the visits told");
        }
    }
    void check_sleep(const taut_events& events, const std::vector<taut_body>& bodies, const Broken& expect) {
        for (uint32_t i = 0; i < events.fell_asleep_count; ++i)
            expect(asleep_.insert(events.fell_asleep[i].body.bits).second, "who falls asleep twice");
        for (uint32_t i = 0; i < events.woke_count; ++i)
            expect(asleep_.erase(events.woke[i].body.bits) == 1 || missed_, "who wakes and never slept");
        for (taut_body body : bodies)
            if (taut_body_is_valid(body)) expect(awake(body) != (asleep_.count(body.bits) == 1), "who sleeps untold");
    }

    std::set<Two> touching_;     // colliders, the smaller handle first
    std::set<Two> visits_;       // sensor and visitor
    std::set<uint64_t> asleep_;  // bodies
    bool missed_ = false;
};

}  // namespace taut_test
