// Projected Gauss-Seidel by colour: joints and contacts in lanes, what is neither as rows.
#include "solvers/projected_gauss_seidel.h"

#include <Eigen/LU>
#include <algorithm>

#include "system/assemble.h"
#include "system/colour_stages.h"
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

// What a pass over joints, rows and contacts is made of, in order: lane groups of a colour, which share no moving node,
// so that threads may take them side by side; those of the overflow colour, the last, and rows go one by one. Small
// colours one after the other are a stage of one thread: another would help less than it takes to wait for it.
struct PassStages {
    enum What : uint8_t { joints, rows, contacts };
    struct Piece {
        What what;
        uint32_t first, count;
    };
    Piece piece[Team::kMaxStages];
    uint32_t first_piece[Team::kMaxStages + 1] = {};
    Team::Stage stage[Team::kMaxStages];
    uint32_t count = 0, pieces = 0, groups = 0;
    bool last_is_small = false;
    static_assert(2 * kMaxColours + 1 <= Team::kMaxStages);

    void add(Piece next, uint32_t grain, bool small) {
        if (!(small && last_is_small)) stage[count++] = small ? Team::Stage{1, 1} : Team::Stage{next.count, grain};
        piece[pieces++] = next;
        first_piece[count] = pieces;
        last_is_small = small;
    }
    template <class Lanes>
    void add_colours(What what, const Lanes& lanes, bool backward, uint32_t threads) {
        if (lanes.group.empty()) return;
        constexpr uint32_t kSmall = 3;  // lane groups
        for (uint32_t k = 0; k < kMaxColours; ++k) {
            const uint32_t c = backward ? kMaxColours - 1 - k : k;
            const auto [first, colour] = colour_stage(lanes, c, threads);
            const bool one_by_one = c + 1 == kMaxColours || colour.count <= kSmall;
            if (colour.count > 0) add({what, first, colour.count}, colour.grain, one_by_one);
            groups += colour.count;
        }
    }
    bool whole(uint32_t i) const {  // run by one thread
        return stage[i].count == 1;
    }
};

// joints(begin, end) over the lane groups of joints, rows(), then contacts(begin, end), colour by colour, those of
// contacts backward if asked.
template <class Joints, class Rows, class Contacts>
void pass(Substep& s, Joints&& joints, Rows&& rows, Contacts&& contacts, bool backward = false) {
    PassStages of;
    of.add_colours(PassStages::joints, s.system.joints, false, s.team.size());
    if (s.system.rows.lasting > s.system.rows.joints) of.add({PassStages::rows, 0, 1}, 1, true);
    of.add_colours(PassStages::contacts, s.system.contacts, backward, s.team.size());
    const auto run_piece = [&](PassStages::What what, uint32_t begin, uint32_t end) {
        if (what == PassStages::joints) joints(begin, end);
        if (what == PassStages::rows) rows();
        if (what == PassStages::contacts) contacts(begin, end);
    };
    const auto run = [&](uint32_t i, uint32_t begin, uint32_t end) {
        const PassStages::Piece* const first = of.piece + of.first_piece[i];
        if (!of.whole(i)) return run_piece(first->what, first->first + begin, first->first + end);
        for (auto piece = first; piece != of.piece + of.first_piece[i + 1]; ++piece)
            run_piece(piece->what, piece->first, piece->first + piece->count);
    };
    if (of.groups >= kFewGroups) return s.team.for_stages({of.stage, of.count}, run);
    for (uint32_t i = 0; i < of.count; ++i) run(i, 0, of.stage[i].count);
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
    for (uint32_t i = first; i < first + count; ++i) {
        const RowBlock& block = s.system.rows.block[i];
        RowSweep row(s.system, block);
        if (block.type->bound == Bound::cone)
            row.solve_cone(soft, biased);
        else
            row.solve_load();
    }
}

namespace {

// What the kernels work on, and the passes over it.
struct Swept {
    Substep& s;
    JointView joints;
    LaneView contacts;
    SweepVelocity* velocity;
    const SweepMass* mass;
    uint32_t first_row, row_count;
    SweepTerms soft;

    explicit Swept(Substep& substep)
        : s(substep),
          joints(s.system.joints.view()),
          contacts(s.system.contacts.view()),
          velocity(s.system.velocity.data()),
          mass(s.system.inverse_mass.data()),
          first_row(s.system.rows.joints),
          row_count(s.system.rows.lasting - s.system.rows.joints),
          soft(contact_terms(s.system.h)) {
        contacts.shared = s.team.size() > 1;
    }

    void warm_start() const {
        pass(
            s,
            [&](uint32_t begin, uint32_t end) {
                s.settings.joint_kernels->warm_start(joints, begin, end, velocity, mass);
            },
            [&] { warm_start_rows(s, first_row, row_count); },
            [&](uint32_t begin, uint32_t end) {
                s.settings.kernels->warm_start(contacts, begin, end, velocity, mass);
            });
    }
    // first: of the substep, which measures the gaps.
    void sweep_biased(bool first) const {
        const SweepTerms stiff = joint_terms(s.system.h);
        const SweepShift* const shifts = first ? s.system.shift.data() : nullptr;
        pass(
            s,
            [&](uint32_t begin, uint32_t end) {
                s.settings.joint_kernels->sweep_biased(joints, begin, end, velocity, mass, stiff);
            },
            [&] { sweep_rows(s, first_row, row_count, true); },
            [&](uint32_t begin, uint32_t end) {
                s.settings.kernels->sweep_biased(contacts, begin, end, velocity, mass, shifts, soft);
            },
            s.corrects_backward);
    }
    void sweep_relaxed() const {
        pass(
            s,
            [&](uint32_t begin, uint32_t end) {
                s.settings.joint_kernels->sweep_relaxed(joints, begin, end, velocity, mass);
            },
            [&] { sweep_rows(s, first_row, row_count, false); },
            [&](uint32_t begin, uint32_t end) {
                s.settings.kernels->sweep_relaxed(contacts, begin, end, velocity, mass, soft);
            },
            s.relaxes_backward);
    }
    void restitute() const {
        pass(
            s, [](uint32_t, uint32_t) {}, [] {},
            [&](uint32_t begin, uint32_t end) {
                s.settings.kernels->restitute(contacts, begin, end, velocity, mass, kBounceSpeed, s.last);
            });
    }
};

}  // namespace

void warm_start_sweeps(Substep& s) { Swept(s).warm_start(); }

void sweep_biased(Substep& s) {
    const uint32_t sweeps = s.settings.sweeps ? s.settings.sweeps : s.group.sweeps;
    const Swept swept(s);
    for (uint32_t i = 0; i < sweeps; ++i) swept.sweep_biased(i == 0);
    publish(s);
}

void sweep_relaxed(Substep& s) {
    const Swept swept(s);
    for (uint32_t i = 0; i < kRelaxSweeps; ++i) swept.sweep_relaxed();
    if (s.system.contacts.bounces) swept.restitute();
    if (s.last) bounce_rows(s, swept.first_row, swept.row_count);
    publish(s);
}

const Solver kProjectedGaussSeidel{"projected_gauss_seidel", false, true, solve, nullptr, relax};

}  // namespace taut
