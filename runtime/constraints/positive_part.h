// Positive parts of small symmetric matrices.
#pragma once

#include <Eigen/Eigenvalues>

namespace taut {

// Whether an elimination without exchange meets no negative pivot; reads the lower half.
template <int N>
bool is_positive(Eigen::Matrix<double, N, N> m) {
    for (int k = 0; k < N; ++k) {
        const double pivot = m(k, k);
        if (!(pivot >= 0)) return false;
        for (int i = k + 1; i < N; ++i) {
            if (m(i, k) == 0) continue;
            if (pivot == 0) return false;
            const double ratio = m(i, k) / pivot;
            for (int j = k + 1; j <= i; ++j) m(i, j) -= ratio * m(j, k);
        }
    }
    return true;
}

// Its eigenvalues clipped at zero.
template <int N>
void clip_negative(Eigen::Matrix<double, N, N>& m) {
    using Matrix = Eigen::Matrix<double, N, N>;
    if (is_positive<N>(m)) return;
    const Eigen::SelfAdjointEigenSolver<Matrix> eigen(m);
    const Matrix scaled = eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal();
    m = scaled.lazyProduct(eigen.eigenvectors().transpose());
}

}  // namespace taut
