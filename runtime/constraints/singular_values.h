// Singular values of a deformation gradient with rotations on both sides:  F = U diag(sigma) V^T,  sigma falling,
// det U = det V = 1; of a 3x3 matrix the last one is negative where det F is. U V^T, its first columns for a surface,
// is the rotation nearest to F; what F leaves open of it, as F = 0 does of all, is chosen, the same for the same bits.
#pragma once

#include "base/math.h"

namespace taut {

// Difference or sum of two of them below which their directions, or the rotation, count as open: far above what
// rounding leaves of them [1].
inline constexpr double kLeastGap = 1e-6;

template <int Dim>
struct SingularValues {
    Mat3 u;  // of a surface the last column is its normal
    Eigen::Matrix<double, Dim, Dim> v;
    Eigen::Matrix<double, Dim, 1> sigma;
};

template <int Dim>
SingularValues<Dim> singular_values(const Eigen::Matrix<double, 3, Dim>& f);
extern template SingularValues<2> singular_values<2>(const Eigen::Matrix<double, 3, 2>&);
extern template SingularValues<3> singular_values<3>(const Eigen::Matrix<double, 3, 3>&);

}  // namespace taut
