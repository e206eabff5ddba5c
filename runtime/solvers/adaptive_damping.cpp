// K is formed from the force of the last step. In long steps, or where velocities contradict the joints, the next force
// is another one: compression where there was tension. The positive part of K is none then, and light links fly off.
// The size of K is on the safe side for a force of that length in any direction:
//   bodies that turn about a lever:  |K| = (K^T K)^(1/2) of each body's rotations, K = (f.r) I - r f^T: |f.r| about the
//                                    normal of r and f, |f||r| about the other axis across r, 0 about r itself
//   constraints that couple nodes:   |K| = K+(f) + K+(-f), which leaves a common translation free
// Under tension |K| is K+, and ordinary motion is damped as ever.
//
// Andrews et al. take the norms of K's columns, which depend on the axes of the world, and add only as much damping as
// a step of semi-implicit Euler needs, b = max(0, h k / 2 - 2 m / h). That threshold leaves a slow swing more of its
// energy, but loses up to half of the violent starts from 1:1000 on (prototype, steps of 2 to 100 ms).
#include "solvers/adaptive_damping.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <functional>

namespace taut {
namespace {

constexpr int kMostWidth = kDof * kMaxNodes;

void add_both_ways(const ConstraintType& type, const void* data, const Pose* x, const double* force, double* k) {
    double against[kMaxRows], other[kMostWidth * kMostWidth];
    std::transform(force, force + type.rows, against, [](double f) { return -f; });
    type.stiffness(data, x, force, Curvature::positive, k);
    type.stiffness(data, x, against, Curvature::positive, other);
    const int width = kDof * type.nodes;
    std::transform(k, k + width * width, other, k, std::plus<double>());
}

Mat3 magnitude(const Mat3& k) {
    const Eigen::SelfAdjointEigenSolver<Mat3> squares(k.transpose() * k);
    const Vec3 sizes = squares.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    return squares.eigenvectors() * sizes.asDiagonal() * squares.eigenvectors().transpose();
}

}  // namespace

void stiffness_magnitude(const ConstraintType& type, const void* data, const Pose* x, const double* force, double* k) {
    if (type.couples_nodes) {
        add_both_ways(type, data, x, force, k);
        return;
    }
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    const int width = kDof * type.nodes;
    type.stiffness(data, x, force, Curvature::raw, k);
    Eigen::Map<RowMajor> whole(k, width, width);
    for (int n = 0; n < type.nodes; ++n) {
        auto turning = whole.block<3, 3>(kDof * n + 3, kDof * n + 3);
        turning = magnitude(turning);
    }
}

}  // namespace taut
