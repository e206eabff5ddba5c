// Solids that yield: after each step what has flowed is taken out of the rest shape of their elements, which then
// strain by what is elastic alone (constraints/plasticity.h). Once a step, and by how long that was: creep does not
// know how steps are divided. What sleeps does not flow.
#pragma once

#include "models/softs.h"

namespace taut {

// With an event of each cell that did not flow in the step before.
void flow_solids(World& world);

// Of a cell, mean of its Gauss points: |stretch - 1| of their sets; 0 of what does not yield.
double plastic_strain(const Soft& soft, uint32_t cell);

}  // namespace taut
