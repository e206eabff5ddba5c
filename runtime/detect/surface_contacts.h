// Contacts of surfaces of soft bodies, but for those of their vertices with shapes, which are pairs.
//
// Against each other: vertices with faces and edges with edges that come within the sum of their radii and the contact
// margin in the frame, as they move now, at the moment when they first do. Against shapes: edges, which are capsules,
// and faces with what stands out of a shape. Of two features that were in touch before the side is known: they are
// pulled back through each other.
#pragma once

#include "collision/collide.h"
#include "state/colliders.h"
#include "state/pairs.h"
#include "state/shapes.h"
#include "state/softs.h"
#include "threads/team.h"

namespace taut {

struct SurfaceScene {
    const Nodes& nodes;
    const Colliders& colliders;
    const Shapes& shapes;
    Softs& softs;
    Pairs& pairs;
    const collision::Broadphase& broadphase;
    double time;  // ahead [s]
};

// Into Pairs::surfaces, with the forces of those that touched before. After update_pairs() of the frame.
void find_surface_contacts(Team& team, const SurfaceScene& scene);

}  // namespace taut
