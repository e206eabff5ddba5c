// What overlaps the sensors: the visits, each known by its two handles, so that a removed collider leaves by itself.
#pragma once

#include <taut/event.h>

#include "base/describe.h"
#include "base/memory.h"

namespace taut {

struct Sensors {
    explicit Sensors(Memory& memory)
        : inside(memory), before(memory), enter(memory), leave(memory), candidates(memory), meets(memory) {}

    Array<taut_sensor_event> inside;        // after the last step; sorted by the slots of sensor and visitor
    Array<taut_sensor_event> before;        // the same of the step before
    Array<taut_sensor_event> enter, leave;  // since the host read them; in each step sorted likewise
    Array<uint64_t> candidates;             // scratch: sensor << 32 | visitor whose boxes meet
    Array<uint8_t> meets;                   // scratch: whether their shapes do
};
template <class Visitor, Like<taut_sensor_event> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [sensor, visitor_of, sensor_body, visitor_body, step, reserved] = of;
    TAUT_FIELDS(visitor, sensor.bits, visitor_of.bits, sensor_body.bits, visitor_body.bits, step);
}
template <class Visitor, Like<Sensors> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [inside, before, enter, leave, candidates, meets] = of;  // enter, leave: events
    TAUT_ASIDE(visitor, inside);
}

}  // namespace taut
