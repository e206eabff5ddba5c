// Colliders of a body and events of a world, for the tests of what touches.
#pragma once

#include "physics/lab.h"

namespace lab {

// The only one, or the first.
inline taut_collider collider_of(taut_body body) {
    taut_collider out{};
    uint32_t count = 0;
    ok(taut_body_get_colliders(body, &out, 1, &count));
    return out;
}

// Of the steps since they were read last.
inline taut_events events_of(taut_world world) {
    taut_events out{};
    ok(taut_world_get_events(world, &out));
    return out;
}
inline taut_events events_of(const World& world) { return events_of(world.handle); }

}  // namespace lab
