// Two axes grown by radii, in one frame: spheres, capsules, and edges, whose radius is 0.
#pragma once

#include "collision/collide.h"
#include "collision/narrowphase/segment.h"

namespace taut::collision {

struct Rounds {
    Segment a, b;
    float radius_a, radius_b;  // [m]; a's is not 0
};

// Their contact, closer than margin: one point, or both ends of the stretch where they run side by side. Fills out,
// empty on entry: normal from a to b. Returns how far apart they are, where that is further [m]; else 0.
float touch_rounds(const Rounds& rounds, float margin, Manifold& out);

}  // namespace taut::collision
