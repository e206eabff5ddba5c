// Direct solve of blocks (joint-connected nodes), contacts by coloured sweeps around it.
//
//   [ M + h^2 K   -J^T ] [v+]   [ M v* + contact impulses + h^2 K s ]     (Tournier et al. 2015, eq. 21,
//   [ -J          -c   ] [mu] = [ -target                           ]      s instead of 0: only fast motion is damped)
//
// K is formed from the force lambda of the last substep. Where a force grew by more than 30 % the block is solved
// once more with K(old) + K(new), which is never too soft; a block's first substep is solved twice, with K(new).
// A block that gains energy is solved without s and twice for a while: see energy_guard.cpp.
#include <algorithm>

#include "base/clock.h"
#include "solvers/energy_guard.h"
#include "solvers/projected_gauss_seidel.h"
#include "system/row_algebra.h"

namespace taut {
namespace {

constexpr double kGrowth = 1.3;           // of a force, above which K is formed again
constexpr double kNegligible = 1e-3;      // of the block's largest force: smaller ones do not count
constexpr double kLoopCompliance = 1e-7;  // of a row's own effective inverse mass: makes redundant loops solvable

// A light chain that whips turns so far in a substep that its straight steps leave the joints open. Where the gap
// exceeds this part of the lever, positions (not velocities) are projected once more on the same factor. Heavy loads
// do not whip, and there the projection disturbs the tension that K was formed from (measured: 2 of 16 starts lost).
constexpr double kSettleGap = 4e-3;
constexpr double kSettleMassRatio = 100;

constexpr int kLd = kDof;

class BlockSolve {
public:
    BlockSolve(Substep& s, Block& b) : s_(s), sys_(s.system), b_(b), nodes_(static_cast<uint32_t>(b.nodes.size())) {}

    void analyse();
    // Factor at this substep's poses and solve from the unconstrained velocity; twice where the force demands it.
    bool solve_first();
    // Same factor, with what contacts have changed since.
    void solve_again();
    void finish();
    // Displacements that close the joints at the moved positions; false if they are closed well enough.
    bool settle();

private:
    const RowBlock& row(uint32_t j) const { return sys_.rows.block[b_.first_row_block + j]; }
    uint32_t joints() const { return static_cast<uint32_t>(b_.joints.size()); }
    uint32_t local(uint32_t sweep_node) const {  // position in b_.nodes, or kNone
        if (!sys_.in_block[sweep_node]) return kNone;
        const auto at = std::lower_bound(b_.nodes.begin(), b_.nodes.end(), sweep_node - 1);
        return static_cast<uint32_t>(at - b_.nodes.begin());
    }
    int size_of(uint32_t i) const { return s_.nodes.info[b_.nodes[i]].kind == NodeKind::particle ? 3 : 6; }
    bool looped() const;

    void assemble(bool with_new);
    void add_mass(uint32_t i);
    void add_stiffness(const RowBlock& block, const double* force);
    void add_joint(uint32_t j);
    double loop_compliance(const RowBlock& block) const;
    void right_hand_side();
    void take_solution();
    bool force_grew() const;

    double* node_known(uint32_t i) { return &b_.known[i * kLd]; }
    double* joint_force(uint32_t j) { return &b_.force[j * kMaxRows]; }
    const double* joint_force(uint32_t j) const { return &b_.force[j * kMaxRows]; }

