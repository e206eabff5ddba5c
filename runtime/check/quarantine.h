// Containment: a node whose motion is no longer finite, or too fast for any, is put back to its last good pose and
// stays there until the host lets it go; the rest of the world goes on.
#pragma once

#include "state/elements.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/sane.h"
#include "threads/team.h"

namespace taut {

// Freezes the nodes of a list that are not sane, or that their own load makes so within h, before they drag others
// along; appends their numbers to frozen. True: some node of the list has a load, and is to be asked again as it moves
// on.
bool quarantine(Team& team, Nodes& nodes, const Array<uint32_t>& list, Array<uint32_t>& frozen, double h = 0);

// Carried impulses and forces that are not finite become zero.
void drop_bad_impulses(Pairs& pairs, Joints& joints, Elements& elements);

}  // namespace taut
