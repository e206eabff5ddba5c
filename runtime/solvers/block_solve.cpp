#include "solvers/block_solve.h"

#include <algorithm>

#include "solvers/energy_guard.h"

namespace taut {
namespace {

constexpr double kGrowth = 1.3;           // of a force, above which K is formed again
constexpr double kNegligible = 1e-3;      // of the block's largest force: smaller ones do not count
constexpr double kStiff = 1.0;            // h^2 K / M above which a force counts: symplectic steps hold 4 without any K
constexpr double kLoopCompliance = 1e-7;  // of a row's own effective inverse mass: makes redundant loops solvable

// A light chain that whips turns so far in a substep that its straight steps leave the joints open. Where the gap
// exceeds this part of the lever, positions (not velocities) are projected once more on the same factor. Heavy loads
// do not whip, and there the projection disturbs the tension that K was formed from (measured: 2 of 16 starts lost).
constexpr double kSettleGap = 4e-3;

constexpr int kLd = kDof;

int locked_rows(const RowBlock& block) {
    int count = 0;
    for (int r = 0; r < block.type->rows; ++r) count += block.locked(r);
    return count;
}

// sum += w a^T b, 6 x 6.
void add_product(const double* a, const double* b, double w, double* sum) {
    for (int r = 0; r < kDof; ++r) {
        const double scaled = w * a[r];
        for (int c = 0; c < kDof; ++c) sum[r * kDof + c] += scaled * b[c];
    }
}

}  // namespace

void BlockSolve::analyse() {
    SparseBlockLdlt& matrix = b_.matrix;
    if (matrix.analysed()) return;
    matrix.begin(nodes_ + joints());
    for (uint32_t i = 0; i < nodes_; ++i) matrix.set_unknown(i, size_of(i), false);
    for (uint32_t j = 0; j < joints(); ++j) {
        const ConstraintType& type = *row(j).type;
        matrix.set_unknown(nodes_ + j, type.rows > 3 ? 6 : 3, true, locked_rows(row(j)));
        for (int n = 0; n < type.nodes; ++n) {
            const uint32_t i = local(row(j).node[n]);
            if (i == kNone) continue;
            matrix.link(nodes_ + j, i);
            for (int m = 0; m < n && (type.couples_nodes || row(j).axis); ++m) {
                const uint32_t k = local(row(j).node[m]);
                if (k != kNone) matrix.link(i, k);
            }
        }
    }
    for (uint64_t link : b_.links)
        matrix.link(local(static_cast<uint32_t>(link >> 32) + 1), local(static_cast<uint32_t>(link) + 1));
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

// Angular velocity of a constraint's line, as its ends move now.
Vec3 BlockSolve::line_turn(const RowBlock& block, const Line& line) const {
    const Velocity &a = sys_.exact[block.node[0]], &b = sys_.exact[block.node[1]];
    const Vec3 apart = b.v + b.w.cross(line.lever_b) - a.v - a.w.cross(line.lever_a);
    return line.span.cross(apart) / line.span.squaredNorm();
}

// Slow velocities s of a row block's nodes. Rotations have their own; of a line between nodes only the motion of one
// end against the other matters to K: that of the low-passed turning of the line.
void BlockSolve::slow_velocities(const RowBlock& block, const Pose* poses, const uint32_t* at, double* slow) const {
    const ConstraintType& type = *block.type;
    for (int n = 0; n < type.nodes; ++n) {
        if (at[n] == kNone) continue;
        const NodeMotion& m = s_.nodes.motion[b_.nodes[at[n]]];
        if (!type.line) Vec3::Map(slow + kDof * n) = m.slow_v;
        Vec3::Map(slow + kDof * n + 3) = m.slow_w;
    }
    if (!type.line) return;
    const Line line = type.line(block.data, poses);
    const Vec3 wa = Vec3::Map(slow + 3), wb = Vec3::Map(slow + kDof + 3);
    const Vec3 apart = block.slow_turn->cross(line.span) + wa.cross(line.lever_a) - wb.cross(line.lever_b);
    // An end whose velocity is known moves as it does; K takes no part of it.
    if (at[1] != kNone)
        Vec3::Map(slow + kDof) = apart + (at[0] == kNone ? sys_.exact[block.node[0]].v : Vec3(Vec3::Zero()));
    else
        Vec3::Map(slow) = sys_.exact[block.node[1]].v - apart;
}

void BlockSolve::filter_lines() {
    for (uint32_t j = 0; j < joints(); ++j) {
        const RowBlock& block = row(j);
        if (!block.type->line) continue;
        const Pose poses[2] = {sys_.pose[block.node[0]], sys_.pose[block.node[1]]};
        const Vec3 turn = line_turn(block, block.type->line(block.data, poses));
        const bool first = block.fresh && b_.memory.solved == 0;
        *block.slow_turn += (first ? 1 : s_.settings.velocity_filter) * (turn - *block.slow_turn);
    }
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
    }
    if (spare) slow_velocities(block, poses, at, slow);
    type.stiffness(block.data, poses, force, Curvature::positive, k);
    const double hh = sys_.h * sys_.h;
    for (int n = 0; n < type.nodes; ++n) {
        if (at[n] == kNone) continue;
        double* known = node_known(at[n]);
        for (int m = 0; m < type.nodes; ++m) {
            if (at[m] == kNone || (m != n && !type.couples_nodes)) continue;
            double* block_nm = k + kDof * n * width + kDof * m;
            for (int r = 0; r < size_of(at[n]); ++r)
                for (int c = 0; c < size_of(at[m]); ++c) {
                    double& entry = block_nm[r * width + c];
                    entry *= hh;
                    known[r] += entry * slow[kDof * m + c];
                }
            if (m <= n) b_.matrix.add(at[n], at[m], block_nm, size_of(at[n]), size_of(at[m]), width);
        }
    }
}

double BlockSolve::loop_compliance(const RowBlock& block, int r) const {
    double k = 0;
    const double* j = &sys_.rows.jacobian[block.jacobian] + r * kDof;
    for (int n = 0; n < block.type->nodes; ++n, j += block.type->rows * kDof)
        if (local(block.node[n]) != kNone) k += inverse_mass_along(sys_.inverse_mass[block.node[n]], j);
    return kLoopCompliance * k;
}

// The locked rows; the place of every other row is taken by mu = 0.
void BlockSolve::add_joint(uint32_t j) {
    const RowBlock& block = row(j);
    const int rows = block.type->rows, padded = rows > 3 ? 6 : 3;
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t i = local(block.node[n]);
        if (i == kNone) continue;
        RowJacobian minus = -jacobian_of(sys_, block, n);
        for (int r = 0; r < rows; ++r)
            if (!block.locked(r)) minus.row(r).setZero();
        b_.matrix.add(nodes_ + j, i, minus.data(), rows, size_of(i), kDof);
    }
    const RowMatrix c = compliance_of(block, sys_.h);
    double diagonal[kMaxRows * kMaxRows] = {};
    for (int r = 0; r < padded; ++r) diagonal[r * padded + r] = -1;
    for (int r = 0; r < rows; ++r) {
        if (!block.locked(r)) continue;
        for (int k = 0; k < rows; ++k) diagonal[r * padded + k] = -c(r, k);
        if (b_.looped) diagonal[r * padded + r] = -std::max(c(r, r), loop_compliance(block, r));
    }
    b_.matrix.add(nodes_ + j, nodes_ + j, diagonal, padded, padded, padded);
}

