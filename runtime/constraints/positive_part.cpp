#include "constraints/positive_part.h"

#include <Eigen/Eigenvalues>

namespace taut {
namespace {

template <class Matrix>
void clip(Eigen::Map<Matrix> m) {
    if (is_positive(Matrix(m))) return;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m);
    const Matrix scaled = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal();
    m = scaled.lazyProduct(eigen.eigenvectors().transpose());
}

}  // namespace

void clip_negative(double* m, int size) {
    if (size == 3) return clip(Eigen::Map<Eigen::Matrix3d>(m));
    clip(Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostClipped, kMostClipped>>(m, size,
                                                                                                          size));
}

}  // namespace taut
