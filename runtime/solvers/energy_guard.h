// Guard on the energy of a block that is solved with the slow velocity spared.
#pragma once

#include "solvers/solver.h"

namespace taut {

// What a solution gains of kinetic energy beyond the work of all that is not an ideal joint.
struct EnergyGain {
    double gain = 0;     // [J]
    double allowed = 0;  // what the block's internal motion and the step's error account for [J]
    double fall = 0;     // what gravity gives the block from rest within the substep [J]
    bool excessive(double times) const { return gain > times * allowed + fall; }
};

// Whose forces are no longer settling.
bool is_guarded(const Block& block);
// How many times what is allowed one solution may gain: 1 with light parts under a heavy load.
double may_burst(const Block& block);
// Of the block's present solution. row_work: of its contacts, stops, drives, springs and led joints [J].
EnergyGain energy_gain(const Substep& substep, const Block& block, double row_work);

// After the solve of a guarded block, before positions move: adds the gain to the block's account, and trips where that
// exceeds what is allowed. A tripped block is solved without the slow velocity (plain implicit damping) and twice for a
// while; tripping twice within that time asks for more substeps.
void guard_energy(Substep& substep, Block& block, const EnergyGain& gained);

}  // namespace taut
