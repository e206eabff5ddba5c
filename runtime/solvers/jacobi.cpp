// Projected Jacobi and its accelerated form (Frâncu 2016, eq. 6.37, 6.41 and 7.35, algorithm 6): all rows at once,
//   mu_{k+1} = proj( mu_k - omega D^-1 r_k + beta_k (mu_k - mu_{k-1}) )
// D is the diagonal with masses split among the rows that share them, under which omega = 1 cannot diverge (Tonge et
// al. 2012). Momentum, which starts again in an island where it points against the descent:
//   none        beta = 0
//   power       beta_k = min(a (k / n)^b, 1), a = 1, b = 0.6                                  (eq. 6.39)
//   nesterov    theta_{k+1} = (-theta_k^2 + theta_k sqrt(theta_k^2 + 4)) / 2,  theta_0 = 1    (eq. 6.42)
//               beta_{k+1} = theta_k (1 - theta_k) / (theta_k^2 + theta_{k+1})                (eq. 6.43)
#include "solvers/row_solver.h"

namespace taut {
namespace {

// min(x^0.6, 1) of x > 0: Newton's method for y^5 = x^3 from above, which falls until it rounds; the same bits on every
// machine.
double power(double x) {
    if (!(x < 1)) return 1;
    const double cube = x * x * x;
    for (double y = 1;;) {
        const double squared = y * y, next = y - (y - cube / (squared * squared)) / 5;
        if (!(next < y)) return y;
        y = next;
    }
}

// beta by the number of iterations since an island's momentum began.
class Momentum {
public:
    Momentum(MomentumRule rule, uint32_t count) : rule_(rule), count_(count) {}

    double at(uint32_t k) {
        if (k == 0) return 0;
        if (rule_ == MomentumRule::power) return power(static_cast<double>(k) / count_);
        double theta = 1, beta = 0;
        for (uint32_t i = 0; i < k; ++i) {
            const double next = 0.5 * (-theta * theta + theta * std::sqrt(theta * theta + 4));
            beta = theta * (1 - theta) / (theta * theta + next);
            theta = next;
        }
        return beta;
    }

private:
    MomentumRule rule_;
    uint32_t count_;
};

template <bool accelerated>
void iterate_jacobi(Problem& p, const IterationSettings& settings) {
    Momentum momentum(settings.momentum, settings.count);
    Problem::Vector &r = p.scratch(0), &next = p.scratch(1), &before = p.scratch(2);
    Problem::Vector &age = p.island_scratch(0), &uphill = p.island_scratch(1), &beta = p.island_scratch(2);
    before = p.impulse();
    for (uint32_t k = 0; k < settings.count; ++k) {
        p.evaluate();
        p.residual(r);
        if constexpr (accelerated)
            for (size_t i = 0; i < beta.size(); ++i) beta[i] = momentum.at(static_cast<uint32_t>(age[i]));
        for (const Unit& unit : p.units()) {
            const RowVector mu = p.of(unit, p.impulse()), change = mu - p.of(unit, before);
            p.of(unit, next) = mu - settings.relaxation * p.inverse(unit, p.of(unit, r)) + beta[unit.island] * change;
        }
        p.project(next);
        sum_by_island(p, uphill, [&](const Unit& unit) {
            return p.of(unit, r).dot(p.of(unit, p.impulse()) - p.of(unit, before));
        });
        before = p.impulse();
        p.move_to(next);
        for (size_t i = 0; i < age.size(); ++i) age[i] = uphill[i] > 0 ? 0 : age[i] + 1;
    }
}

}  // namespace

const Solver kJacobi = row_solver<iterate_jacobi<false>>("jacobi");
const Solver kAcceleratedJacobi = row_solver<iterate_jacobi<true>>("accelerated_jacobi");

}  // namespace taut
