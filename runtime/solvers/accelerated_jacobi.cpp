// Accelerated Jacobi (Frâncu 2016, eq. 6.41 to 6.43 and 7.35, algorithm 6): every row block at once,
//   mu_{k+1} = proj( mu_k - S^-1 r_k + beta_k (mu_k - mu_{k-1}) ),   r = J v - target + c mu
//   theta_{k+1} = (-theta_k^2 + theta_k sqrt(theta_k^2 + 4)) / 2,  theta_0 = 1
//   beta_{k+1} = theta_k (1 - theta_k) / (theta_k^2 + theta_{k+1})
// S is the block's diagonal with each node's inverse mass multiplied by the number of blocks on it: the mass
// splitting bound, under which the plain iteration (omega = 1) cannot diverge. The momentum restarts where it
// points against the descent.
#include <Eigen/LU>
#include <algorithm>

#include "solvers/solver.h"
#include "system/soft_contact.h"

namespace taut {
namespace {

constexpr uint32_t kDefaultIterations = 30;

// biased: position errors are removed, softly; relaxed: not; bouncing: contacts that were hit part again.
enum class Phase { biased, relaxed, bouncing };

using NodeVector = Eigen::Matrix<double, kDof, 1>;
using RowJacobian = Eigen::Matrix<double, Eigen::Dynamic, kDof, Eigen::RowMajor, kMaxRows, kDof>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMaxRows>;
using ShortVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;
using Map = Eigen::Map<ShortVector>;
using ConstMap = Eigen::Map<const ShortVector>;

class Iteration {
public:
    explicit Iteration(Substep& s)
        : sys_(s.system),
          count_(s.scratch.count),
          inverse_(s.scratch.inverse),
          previous_(s.scratch.previous),
          next_(s.scratch.next),
          soft_(soft_terms(sys_.h)) {
        count_.assign(sys_.pose.size(), 0);
        inverse_.clear();
        next_.resize(sys_.rows.impulse.size());
        for (const RowBlock& block : sys_.rows.block)
            for (int n = 0; n < block.type->nodes; ++n) ++count_[block.node[n]];
        for (const RowBlock& block : sys_.rows.block) {
            const int rows = block.type->rows;
            RowMatrix split = RowMatrix::Zero(rows, rows);
            for (int n = 0; n < block.type->nodes; ++n)
                for (int r = 0; r < rows; ++r)
                    split.col(r) +=
                        count_[block.node[n]] *
                        (jacobian(block, n) * respond(block.node[n], jacobian(block, n).row(r).transpose()));
            split.diagonal().array() += softness(block, Phase::biased) + 1e-12 * split.trace();
            const RowMatrix inverse = split.inverse();
            inverse_.insert(inverse_.end(), inverse.data(), inverse.data() + rows * rows);
        }
    }

    void apply_all() {  // warm start: J^T mu onto v*
        for (const RowBlock& block : sys_.rows.block)
            push(block, ConstMap(&sys_.rows.impulse[block.row], block.type->rows));
    }

    void run(uint32_t iterations, Phase phase) {
        double theta = 1, beta = 0;
        previous_ = sys_.rows.impulse;
        for (uint32_t k = 0; k < iterations; ++k) {
            const bool uphill = advance(beta, phase);
            const double after = 0.5 * (-theta * theta + theta * std::sqrt(theta * theta + 4));
            beta = theta * (1 - theta) / (theta * theta + after);
            theta = after;
            if (uphill) theta = 1, beta = 0;
        }
    }

private:
    // One iteration; true if the momentum pointed against the descent.
    bool advance(double beta, Phase phase) {
        size_t at = 0;
        double alignment = 0;
        Array<double>& impulse = sys_.rows.impulse;
        for (const RowBlock& block : sys_.rows.block) {
            const int rows = block.type->rows;
            const ConstMap now(&impulse[block.row], rows), before(&previous_[block.row], rows);
            const Eigen::Map<const RowMatrix> inverse(&inverse_[at], rows, rows);
            at += static_cast<size_t>(rows * rows);
            const ShortVector r = residual(block, now, phase);
            alignment += r.dot(now - before);
            ShortVector next = now - inverse * r + beta * (now - before);
            project(block, next);
            Map(&next_[block.row], rows) = next;
        }
        for (const RowBlock& block : sys_.rows.block)
            push(block,
                 ConstMap(&next_[block.row], block.type->rows) - ConstMap(&impulse[block.row], block.type->rows));
        previous_ = impulse;
        impulse = next_;
        return alignment > 0;
    }

