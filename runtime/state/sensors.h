// What overlaps the sensors: the visits, each known by its two handles, so that a removed collider leaves by itself.
#pragma once

#include <taut/event.h>

#include "base/describe.h"
#include "base/math.h"
#include "base/memory.h"
#include "state/nodes.h"

namespace taut {

// Of a soft body after a step, about all of it [m].
struct SoftBounds {
    uint32_t collider = kNone;  // by which it goes: of its first vertex with one; kNone: it touches nothing
    double radius = 0;          // half of its thickness [m]
    Vec3 lo = Vec3::Constant(1e300), hi = Vec3::Constant(-1e300);
};

struct Sensors {
    explicit Sensors(Memory& memory)
        : inside(memory),
          before(memory),
          enter(memory),
          leave(memory),
          candidates(memory),
          meets(memory),
          soft(memory) {}

    Array<taut_sensor_event> inside;        // after the last step; sorted by the slots of sensor and visitor
    Array<taut_sensor_event> before;        // the same of the step before
    Array<taut_sensor_event> enter, leave;  // since the host read them; in each step sorted likewise
    Array<uint64_t> candidates;             // scratch: sensor << 32 | visitor whose boxes meet
    Array<uint8_t> meets;                   // scratch: whether their shapes do
    Array<SoftBounds> soft;                 // scratch: by slot
};
template <class Visitor, Like<taut_sensor_event> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [sensor, visitor_of, sensor_body, visitor_body, step, reserved] = of;
    TAUT_FIELDS(visitor, sensor.bits, visitor_of.bits, sensor_body.bits, visitor_body.bits, step);
}
template <class Visitor, Like<Sensors> Of>
void describe(Visitor& visitor, Of& of) {
    auto& [inside, before, enter, leave, candidates, meets, soft] = of;  // enter, leave: events
    TAUT_ASIDE(visitor, inside);
}

}  // namespace taut
