// Contacts as hosts read them: all that touched or pushed in the last step, pair by pair in the order of the list.
#pragma once

#include <taut/event.h>

#include <algorithm>
#include <iterator>

#include "api/access.h"

namespace taut {

// What impulses of contacts are told over [s].
inline float told_substep(const World& world) { return static_cast<float>(world.last_step / world.least_substeps()); }

taut_contact public_contact(const World& world, const Pair& pair, int point);
taut_contact public_contact(const World& world, const GrainContact& contact);
taut_contact public_contact(const World& world, const SurfaceContact& contact);
// Those of nodes that were removed since the step are not told.
bool touching(const Grains& grains, const GrainContact& contact);
bool touching(const SurfaceContacts& surfaces, const SurfaceContact& contact);

uint32_t count_contacts(const World& world);  // of all
// act(const taut_contact&) for those that may be of a node; kNone: for all.
template <class Act>
void for_contacts(const World& world, uint32_t node, Act&& act) {
    for_pairs(world.pairs, [&](const Pair& pair) {
        if (!pair.touching || (node != kNone && !ends_on(node)(pair))) return;
        for (int i = 0; i < pair.manifold.count; ++i) act(public_contact(world, pair, i));
    });
    const Grains& grains = world.pairs.grains;
    for (const GrainContact& contact : grains.contact)
        if ((node == kNone || contact.a == node || contact.b == node) && touching(grains, contact))
            act(public_contact(world, contact));
    const SurfaceContacts& surfaces = world.pairs.surfaces;
    for (const SurfaceContact& contact : surfaces.contact)
        if ((node == kNone || std::ranges::find(contact.node, node) != std::end(contact.node)) &&
            touching(surfaces, contact))
            act(public_contact(world, contact));
}

}  // namespace taut
