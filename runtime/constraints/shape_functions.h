// Shape functions of rest shapes: at each Gauss point the gradients that continua take as data (continuum.h), and what
// it stands for. Refused, with false, is what is inverted or has no extent at one of its points; out is then undefined.
#pragma once

#include "base/math.h"

namespace taut {

template <int Nodes, int Dim>
struct GaussPoint {
    double g[Nodes][Dim];  // dN/dX [1/m]; of a surface along its warp and across it
    double weight;         // area [m^2] or volume [m^3]
};

// Triangle and quadrilateral anywhere in space. warp: the direction of the material's first axis, as far as it lies in
// the surface; one across it is refused.
bool tri3_point(const Vec3 (&x)[3], const Vec3& warp, GaussPoint<3, 2>& out);
// Points go round it; 2 x 2 Gauss points.
bool quad4_points(const Vec3 (&x)[4], const Vec3& warp, GaussPoint<4, 2> (&out)[4]);
// dX/du of a triangle with texture coordinates, the direction in which u alone grows; 0 where they have no extent.
Vec3 warp_of(const Vec3 (&x)[3], const double (&uv)[3][2]);

// Positive where 1, 2, 3 go round counterclockwise as seen from outside, 0 being on the other side.
bool tet4_point(const Vec3 (&x)[4], GaussPoint<4, 3>& out);
// 0 to 3 go round the bottom counterclockwise as seen from above, 4 to 7 lie over them; 2 x 2 x 2 Gauss points.
bool hex8_points(const Vec3 (&x)[8], GaussPoint<8, 3> (&out)[8]);

// Meshless: the gradient of the linear field that fits the nodes around a point best, by moving least squares,
//   g_n = M^-1 w_n (X_n - mean),  M = sum_n w_n (X_n - mean)(X_n - mean)^T,  mean = sum_n w_n X_n / sum_n w_n,
// exact for linear fields. weight: of each node >= 0, falling with its distance from the point. A node of weight 0 has
// g_n = 0: a point with fewer neighbours takes further nodes of the body at that weight. Its volume is the owner's.
bool meshless_point(const Vec3 (&x)[8], const double (&weight)[8], double volume, GaussPoint<8, 3>& out);

// Weights of a quadratic bend of triangles (0, 1, 2) and (1, 0, 3), from the cotangents at their common edge:
// -e times the curvature of the edge. Also their areas together [m^2].
bool quadratic_bend_weights(const Vec3 (&x)[4], double (&weight)[4], double& area);

}  // namespace taut
