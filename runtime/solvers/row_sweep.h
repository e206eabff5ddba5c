// Passes over some row blocks of a system, one by one in their order, on System::velocity.
#pragma once

#include "solvers/solver.h"

namespace taut {

// Impulses of the last substep onto the velocities.
void warm_start_rows(Substep& s, uint32_t first, uint32_t count);
// Contacts and their rolling friction; biased: with the soft push out of overlaps.
void sweep_rows(Substep& s, uint32_t first, uint32_t count, bool biased);

}  // namespace taut
