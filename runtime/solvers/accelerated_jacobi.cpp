// Accelerated Jacobi (Frâncu 2016, eq. 6.41 to 6.43 and 7.35, algorithm 6): every row block at once,
//   mu_{k+1} = proj( mu_k - S^-1 r_k + beta_k (mu_k - mu_{k-1}) ),   r = J v - target + c mu
//   theta_{k+1} = (-theta_k^2 + theta_k sqrt(theta_k^2 + 4)) / 2,  theta_0 = 1
//   beta_{k+1} = theta_k (1 - theta_k) / (theta_k^2 + theta_{k+1})
// S is the block's diagonal with each node's inverse mass multiplied by the number of blocks on it: the mass
// splitting bound, under which the plain iteration (omega = 1) cannot diverge. The momentum restarts where it
// points against the descent. Rows that friction bounds take steps of their own: a matrix that couples them would let
// the speed at which a contact slides into the equation of its normal. Stops, drives and friction of a joint's axis are
// scalar rows of their own beside the block of what is locked.
#include <Eigen/LU>
#include <algorithm>
#include <utility>

#include "solvers/solver.h"
#include "system/row_algebra.h"
#include "system/soft_contact.h"

namespace taut {
namespace {

constexpr uint32_t kDefaultIterations = 30;

// biased: position errors are removed, softly; relaxed: not.
enum class Phase { biased, relaxed };

class Iteration {
public:
    explicit Iteration(Substep& s)
        : sys_(s.system),
          count_(s.scratch.count),
          inverse_(s.scratch.inverse),
          softness_(s.scratch.softness),
          previous_(s.scratch.previous),
          next_(s.scratch.next),
          axes_(s.scratch.axes),
          soft_(contact_terms(sys_.h, sys_.stretch)) {
        count_.assign(sys_.pose.size(), 0);
        inverse_.clear();
        softness_.clear();
        next_.resize(sys_.rows.impulse.size());
        find_axes();
        for (const RowBlock& block : sys_.rows.block)
            for (int n = 0; n < block.type->nodes; ++n) ++count_[block.node[n]];
        for (const AxisIterate& axis : axes_)
            for (int n = 0; n < block_of(axis).type->nodes; ++n) ++count_[block_of(axis).node[n]];
        for (const RowBlock& block : sys_.rows.block) prepare(block);
        for (AxisIterate& axis : axes_) prepare(axis);
    }

    void apply_all() {  // warm start: J^T mu onto v*
        for (const RowBlock& block : sys_.rows.block) push(block, impulse_of(sys_, block));
    }

    void run(uint32_t iterations, Phase phase) {
        double theta = 1, beta = 0;
        previous_ = sys_.rows.impulse;
        for (AxisIterate& axis : axes_) axis.previous = axis.impulse;
        for (uint32_t k = 0; k < iterations; ++k) {
            const bool uphill = advance(beta, phase);
            const double after = 0.5 * (-theta * theta + theta * std::sqrt(theta * theta + 4));
            beta = theta * (1 - theta) / (theta * theta + after);
            theta = after;
            if (uphill) theta = 1, beta = 0;
        }
    }

    void store_forces() {
        for (const RowBlock& block : sys_.rows.block)
            for (int r = 0; block.force && r < block.type->rows; ++r)
                block.force[r] = sys_.rows.impulse[block.row + static_cast<uint32_t>(r)] / sys_.h;
        store_axes();
    }
    void store_axes() {
        for (const AxisIterate& axis : axes_) *axis.axis.force = static_cast<float>(axis.impulse / sys_.h);
    }

private:
    const RowBlock& block_of(const AxisIterate& axis) const { return sys_.rows.block[axis.block]; }

    // Rows of axes, with the impulses that they carry: what a row of the block has is their sum.
    void find_axes() {
        axes_.clear();
        for (uint32_t b = 0; b < sys_.rows.block.size(); ++b) {
            const RowBlock& block = sys_.rows.block[b];
            for (int r = 0; block.axis && r < block.type->rows; ++r) {
                if (block.locked(r)) continue;
                const size_t at = block.row + static_cast<size_t>(r);
                double& sum = sys_.rows.impulse[at] = 0;
                for_each_axis_row(block, r, sys_.rows.error[at], sys_.h, [&](const AxisRow& axis) {
                    axes_.push_back({axis, b, r, 0, sys_.h * static_cast<double>(*axis.force), 0});
                    gear(sys_, block, r, axes_.back().axis);
                    sum += axis.sign * axes_.back().impulse;
                });
            }
        }
    }

