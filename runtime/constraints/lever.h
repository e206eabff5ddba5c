// A force f at the end of a lever r that turns with its body: torque r x f.
// Geometric stiffness of the rotation, K = -d(r x f)/dtheta = (f.r) I - r f^T   [N m]  (Tournier et al. 2015, eq. 22)
#pragma once

#include "constraints/constraint.h"

namespace taut {

// Symmetric part of K has the eigenpairs, with fh = f/|f| and rh = r/|r|,
//   along rh + fh : (f.r - |f||r|)/2 <= 0   never positive
//   along rh - fh : (f.r + |f||r|)/2 >= 0   kept
//   along rh x fh :  f.r                    kept if positive
inline Mat3 lever_stiffness(const Vec3& f, const Vec3& r, Curvature part) {
    const double fr = f.dot(r);
    if (part == Curvature::raw) return fr * Mat3::Identity() - r * f.transpose();
    const double size = f.norm(), arm = r.norm(), scale = size * arm;
    if (!(scale > 1e-30)) return Mat3::Zero();
    const Vec3 fh = f * (1 / size), rh = r * (1 / arm);
    const Vec3 m = rh - fh, n = rh.cross(fh);
    const double mm = m.squaredNorm(), nn = n.squaredNorm();
    if (mm < 1e-8) return scale * (Mat3::Identity() - rh * rh.transpose());  // parallel: tension
    if (nn < 1e-8) return Mat3::Zero();                                      // anti-parallel: compression
    return 0.5 * (fr + scale) / mm * m * m.transpose() + std::max(0.0, fr) / nn * n * n.transpose();
}

// Writes a 3x3 block of the [6 nodes][6 nodes] matrix k of a two-node constraint.
inline void add_block(double* k, int row, int column, const Mat3& block) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) k[(row + i) * 12 + column + j] += block(i, j);
}

// Writes a 3x3 block into the first three rows of a jacobian [node][rows][6].
inline void set_block(double* jacobian, int rows, int node, int column, const Mat3& block) {
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) jacobian[(node * rows + i) * kDof + column + j] = block(i, j);
}

}  // namespace taut
