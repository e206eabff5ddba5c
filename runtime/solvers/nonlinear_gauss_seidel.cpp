// Nonlinear projected Gauss-Seidel, and over-relaxation (Frâncu 2016, section 6.6.1 and algorithm 5): row after row,
//   mu_i <- proj( mu_i - omega D_i^-1 r_i ),   u <- u + W J_i^T (change of mu_i)
// with C, J and r of each row at the positions that all rows before it left: position based dynamics with impulses.
// omega < 1 relaxes less, omega > 1 is SOR. Every other pass takes the rows from the last to the first.
#include "solvers/row_solver.h"

namespace taut {
namespace {

void sweep_nonlinear(Problem& p, const IterationSettings& settings) {
    p.use_whole_masses();
    Problem::Vector& next = p.scratch(0);
    next = p.impulse();
    const auto visit = [&](const Unit& unit) {
        p.evaluate(unit);
        p.of(unit, next) -= settings.relaxation * p.inverse(unit, p.residual(unit));
        p.project(unit, next);
        p.move_to(unit, next);
    };
    const auto units = p.units();
    for (uint32_t k = 0; k < settings.count; ++k) {
        if (k % 2 == 0)
            std::for_each(units.begin(), units.end(), visit);
        else
            std::for_each(units.rbegin(), units.rend(), visit);
    }
}

}  // namespace

const Solver kNonlinearGaussSeidel = row_solver<sweep_nonlinear>("nonlinear_gauss_seidel");

}  // namespace taut
