#include <taut/sleep.h>

#include "api/access.h"
#include "sleep/sleep.h"
#include "sleep/wake.h"

using namespace taut;

taut_result taut_body_get_awake(taut_body handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        // A disabled one is what events said of it last; they go on once it is enabled.
        const bool sleeps = world.nodes.enabled(node) ? world.nodes.sleeps(node) : world.nodes.sleep[node].told_asleep;
        *out = sleeps ? 0 : 1;
        return TAUT_OK;
    });
}

taut_result taut_body_set_awake(taut_body handle, uint32_t awake) {
    TAUT_RECORD(taut_body_set_awake, handle, awake);
    Check check(__func__);
    if (!check.boolean("awake", awake)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        check.require(moves_by_forces(world.nodes.info[node].kind), "body is static or kinematic")
            .require(world.nodes.enabled(node), "body is disabled: nothing moves it")
            .require(awake || world.def.sleeping, "awake is 0, but the world's def does not let bodies sleep");
        if (!check) return check.result();
        if (awake)
            wake(world, node);
        else if (!world.nodes.sleeps(node))
            put_to_sleep(world, node);
        return TAUT_OK;
    });
}

taut_result taut_body_get_can_sleep(taut_body handle, uint32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = world.nodes.sleep[node].can_sleep ? 1 : 0;
        return TAUT_OK;
    });
}

taut_result taut_body_set_can_sleep(taut_body handle, uint32_t can_sleep) {
    TAUT_RECORD(taut_body_set_can_sleep, handle, can_sleep);
    Check check(__func__);
    if (!check.boolean("can_sleep", can_sleep)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t node) {
        world.nodes.sleep[node].can_sleep = can_sleep != 0;
        if (!can_sleep) wake(world, node);
        return TAUT_OK;
    });
}

taut_result taut_world_wake_box(taut_world handle, taut_pos low, taut_pos high) {
    TAUT_RECORD(taut_world_wake_box, handle, low, high);
    Check check(__func__);
    check.vector("low", low, kPosition).vector("high", high, kPosition);
    check.require(low.x <= high.x && low.y <= high.y && low.z <= high.z, "low is above high");
    if (!check) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        wake_box(world, {to_vec(low).cast<float>(), to_vec(high).cast<float>()});
        return TAUT_OK;
    });
}
