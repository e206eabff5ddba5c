#include "api/contacts.h"

#include <algorithm>

#include "detect/surface_point.h"

namespace taut {

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
            to_float(substep * hypotenuse(double{force.tangent1}, double{force.tangent2})),
            world.collider_handle(pair.collider_a()),
            world.collider_handle(pair.collider_b())};
}

namespace {

bool is_gone(const Array<uint32_t>& gone, std::span<const uint32_t> nodes) {
    return !gone.empty() &&
           std::ranges::any_of(nodes, [&](uint32_t node) { return std::ranges::find(gone, node) != gone.end(); });
}

}  // namespace

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
            to_float(substep * hypotenuse(double{contact.force.tangent1}, double{contact.force.tangent2})),
            world.collider_handle(contact.collider[1]),
            world.collider_handle(contact.collider[0])};
}

uint32_t count_contacts(const World& world) {
    uint32_t count = 0;
    for_pairs(world.pairs, [&](const Pair& pair) {
        if (pair.touching) count += static_cast<uint32_t>(pair.manifold.count);
    });
    const Grains& grains = world.pairs.grains;
    const SurfaceContacts& surfaces = world.pairs.surfaces;
    for (const GrainContact& contact : grains.contact) count += touching(grains, contact);
    for (const SurfaceContact& contact : surfaces.contact) count += touching(surfaces, contact);
    return count;
}

}  // namespace taut
