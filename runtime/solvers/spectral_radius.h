// Spectral radius by the power method, for solvers that take fixed steps (Frâncu 2016, section 6.6.3).
#pragma once

#include "solvers/row_solver.h"

namespace taut {

// 1 / rho(D^-1 A) of each island, A = J W J^T + c. Uses scratch 1 and 2 of the problem and its island scratch 1 and 2.
// Ten rounds from alternating signs find rho to within a tenth; steps of up to 2 / rho are stable.
inline void find_fixed_step(Problem& p, Array<double>& step) {
    constexpr int kRounds = 10;
    Problem::Vector &x = p.scratch(1), &image = p.scratch(2);
    Problem::Vector &size = p.island_scratch(1), &image_size = p.island_scratch(2);
    for (size_t i = 0; i < x.size(); ++i) x[i] = i % 2 == 0 ? 1 : -1;
    for (int round = 0; round < kRounds; ++round) {
        p.apply_system(x, image);
        dot(p, x, x, size);
        for (const Unit& unit : p.units()) p.of(unit, image) = p.inverse(unit, p.of(unit, image));
        dot(p, image, image, image_size);
        for (size_t i = 0; i < step.size(); ++i) step[i] = image_size[i] > 0 ? std::sqrt(size[i] / image_size[i]) : 0;
        for (const Unit& unit : p.units()) p.of(unit, x) = step[unit.island] * p.of(unit, image);
    }
}

}  // namespace taut
