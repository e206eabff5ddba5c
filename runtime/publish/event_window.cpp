#include <algorithm>

#include "publish/publish.h"

namespace taut {
namespace {

// Lists whose events say of which step they are.
template <class Act>
void for_event_lists(World& w, Act&& act) {
    act(w.contact_begin), act(w.contact_persist), act(w.contact_end);
    act(w.hits);
    act(w.sensors.enter), act(w.sensors.leave);
    act(w.quarantined);
    act(w.broken);
    act(w.detached);
    act(w.torn);
    act(w.yielded);
    act(w.fell_asleep), act(w.woke);
}

// The first point of the first event that is left of a list, or `none`.
uint32_t first_point(const Array<taut_contact_event>& events, size_t none) {
    return events.empty() ? static_cast<uint32_t>(none) : events.front().first_point;
}

// Those of the oldest steps.
void drop_events(World& w, uint32_t steps) {
    for_event_lists(w, [&](auto& list) {
        list.erase(list.begin(),
                   std::partition_point(list.begin(), list.end(), [&](const auto& e) { return e.step < steps; }));
        for (auto& event : list) event.step -= steps;
    });
    const size_t points = w.contact_points.size();
    const uint32_t gone = std::min(first_point(w.contact_begin, points), first_point(w.contact_persist, points));
    w.contact_points.erase(w.contact_points.begin(), w.contact_points.begin() + gone);
    for (auto* list : {&w.contact_begin, &w.contact_persist})
        for (taut_contact_event& event : *list) event.first_point -= gone;
    w.window.steps -= steps;
    w.window.dropped_steps += steps;
}

}  // namespace

void forget_events(World& world) {
    for_event_lists(world, [](auto& list) { list.clear(); });
    world.contact_points.clear();
    world.moved.clear();
    world.window.steps = world.window.dropped_steps = world.window.dropped_contacts = 0;
    world.window.read = false;
}

void begin_call(World& world) {
    if (world.window.read) forget_events(world);
}

void begin_events(World& world) {
    begin_call(world);
    const uint32_t least = std::max<uint32_t>(TAUT_EVENT_STEPS, world.def.max_catch_up);
    if (world.window.steps >= 2 * least) drop_events(world, least);
}

void end_events(World& world) {
    ++world.window.steps;
    world.window.dropped_contacts += world.profile.dropped_contacts;
}

}  // namespace taut