    static void project(const RowBlock& block, ShortVector& mu) {
        if (block.type->bound != Bound::cone) return;
        mu[0] = std::max(0.0, mu[0]);
        const double limit = block.friction * mu[0], size = std::sqrt(mu[1] * mu[1] + mu[2] * mu[2]);
        if (size > limit) mu.tail(2) *= limit / size;
    }

    // c of a row: physical, or the soft row's on its own effective mass (see soft_contact.h).
    double softness(const RowBlock& block, Phase phase) const {
        if (block.compliance > 0) return row_terms(block, sys_.h).compliance;
        if (phase != Phase::biased) return 0;
        double trace = 0;
        for (int n = 0; n < block.type->nodes; ++n)
            for (int r = 0; r < block.type->rows; ++r)
                trace += jacobian(block, n).row(r).dot(respond(block.node[n], jacobian(block, n).row(r).transpose()));
        return soft_.impulse_scale / soft_.mass_scale * trace / block.type->rows;
    }

    ShortVector residual(const RowBlock& block, const ConstMap& mu, Phase phase) const {
        const int rows = block.type->rows;
        const double* error = &sys_.rows.error[block.row];
        ShortVector r = ShortVector::Zero(rows);
        for (int n = 0; n < block.type->nodes; ++n) {
            const Velocity& u = sys_.exact[block.node[n]];
            NodeVector v;
            v << u.v, u.w;
            r += jacobian(block, n) * v;
        }
        if (block.type->bound == Bound::cone) {  // only the normal row has a target
            const double gap = error[0];
            if (phase == Phase::bouncing && block.bounce > 0 && mu[0] > 0)
                r[0] -= block.bounce;
            else if (gap > 0)
                r[0] += gap * soft_.inv_h;
            else if (phase == Phase::biased)
                r[0] += std::max<double>(soft_.bias_rate * gap, -soft_.push) + softness(block, Phase::biased) * mu[0];
            return r;
        }
        const double rate = block.compliance > 0     ? row_terms(block, sys_.h).rate
                            : phase == Phase::biased ? soft_.bias_rate
                                                     : 0.0;
        return r + rate * ConstMap(error, rows) + softness(block, phase) * mu;
    }

    NodeVector respond(uint32_t node, const NodeVector& p) const {
        const SweepMass& m = sys_.inverse_mass[node];
        const float* i = m.inv_inertia;
        NodeVector v;
        v << m.inv_mass * p.head<3>(), i[0] * p[3] + i[3] * p[4] + i[4] * p[5], i[3] * p[3] + i[1] * p[4] + i[5] * p[5],
            i[4] * p[3] + i[5] * p[4] + i[2] * p[5];
        return v;
    }
    void push(const RowBlock& block, const ShortVector& impulse) {
        for (int n = 0; n < block.type->nodes; ++n) {
            const NodeVector dv = respond(block.node[n], jacobian(block, n).transpose() * impulse);
            sys_.exact[block.node[n]].v += dv.head<3>();
            sys_.exact[block.node[n]].w += dv.tail<3>();
        }
    }
    Eigen::Map<const RowJacobian> jacobian(const RowBlock& block, int n) const {
        return {&sys_.rows.jacobian[block.jacobian + static_cast<uint32_t>(n * block.type->rows * kDof)],
                block.type->rows, kDof};
    }

    System& sys_;
    Array<uint32_t>& count_;  // row blocks on each node
    Array<double>& inverse_;  // of the split diagonal, rows x rows a block
    Array<double>&previous_, &next_;
    SweepTerms soft_;
};

uint32_t iterations(const Substep& s) { return s.settings.sweeps ? s.settings.sweeps : kDefaultIterations; }

void solve(Substep& s) {
    Iteration iteration(s);
    iteration.apply_all();
    iteration.run(iterations(s), Phase::biased);
    for (const RowBlock& block : s.system.rows.block)
        if (block.force)
            for (int r = 0; r < block.type->rows; ++r)
                block.force[r] = s.system.rows.impulse[block.row + r] / s.system.h;
}

void relax(Substep& s) {
    Iteration iteration(s);
    iteration.run(iterations(s), Phase::relaxed);
    if (s.last) iteration.run(iterations(s), Phase::bouncing);
}

}  // namespace

const Solver kAcceleratedJacobi{"accelerated_jacobi", false, false, solve, nullptr, relax};

}  // namespace taut
