#include "constraints/point_penalty.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr double kSmooth = 1e-15;  // epsilon [m^2]

// Phi(d) and its derivatives.
struct OfSquare {
    double value, first, second;
};
OfSquare of_square(double stiffness, double d) {
    const double root = std::sqrt(d + kSmooth);
    return {stiffness * d * root, stiffness * (root + d / (2 * root)),
            stiffness * (1 / root - d / (4 * root * root * root))};
}

// p - sum w_i a_i
Vec3 apart(const TrianglePoint& at, const Vec3& point, const Vec3 (&triangle)[3]) {
    Vec3 r = point;
    for (int i = 0; i < 3; ++i) r -= at.weight[i] * triangle[i];
    return r;
}

}  // namespace

// By the regions of the plane about a triangle (Ericson 2005, section 5.1.5).
TrianglePoint nearest_on_triangle(const Vec3& point, const Vec3 (&triangle)[3]) {
    const auto on_edge = [&](int from, int to) {
        const Vec3 edge = triangle[to] - triangle[from];
        const double square = edge.squaredNorm(), part = square > 0 ? (point - triangle[from]).dot(edge) / square : 0;
        TrianglePoint out{{0, 0, 0}, {from, to, 0}, 2};
        if (part <= 0 || part >= 1) {
            out.corner[0] = part <= 0 ? from : to;
            out.corners = 1;
            out.weight[out.corner[0]] = 1;
        } else {
            out.weight[from] = 1 - part;
            out.weight[to] = part;
        }
        return out;
    };
    const Vec3 u = triangle[1] - triangle[0], v = triangle[2] - triangle[0], n = u.cross(v), r = point - triangle[0];
    const double area = n.squaredNorm();
    if (area > 0) {
        const double b = r.cross(v).dot(n) / area, c = u.cross(r).dot(n) / area;
        if (b > 0 && c > 0 && b + c < 1) return {{1 - b - c, b, c}, {0, 1, 2}, 3};
    }
    TrianglePoint best = on_edge(0, 1);
    for (int k = 1; k < 3; ++k) {
        const TrianglePoint other = on_edge(k, k == 2 ? 0 : k + 1);
        if (apart(other, point, triangle).squaredNorm() < apart(best, point, triangle).squaredNorm()) best = other;
    }
    return best;
}

// dd/dx_i = 2 c_i r, c = (1, -w): the weights are where d is least.
PenaltyTerms point_penalty(double stiffness, const Vec3& point, const Vec3 (&triangle)[3]) {
    const TrianglePoint at = nearest_on_triangle(point, triangle);
    const Vec3 r = apart(at, point, triangle);
    const OfSquare phi = of_square(stiffness, r.squaredNorm());
    PenaltyTerms out;
    out.energy = phi.value;
    out.gradient[0] = 2 * phi.first * r;
    for (int i = 0; i < 3; ++i) out.gradient[i + 1] = -at.weight[i] * out.gradient[0];
    return out;
}

// d2d/dx2 = 2 (c c^T (x) 1 - B G^-1 B^T): u are the weights of the feature's further corners, of which each is an edge
// A_k from the first, G = A^T A, B_ik = dc_i/du_k r - c_i A_k.
void point_penalty_hessian(double stiffness, const Vec3& point, const Vec3 (&triangle)[3], double* out) {
    const TrianglePoint at = nearest_on_triangle(point, triangle);
    const Vec3 r = apart(at, point, triangle);
    const OfSquare phi = of_square(stiffness, r.squaredNorm());
    const double c[4] = {1, -at.weight[0], -at.weight[1], -at.weight[2]};
    Eigen::Matrix<double, 12, 12, Eigen::RowMajor> matrix = Eigen::Matrix<double, 12, 12, Eigen::RowMajor>::Zero();
    Eigen::Matrix<double, 12, 1> gradient;
    for (int i = 0; i < 4; ++i) {
        gradient.segment<3>(3 * i) = 2 * c[i] * r;
        for (int k = 0; k < 4; ++k) matrix.block<3, 3>(3 * i, 3 * k).diagonal().setConstant(2 * c[i] * c[k]);
    }
    if (at.corners > 1) {
        using Further = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 12, 2>;
        Further b = Further::Zero(12, at.corners - 1);
        Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 2> edge(3, at.corners - 1);
        for (int k = 0; k + 1 < at.corners; ++k) {
            edge.col(k) = triangle[at.corner[k + 1]] - triangle[at.corner[0]];
            for (int i = 0; i < 4; ++i) b.col(k).segment<3>(3 * i) = -c[i] * edge.col(k);
            b.col(k).segment<3>(3 * (at.corner[k + 1] + 1)) -= r;
            b.col(k).segment<3>(3 * (at.corner[0] + 1)) += r;
        }
        const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 2, 2> gram = edge.transpose() * edge;
        matrix -= 2 * b.lazyProduct(gram.ldlt().solve(b.transpose()).eval());
    }
    matrix = phi.first * matrix + phi.second * gradient * gradient.transpose();
    Eigen::Map<Eigen::Matrix<double, 12, 12, Eigen::RowMajor>>(out, 12, 12) = matrix;
}

}  // namespace taut