    Substep& s_;
    System& sys_;
    Block& b_;
    uint32_t nodes_;
};

void BlockSolve::analyse() {
    SparseBlockLdlt& matrix = b_.matrix;
    if (matrix.analysed()) return;
    matrix.begin(nodes_ + joints());
    for (uint32_t i = 0; i < nodes_; ++i) matrix.set_unknown(i, size_of(i), false);
    for (uint32_t j = 0; j < joints(); ++j) {
        const ConstraintType& type = *row(j).type;
        matrix.set_unknown(nodes_ + j, type.rows > 3 ? 6 : 3, true, type.rows);
        for (int n = 0; n < type.nodes; ++n) {
            const uint32_t i = local(row(j).node[n]);
            if (i == kNone) continue;
            matrix.link(nodes_ + j, i);
            for (int m = 0; m < n && type.couples_nodes; ++m) {
                const uint32_t k = local(row(j).node[m]);
                if (k != kNone) matrix.link(i, k);
            }
        }
    }
    b_.solution.resize((nodes_ + joints()) * kLd);
    b_.known.resize(nodes_ * kLd);
    b_.force.resize(joints() * kMaxRows);
    matrix.analyse();
    b_.looped = looped();
}

// More joints than a tree on the nodes (and the ground, where something is held) can have.
bool BlockSolve::looped() const {
    bool held = false;
    for (uint32_t j = 0; j < joints(); ++j)
        for (int n = 0; n < row(j).type->nodes; ++n) held = held || local(row(j).node[n]) == kNone;
    return joints() + 1 > nodes_ + (held ? 1u : 0u);
}

void BlockSolve::add_mass(uint32_t i) {
    const uint32_t node = b_.nodes[i];
    const double mass = s_.nodes.mass[node].mass;
    const double diagonal[9] = {mass, 0, 0, 0, mass, 0, 0, 0, mass};
    b_.matrix.add(i, i, diagonal, 3, 3, 3);
    if (size_of(i) == 6) b_.matrix.add(i, i, sys_.inertia[node + 1].data(), 3, 3, 3, 3, 3);
}

// h^2 K into the matrix and h^2 K s onto the known side.
void BlockSolve::add_stiffness(const RowBlock& block, const double* force) {
    const ConstraintType& type = *block.type;
    const int width = kDof * type.nodes;
    Pose poses[kMaxNodes];
    uint32_t at[kMaxNodes];
    double k[kDof * kMaxNodes * kDof * kMaxNodes], slow[kDof * kMaxNodes] = {};
    const bool spare = s_.settings.velocity_filter > 0 && b_.memory.guard_left == 0;
    for (int n = 0; n < type.nodes; ++n) {
        poses[n] = sys_.pose[block.node[n]];
        at[n] = local(block.node[n]);
        if (at[n] == kNone || !spare) continue;
        const NodeMotion& m = s_.nodes.motion[b_.nodes[at[n]]];
        Vec3::Map(slow + kDof * n) = m.slow_v;
        Vec3::Map(slow + kDof * n + 3) = m.slow_w;
    }
    type.stiffness(block.data, poses, force, Curvature::positive, k);
    const double hh = sys_.h * sys_.h;
    for (int i = 0; i < width * width; ++i) k[i] *= hh;
    for (int n = 0; n < type.nodes; ++n) {
        if (at[n] == kNone) continue;
        for (int m = 0; m <= n; ++m) {
            if (m != n && (!type.couples_nodes || at[m] == kNone)) continue;
            b_.matrix.add(at[n], at[m], k + kDof * n * width + kDof * m, size_of(at[n]), size_of(at[m]), width);
        }
        double* known = node_known(at[n]);
        for (int r = 0; r < kDof; ++r)
            for (int c = 0; c < width; ++c) known[r] += k[(kDof * n + r) * width + c] * slow[c];
    }
}

double BlockSolve::loop_compliance(const RowBlock& block) const {
    const double* jacobian = &sys_.rows.jacobian[block.jacobian];
    double trace = 0;
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t i = local(block.node[n]);
        if (i == kNone) continue;
        for (int r = 0; r < block.type->rows; ++r, jacobian += kDof)
            trace += s_.nodes.mass[b_.nodes[i]].inv_mass * Vec3::Map(jacobian).squaredNorm();
    }
    return kLoopCompliance * trace / block.type->rows;
}

void BlockSolve::add_joint(uint32_t j) {
    const RowBlock& block = row(j);
    const int rows = block.type->rows, padded = rows > 3 ? 6 : 3;
    const double* jacobian = &sys_.rows.jacobian[block.jacobian];
    for (int n = 0; n < block.type->nodes; ++n, jacobian += rows * kDof) {
        const uint32_t i = local(block.node[n]);
        if (i == kNone) continue;
        double minus[kMaxRows * kDof];
        for (int e = 0; e < rows * kDof; ++e) minus[e] = -jacobian[e];
        b_.matrix.add(nodes_ + j, i, minus, rows, size_of(i), kDof);
    }
    RowMatrix c = compliance_of(block, sys_.h);
    if (b_.looped) c.diagonal() = c.diagonal().cwiseMax(loop_compliance(block));
    double diagonal[kMaxRows * kMaxRows] = {};
    for (int r = 0; r < padded; ++r) diagonal[r * padded + r] = -1;  // unused rows: mu = 0
    for (int r = 0; r < rows; ++r)
        for (int k = 0; k < rows; ++k) diagonal[r * padded + k] = -c(r, k);
    b_.matrix.add(nodes_ + j, nodes_ + j, diagonal, padded, padded, padded);
}

void BlockSolve::assemble(bool with_new) {
    b_.matrix.clear();
    std::fill(b_.known.begin(), b_.known.end(), 0.0);
    for (uint32_t i = 0; i < nodes_; ++i) add_mass(i);
    for (uint32_t j = 0; j < joints(); ++j) {
        const RowBlock& block = row(j);
        if (s_.settings.geometric_stiffness) {
            const bool old_counts = !block.fresh || b_.memory.solved > 0;
            if (old_counts && !(with_new && b_.memory.guard_left > 0)) add_stiffness(block, block.force);
            if (with_new) add_stiffness(block, joint_force(j));
        }
        add_joint(j);
    }
}

// M (v* + contact changes) + h^2 K s for nodes, -target for joints.
void BlockSolve::right_hand_side() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const uint32_t node = b_.nodes[i];
        double* x = &b_.solution[i * kLd];
        const Velocity& u = sys_.free[node + 1];
        Vec3::Map(x) = s_.nodes.mass[node].mass * u.v + Vec3::Map(node_known(i));
        Vec3::Map(x + 3).setZero();
        if (size_of(i) == 6) Vec3::Map(x + 3) = sys_.inertia[node + 1] * u.w + Vec3::Map(node_known(i) + 3);
    }
    for (uint32_t j = 0; j < joints(); ++j) {
        const RowBlock& block = row(j);
        const int rows = block.type->rows;
        double* x = &b_.solution[(nodes_ + j) * kLd];
        const double* jacobian = &sys_.rows.jacobian[block.jacobian];
        for (int r = 0; r < kLd; ++r)
            x[r] = r < rows ? row_terms(block, r, sys_.h).rate * sys_.rows.error[block.row + r] : 0.0;
        for (int n = 0; n < block.type->nodes; ++n, jacobian += rows * kDof) {
            if (block.node[n] == 0 || local(block.node[n]) != kNone) continue;
            const Velocity& u = sys_.exact[block.node[n]];  // a kinematic node: its velocity is known
            for (int r = 0; r < rows; ++r)
                x[r] += Vec3::Map(jacobian + r * kDof).dot(u.v) + Vec3::Map(jacobian + r * kDof + 3).dot(u.w);
        }
    }
}

