// Positive parts of small symmetric matrices.
#pragma once

#include <Eigen/Core>

#include "constraints/sizes.h"

namespace taut {

// Whether an elimination without exchange meets no negative pivot; reads the lower half.
template <class Matrix>
bool is_positive(Matrix m) {
    const Eigen::Index n = m.rows();
    for (Eigen::Index k = 0; k < n; ++k) {
        const double pivot = m(k, k);
        if (!(pivot >= 0)) return false;
        for (Eigen::Index i = k + 1; i < n; ++i) {
            if (m(i, k) == 0) continue;
            if (pivot == 0) return false;
            const double ratio = m(i, k) / pivot;
            for (Eigen::Index j = k + 1; j <= i; ++j) m(i, j) -= ratio * m(j, k);
        }
    }
    return true;
}

// Eigenvalues of m, symmetric of size x size, clipped at zero; size at most kMostClipped.
inline constexpr int kMostClipped = kMaxNodes * kDof;
void clip_negative(double* m, int size);

template <int N>
void clip_negative(Eigen::Matrix<double, N, N>& m) {
    static_assert(N <= kMostClipped);
    clip_negative(m.data(), N);
}

}  // namespace taut
