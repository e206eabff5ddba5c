// K is formed from the force of the last step. In long steps, or where joints contradict each other, the next force is
// another one: compression where there was tension, and the positive part of K, which is none, lets light links fly
// off. The size of K errs on the safe side for every direction of that force:
//   bodies that turn about a lever:  |K| = (K^T K)^(1/2) of each body's rotations, K = (f.r) I - r f^T: |f||r| across
//   the
//                                    lever within the plane of f and r, |f.r| across that plane, none about the lever
//   constraints that couple nodes:   |K| = K+(f) + K+(-f), which leaves a common translation free
// Andrews et al. take norms of K's columns, which depend on the axes of the world, and add only what a step's stability
// asks for, b = max(0, h k / 2 - 2 m / h). With that threshold a slow swing keeps more of its energy, but half of the
// violent starts are lost from 1:1000 on; whole, none is. Under tension |K| is K+, so ordinary motion is damped as
// ever.
#include "solvers/adaptive_damping.h"

#include <Eigen/Eigenvalues>
#include <algorithm>

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
