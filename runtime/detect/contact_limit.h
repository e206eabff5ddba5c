// A bound on the contacts that a step solves.
#pragma once

#include <cstdint>

#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"

namespace taut {

// Drops what pairs.active holds beyond the limit (0: none) and returns how many that were. The deepest stay, and of
// equally deep ones the first in the list: gaps that may not even close go before overlaps.
uint32_t limit_contacts(const Nodes& nodes, const Colliders& colliders, uint32_t limit, Pairs& pairs);

}  // namespace taut