// B^T B / c of the rows that are on; rows on the same nodes follow each other and go into the matrix together.
void BlockSolve::add_bounded() {
    const auto rows = set.rows();
    for (size_t i = 0; i < rows.size();) {
        const BoundedRow& first = rows[i];
        double sum[kMaxNodes][kMaxNodes][kDof * kDof] = {};
        bool any = false;
        for (; i < rows.size() && std::equal(first.place, first.place + kMaxNodes, rows[i].place); ++i) {
            const BoundedRow& row = rows[i];
            if (!row.on || row.at_limit != 0) continue;
            any = true;
            for (int n = 0; n < row.nodes; ++n)
                for (int m = 0; m <= n; ++m)
                    if (row.place[n] != kNone && row.place[m] != kNone)
                        add_product(row.jacobian + static_cast<size_t>(n) * row.stride,
                                    row.jacobian + static_cast<size_t>(m) * row.stride, 1 / row.c, sum[n][m]);
        }
        for (int n = 0; any && n < first.nodes; ++n)
            for (int m = 0; m <= n; ++m)
                if (first.place[n] != kNone && first.place[m] != kNone)
                    b_.matrix.add(first.place[n], first.place[m], sum[n][m], size_of(first.place[n]),
                                  size_of(first.place[m]), kDof);
    }
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
    add_bounded();
}

