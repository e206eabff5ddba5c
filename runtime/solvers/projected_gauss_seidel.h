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

constexpr uint32_t kRelaxSweeps = 2;  // the pair that takes the push of overlaps out of the velocity

}  // namespace taut