    void prepare(AxisIterate& axis) {
        const RowBlock& block = block_of(axis);
        double split = 0;
        for (int n = 0; n < block.type->nodes; ++n)
            split += count_[block.node[n]] *
                     inverse_mass_along(sys_.sweep[block.node[n]].mass, row_of(sys_, block, n, axis.row));
        axis.inverse = split > 0 ? 1 / (split + axis.axis.compliance) : 0;
    }

    // Inverse of the split diagonal, and the compliance c that the biased phase gives the block: physical, or a soft
    // row's share of its own effective mass (see soft_contact.h).
    void prepare(const RowBlock& block) {
        const int rows = block.type->rows;
        RowMatrix split = RowMatrix::Zero(rows, rows), own = split;
        for (int n = 0; n < block.type->nodes; ++n) {
            const RowMatrix s = effective_mass(sys_, block, n);
            own += s;
            split += count_[block.node[n]] * s;
        }
        RowMatrix softness = soft_.impulse_scale / soft_.mass_scale * own;
        if (block.elastic(0)) softness = compliance_of(block, sys_.h);
        if (block.type->bound != Bound::free) {
            split = uncoupled(split);
            const double of_normal = block.type->bound == Bound::cone && !block.hits ? softness(0, 0) : 0.0;
            softness.setZero();
            softness(0, 0) = of_normal;
        }
        split.diagonal().array() += 1e-12 * split.trace();
        for (int r = 0; r < rows; ++r) {  // rows that are not locked stay out
            if (block.locked(r)) continue;
            split.row(r).setZero();
            split.col(r).setZero();
            softness.row(r).setZero();
            softness.col(r).setZero();
            split(r, r) = 1;
        }
        const RowMatrix inverse = (split + softness).inverse();
        inverse_.insert(inverse_.end(), inverse.data(), inverse.data() + rows * rows);
        softness_.insert(softness_.end(), softness.data(), softness.data() + rows * rows);
    }

    // Above the matrix of a normal and its tangents, or of spinning and rolling: twice what does not couple the two
    // (Cauchy and Schwarz), and the same for either of the second, so that projection onto their circle keeps the slip
    // opposed to the friction.
    static RowMatrix uncoupled(const RowMatrix& s) {
        const double larger = 0.5 * (s(1, 1) + s(2, 2)) + std::hypot(0.5 * (s(1, 1) - s(2, 2)), s(1, 2));
        RowMatrix out = RowMatrix::Zero(3, 3);
        out.diagonal() << 2 * s(0, 0), 2 * larger, 2 * larger;
        return out;
    }

    // One iteration; true if the momentum pointed against the descent.
    bool advance(double beta, Phase phase) {
        size_t at = 0;
        double alignment = 0;
        Array<double>& impulse = sys_.rows.impulse;
        for (const RowBlock& block : sys_.rows.block) {
            const int rows = block.type->rows;
            const Eigen::Map<const RowVector> now(&impulse[block.row], rows), before(&previous_[block.row], rows);
            const Eigen::Map<const RowMatrix> inverse(&inverse_[at], rows, rows), softness(&softness_[at], rows, rows);
            at += static_cast<size_t>(rows * rows);
            const RowVector r = residual(block, now, softness, phase);
            alignment += r.dot(now - before);
            RowVector next = now - inverse * r + beta * (now - before);
            for (int row = 0; row < rows; ++row)
                if (!block.locked(row)) next[row] = now[row];
            project(block, next);
            Eigen::Map<RowVector>(&next_[block.row], rows) = next;
        }
        for (AxisIterate& axis : axes_) alignment += advance(axis, beta, phase);
        for (const RowBlock& block : sys_.rows.block)
            push(block, Eigen::Map<const RowVector>(&next_[block.row], block.type->rows) - impulse_of(sys_, block));
        previous_ = impulse;
        impulse = next_;
        return alignment > 0;
    }

    // Of an axis: onto what its block's row has next. The alignment of momentum and residual.
    double advance(AxisIterate& axis, double beta, Phase phase) {
        const double step = axis.impulse - axis.previous, r = residual(axis, phase);
        const double next = std::clamp(axis.impulse - axis.inverse * r + beta * step,
                                       axis.axis.stop ? 0.0 : -axis.axis.limit, axis.axis.limit);
        next_[block_of(axis).row + static_cast<uint32_t>(axis.row)] += axis.axis.sign * (next - axis.impulse);
        axis.previous = std::exchange(axis.impulse, next);
        return r * step;
    }