// M (v* + contact changes) + h^2 K s + B^T goal / c for nodes, -target for joints.
void BlockSolve::right_hand_side() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const uint32_t node = b_.nodes[i];
        double* x = &b_.solution[i * kLd];
        const Velocity& u = sys_.free[node + 1];
        Vec3::Map(x) = s_.nodes.mass[node].mass * u.v + Vec3::Map(node_known(i));
        Vec3::Map(x + 3).setZero();
        if (size_of(i) == 6) Vec3::Map(x + 3) = sys_.inertia[node + 1] * u.w + Vec3::Map(node_known(i) + 3);
    }
    // J v of ends whose velocity is known: kinematic ones.
    auto known = [&](const RowBlock& block, int r) {
        double v = 0;
        for (int n = 0; n < block.type->nodes; ++n) {
            if (block.node[n] == 0 || local(block.node[n]) != kNone) continue;
            const Velocity& u = sys_.exact[block.node[n]];
            const auto j = jacobian_of(sys_, block, n).row(r);
            v += j.head<3>().dot(u.v) + j.tail<3>().dot(u.w);
        }
        return v;
    };
    for (uint32_t j = 0; j < joints(); ++j) {
        const RowBlock& block = row(j);
        double* x = &b_.solution[(nodes_ + j) * kLd];
        std::fill(x, x + kLd, 0.0);
        for (int r = 0; r < block.type->rows; ++r)
            if (block.locked(r))
                x[r] = row_terms(block, r, sys_.h).rate * sys_.rows.error[block.row + static_cast<uint32_t>(r)] +
                       known(block, r);
    }
    for (const BoundedRow& bounded : set.rows()) {
        if (!bounded.on) continue;
        const double held = (bounded.goal - bounded.known) / bounded.c;
        const double f = bounded.sign * (bounded.at_limit != 0 ? bounded.at_limit * bounded.limit : held);
        const double* j = bounded.jacobian;
        for (int n = 0; n < bounded.nodes; ++n, j += bounded.stride) {
            if (bounded.place[n] == kNone) continue;
            double* x = &b_.solution[bounded.place[n] * kLd];
            for (int k = 0; k < kLd; ++k) x[k] += f * j[k];
        }
    }
}

void BlockSolve::solve_known() {
    right_hand_side();
    b_.matrix.solve(b_.solution.data());
    take_solution();
    set.take_impulses();
}

void BlockSolve::take_solution() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const double* x = &b_.solution[i * kLd];
        sys_.exact[b_.nodes[i] + 1] = {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
}

