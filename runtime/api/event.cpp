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

namespace {

// What impulses of contacts are told over [s].
float told_substep(const World& world) { return static_cast<float>(world.last_step / world.least_substeps()); }

taut_contact public_contact(const World& world, const Pair& pair, int i) {
    const collision::ContactPoint& point = pair.manifold.points[i];
    const ContactForce& force = pair.force[i];
    const Vec3f& normal = pair.manifold.normal;
    const float substep = told_substep(world);
    return {world.body_handle(pair.a),
            world.body_handle(pair.b),
            to_pos(world.nodes.origin(pair.a) + point.position.cast<double>()),
            {normal.x(), normal.y(), normal.z()},
            point.separation,
            substep * force.normal,
            substep * std::hypot(force.tangent1, force.tangent2),
            world.collider_handle(pair.collider_a()),
            world.collider_handle(pair.collider_b())};
}

bool touching(const GrainContact& contact) { return contact.separation <= 0 || contact.pushes(); }

// Between grains, whose spheres are about their nodes.
taut_contact public_contact(const World& world, const GrainContact& contact) {
    const uint32_t a = world.nodes.info[contact.a].collider, b = world.nodes.info[contact.b].collider;
    const Vec3f& n = contact.normal;
    const double radius = collision::ball_radius(world.shapes[world.colliders.record[a].shape].shape);
    const double way = radius + 0.5 * static_cast<double>(contact.separation);
    const float push = contact.force.dot(n), substep = told_substep(world);
    return {world.body_handle(contact.a),
            world.body_handle(contact.b),
            to_pos(world.nodes.origin(contact.a) + way * n.cast<double>()),
            {n.x(), n.y(), n.z()},
            contact.separation,
            substep * push,
            substep * (contact.force - push * n).norm(),
            world.collider_handle(a),
            world.collider_handle(b)};
}

}  // namespace

taut_result taut_world_get_contacts(taut_world handle, taut_contact* contacts, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        uint32_t needed = 0;
        for_pairs(world.pairs, [&](const Pair& pair) {
            if (pair.touching) needed += static_cast<uint32_t>(pair.manifold.count);
        });
        for (const GrainContact& contact : world.pairs.grains.contact) needed += touching(contact);
        if (needed > capacity) {
            *count = needed;
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        }
        if (needed > 0 && !check.pointer("contacts", contacts)) return check.result();
        *count = needed;
        for_pairs(world.pairs, [&](const Pair& pair) {
            for (int i = 0; pair.touching && i < pair.manifold.count; ++i) *contacts++ = public_contact(world, pair, i);
        });
        for (const GrainContact& contact : world.pairs.grains.contact)
            if (touching(contact)) *contacts++ = public_contact(world, contact);
        return TAUT_OK;
    });
}
