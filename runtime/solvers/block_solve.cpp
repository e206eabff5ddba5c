#include "solvers/block_solve.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

namespace taut {
namespace {

// K of the new forces is added where a joint's h^2 K > kStable M + kGrowth h^2 K(old). Theory allows a growth of 2;
// with 1.3 fewer violent starts fail (measured at 1:10000: 2 of 1000; with 2, on sums over the joints of a node, 10).
constexpr double kGrowth = 1.3;
constexpr double kStable = 4;
constexpr double kNegligible = 1e-3;  // of the block's largest force: smaller ones do not count
// A light chain that whips turns so far in a substep that its straight steps leave the joints open. Where the gap
// exceeds this part of the lever, positions (not velocities) are projected once more on the same factor. Heavy loads
// do not whip, and there the projection disturbs the tension that K was formed from (measured: 2 of 16 starts lost).
constexpr double kSettleGap = 4e-3;

double squared(const double* f, int rows) {
    double sum = 0;
    for (int r = 0; r < rows; ++r) sum += f[r] * f[r];
    return sum;
}

}  // namespace

// Angular velocity of a constraint's line, as its ends move now.
Vec3 BlockSolve::line_turn(const RowBlock& block) const {
    const Pose poses[2] = {sys_.pose[block.node[0]], sys_.pose[block.node[1]]};
    const Line line = block.type->line(block.data, poses);
    const Velocity &a = sys_.exact[block.node[0]], &b = sys_.exact[block.node[1]];
    const Vec3 apart = b.v + b.w.cross(line.lever_b) - a.v - a.w.cross(line.lever_a);
    return line.span.cross(apart) / line.span.squaredNorm();
}

// Slow velocities s of a row block's nodes. Rotations have their own; of a line between nodes only the motion of one
// end against the other matters to K: that of the low-passed turning of the line.
void BlockSolve::slow_velocities(const RowBlock& block, double* slow) const {
    const ConstraintType& type = *block.type;
    uint32_t at[kMaxNodes];
    for (int n = 0; n < type.nodes; ++n) at[n] = local(block.node[n]);
    for (int n = 0; n < type.nodes; ++n) {
        if (at[n] == kNone) continue;
        const NodeMotion& m = s_.nodes.motion[b_.nodes[at[n]]];
        if (!type.line) Vec3::Map(slow + kDof * n) = m.slow_v;
        Vec3::Map(slow + kDof * n + 3) = m.slow_w;
    }
    if (!type.line) return;
    const Pose poses[2] = {sys_.pose[block.node[0]], sys_.pose[block.node[1]]};
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
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        if (!block.type->line) continue;
        const Vec3 turn = line_turn(block);
        const bool first = block.fresh && b_.memory.solved == 0;
        *block.slow_turn += (first ? 1 : s_.settings.velocity_filter) * (turn - *block.slow_turn);
    }
}

// J v of a row's ends that the block does not solve for: kinematic ones, and those that are at rest.
double BlockSolve::known_rate(const RowBlock& block, int r) const {
    double v = 0;
    for (int n = 0; n < block.type->nodes; ++n) {
        if (block.node[n] == 0 || local(block.node[n]) != kNone) continue;
        v += along(row_of(sys_, block, n, r), sys_.exact[block.node[n]]);
    }
    return v;
}

