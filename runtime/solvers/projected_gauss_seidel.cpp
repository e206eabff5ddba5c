// Projected Gauss-Seidel by colour: joints and contacts in lanes, what is neither as rows.
#include "solvers/projected_gauss_seidel.h"

#include <Eigen/LU>
#include <algorithm>

#include "system/assemble.h"
#include "system/row_algebra.h"
#include "system/soft_contact.h"

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
            const NodeVector dv = response(system_.inverse_mass[node], jacobian(i).transpose() * impulse);
            SweepVelocity& u = system_.velocity[node];
            for (int k = 0; k < 3; ++k) {
                u.v[k] += static_cast<float>(dv[k]);
                u.w[k] += static_cast<float>(dv[3 + k]);
            }
        }
    }
    RowVector velocity() const {  // J v
        RowVector v = RowVector::Zero(rows_);
        for (int i = 0; i < block_.type->nodes; ++i) v += jacobian(i) * velocity_of(system_.velocity[block_.node[i]]);
        return v;
    }
    RowMatrix effective() const {  // J W J^T
        RowMatrix s = RowMatrix::Zero(rows_, rows_);
        for (int i = 0; i < block_.type->nodes; ++i) s += effective_mass(system_, block_, i);
        return s;
    }
    RowVector impulse() const { return impulse_of(system_, block_); }
    void move_to(const RowVector& next) {
        apply(next - impulse());
        Eigen::Map<RowVector>(&system_.rows.impulse[block_.row], rows_) = next;
    }

    // Normal row first, then the tangents on the cone; as in the fused sweep (constraints/contact_sweep.inl).
    void solve_cone(const SweepTerms& soft, bool biased) {
        const double gap = system_.rows.error[block_.row];
        const RowMatrix s = effective();
        RowVector p = impulse();
        const bool open = gap > 0;
        const double bias = open ? gap * soft.inv_h : biased ? std::max<double>(soft.bias_rate * gap, -soft.push) : 0.0;
        const bool softened = biased && !open;
        const double step = (softened ? soft.mass_scale : 1.0) / s(0, 0) * (velocity()[0] + bias) +
                            (softened ? soft.impulse_scale : 0.0) * p[0];
        p[0] = std::max(0.0, p[0] - step);
        move_to(p);

        solve_circle(s, block_.friction * p[0]);
    }

    // What was hit leaves at the speed that its restitution asks for; as in the fused sweep.
    void bounce() {
        RowVector p = impulse();
        if (!(block_.bounce > 0 && p[0] > 0)) return;
        p[0] = std::max(0.0, p[0] + (block_.bounce - velocity()[0]) / effective()(0, 0));
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
        const Eigen::Vector2d slip(v[1] - block_.drive[0], v[2] - block_.drive[1]), old(p[1], p[2]);
        Eigen::Vector2d q = old - k.inverse() * slip;
        if (q.norm() > limit) {
            const double half = 0.5 * k.trace(), diff = 0.5 * (k(0, 0) - k(1, 1));
            q = old - slip / (half + std::sqrt(diff * diff + k(0, 1) * k(0, 1)));
            if (q.norm() > limit) q *= limit / q.norm();
        }
        p[1] = q[0];
        p[2] = q[1];
        move_to(p);
    }

    Eigen::Map<const RowJacobian> jacobian(int node) const { return jacobian_of(system_, block_, node); }

    System& system_;
    const RowBlock& block_;
    int rows_;
};

// run(begin, end) over the lane groups of colour after colour. Those of one colour share no moving node, so that
// threads may take them side by side; the overflow colour, the last, goes one by one.
template <class Lanes, class Run>
void for_colours(Substep& s, const Lanes& lanes, Run&& run) {
    constexpr uint32_t kGrain = 16;  // lane groups, about 3 us
    const uint32_t all = static_cast<uint32_t>(lanes.group.size());
    if (s.team.size() == 1 || all < 2 * kGrain) {
        run(0u, all);
        return;
    }
    for (uint32_t c = 0; c + 1 < kMaxColours; ++c) {
        const uint32_t first = lanes.colour_begin[c], count = lanes.colour_begin[c + 1] - first;
        s.team.for_ranges(count, kGrain, [&](uint32_t begin, uint32_t end) { run(first + begin, first + end); });
    }
    if (lanes.colour_begin[kMaxColours - 1] < all) run(lanes.colour_begin[kMaxColours - 1], all);
}

