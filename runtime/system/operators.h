// Operators of one row block: J u, J^T mu, W p, J W J^T, and what bounds an impulse (project). Every solver that works
// row block by row block uses these; lanes have them fused (constraints/*_sweep.inl).
#pragma once

#include <algorithm>

#include "system/axis_rows.h"

namespace taut {

using NodeVector = Eigen::Matrix<double, kDof, 1>;
using RowVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMaxRows>;
using RowJacobian = Eigen::Matrix<double, Eigen::Dynamic, kDof, Eigen::RowMajor, kMaxRows, kDof>;

// J of one of the block's nodes: rows x 6.
inline Eigen::Map<const RowJacobian> jacobian_of(const System& system, const RowBlock& block, int node) {
    const int rows = block.type->rows;
    return {&system.rows.jacobian[block.jacobian + static_cast<uint32_t>(node * rows * kDof)], rows, kDof};
}

// One row of it [6].
inline const double* row_of(const System& system, const RowBlock& block, int node, int row) {
    return &system.rows.jacobian[block.jacobian + static_cast<uint32_t>((node * block.type->rows + row) * kDof)];
}

// J u of a block's rows [m/s]; velocity_of(seat) gives a NodeVector.
template <class VelocityOf>
RowVector rates(const System& system, const RowBlock& block, VelocityOf&& velocity_of) {
    RowVector rate = RowVector::Zero(block.type->rows);
    for (int n = 0; n < block.type->nodes; ++n) rate += jacobian_of(system, block, n) * velocity_of(block.node[n]);
    return rate;
}

// The same of one row j [6] of each node: j u.
inline double along(const auto& linear, const auto& angular, const Velocity& u) {
    return linear.dot(u.v) + angular.dot(u.w);
}
inline double along(const double* j, const Velocity& u) { return along(Vec3::Map(j), Vec3::Map(j + 3), u); }
inline double rate(const System& system, const RowBlock& block, int row, const Array<Velocity>& velocity) {
    double sum = 0;
    for (int n = 0; n < block.type->nodes; ++n) sum += along(row_of(system, block, n, row), velocity[block.node[n]]);
    return sum;
}

inline NodeVector vector_of(const Velocity& u) {
    NodeVector v;
    v << u.v, u.w;
    return v;
}

// |g| of a row that turns, 1 of others: how much faster than its bodies the coordinate turns.
inline double gearing_of(const System& system, const RowBlock& block, int row) {
    if (!block.angular(row)) return 1;
    return Eigen::Map<const Vec3>(row_of(system, block, block.type->nodes - 1, row) + 3).norm();
}

// Friction is a torque, and lambda as much less; against a damping torque the coordinate's rate counts as much more.
inline void gear(const System& system, const RowBlock& block, int row, AxisRow& axis) {
    if (!axis.torque) return;
    const double g = gearing_of(system, block, row);
    axis.limit /= g;
    axis.compliance *= g * g;
}

// Larger eigenvalue of the part of J W J^T of a contact's two tangents [1/kg].
inline double largest_across(const RowMatrix& s) {
    const double half = 0.5 * (s(1, 1) + s(2, 2)), diff = 0.5 * (s(1, 1) - s(2, 2));
    return half + std::sqrt(diff * diff + s(1, 2) * s(1, 2));
}

inline RowVector impulse_of(const System& system, const RowBlock& block) {
    return Eigen::Map<const RowVector>(&system.rows.impulse[block.row], block.type->rows);
}

inline RowVector error_of(const System& system, const RowBlock& block) {
    return Eigen::Map<const RowVector>(&system.rows.error[block.row], block.type->rows);
}

// c of elastic rows, zero of rigid ones: see scheme.h.
inline RowMatrix compliance_of(const RowBlock& block, const Scheme& scheme) {
    const int rows = block.type->rows;
    if (block.compliance_block)
        return scheme.row_compliance(relaxation_of(block, 0)) * block.compliance[0] *
               Eigen::Map<const RowMatrix>(block.compliance_block, rows, rows);
    RowMatrix c = RowMatrix::Zero(rows, rows);
    for (int r = 0; r < rows; ++r)
        c(r, r) = scheme.row_compliance(relaxation_of(block, r)) * block.compliance[block.angular(r)];
    return c;
}

// error / (h + d) of each row: -target.
inline RowVector error_rate_of(const System& system, const RowBlock& block) {
    RowVector e = error_of(system, block);
    for (int r = 0; r < block.type->rows; ++r) e[r] *= system.scheme.row_rate(relaxation_of(block, r));
    return e;
}

// W p: what an impulse [N s, N m s] changes of a node's velocity.
inline NodeVector response(const SweepNode& node, const NodeVector& p) {
    const float* i = node.mass.inv_inertia;
    NodeVector v;
    v << node.mass.inv_mass_x * p[0], node.velocity.inv_mass_y * p[1], node.velocity.inv_mass_z * p[2],
        i[0] * p[3] + i[3] * p[4] + i[4] * p[5], i[3] * p[3] + i[1] * p[4] + i[5] * p[5],
        i[4] * p[3] + i[5] * p[4] + i[2] * p[5];
    return v;
}

// j W j^T of one row [6] on one node, were no linear axis locked; of one that turns about some axes no less than if it
// turned about all as about the one that it turns about most easily.
inline double unlocked_along(const SweepNode& node, const double* j) {
    const float* i = node.mass.inv_inertia;
    return node.mass.inv_mass * (j[0] * j[0] + j[1] * j[1] + j[2] * j[2]) +
           std::max({i[0], i[1], i[2]}) * (j[3] * j[3] + j[4] * j[4] + j[5] * j[5]);
}

// j W j^T of one row [6] on one node; nothing where locks leave rounding alone.
inline double inverse_mass_along(const SweepNode& node, const double* j) {
    const SweepMass& m = node.mass;
    const SweepVelocity& of = node.velocity;
    const float* i = m.inv_inertia;
    const double moved = node.locked()
                             ? m.inv_mass_x * j[0] * j[0] + of.inv_mass_y * j[1] * j[1] + of.inv_mass_z * j[2] * j[2]
                             : m.inv_mass * (j[0] * j[0] + j[1] * j[1] + j[2] * j[2]);
    const double sum = moved + i[0] * j[3] * j[3] + i[1] * j[4] * j[4] + i[2] * j[5] * j[5] +
                       2 * (i[3] * j[3] * j[4] + i[4] * j[3] * j[5] + i[5] * j[4] * j[5]);
    return !node.held() || sum > static_cast<double>(kLeastFree) * unlocked_along(node, j) ? sum : 0;
}

// J W J^T of one of the block's nodes.
inline RowMatrix effective_mass(const System& system, const RowBlock& block, int node) {
    const auto j = jacobian_of(system, block, node);
    RowMatrix s(block.type->rows, block.type->rows);
    for (int r = 0; r < block.type->rows; ++r)
        s.col(r) = j * response(system.sweep[block.node[node]], j.row(r).transpose());
    return s;
}

}  // namespace taut
