// Bodies that were put into one place: all are near all, and a step would go through n^2 / 2 pairs.
//
// A collider is crowded by those that are sunk into it: the balls inside the two (collision::thickness()) overlap by
// more than their contact margins. Where more than Crowd::kMost are, it has contacts with the deepest of them alone,
// and with all that is not crowded; what is left out has its turn as these part.
#pragma once

#include <cstdint>

#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Marks the near pairs that are left out in this frame, takes the points of those that had some, and returns how many
// they are. Does nothing while no collider has more than Crowd::kMost sunk into it of those after it in order.
uint32_t thin_crowds(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs);

}  // namespace taut
