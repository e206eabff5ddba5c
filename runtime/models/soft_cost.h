// What a planned soft body costs and errs, solved directly and swept, and which of the two it is to be. In a step of
// length H with s substeps, N vertices, P pairs of them that elements couple, e elements of r rows and w freedoms:
//
//   direct   s (factor + sum of a w^2 over elements),  factor = 8 ns P^(3/2) of sheets, 0.1 ns P^2 of solids, whose
//            separators have P^(1/2) and P^(2/3) pairs;  a = 9 ns in the form of energy, else 2 ns
//   swept    n (20 ns N + sum of 1.1 ns w r over elements)
//
// A direct solve holds any load. Sweeps are as stiff as the material in substeps h with rate (h^2 + d h) <= 1, d the
// damping time and rate = J W J^T D [1/s^2] the square of how fast an element swings, of neo-Hookean rows what they
// yield at rest over what sweeps hold; so many substeps, n = H/h, err by no load. Fewer let rows yield: a sheet of
// edges L that two corners hold by two threads each carries a quarter of its weight there, long links bear half of it,
// and
//   strain = N g h^2 / (4 L),   n = H sqrt(N g / (4 L tolerance))
// of its own weight. What will hang on it is not known, so that is taken where a direct solve has no time: s of them
// last longer than H. Times are those of one machine, in proportion to each other on others (figures of 400 to 10000
// vertices, AVX-512, within a third of what was measured).
#pragma once

#include "models/softs.h"

namespace taut {

struct SoftCost {
    double direct = 0, swept = 0;  // of a step [s]; infinite: it cannot be
    double substeps = 0;           // that sweeps take to be as stiff as the material
    double least_substeps = 0;     // to hold the body's own weight within tolerance
    double swept_least = 0;        // of a step with these [s]
};

// Of elements planned for either.
SoftCost cost_of(const World& world, const SoftPlan& plan);
JointSolve cheapest_solve(const World& world, const SoftPlan& plan);

}  // namespace taut
