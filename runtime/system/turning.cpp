// Impulses that follow their rows' J from where the substep begins to where it ends. With p_i = J_i(x)^T mu_i once
// converged, at x = x_n + h u,
//
//   u = u* + W sum p_i
//
// is implicit in directions too: the minimum of the energy, or the projection on C = 0 (Frâncu 2016, eq. 6.24
// and 6.26). Left at J(x_n) it is explicit in the geometric stiffness K = -d(J^T lambda)/dx, and nodes that are light
// for what their rods carry, h^2 K > 2 m, jump to the other side. As an iteration,
//
//   p_i <- p_i + theta_i (J_i(x)^T mu_i - p_i),   theta_i = 1 / (1 + s_i),   s_i = h t sum_n count_n tr(W_n |K_nn|)
//
// is stable for any number of units on a node: for K >= 0 its matrix Theta (1 + h t K E W E^T) has eigenvalues in (0,
// 1], as E W E^T, by which units share nodes, is not above W with the units of each node counted (Tonge et al. 2012).
// Of K < 0, compression, the implicit equation has other solutions, which buckled: that part stays explicit, as in
// position based dynamics. Springs turn there by c / (A + c), which is stable while they are less than twice as long.
#include "system/problem.h"

namespace taut {
namespace {

// By squaring: the same bits wherever it runs.
double power(double base, uint32_t exponent) {
    double out = 1;
    for (; exponent > 0; exponent >>= 1, base *= base)
        if ((exponent & 1) != 0) out *= base;
    return out;
}

}  // namespace

void Problem::find_turning() {
    m_.turning.clear();
    m_.applied.clear();
    if (rigid_ == Rigid::soft) return;  // forces are of the present J there
    for (Unit& unit : m_.unit) {
        if (unit.linear || unit.force) continue;
        Turning turning;
        if (!unit.rigid) turning.elastic = (matrix(m_.inverse, unit) * matrix(m_.compliance, unit)).trace() / unit.rows;
        unit.turning = static_cast<uint32_t>(m_.turning.size());
        unit.applied = static_cast<uint32_t>(m_.applied.size());
        m_.turning.push_back(turning);
        m_.applied.resize(m_.applied.size() + nodes(unit).size(), NodeVector::Zero());
    }
}

// sum_n count_n tr(W_n K_nn) of the positive part of K.
double Problem::trace_of_stiffness(const Unit& unit, const Pose* poses, const RowVector& force) const {
    const ConstraintType& type = *block(unit).type;
    constexpr int kWidth = kDof * kMaxNodes;
    double k[kWidth * kWidth];
    type.stiffness(block(unit).data, poses, force.data(), Curvature::positive, k);
    const int width = kDof * type.nodes;
    double sum = 0;
    for (int n = 0; n < type.nodes; ++n) {
        const uint32_t seat = block(unit).node[n];
        for (int i = 0; i < kDof && m_.count[seat] > 0; ++i)  // K_nn is symmetric
            sum += m_.count[seat] * response_of(seat, NodeVector::Map(k + (kDof * n + i) * width + kDof * n))[i];
    }
    return sum;
}

// K is linear in the size of an impulse, and formed again only where its direction turned by more than 60 degrees.
Problem::Stiffness Problem::stiffness(const Unit& unit, const Pose* poses) {
    Turning& turning = m_.turning[unit.turning];
    const RowVector mu = of(unit, m_.impulse);
    const double size = mu.norm();
    if (size == 0) return {};
    Eigen::Map<RowVector> direction(turning.direction, unit.rows);
    if (!(mu.dot(direction) >= 0.5 * size)) {
        direction = mu / size;
        turning.pull = s_.scheme.h * trace_of_stiffness(unit, poses, direction);
        turning.push = s_.scheme.h * trace_of_stiffness(unit, poses, -direction);
    }
    const double both = turning.pull + turning.push;
    return {size * both, both > 0 ? turning.pull / both : 1};
}

void Problem::turn(const Unit& unit, const Pose* poses) {
    if (unit.turning == kNone) return;
    const Stiffness k = stiffness(unit, poses);
    const double share = k.positive * k.stable_share() + (1 - k.positive) * m_.turning[unit.turning].elastic;
    if (share == 0) return;
    for (int n = 0; n < block(unit).type->nodes; ++n) {
        const uint32_t seat = block(unit).node[n];
        NodeVector& applied = m_.applied[unit.applied + static_cast<uint32_t>(n)];
        const NodeVector change = share * (jacobian(unit, n).transpose() * of(unit, m_.impulse) - applied);
        applied += change;
        if (m_.count[seat] > 0) move(seat, response_of(seat, change));
    }
}

// What is carried over is along J(x_n), and so much of it is taken as the evaluations to come can turn,
// 1 - (1 - theta)^n: all of it but where steps are long for it, where in the end the start is cold.
void Problem::warm_start(uint32_t evaluations) {
    find_turning();
    for (const Unit& unit : m_.unit) {
        Eigen::Map<RowVector> mu = of(unit, m_.impulse);
        mu = masked(unit, mu);
        if (unit.turning != kNone) {
            Pose poses[kMaxNodes];
            for (int n = 0; n < block(unit).type->nodes; ++n) poses[n] = s_.pose[block(unit).node[n]];
            mu *= 1 - power(1 - stiffness(unit, poses).stable_share(), evaluations);
        }
        push(unit, mu);
    }
}

void Problem::go_on() {
    find_turning();
    for (const Unit& unit : m_.unit) {
        if (unit.turning == kNone) continue;
        for (int n = 0; n < block(unit).type->nodes; ++n)
            m_.applied[unit.applied + static_cast<uint32_t>(n)] = jacobian(unit, n).transpose() * of(unit, m_.impulse);
    }
}

}  // namespace taut
