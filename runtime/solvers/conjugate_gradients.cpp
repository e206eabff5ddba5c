// Nonlinear conjugate gradients on the energy form (Frâncu 2016, algorithm 1): unknowns are velocities u, rows give
// forces by their law mu(u) = proj((target - rate(u)) / c),
//   r = J^T mu(u) - M (u - u*)       the negative gradient of  |u - u*|^2_M / 2 + sum c mu^2 / 2    [N s]
//   d = W r + beta d,  beta = (r . W r) / (r . W r)_before         (Fletcher and Reeves, in the metric of M)
//   alpha = (r . d) / (d . S d),  S = M + J^T (1/c) J,  u <- u + alpha d
// one step of the line search an iteration, by islands. Rigid rows are springs here; see Rigid::soft.
#include "solvers/row_solver.h"

namespace taut {
namespace {

class Descent {
public:
    explicit Descent(Problem& p)
        : p_(p),
          spent_(p.node_scratch(0)),
          residual_(p.node_scratch(1)),
          direction_(p.node_scratch(2)),
          momentum_(p.node_scratch(3)),
          last_(p.node_scratch(4)),
          delta_(p.island_scratch(0)),
          before_(p.island_scratch(1)),
          curvature_(p.island_scratch(2)),
          overlap_(p.island_scratch(3)) {
        p_.use_stiffness();
        p_.apply_transpose(p_.impulse(), spent_);
        for (Problem::NodeVectors* each : {&direction_, &momentum_, &last_})
            for (const uint32_t seat : p_.seats()) (*each)[seat].setZero();
    }

    void advance(double relaxation) {
        find_residual();
        turn();
        find_curvature();
        for (const uint32_t seat : p_.seats()) {
            const uint32_t i = p_.island_of(seat);
            const double alpha = curvature_[i] > 0 ? relaxation * delta_[i] / curvature_[i] : 0;
            p_.move(seat, alpha * direction_[seat]);
            spent_[seat] += alpha * momentum_[seat];
        }
    }
    // Forces of the law at the velocities reached.
    void finish() {
        p_.evaluate();
        p_.find_forces(p_.impulse());
    }

private:
    template <class Value>
    void sum(Problem::Vector& sums, Value&& value) {
        std::fill(sums.begin(), sums.end(), 0.0);
        for (const uint32_t seat : p_.seats()) sums[p_.island_of(seat)] += value(seat);
    }

    // r = J^T mu(u) - M (u - u*), and r . W r of each island.
    void find_residual() {
        p_.evaluate();
        p_.find_forces(p_.scratch(0));
        p_.apply_transpose(p_.scratch(0), residual_);
        for (const uint32_t seat : p_.seats()) residual_[seat] -= spent_[seat];
        sum(delta_, [&](uint32_t seat) { return residual_[seat].dot(p_.response_of(seat, residual_[seat])); });
    }

    // d = W r + beta d, and M d with it. Where friction or contacts changed r much against what it was, directions are
    // not conjugate any more, and an island starts again (Powell 1977: r . W r_before beyond a fifth of r . W r).
    void turn() {
        constexpr double kConjugate = 0.2;
        sum(overlap_, [&](uint32_t seat) { return last_[seat].dot(p_.response_of(seat, residual_[seat])); });
        for (const uint32_t seat : p_.seats()) {
            const uint32_t i = p_.island_of(seat);
            const bool conjugate = before_[i] > 0 && std::abs(overlap_[i]) < kConjugate * delta_[i];
            const double beta = conjugate ? delta_[i] / before_[i] : 0;
            direction_[seat] = p_.response_of(seat, residual_[seat]) + beta * direction_[seat];
            momentum_[seat] = residual_[seat] + beta * momentum_[seat];
            last_[seat] = residual_[seat];
        }
        before_ = delta_;
        sum(delta_, [&](uint32_t seat) { return residual_[seat].dot(direction_[seat]); });
    }

    // d . S d = d . M d + (J d) . (1/c) J d, with rows that projection holds too: steps may be short and never
    // overshoot.
    void find_curvature() {
        sum(curvature_, [&](uint32_t seat) { return direction_[seat].dot(momentum_[seat]); });
        p_.apply(direction_, p_.scratch(1));
        for (const Unit& unit : p_.units()) {
            if (!unit.solved) continue;
            const RowVector rate = p_.of(unit, p_.scratch(1));
            curvature_[unit.island] += rate.dot(p_.inverse(unit, rate));
        }
    }

    Problem& p_;
    Problem::NodeVectors &spent_, &residual_, &direction_, &momentum_, &last_;  // M (u - u*), r, d, M d, r before
    Problem::Vector &delta_, &before_, &curvature_, &overlap_;
};

void descend(Problem& p, const IterationSettings& settings) {
    Descent descent(p);
    for (uint32_t k = 0; k < settings.count; ++k) descent.advance(settings.relaxation);
    descent.finish();
}

}  // namespace

const Solver kConjugateGradients = row_solver<descend, 60, Rigid::soft>("conjugate_gradients");

}  // namespace taut
