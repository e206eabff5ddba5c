// Tethers of a cloth: links that only pull, from each vertex to the pinned ones that are nearest along its edges at
// rest
// ("Long range attachments", Kim, Chentanez and Müller-Fischer 2012).
#pragma once

#include <span>

#include "world.h"

namespace taut {

struct TetherPlan {
    explicit TetherPlan(Memory& m) : vertex(m), length(m), lambda(m), memory(m) {}

    Array<uint32_t> vertex;    // [2] of each tether: its own, and the pinned one
    Array<double> length;      // [m]
    Array<double> lambda;      // what it carries, as one that is there already [N]
    Array<AxisMemory> memory;  // likewise
};

// Those of a cloth as it is, but for one vertex pinned or not, kNone: no one; and room for them. Throws std::bad_alloc
// with nothing changed.
void plan_tethers(World& world, const Soft& soft, uint32_t vertex, bool pinned, TetherPlan& out);
// In the place of those that are there.
void set_tethers(World& world, const Soft& soft, const TetherPlan& plan);

// Lengths at rest of a cloth's triangle: from its corner k to the next [m].
void rest_edges(const Soft& soft, uint32_t triangle, double (&length)[3]);

}  // namespace taut