// Of locked rows from their multipliers, of all others from their bounded rows.
void BlockSolve::take_forces() {
    for (uint32_t j = 0; j < joints(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r)
            joint_force(j)[r] =
                row(j).locked(r) ? b_.solution[(nodes_ + j) * kLd + static_cast<uint32_t>(r)] / sys_.h : 0;
    for (const BoundedRow& bounded : set.rows())
        if (bounded.force)
            joint_force(bounded.block - b_.first_row_block)[bounded.row] += bounded.sign * bounded.mu / sys_.h;
}

// True if the geometric stiffness of this force, left out, would matter to the motion of a node: h^2 K_ii / M_ii.
bool BlockSolve::stiff(const RowBlock& block, const double* force) const {
    const int width = kDof * block.type->nodes;
    Pose poses[kMaxNodes];
    double k[kDof * kMaxNodes * kDof * kMaxNodes];
    for (int n = 0; n < block.type->nodes; ++n) poses[n] = sys_.pose[block.node[n]];
    block.type->stiffness(block.data, poses, force, Curvature::positive, k);
    for (int n = 0; n < block.type->nodes; ++n) {
        const uint32_t at = local(block.node[n]);
        if (at == kNone) continue;
        const Mat3& inertia = sys_.inertia[block.node[n]];
        for (int i = 0; i < size_of(at); ++i) {
            const double mass = i < 3 ? s_.nodes.mass[b_.nodes[at]].mass : inertia(i - 3, i - 3);
            if (sys_.h * sys_.h * k[(kDof * n + i) * (width + 1)] > kStiff * mass) return true;
        }
    }
    return false;
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
        if (now > kGrowth * kGrowth * before && now > kNegligible * kNegligible * largest &&
            stiff(row(j), joint_force(j)))
            return true;
    }
    return false;
}

// Rounds over the active set; of a tower, the relaxed solution has to push as well.
bool BlockSolve::factor_rounds(bool with_new) {
    const uint32_t rounds = set.empty() ? 1 : set.rounds();
    for (uint32_t round = 1;; ++round) {
        assemble(with_new);
        if (!b_.matrix.factor()) return false;
        set.aim_biased();
        solve_known();
        relaxed_ = false;
        if (round == rounds) return true;
        ++s_.report.rounds;
        if (set.revise()) continue;
        if (!b_.tower) return true;
        solve_relaxed();
        if (!set.drop_pulling()) return true;
    }
}

bool BlockSolve::solve_first() {
    ++s_.report.solves;
    for (int pass = 0; pass < 2; ++pass) {
        if (!factor_rounds(pass > 0)) return false;
        take_forces();
        const bool again = joints() > 0 && (b_.memory.solved == 0 || b_.memory.guard_left > 0 || force_grew());
        if (pass > 0 || !again || !s_.settings.geometric_stiffness) break;
        ++s_.report.resolves;
    }
    return true;
}

void BlockSolve::solve_again() {
    set.aim_biased();
    solve_known();
    take_forces();
}

// A tower's resting rows refer to a first relaxed solution, an articulation's to the biased one: measured.
void BlockSolve::solve_relaxed() {
    Array<Velocity>& exact = sys_.exact;
    for (uint32_t node : b_.nodes) sys_.kept[node + 1] = exact[node + 1];
    if (b_.tower) {
        set.aim_relaxed(false);
        solve_known();
    }
    set.aim_relaxed(true);
    solve_known();
    for (uint32_t node : b_.nodes) std::swap(sys_.kept[node + 1], exact[node + 1]);
    relaxed_ = true;
}

bool BlockSolve::finish() {
    if (s_.settings.velocity_filter > 0 && s_.settings.geometric_stiffness && joints() > 0)
        guard_energy(s_, b_, set.work());
    if (!set.empty()) {
        if (!relaxed_) solve_relaxed();
        if (b_.tower && !set.acceptable()) return false;
        take_forces();
        set.store();
    }
    for (uint32_t j = 0; j < joints(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r) {
            const double f = joint_force(j)[r];
            row(j).force[r] = f;
            sys_.rows.impulse[row(j).row + static_cast<uint32_t>(r)] = sys_.h * f;
        }
    if (s_.settings.velocity_filter > 0 && s_.settings.geometric_stiffness) filter_lines();
    ++b_.memory.solved;
    return true;
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
            error[r] -= sys_.frame_left * block.drift[r];
            if (block.elastic(r) || !block.locked(r)) error[r] = 0;  // not a gap to close
            if (!block.angular(r)) gap = std::max(gap, std::abs(error[r]));
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

}  // namespace taut
