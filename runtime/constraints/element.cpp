#include "constraints/element.h"

#include "constraints/positive_part.h"

namespace taut {
namespace {

using Error = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;
using Modulus =
    Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMaxRows>>;

constexpr int kMostFreedoms = kMaxNodes * kDof;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMostFreedoms, kMostFreedoms>;
using Jacobian = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxRows, kMostFreedoms>;

// One element of a batch.
ElementBatch one_of(const ElementType& type, const ElementBatch& batch, uint32_t i) {
    return {1, batch.node + size_t{i} * static_cast<uint32_t>(type.row.nodes), nullptr,
            batch.data + size_t{batch.index(i)} * static_cast<uint32_t>(type.numbers), batch.x};
}

}  // namespace

void element_energy(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d, double* energy) {
    const int rows = type.row.rows;
    for (uint32_t i = 0; i < batch.count; ++i) {
        Error c(rows);
        type.evaluate(one_of(type, batch, i), c.data(), nullptr, type.freedoms);
        energy[i] = 0.5 * c.dot(Modulus(d.material, rows, rows) * c) / d.softness[batch.index(i)];
    }
}

void element_hessian(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d,
                     const double* lambda, Curvature part, double* k) {
    if (type.hessian) return type.hessian(batch, d, lambda, part, k);
    const int rows = type.row.rows, nodes = type.row.nodes, width = nodes * type.freedoms;
    for (uint32_t i = 0; i < batch.count; ++i) {
        const ElementBatch one = one_of(type, batch, i);
        double error[kMaxRows], jacobian[kMaxRows * kMostFreedoms];
        type.evaluate(one, error, jacobian, type.freedoms);
        Jacobian j(rows, width);
        for (int n = 0; n < nodes; ++n)
            j.middleCols(n * type.freedoms, type.freedoms) =
                Eigen::Map<const Jacobian>(jacobian + n * rows * type.freedoms, rows, type.freedoms);
        Square sum(width, width);
        type.stiffness(one, lambda + size_t{i} * static_cast<uint32_t>(rows), Curvature::raw, sum.data());
        sum = (0.5 * (sum + sum.transpose())).eval();
        const Jacobian force = Modulus(d.material, rows, rows).lazyProduct(j) / d.softness[batch.index(i)];
        sum += j.transpose().lazyProduct(force);
        Eigen::Map<Square> out(k + size_t{i} * static_cast<uint32_t>(width * width), width, width);
        out = sum;
        if (part == Curvature::positive) clip_negative(out.data(), width);
    }
}

void positive_sum(const ElementType& type, const ElementBatch& batch, const ElementStiffness& d, const double* lambda,
                  double* k) {
    element_hessian(type, batch, d, lambda, Curvature::positive, k);
}

}  // namespace taut
