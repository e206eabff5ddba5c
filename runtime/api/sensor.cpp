#include <taut/sensor.h>

#include <algorithm>

#include "api/access.h"
#include "sleep/wake.h"

using namespace taut;

taut_result taut_collider_set_sensor(taut_collider handle, uint32_t sensor) {
    TAUT_RECORD(taut_collider_set_sensor, handle, sensor);
    Check check(__func__);
    if (!check.boolean("sensor", sensor)) return check.result();
    return with(check.call(), handle, Use::write, [&](World& world, uint32_t index) {
        Collider& collider = world.colliders.record[index];
        check.require(!world.nodes.info[collider.node].is_part(), "the body is part of a cable, cloth or solid",
                      TAUT_IN_USE);
        if (!check || collider.sensor == (sensor != 0)) return check.result();
        world.colliders.reserve_sensor();  // what may fail comes first
        wake_about(world, collider.node);
        forget_pairs(world.pairs, world.nodes, world.colliders, ends_on_collider(index));  // asked anew by the step
        collider.sensor = sensor != 0;
        if (world.nodes.enabled(collider.node)) world.colliders.list_sensor(index, collider.sensor);
        return TAUT_OK;
    });
}

taut_result taut_collider_get_overlaps(taut_collider handle, taut_collider* colliders, uint32_t capacity,
                                       uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Array<taut_sensor_event>& inside = world.sensors.inside;
        const auto first =
            std::lower_bound(inside.begin(), inside.end(), handle.bits,
                             [](const taut_sensor_event& visit, uint64_t bits) { return visit.sensor.bits < bits; });
        const auto for_visitors = [&](auto&& act) {
            for (auto visit = first; visit != inside.end() && visit->sensor.bits == handle.bits; ++visit) {
                HandleBits bits;
                const bool lives = unpack_handle(visit->visitor.bits, bits) && names(world, visit->visitor, bits);
                if (lives && world.colliders.record[index].sensor) act(visit->visitor);
            }
        };
        uint32_t needed = 0;
        for_visitors([&](taut_collider) { ++needed; });
        *count = needed;
        if (needed > capacity)
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        if (needed > 0 && !check.pointer("colliders", colliders)) return check.result();
        for_visitors([&](taut_collider visitor) { *colliders++ = visitor; });
        return TAUT_OK;
    });
}