    double residual(const AxisIterate& iterate, Phase phase) const {
        const RowBlock& block = block_of(iterate);
        const AxisRow& axis = iterate.axis;
        double speed = 0;
        for (int n = 0; n < block.type->nodes; ++n) {
            const Velocity& u = sys_.exact[block.node[n]];
            const double* j = row_of(sys_, block, n, iterate.row);
            speed += Vec3::Map(j).dot(u.v) + Vec3::Map(j + 3).dot(u.w);
        }
        double target = phase == Phase::biased ? axis.target : axis.relaxed_target;
        if (axis.stop && !axis.physical && axis.gap <= 0 && phase == Phase::biased)
            target = std::min<double>(soft_.push, -soft_.bias_rate * axis.gap);
        return axis.sign * speed - target + axis.compliance * iterate.impulse;
    }

    void project(const RowBlock& block, RowVector& mu) const {
        if (block.type->bound == Bound::load) {  // its contact points went before
            double load = 0;
            for (uint32_t k = 0; k < block.loads; ++k) load += next_[block.loaded + 3 * k];
            mu[0] = std::clamp(mu[0], -block.arm[0] * load, block.arm[0] * load);
            limit_circle(mu, block.arm[1] * load);
            return;
        }
        if (block.type->bound != Bound::cone) return;
        mu[0] = std::max(0.0, mu[0]);
        limit_circle(mu, block.friction * mu[0]);
    }

    static void limit_circle(RowVector& mu, double limit) {
        const double size = std::sqrt(mu[1] * mu[1] + mu[2] * mu[2]);
        if (size > limit) mu.tail(2) *= limit / size;
    }

    RowVector residual(const RowBlock& block, const RowVector& mu, const RowMatrix& softness, Phase phase) const {
        RowVector r = RowVector::Zero(block.type->rows);
        for (int n = 0; n < block.type->nodes; ++n) {
            NodeVector v;
            v << sys_.exact[block.node[n]].v, sys_.exact[block.node[n]].w;
            r += jacobian_of(sys_, block, n) * v;
        }
        for (int row = 0; row < block.type->rows; ++row)
            if (!block.locked(row)) r[row] = 0;
        const RowVector error = error_of(sys_, block);
        if (block.type->bound == Bound::load) return r;
        if (block.type->bound == Bound::cone) {  // only the normal row has a position to reach
            const double gap = error[0];
            r[1] -= block.drive[0];
            r[2] -= block.drive[1];
            if (gap > 0)
                r[0] += gap * soft_.inv_h;
            else if (phase == Phase::biased)
                r[0] += std::max<double>(soft_.bias_rate * gap, -soft_.push) + softness(0, 0) * mu[0];
            return r;
        }
        if (block.elastic(0)) return r + error_rate_of(sys_, block) + softness * mu;
        if (phase == Phase::biased) return r + soft_.bias_rate * error + softness * mu;
        return r;
    }

    void push(const RowBlock& block, const RowVector& impulse) {
        for (int n = 0; n < block.type->nodes; ++n) {
            const uint32_t node = block.node[n];
            const NodeVector dv = response(sys_.sweep[node].mass, jacobian_of(sys_, block, n).transpose() * impulse);
            sys_.exact[node].v += dv.head<3>();
            sys_.exact[node].w += dv.tail<3>();
        }
    }

    System& sys_;
    Array<uint32_t>& count_;             // row blocks on each node
    Array<double>&inverse_, &softness_;  // rows x rows a block
    Array<double>&previous_, &next_;     // impulses
    Array<AxisIterate>& axes_;
    SweepTerms soft_;
};

uint32_t iterations(const Substep& s) { return s.settings.sweeps ? s.settings.sweeps : kDefaultIterations; }

void solve(Substep& s) {
    Iteration iteration(s);
    iteration.apply_all();
    iteration.run(iterations(s), Phase::biased);
    iteration.store_forces();
}

void relax(Substep& s) {
    Iteration iteration(s);
    iteration.run(iterations(s), Phase::relaxed);
    iteration.store_axes();
}

}  // namespace

const Solver kAcceleratedJacobi{"accelerated_jacobi", false, false, solve, nullptr, relax};

}  // namespace taut
