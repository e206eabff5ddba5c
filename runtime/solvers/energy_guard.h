// Guard on the energy of a block that is solved with the slow velocity spared.
#pragma once

#include "solvers/solver.h"

namespace taut {

// After a substep's solve, before positions move: adds what no force explains of the kinetic energy's growth to the
// block's account, and trips where that exceeds what the block has of internal motion. A tripped block is solved
// without the slow velocity (plain implicit damping) and twice for a while; tripping twice within that time asks for
// more substeps. bounded_work: of the block's contacts, stops and drives [J].
void guard_energy(Substep& substep, Block& block, double bounded_work);

}  // namespace taut
