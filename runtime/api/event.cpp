#include <taut/event.h>

#include <cmath>

#include "api/sized.h"
#include "detect/surface_point.h"

using namespace taut;

taut_result taut_world_get_events_sized(taut_world handle, taut_events* first, uint32_t size) {
    const RecordOut<taut_events> out(first, size);
    Check check("taut_world_get_events");
    if (!check.pointer("out", out)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        world.window.read = true;
        const auto length = [](const auto& array) { return static_cast<uint32_t>(array.size()); };
        *out = {world.contact_begin.data(),
                world.contact_end.data(),
                world.moved.data(),
                world.quarantined.data(),
                length(world.contact_begin),
                length(world.contact_end),
                length(world.moved),
                length(world.quarantined),
                world.broken.data(),
                length(world.broken),
                world.window.steps,
                world.contact_persist.data(),
                world.hits.data(),
                world.contact_points.data(),
                world.sensors.enter.data(),
                world.sensors.leave.data(),
                length(world.contact_persist),
                length(world.hits),
                length(world.contact_points),
                length(world.sensors.enter),
                length(world.sensors.leave),
                world.window.dropped_steps,
                world.fell_asleep.data(),
                world.woke.data(),
                length(world.fell_asleep),
                length(world.woke),
                world.window.dropped_contacts,
                length(world.torn),
                world.detached.data(),
                world.torn.data(),
                length(world.detached),
                length(world.yielded),
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
            to_float(substep * double{force.normal}),
            to_float(substep * std::hypot(double{force.tangent1}, double{force.tangent2})),
            world.collider_handle(pair.collider_a()),
            world.collider_handle(pair.collider_b())};
}

bool is_gone(const Array<uint32_t>& gone, std::span<const uint32_t> nodes) {
    return !gone.empty() &&
           std::ranges::any_of(nodes, [&](uint32_t node) { return std::ranges::find(gone, node) != gone.end(); });
}

// Those of nodes that were removed since the step are not told.
bool touching(const Grains& grains, const GrainContact& contact) {
    const uint32_t ends[] = {contact.a, contact.b};
    return (contact.separation <= 0 || contact.pushes()) && !is_gone(grains.gone, ends);
}
bool touching(const SurfaceContacts& surfaces, const SurfaceContact& contact) {
    return contact.touches() && !is_gone(surfaces.gone, contact.node);
}

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
            to_float(substep * double{push}),
            to_float(substep * (contact.force - push * n).cast<double>().norm()),
            world.collider_handle(a),
            world.collider_handle(b)};
}

// The normal is the way in which b leaves a: that of the gap, which grows with the weights above 0.
taut_contact public_contact(const World& world, const SurfaceContact& contact) {
    const auto side = [&](float sign) { return side_of(world.nodes, world.colliders, world.shapes, contact, sign); };
    const SurfaceSide a = side(-1), b = side(1);
    const float substep = told_substep(world);
    return {world.body_handle(a.node),
            world.body_handle(b.node),
            to_pos(0.5 * (a.at + b.at)),
            {contact.normal.x(), contact.normal.y(), contact.normal.z()},
            contact.gap,
            to_float(substep * double{contact.force.normal}),
            to_float(substep * std::hypot(double{contact.force.tangent1}, double{contact.force.tangent2})),
            world.collider_handle(contact.collider[1]),
            world.collider_handle(contact.collider[0])};
}

}  // namespace

taut_result taut_world_get_contacts_sized(taut_world handle, taut_contact* first, uint32_t capacity, uint32_t* count,
                                          uint32_t size) {
    const RecordOut<taut_contact> contacts(first, size);
    Check check("taut_world_get_contacts");
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        uint32_t needed = 0, next = 0;
        for_pairs(world.pairs, [&](const Pair& pair) {
            if (pair.touching) needed += static_cast<uint32_t>(pair.manifold.count);
        });
        const Grains& grains = world.pairs.grains;
        const SurfaceContacts& surfaces = world.pairs.surfaces;
        for (const GrainContact& contact : grains.contact) needed += touching(grains, contact);
        for (const SurfaceContact& contact : surfaces.contact) needed += touching(surfaces, contact);
        if (needed > capacity) {
            *count = needed;
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
        }
        if (needed > 0 && !check.pointer("contacts", contacts)) return check.result();
        *count = needed;
        for_pairs(world.pairs, [&](const Pair& pair) {
            for (int i = 0; pair.touching && i < pair.manifold.count; ++i)
                contacts[next++] = public_contact(world, pair, i);
        });
        for (const GrainContact& contact : grains.contact)
            if (touching(grains, contact)) contacts[next++] = public_contact(world, contact);
        for (const SurfaceContact& contact : surfaces.contact)
            if (touching(surfaces, contact)) contacts[next++] = public_contact(world, contact);
        return TAUT_OK;
    });
}
