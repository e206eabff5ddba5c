// Contacts as hosts read them: all that touched or pushed in the last step, pair by pair in the order of the list.
#pragma once

#include <taut/event.h>

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

uint32_t count_contacts(const World& world);
// act(const taut_contact&)
template <class Act>
void for_contacts(const World& world, Act&& act) {
    for_pairs(world.pairs, [&](const Pair& pair) {
        for (int i = 0; pair.touching && i < pair.manifold.count; ++i) act(public_contact(world, pair, i));
    });
    const Grains& grains = world.pairs.grains;
    const SurfaceContacts& surfaces = world.pairs.surfaces;
    for (const GrainContact& contact : grains.contact)
        if (touching(grains, contact)) act(public_contact(world, contact));
    for (const SurfaceContact& contact : surfaces.contact)
        if (touching(surfaces, contact)) act(public_contact(world, contact));
}

}  // namespace taut
