// Contacts between grains, found each frame from where they are and go: nothing is kept of who is merely near.
#pragma once

#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// Into pairs.grains: all pairs of grains that lie closer than their contact margin, or will within the frame as they
// move now, with the forces that they had. Both may be asleep; while all are, nothing changes.
void find_grain_contacts(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes, Pairs& pairs,
                         double time_step);

}  // namespace taut
