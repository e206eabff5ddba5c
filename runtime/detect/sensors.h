// What overlaps the sensors after a step.
#pragma once

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/nodes.h"
#include "state/sensors.h"
#include "state/shapes.h"
#include "threads/team.h"

namespace taut {

// Finds all visits at the present poses, where the broadphase has its strays noted, and what changed since the last
// time. world: id, for handles.
void sense(Team& team, const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
           const collision::Broadphase& broadphase, uint32_t world, Sensors& sensors);

}  // namespace taut
