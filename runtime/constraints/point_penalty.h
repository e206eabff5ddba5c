// Penalty of a point that is within a solid, by its distance from a triangle of the surface (Gast and Schroeder 2014,
// section 5.3): with d the square of the least distance from the triangle [m^2],
//   Phi = k d sqrt(d + epsilon) [J],  k [Pa],  epsilon 1e-15 m^2: of depth cubed but for a smooth beginning.
#pragma once

#include "base/math.h"

namespace taut {

// Where a triangle is nearest to a point: weights of its corners, and those that these depend on, of a face, an edge or
// a corner.
struct TrianglePoint {
    double weight[3];
    int corner[3], corners;
};
TrianglePoint nearest_on_triangle(const Vec3& point, const Vec3 (&triangle)[3]);

// Of the point and the three corners, in this order.
struct PenaltyTerms {
    double energy = 0;  // [J]
    Vec3 gradient[4];   // [N]
};
PenaltyTerms point_penalty(double stiffness, const Vec3& point, const Vec3 (&triangle)[3]);
// d2Phi/dx2, [12][12] [N/m]; what the weights give way by is in it.
void point_penalty_hessian(double stiffness, const Vec3& point, const Vec3 (&triangle)[3], double* out);

}  // namespace taut
