// Calls of sleep.h and the switch of continuous collision.
#pragma once

#include "host.h"

namespace taut_test {

class SleepCalls : protected virtual Host {
protected:
    void put_to_sleep() {
        const taut_body body = pick_body(pick_world());
        uint32_t flag = byte() & 1, read = 0;
        spoil(flag);
        run("taut_body_set_can_sleep", [&] { return taut_body_set_can_sleep(body, flag); });
        uint32_t can = 0;
        if (ask("taut_body_get_can_sleep", [&] { return taut_body_get_can_sleep(body, &can); }))
            expect(can <= 1, "a flag that is none");
        if (run("taut_body_set_awake", [&] { return taut_body_set_awake(body, flag); })) {
            expect(taut_body_get_awake(body, &read) == TAUT_OK && read == flag, "a sleeper who is awake");
        }
        const taut_pos lo = pos(5), hi = pos(5);
        const taut_world world = worlds_[pick_world()];
        run("taut_world_wake_box", [&] { return taut_world_wake_box(world, lo, hi); });
    }

    void set_continuous() {
        const taut_body body = pick_body(pick_world());
        uint32_t flag = byte() & 1, read = 0;
        spoil(flag);
        if (run("taut_body_set_continuous", [&] { return taut_body_set_continuous(body, flag); }))
            expect(taut_body_get_continuous(body, &read) == TAUT_OK && read == flag, "a switch that does not stay");
    }
};

}  // namespace taut_test
