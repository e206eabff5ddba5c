// Sweeps over row blocks: contacts and rolling frictions that are in no lanes, one by one.
#include "solvers/row_sweep.h"

#include <Eigen/LU>
#include <algorithm>

#include "constraints/soft_contact.h"
#include "system/operators.h"
#include "system/project.h"

namespace taut {
namespace {

NodeVector velocity_of(const SweepVelocity& u) {
    NodeVector v;
    v << u.v[0], u.v[1], u.v[2], u.w[0], u.w[1], u.w[2];
    return v;
}

// One row block and what of the system it touches.
class RowSweep {
public:
    RowSweep(System& system, const RowBlock& block) : system_(system), block_(block), rows_(block.type->rows) {}

    void apply(const RowVector& impulse) {
        for (int i = 0; i < block_.type->nodes; ++i) {
            const uint32_t node = block_.node[i];
            if (!(system_.sweep[node].mass.inv_mass > 0)) continue;  // others read it
            const NodeVector dv = response(system_.sweep[node], jacobian(i).transpose() * impulse);
            SweepVelocity& u = system_.sweep[node].velocity;
            for (int k = 0; k < 3; ++k) {
                u.v[k] += static_cast<float>(dv[k]);
                u.w[k] += static_cast<float>(dv[3 + k]);
            }
        }
    }
    RowVector velocity() const {  // J v
        return rates(system_, block_, [&](uint32_t node) { return velocity_of(system_.sweep[node].velocity); });
    }
    RowMatrix effective() const {  // J W J^T
        RowMatrix s = RowMatrix::Zero(rows_, rows_);
        for (int i = 0; i < block_.type->nodes; ++i) s += effective_mass(system_, block_, i);
        return s;
    }
    double inverse_mass(int r) const {
        double sum = 0;
        for (int i = 0; i < block_.type->nodes; ++i)
            sum += inverse_mass_along(system_.sweep[block_.node[i]], row_of(system_, block_, i, r));
        return sum;
    }
    RowVector impulse() const { return impulse_of(system_, block_); }
    void move_to(const RowVector& next) {
        apply(next - impulse());
        Eigen::Map<RowVector>(&system_.rows.impulse[block_.row], rows_) = next;
    }

    // Normal row first, then the tangents on the cone; what is hit answers for what these do to its normal row. As in
    // the fused sweep (constraints/contact_sweep.inl).
    void solve_cone(const SweepTerms& soft, bool biased) {
        const double gap = system_.rows.error[block_.row];
        const RowMatrix s = effective();
        if (!(inverse_mass(0) > 0)) return;  // neither end moves
        RowVector p = impulse();
        const bool open = gap > 0;
        const double bias = open ? gap * soft.inv_h : biased ? std::max<double>(soft.bias_rate * gap, -soft.push) : 0.0;
        const bool softened = biased && !open && !block_.hits;
        const double step = (softened ? soft.mass_scale : 1.0) / s(0, 0) * (velocity()[0] + bias) +
                            (softened ? soft.impulse_scale : 0.0) * p[0];
        const double asked = p[0] - step;
        const Eigen::Vector2d before = p.tail<2>();
        p[0] = std::max(0.0, asked);
        move_to(p);

        solve_circle(s, block_.friction * p[0]);
        if (!(biased && block_.hits)) return;
        p = impulse();
        p[0] = std::max(0.0, asked - s.row(0).tail<2>().dot(p.tail<2>() - before) / s(0, 0));
        move_to(p);
    }

    // Spinning first, then rolling on its circle.
    void solve_load() {
        const RowMatrix s = effective();
        if (!(s(0, 0) > 0)) return;  // both bodies stand still
        double load = 0;
        for (uint32_t k = 0; k < block_.loads; ++k) load += system_.rows.impulse[block_.loaded + 3 * k];
        RowVector p = impulse();
        const double limit = block_.arm[0] * load;
        p[0] = std::clamp(p[0] - velocity()[0] / s(0, 0), -limit, limit);
        move_to(p);
        solve_circle(s, block_.arm[1] * load);
    }

private:
    // Rows 1 and 2 towards no slip on a circle; isotropic where they slide.
    void solve_circle(const RowMatrix& s, double limit) {
        RowVector p = impulse();
        const RowVector v = velocity();
        const Eigen::Matrix2d k = s.bottomRightCorner<2, 2>();
        if (!(inverse_mass(1) > 0) && !(inverse_mass(2) > 0)) return;
        const Eigen::Vector2d slip(v[1] - block_.drive[0], v[2] - block_.drive[1]), old(p[1], p[2]);
        const double largest = largest_across(s);
        // Locked axes may leave one direction alone.
        const bool flat = has_locks() && !(k.determinant() > static_cast<double>(kLeastFree) * largest * largest);
        Eigen::Vector2d q = flat ? Eigen::Vector2d(old - slip / largest) : Eigen::Vector2d(old - k.inverse() * slip);
        if (q.norm() > limit) q = old - slip / largest;
        double t[2] = {q[0], q[1]};
        project_disc(t, limit);
        p[1] = t[0];
        p[2] = t[1];
        move_to(p);
    }

    bool has_locks() const {
        return std::any_of(block_.node, block_.node + block_.type->nodes,
                           [&](uint32_t node) { return system_.sweep[node].held(); });
    }
    Eigen::Map<const RowJacobian> jacobian(int node) const { return jacobian_of(system_, block_, node); }

    System& system_;
    const RowBlock& block_;
    int rows_;
};

}  // namespace

void warm_start_rows(Substep& s, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; ++i) {
        RowSweep row(s.system, s.system.rows.block[i]);
        row.apply(row.impulse());
    }
}

void sweep_rows(Substep& s, uint32_t first, uint32_t count, bool biased) {
    const SweepTerms soft = contact_terms(s.system.scheme.h, s.system.stretch);
    for (uint32_t i = first; i < first + count; ++i) {
        const RowBlock& block = s.system.rows.block[i];
        RowSweep row(s.system, block);
        if (block.type->bound == Bound::cone)
            row.solve_cone(soft, biased);
        else
            row.solve_load();
    }
}

}  // namespace taut
