// Nonlinear projected conjugate residuals (Frâncu 2016, algorithm 3): minimum residual along directions whose images
// are conjugate,
//   z = D^-1 r,  delta = z . A z,  beta = min(delta / delta_before, 1),  d = z + beta d
//   p = A d,  alpha = (p . z) / (p . D^-1 p),  mu <- proj(mu - alpha d)
// beta stays below 1 and alpha is not negative; where an island's step would lead uphill, d starts again from
// z. With the option of fixed steps alpha = 1 / rho(D^-1 A). All by islands.
#include "solvers/row_solver.h"
#include "solvers/spectral_radius.h"

namespace taut {
namespace {

// d = z + beta d with beta of delta and the one before, which it becomes.
void turn_residuals(Problem& p, const Problem::Vector& z, const Problem::Vector& delta, Problem::Vector& before,
                    Problem::Vector& d) {
    for (const Unit& unit : p.units()) {
        const double last = before[unit.island], now = delta[unit.island];
        const double beta = last > 0 && now > 0 ? std::min(now / last, 1.0) : 0;
        p.of(unit, d) = p.of(unit, z) + beta * p.of(unit, d);
    }
    before = delta;
}

void conjugate_residuals(Problem& p, const IterationSettings& settings) {
    Problem::Vector &r = p.scratch(0), &z = p.scratch(1), &image = p.scratch(2), &d = p.scratch(3);
    Problem::Vector &before = p.island_scratch(0), &above = p.island_scratch(1), &below = p.island_scratch(2);
    Problem::Vector fixed(p.islands(), 1.0, before.get_allocator());
    if (settings.fixed_step) {
        p.evaluate();
        find_fixed_step(p, fixed);
    }
    for (uint32_t k = 0; k < settings.count; ++k) {
        p.evaluate();
        p.residual(r);
        p.direction(r, z);
        p.apply_system(z, image);
        dot(p, z, image, above);
        turn_residuals(p, z, above, before, d);
        p.apply_system(d, image);
        dot(p, image, z, above);
        scaled_dot(p, image, image, below);
        for (const Unit& unit : p.units()) {
            const uint32_t i = unit.island;
            const double best = below[i] > 0 ? std::max(0.0, above[i] / below[i]) : 0;
            const double step = settings.relaxation * (settings.fixed_step ? fixed[i] : best);
            p.of(unit, r) = p.of(unit, p.impulse()) - step * p.of(unit, d);
            if (above[i] <= 0) before[i] = 0;
        }
        p.project(r);
        p.move_to(r);
    }
}

}  // namespace

const Solver kConjugateResiduals = row_solver<conjugate_residuals>("conjugate_residuals");

}  // namespace taut
