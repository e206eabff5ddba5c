// What a world of TAUT_SOLVER_MINIMISATION does not take.
#pragma once

#include "world.h"

namespace taut {

// Why the world cannot be stepped; null: it can, as can all of other solvers. In the order of nodes and sets.
const char* why_not_minimised(const World& world);
// Why it has no rest besides: something nothing holds, and a force on it. Null: it has. Throws std::bad_alloc.
const char* why_not_relaxed(World& world);

}  // namespace taut
