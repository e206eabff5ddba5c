// What overlaps the sensors: the visits, each known by its two handles, so that a removed collider leaves by itself.
#pragma once

#include <taut/event.h>

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

}  // namespace taut