// M (v* + contact changes) + h^2 K s + B^T goal / c for nodes, -closing target for ties.
void BlockSolve::right_hand_side() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const uint32_t node = b_.nodes[i];
        double* x = &b_.solution[i * kDof];
        const Velocity& u = sys_.free[sys_.at(node)];
        Vec3::Map(x) = s_.nodes.mass[node].mass * u.v + Vec3::Map(known(i));
        Vec3::Map(x + 3).setZero();
        if (size_of(i) == 6) Vec3::Map(x + 3) = sys_.inertia[sys_.at(node)] * u.w + Vec3::Map(known(i) + 3);
    }
    for (size_t i = 0; i < b_.elastic_force.size(); ++i) b_.solution[i] += b_.elastic_force[i];
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        double* x = &b_.solution[(nodes_ + j) * kDof];
        std::fill(x, x + kDof, 0.0);
        const bool meets_known = std::any_of(block.node, block.node + block.type->nodes,
                                             [&](uint32_t node) { return node != 0 && local(node) == kNone; });
        for (int r = 0; r < block.type->rows; ++r) {
            if (!block.locked(r)) continue;
            const double part = b_.closing < 1 && ideal(block, r) ? b_.closing : 1;
            x[r] = part * known(nodes_ + j)[r] * error_of(block, r) + (meets_known ? known_rate(block, r) : 0.0);
        }
    }
    const bool apart = splits();
    if (apart) split.add_known(b_.solution.data());
    for (const BoundedRow& bounded : set.rows()) {
        if (apart ? bounded.mu == 0 : !bounded.on) continue;
        const double held =
            bounded.at_limit != 0 ? bounded.at_limit * bounded.limit : (bounded.goal - bounded.known) / bounded.c;
        const double f = bounded.sign * (apart ? bounded.mu : held);
        const double* j = bounded.jacobian;
        for (int n = 0; n < bounded.nodes; ++n, j += bounded.stride) {
            if (bounded.place[n] == kNone) continue;
            double* x = &b_.solution[bounded.place[n] * kDof];
            for (int k = bounded.begin; k < kDof; ++k) x[k] += f * j[k];
        }
    }
}

void BlockSolve::solve_linear() {
    right_hand_side();
    b_.matrix.solve(b_.solution.data());
    yield_to_gas(b_.solution.data(), b_.gases.size());
}

void BlockSolve::gather_rows() {
    set.gather();
    if (!splits()) return;
    bound_impulses(set.rows());
    split.make_room();
}

// Steps towards the impulses that the laws of all bounded rows ask for. False where these, or the linearisations in
// between, lead away from them: to where they are missed by more than the substep began with, and by more than any two
// nodes would part or meet without impulses.
bool BlockSolve::approach_laws() {
    constexpr uint32_t kMostSteps = 10;  // loads of 1 to 5000 times a sheet's mass end within micrometres
    solve_linear();
    double missed = 0;
    for (uint32_t step = 0; step < kMostSteps; ++step) {
        missed = split.improve();
        if (began_off_ < 0) began_off_ = missed;
        solve_linear();
        if (missed <= split.near()) return true;
    }
    if (missed <= began_off_) return true;
    double fastest = 0;
    for (const uint32_t node : b_.nodes) fastest = std::max(fastest, sys_.free[sys_.at(node)].v.norm());
    return missed <= 2 * fastest;
}

// With the impulses that the laws of all bounded rows ask for. Frictions whose bounds follow the pushes that they cause
// may have no such impulses, or none that sweeps find (tangled cloths); without friction the laws are those of a
// minimum, and have.
void BlockSolve::solve_laws() {
    if (!approach_laws()) {
        split.begin_anew();
        approach_laws();
    }
    split.move_free_parts();
    take_solution();
    note_state(set.rows());
}

void BlockSolve::solve_known() {
    if (splits()) return solve_laws();
    solve_linear();
    for (size_t i = 0; i < unknowns(); ++i) b_.solution[i] += iterate()[i];
    take_solution();
    set.take_impulses();
}

