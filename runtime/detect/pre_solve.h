// Which of the contacts found are solved: one-way colliders and the host's own filter decide.
#pragma once

#include <taut/pre_solve.h>

#include "state/colliders.h"
#include "state/nodes.h"
#include "state/pairs.h"
#include "state/shapes.h"

namespace taut {

// The host's filter; null: none.
struct PreSolve {
    taut_pre_solve_fn ask = nullptr;
    void* user_data = nullptr;
};

// Takes the contacts that are ignored out of pairs.active, and gives others the surface that the host wants. Returns
// how many of the host's answers were refused.
uint32_t filter_contacts(const Nodes& nodes, const Colliders& colliders, const PreSolve& pre_solve, Pairs& pairs);
// The same for contacts of surfaces, which get what moving surfaces of their colliders drive as well.
uint32_t filter_surfaces(const Nodes& nodes, const Colliders& colliders, const Shapes& shapes,
                         const PreSolve& pre_solve, const Pairs& pairs, Array<SurfaceContact>& contacts);

}  // namespace taut
