// What events with points and hits tell beyond the last substep: how pairs closed before the step, and their impulses
// summed over it. Only pairs whose events ask for it are watched.
#pragma once

#include <taut/collider.h>

#include "detect/approach.h"
#include "detect/obstacles.h"
#include "partition/partition.h"
#include "system/impacts.h"

namespace taut {

constexpr uint32_t kAsksWatch = TAUT_CONTACT_EVENTS_POINTS | TAUT_CONTACT_EVENTS_HIT;

struct WatchedPair {
    uint32_t pair = 0;                      // index into Pairs::list
    RelativeMotion before;                  // the step
    uint32_t lane_group = kNone, lane = 0;  // where it is swept, in System::contacts; kNone: as rows

    // Points as seen last, with the sums so far, in world axes [N s]: pushes along the normals that they had, friction.
    int count = 0;
    uint32_t feature[4];
    Vec3f position[4];
    Vec3f push[4];
    Vec3f friction[4];
};

struct ContactWatch {
    explicit ContactWatch(Memory& memory) : pairs(memory), current(memory) {}

    Array<WatchedPair> pairs;  // sorted by slot
    Array<uint32_t> current;   // of them, those of the group being solved
};

// Once a step, before anything moves.
void watch_contacts(const Nodes& nodes, const Pairs& pairs, ContactWatch& watch);
// Once a step and group, when its lanes are built.
void watch_group(const Group& group, const System& system, const Pairs& pairs, ContactWatch& watch);
// After each substep: adds the impulses of the group's pairs.
void gather_impulses(const System& system, const Impacts& impacts, const Pairs& pairs, ContactWatch& watch);
// The same for contacts of surfaces, all of which keep their sums themselves. Once a step:
void watch_surfaces(Team& team, const Nodes& nodes, const Colliders& colliders, Pairs& pairs);
// After each substep of a group.
void gather_surface_impulses(Team& team, const System& system, const Impacts& impacts, SurfaceContacts& surfaces);
// After a step of a solver that takes ways out in place of contacts: what pushed becomes contacts of surfaces.
// substep: the length of its last substep [s].
void tell_pushes(double substep, const Softs& softs, const Nodes& nodes, Obstacles& obstacles,
                 SurfaceContacts& surfaces);
// The watched pair of an index into Pairs::list, or null.
WatchedPair* find_watched(ContactWatch& watch, uint32_t pair);

}  // namespace taut