// What the sweeps changed becomes part of the solution, except where a direct solve owns it.
void publish(Substep& s) {
    constexpr uint32_t kGrain = 256;  // nodes
    s.team.for_ranges(static_cast<uint32_t>(s.group.nodes.size()), kGrain, [&](uint32_t begin, uint32_t end) {
        for (uint32_t i = begin; i < end; ++i) {
            const uint32_t node = s.group.nodes[i];
            if (s.system.in_block[node + 1]) continue;
            const SweepVelocity& u = s.system.velocity[node + 1];
            Velocity& exact = s.system.exact[node + 1];
            for (int k = 0; k < 3; ++k) {
                exact.v[k] += static_cast<double>(u.v[k] - static_cast<float>(exact.v[k]));
                exact.w[k] += static_cast<double>(u.w[k] - static_cast<float>(exact.w[k]));
            }
        }
    });
}

void bounce_rows(Substep& s, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; ++i) {
        const RowBlock& block = s.system.rows.block[i];
        if (block.type->bound == Bound::cone) RowSweep(s.system, block).bounce();
    }
}

void solve(Substep& s) {
    warm_start_sweeps(s);
    sweep_biased(s);
}

void relax(Substep& s) { sweep_relaxed(s); }

}  // namespace

void warm_start_rows(Substep& s, uint32_t first, uint32_t count) {
    for (uint32_t i = first; i < first + count; ++i) {
        RowSweep row(s.system, s.system.rows.block[i]);
        row.apply(row.impulse());
    }
}

void sweep_rows(Substep& s, uint32_t first, uint32_t count, bool biased) {
    const SweepTerms soft = contact_terms(s.system.h);
    const auto& blocks = s.system.rows.block;
    for (uint32_t i = first; i < first + count; ++i) {
        RowSweep row(s.system, blocks[i]);
        if (blocks[i].type->bound == Bound::cone)
            row.solve_cone(soft, biased);
        else
            row.solve_load();
    }
}

void warm_start_sweeps(Substep& s) {
    const auto velocity = s.system.velocity.data();
    const auto mass = s.system.inverse_mass.data();
    JointLanes& joints = s.system.joints;
    ContactLanes& contacts = s.system.contacts;
    for_colours(s, contacts, [&](uint32_t begin, uint32_t end) {
        s.settings.kernels->warm_start(contacts.view(), begin, end, velocity, mass);
    });
    for_colours(s, joints, [&](uint32_t begin, uint32_t end) {
        s.settings.joint_kernels->warm_start(joints.view(), begin, end, velocity, mass);
    });
    const Rows& rows = s.system.rows;
    warm_start_rows(s, rows.joints, rows.lasting - rows.joints);
}

void sweep_biased(Substep& s) {
    const uint32_t sweeps = s.settings.sweeps ? s.settings.sweeps : s.group.sweeps;
    const auto velocity = s.system.velocity.data();
    const auto mass = s.system.inverse_mass.data();
    JointLanes& joints = s.system.joints;
    ContactLanes& contacts = s.system.contacts;
    const Rows& rows = s.system.rows;
    const SweepTerms soft = contact_terms(s.system.h);
    for (uint32_t i = 0; i < sweeps; ++i) {
        for_colours(s, joints, [&](uint32_t begin, uint32_t end) {
            s.settings.joint_kernels->sweep_biased(joints.view(), begin, end, velocity, mass, joint_terms(s.system.h));
        });
        sweep_rows(s, rows.joints, rows.lasting - rows.joints, true);
        for_colours(s, contacts, [&](uint32_t begin, uint32_t end) {
            s.settings.kernels->sweep_biased(contacts.view(), begin, end, velocity, mass, s.system.shift.data(), soft);
        });
    }
    publish(s);
}

void sweep_relaxed(Substep& s) {
    const auto velocity = s.system.velocity.data();
    const auto mass = s.system.inverse_mass.data();
    JointLanes& joints = s.system.joints;
    ContactLanes& contacts = s.system.contacts;
    const Rows& rows = s.system.rows;
    const SweepTerms soft = contact_terms(s.system.h);
    for (uint32_t i = 0; i < kRelaxSweeps; ++i) {
        for_colours(s, joints, [&](uint32_t begin, uint32_t end) {
            s.settings.joint_kernels->sweep_relaxed(joints.view(), begin, end, velocity, mass);
        });
        sweep_rows(s, rows.joints, rows.lasting - rows.joints, false);
        for_colours(s, contacts, [&](uint32_t begin, uint32_t end) {
            s.settings.kernels->sweep_relaxed(contacts.view(), begin, end, velocity, mass, soft);
        });
    }
    if (contacts.bounces)
        for_colours(s, contacts, [&](uint32_t begin, uint32_t end) {
            s.settings.kernels->restitute(contacts.view(), begin, end, velocity, mass, kBounceSpeed, s.last);
        });
    if (s.last) bounce_rows(s, rows.joints, rows.lasting - rows.joints);
    publish(s);
}

const Solver kProjectedGaussSeidel{"projected_gauss_seidel", false, true, solve, nullptr, relax};

}  // namespace taut