void BlockSolve::take_solution() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const double* x = &b_.solution[i * kLd];
        sys_.exact[b_.nodes[i] + 1] = {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
    for (uint32_t j = 0; j < joints(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r) joint_force(j)[r] = b_.solution[(nodes_ + j) * kLd + r] / sys_.h;
}

bool BlockSolve::force_grew() const {
    double largest = 0;
    auto squared = [](const double* f, int rows) {
        double sum = 0;
        for (int r = 0; r < rows; ++r) sum += f[r] * f[r];
        return sum;
    };
    for (uint32_t j = 0; j < joints(); ++j) largest = std::max(largest, squared(joint_force(j), row(j).type->rows));
    for (uint32_t j = 0; j < joints(); ++j) {
        const double now = squared(joint_force(j), row(j).type->rows),
                     before = squared(row(j).force, row(j).type->rows);
        if (now > kGrowth * kGrowth * before && now > kNegligible * kNegligible * largest) return true;
    }
    return false;
}

bool BlockSolve::solve_first() {
    ++s_.report.solves;
    for (int pass = 0; pass < 2; ++pass) {
        assemble(pass > 0);
        if (!b_.matrix.factor()) return false;
        right_hand_side();
        b_.matrix.solve(b_.solution.data());
        take_solution();
        const bool again = b_.memory.solved == 0 || b_.memory.guard_left > 0 || force_grew();
        if (pass > 0 || !again || !s_.settings.geometric_stiffness) break;
        ++s_.report.resolves;
    }
    return true;
}

void BlockSolve::solve_again() {
    right_hand_side();
    b_.matrix.solve(b_.solution.data());
    take_solution();
}

void BlockSolve::finish() {
    for (uint32_t j = 0; j < joints(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r) {
            const double f = joint_force(j)[r];
            row(j).force[r] = f;
            sys_.rows.impulse[row(j).row + r] = sys_.h * f;
        }
    if (s_.settings.velocity_filter > 0 && s_.settings.geometric_stiffness) guard_energy(s_, b_);
    ++b_.memory.solved;
}

// The velocity that the sweeps left on a node of a block, relative to the one they were given: contact impulses.
void add_contact_changes(Substep& s, const Block& block) {
    for (uint32_t node : block.nodes) {
        const SweepVelocity& u = s.system.velocity[node + 1];
        const Velocity& given = s.system.exact[node + 1];
        Velocity& free = s.system.free[node + 1];
        for (int k = 0; k < 3; ++k) {
            free.v[k] += static_cast<double>(u.v[k] - static_cast<float>(given.v[k]));
            free.w[k] += static_cast<double>(u.w[k] - static_cast<float>(given.w[k]));
        }
    }
}

void give_to_sweeps(Substep& s, const Block& block) {
    for (uint32_t node : block.nodes) {
        SweepVelocity& u = s.system.velocity[node + 1];
        const Velocity& exact = s.system.exact[node + 1];
        for (int k = 0; k < 3; ++k) {
            u.v[k] = static_cast<float>(exact.v[k]);
            u.w[k] = static_cast<float>(exact.w[k]);
        }
    }
}

bool BlockSolve::settle() {
    bool open = false;
    std::fill(b_.solution.begin(), b_.solution.end(), 0.0);
    for (uint32_t j = 0; j < joints(); ++j) {
        const RowBlock& block = row(j);
        const int rows = block.type->rows;
        Pose poses[kMaxNodes];
        for (int n = 0; n < block.type->nodes; ++n) {
            poses[n] = sys_.pose[block.node[n]];
            if (local(block.node[n]) == kNone) continue;
            const NodeMotion& m = s_.nodes.motion[block.node[n] - 1];
            poses[n] = {m.x, m.q.toRotationMatrix()};
        }
        double* error = &b_.solution[(nodes_ + j) * kLd];
        block.type->evaluate(block.data, poses, error, nullptr);
        const double* jacobian = &sys_.rows.jacobian[block.jacobian];
        double lever = 0, gap = 0;
        for (int r = 0; r < rows; ++r) {
            if (block.elastic(r)) error[r] = 0;  // an elastic error is not a gap
            gap = std::max(gap, std::abs(error[r]));
        }
        for (int e = 0; e < block.type->nodes * rows; ++e)
            lever = std::max(lever, Vec3::Map(jacobian + e * kDof + 3).norm());
        open = open || (lever > 0 && gap > kSettleGap * lever);  // particles have no lever, and swing without this
    }
    if (!open) return false;
    b_.matrix.solve(b_.solution.data());
    for (uint32_t i = 0; i < nodes_; ++i) {
        const double* x = &b_.solution[i * kLd];
        sys_.correction[b_.nodes[i] + 1] = {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
    return true;
}

bool has_sweeps(const Substep& s) { return !s.system.contacts.group.empty(); }

void solve(Substep& s) {
    warm_start_sweeps(s);
    Stopwatch watch;
    for (uint32_t b : s.group.blocks) {
        Block& block = s.blocks[b];
        for (uint32_t node : block.nodes) s.system.free[node + 1] = s.system.exact[node + 1];
        add_contact_changes(s, block);
        BlockSolve solve(s, block);
        solve.analyse();
        block.failed = !solve.solve_first();
        if (block.failed) ++s.report.failures;
        give_to_sweeps(s, block);
    }
    s.report.direct_us += watch.lap();
    sweep_biased(s);
    watch.lap();
    for (uint32_t b : s.group.blocks) {
        Block& block = s.blocks[b];
        if (block.failed) continue;
        BlockSolve solve(s, block);
        if (has_sweeps(s)) {
            add_contact_changes(s, block);
            solve.solve_again();
            give_to_sweeps(s, block);
        }
        solve.finish();
    }
    s.report.direct_us += watch.lap();
}

void settle(Substep& s) {
    for (uint32_t b : s.group.blocks) {
        Block& block = s.blocks[b];
        block.corrected = !block.failed && block.mass_ratio <= kSettleMassRatio && BlockSolve(s, block).settle();
    }
}

void relax(Substep& s) {
    if (!has_sweeps(s)) return;
    sweep_relaxed(s);
    for (uint32_t b : s.group.blocks) {  // joints stay as solved; the contacts' push is taken back
        const Block& block = s.blocks[b];
        for (uint32_t node : block.nodes) s.system.free[node + 1] = s.system.exact[node + 1];
        add_contact_changes(s, block);
        for (uint32_t node : block.nodes) s.system.exact[node + 1] = s.system.free[node + 1];
    }
}

}  // namespace

const Solver kBlockLdlt{"block_ldlt", true, true, solve, settle, relax};

}  // namespace taut
