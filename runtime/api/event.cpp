#include <taut/event.h>

#include <cmath>

#include "api/access.h"

using namespace taut;

taut_result taut_world_get_events(taut_world handle, taut_events* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        world.window.read = true;
        const auto size = [](const auto& array) { return static_cast<uint32_t>(array.size()); };
        *out = {world.contact_begin.data(),
                world.contact_end.data(),
                world.moved.data(),
                world.quarantined.data(),
                size(world.contact_begin),
                size(world.contact_end),
                size(world.moved),
                size(world.quarantined),
                world.broken.data(),
                size(world.broken),
                world.window.steps,
                world.contact_persist.data(),
                world.hits.data(),
                world.contact_points.data(),
                world.sensors.enter.data(),
                world.sensors.leave.data(),
                size(world.contact_persist),
                size(world.hits),
                size(world.contact_points),
                size(world.sensors.enter),
                size(world.sensors.leave),
                world.window.dropped_steps,
                world.fell_asleep.data(),
                world.woke.data(),
                size(world.fell_asleep),
                size(world.woke),
                world.window.dropped_contacts,
                size(world.torn),
                world.detached.data(),
                world.torn.data(),
                size(world.detached),
                size(world.yielded),
                world.yielded.data()};
        return TAUT_OK;
    });
}

taut_result taut_world_get_contacts(taut_world handle, taut_contact* contacts, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        uint32_t needed = 0;
        for_pairs(world.pairs, [&](const Pair& pair) {
            if (pair.touching) needed += static_cast<uint32_t>(pair.manifold.count);
        });
        if (needed > capacity) {
            *count = needed;
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        }
        if (needed > 0 && !check.pointer("contacts", contacts)) return check.result();
        *count = needed;
        const auto substep = static_cast<float>(world.last_step / world.least_substeps());
        for_pairs(world.pairs, [&](const Pair& pair) {
            if (!pair.touching) return;
            const taut_body a = world.body_handle(pair.a), b = world.body_handle(pair.b);
            const Vec3 origin = world.nodes.origin(pair.a);
            const Vec3f& normal = pair.manifold.normal;
            for (int i = 0; i < pair.manifold.count; ++i) {
                const collision::ContactPoint& point = pair.manifold.points[i];
                const ContactForce& force = pair.force[i];
                *contacts++ = {a,
                               b,
                               to_pos(origin + point.position.cast<double>()),
                               {normal.x(), normal.y(), normal.z()},
                               point.separation,
                               substep * force.normal,
                               substep * std::hypot(force.tangent1, force.tangent2),
                               world.collider_handle(pair.collider_a()),
                               world.collider_handle(pair.collider_b())};
            }
        });
        return TAUT_OK;
    });
}
