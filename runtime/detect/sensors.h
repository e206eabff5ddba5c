// What overlaps the sensors after a step.
#pragma once

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/nodes.h"
#include "state/sensors.h"
#include "state/shapes.h"
#include "state/softs.h"
#include "threads/team.h"

namespace taut {

// Finds all visits at the present poses, where the broadphase has its strays noted, and appends what changed since the
// last time. world: id, for handles; step: of the events. Throws std::bad_alloc with nothing changed.
void sense(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, const Softs& softs,
           const collision::Broadphase& broadphase, uint32_t world, uint32_t step, Sensors& sensors);

}  // namespace taut
