// Nonlinear projected minimum residual (Frâncu 2016, algorithm 2): every iteration goes along the residual of the
// positions reached, by the step that leaves the least of it,
//   z = D^-1 r,  p = A z,  alpha = (p . z) / (p . D^-1 p),  mu <- proj(mu - alpha z),   A = J W J^T + c
// scaled by the diagonal D, so that rows of all units and masses count alike. Option: the fixed step 1 / rho(D^-1 A),
// with rho by the power method. All by islands.
#include "solvers/row_solver.h"
#include "solvers/spectral_radius.h"

namespace taut {
namespace {

void minimise_residual(Problem& p, const IterationSettings& settings) {
    Problem::Vector &r = p.scratch(0), &z = p.scratch(1), &image = p.scratch(2);
    Problem::Vector &step = p.island_scratch(0), &above = p.island_scratch(1), &below = p.island_scratch(2);
    for (uint32_t k = 0; k < settings.count; ++k) {
        p.evaluate();
        if (settings.fixed_step && k == 0) find_fixed_step(p, step);
        p.residual(r);
        p.direction(r, z);
        if (!settings.fixed_step) {
            p.apply_system(z, image);
            dot(p, image, z, above);
            scaled_dot(p, image, image, below);
            for (size_t i = 0; i < step.size(); ++i) step[i] = below[i] > 0 ? above[i] / below[i] : 0;
        }
        for (const Unit& unit : p.units())
            p.of(unit, z) = p.of(unit, p.impulse()) - settings.relaxation * step[unit.island] * p.of(unit, z);
        p.project(z);
        p.move_to(z);
    }
}

}  // namespace

const Solver kMinimumResidual = row_solver<minimise_residual>("minimum_residual");

}  // namespace taut
