// Coloured sweeps over the swept constraints of a group, also used by solvers that take joints directly.
#pragma once

#include "solvers/solver.h"

namespace taut {

// Impulses of the last substep onto the sweep velocities.
void warm_start_sweeps(Substep& substep);
// With the soft bias that removes position errors.
void sweep_biased(Substep& substep);
// Without: what the velocity keeps. Bounces at the end of the frame.
void sweep_relaxed(Substep& substep);

}  // namespace taut
