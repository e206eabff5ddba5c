// Recovery of a tangled solid, in a world of any solver that steps in real time.
#pragma once

#include "world.h"

namespace taut {

// Cells of a solid whose volume is not positive.
uint32_t inverted_cells(const World& world, const Soft& soft);

// Takes a solid by at most so many of Newton's steps towards a minimum of its elastic energy, as statics do; where
// nothing holds it its centre of mass stays. Nothing else is met on the way, and what the energy falls by is
// dissipated: vertices that forces move go on with the velocity of their centre of mass. Throws std::bad_alloc with
// nothing changed.
void recover(World& world, const Soft& soft, uint32_t most_steps);

}  // namespace taut