void BlockSolve::take_solution() {
    for (uint32_t i = 0; i < nodes_; ++i) {
        const double* x = &b_.solution[i * kDof];
        sys_.exact[sys_.at(b_.nodes[i])] = {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
}

// Of locked rows from their multipliers, of all others from their bounded rows.
void BlockSolve::take_forces() {
    for (uint32_t j = 0; j < ties(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r)
            tie_force(j)[r] =
                row(j).locked(r) ? sys_.scheme.force(b_.solution[(nodes_ + j) * kDof + static_cast<uint32_t>(r)]) : 0;
    for (const BoundedRow& bounded : set.rows())
        if (bounded.force)
            tie_force(bounded.block - b_.first_row_block)[bounded.row] += sys_.scheme.force(bounded.sign * bounded.mu);
}

// True if a joint's stiffness has outgrown the one in the matrix. One freedom of mass m with k in its force and k_old
// in the matrix, (m + h^2 k_old) v+ = m v - h k x, x+ = x + h v+, has stable steps while h^2 k < 4 m + 2 h^2 k_old.
bool BlockSolve::outgrown(const RowBlock& block, const double* force) const {
    const int width = kDof * block.type->nodes;
    double k[kDof * kMaxNodes * kDof * kMaxNodes], old[kDof * kMaxNodes * kDof * kMaxNodes];
    const auto exceeds = [&](auto&& growth) {
        for (int n = 0; n < block.type->nodes; ++n) {
            const uint32_t at = local(block.node[n]);
            if (at == kNone) continue;
            const Mat3& inertia = sys_.inertia[block.node[n]];
            for (int i = 0; i < size_of(at); ++i) {
                const double mass = i < 3 ? s_.nodes.mass[b_.nodes[at]].mass : inertia(i - 3, i - 3);
                if (sys_.scheme.stiffness() * growth((kDof * n + i) * (width + 1)) > kStable * mass) return true;
            }
        }
        return false;
    };
    stiffness_of(block, force, k);
    if (!exceeds([&](int ii) { return k[ii]; })) return false;  // nor less what there was
    stiffness_of(block, block.force, old);
    return exceeds([&](int ii) { return k[ii] - kGrowth * old[ii]; });
}

bool BlockSolve::force_grew() const {
    double largest = 0;
    for (uint32_t j = 0; j < ties(); ++j) largest = std::max(largest, squared(tie_force(j), row(j).type->rows));
    for (uint32_t j = 0; j < ties(); ++j) {
        const int rows = row(j).type->rows;
        double change[kMaxRows];
        for (int r = 0; r < rows; ++r) change[r] = tie_force(j)[r] - row(j).force[r];
        const double least = (kGrowth - 1) * (kGrowth - 1) * squared(row(j).force, rows);
        if (squared(change, rows) > least && squared(tie_force(j), rows) > kNegligible * kNegligible * largest &&
            outgrown(row(j), tie_force(j)))
            return true;
    }
    return false;
}

bool BlockSolve::solve_round() {
    if (!b_.matrix.factor()) return false;
    find_gas_responses();
    set.aim_biased();
    relaxed_ = false;
    if (splits()) {
        split.forget();
        solve_laws();
        return true;
    }
    solve_linear();
    take_solution();
    set.take_impulses();
    return true;
}

void BlockSolve::advance(bool first) {
    const double t = set.advance(first);
    for (size_t i = 0; i < unknowns(); ++i) {
        double& at = iterate()[i];
        at = t == 1 ? b_.solution[i] : at + t * (b_.solution[i] - at);
    }
}

// The iterate is the solution, and what is solved on the same factor from now on is as far from its own.
void BlockSolve::stop_short() {
    for (size_t i = 0; i < unknowns(); ++i) {
        iterate()[i] -= b_.solution[i];
        b_.solution[i] += iterate()[i];
    }
    take_solution();
    set.stop_short();
}

// Rounds over the active set.
bool BlockSolve::factor_rounds() {
    std::fill_n(iterate(), unknowns(), 0.0);
    if (set.empty()) return solve_round();
    set.begin_rounds();
    if (splits()) {
        if (!solve_round()) return false;
        limit_push();
        return true;
    }
    b_.matrix.keep();
    for (uint32_t round = 1;; ++round) {
        if (round > 1) b_.matrix.restore();
        add_bounded();
        if (!solve_round()) return false;
        advance(round == 1);
        if (round == set.rounds() || set.settled()) break;
        ++s_.report.rounds;
        if (!set.revise()) break;
    }
    stop_short();
    limit_push();
    return true;
}

// Once more and from now on with soft rows, where some turned out to depend on each other that the graph holds apart.
bool BlockSolve::factor_softly(bool with_old) {
    if (ties() == 0 || std::exchange(b_.looped, true)) return false;
    assemble(with_old);
    return factor_rounds();
}

bool BlockSolve::solve_first() {
    ++s_.report.solves;
    b_.closing = 1;
    const bool guarded = b_.memory.guard_left > 0, stiffened = s_.settings.geometric_stiffness && ties() > 0;
    assemble(stiffened);
    if (!factor_rounds() && !factor_softly(stiffened)) return false;
    take_forces();
    if (stiffened && (b_.memory.solved == 0 || guarded || force_grew())) {
        ++s_.report.resolves;
        if (guarded)
            assemble(false);
        else if (!set.empty() && !splits())
            b_.matrix.restore();
        add_new_stiffness();
        renewed_ = true;
        if (!factor_rounds()) return false;
        take_forces();
    }
    if (!search(stiffened) || !linearise_again(stiffened)) return false;
    if (stiffened) limit_gain();
    return true;
}

void BlockSolve::solve_again() {
    set.aim_biased();
    solve_known();
    take_forces();
    if (s_.settings.geometric_stiffness) limit_gain();
}

void BlockSolve::solve_relaxed() {
    Array<Velocity>& exact = sys_.exact;
    copy_velocities(sys_, b_, exact, sys_.kept);
    set.aim_relaxed();
    solve_known();
    limit_bounce();
    for (uint32_t node : b_.nodes) std::swap(sys_.kept[sys_.at(node)], exact[sys_.at(node)]);
    relaxed_ = true;
}

void BlockSolve::finish() {
    if (s_.settings.velocity_filter > 0 && s_.settings.geometric_stiffness && ties() > 0) guard_energy(s_, b_, gained_);
    if (!set.empty()) {
        if (!relaxed_) solve_relaxed();
        take_forces();
        set.store();
    }
    for (uint32_t j = 0; j < ties(); ++j)
        for (int r = 0; r < row(j).type->rows; ++r) {
            const double f = tie_force(j)[r];
            row(j).force[r] = f;
            sys_.rows.impulse[row(j).row + static_cast<uint32_t>(r)] = sys_.scheme.impulse(f);
        }
    take_elastic_forces();
    if (s_.settings.velocity_filter > 0 && s_.settings.geometric_stiffness) filter_lines();
    ++b_.memory.solved;
}

// The fastest of its levers, squared [rad^2/s^2]. The Jacobians of rows that are no angles are d, r x d of a direction
// d and a lever r; of three of them sum (w . (r x d))^2 = |w x r|^2 and sum |r x d|^2 = 2 |r|^2.
double BlockSolve::lever_turn(const RowBlock& block) const {
    constexpr double kShort = 0.02;  // of the joint's longest lever: shorter ones do not open it
    double across[kMaxNodes] = {}, lever[kMaxNodes] = {}, longest = 0, most = 0;
    for (int n = 0; n < block.type->nodes; ++n) {
        if (local(block.node[n]) == kNone) continue;
        const Vec3& w = sys_.exact[block.node[n]].w;
        for (int r = 0; r < block.type->rows; ++r) {
            if (block.angular(r) || !block.locked(r)) continue;
            const Vec3 arm = jacobian_of(sys_, block, n).row(r).tail<3>();
            across[n] += arm.dot(w) * arm.dot(w);
            lever[n] += 0.5 * arm.squaredNorm();
        }
        longest = std::max(longest, lever[n]);
    }
    for (int n = 0; n < block.type->nodes; ++n)
        if (lever[n] > kShort * kShort * longest) most = std::max(most, across[n] / lever[n]);
    return most;
}

double BlockSolve::largest_turn() const {
    constexpr double kSlow = 0.03;  // levers on bodies that turn by less need no look [rad]
    double fastest = 0;
    for (uint32_t i = 0; i < nodes_; ++i) fastest = std::max(fastest, sys_.exact[sys_.at(b_.nodes[i])].w.squaredNorm());
    const bool slow = sys_.scheme.h * sys_.scheme.h * fastest <= kSlow * kSlow;
    double most = slow && ties() > 0 ? fastest : 0;
    for (uint32_t j = 0; j < ties(); ++j) {
        if (row(j).type->line) most = std::max(most, line_turn(row(j)).squaredNorm());
        if (!slow) most = std::max(most, lever_turn(row(j)));
    }
    return sys_.scheme.h * std::sqrt(most);
}

bool BlockSolve::settle() {
    bool open = false;
    std::fill(b_.solution.begin(), b_.solution.end(), 0.0);
    for (uint32_t j = 0; j < ties(); ++j) {
        const RowBlock& block = row(j);
        const int rows = block.type->rows;
        Pose poses[kMaxNodes];
        for (int n = 0; n < block.type->nodes; ++n) {
            poses[n] = sys_.pose[block.node[n]];
            const uint32_t i = local(block.node[n]);
            if (i == kNone) continue;
            const NodeMotion& m = s_.nodes.motion[b_.nodes[i]];
            poses[n] = {m.x, m.q.toRotationMatrix()};
        }
        double* error = &b_.solution[(nodes_ + j) * kDof];
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
        const double* x = &b_.solution[i * kDof];
        sys_.correction[sys_.at(b_.nodes[i])] = {Vec3(x[0], x[1], x[2]), Vec3(x[3], x[4], x[5])};
    }
    return true;
}

}  // namespace taut
