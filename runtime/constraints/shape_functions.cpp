#include "constraints/shape_functions.h"

#include <Eigen/LU>
#include <cmath>

namespace taut {
namespace {

// Extent of a parallelepiped over that of a brick of the same edges, below which it has none: rounding takes the rest.
constexpr double kLeastExtent = 1e-8;

constexpr double kGauss = 0.57735026918962576;  // 1/sqrt 3

// N_n = prod_a (1 + s_na xi_a)/2 with the corners s_n of a square or cube.
constexpr int kCorner[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                               {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

// dN/dxi at a point of the square or cube.
template <int Nodes, int Dim>
Eigen::Matrix<double, Dim, Nodes> corner_slopes(const double* xi) {
    Eigen::Matrix<double, Dim, Nodes> out;
    for (int n = 0; n < Nodes; ++n)
        for (int a = 0; a < Dim; ++a) {
            out(a, n) = 0.5 * kCorner[n][a];
            for (int b = 0; b < Dim; ++b)
                if (b != a) out(a, n) *= 0.5 * (1 + kCorner[n][b] * xi[b]);
        }
    return out;
}

// From slopes in a parameter to gradients in space; content: of the parameter's range.
template <int Nodes>
bool solid_point(const Vec3* x, const Eigen::Matrix<double, 3, Nodes>& slopes, double content,
                 GaussPoint<Nodes, 3>& out) {
    Mat3 edges = Mat3::Zero();  // dX/dxi
    for (int n = 0; n < Nodes; ++n) edges += (x[n] - x[0]) * slopes.col(n).transpose();
    const double extent = edges.determinant();
    if (!(extent > kLeastExtent * edges.colwise().norm().prod()) || !std::isfinite(extent)) return false;
    const Mat3 inverse = edges.inverse();
    for (int n = 0; n < Nodes; ++n) Vec3::Map(out.g[n]) = inverse.transpose() * slopes.col(n);
    out.weight = content * extent;
    return true;
}

// The same of a surface, with its normal.
template <int Nodes>
bool surface_point(const Vec3* x, const Eigen::Matrix<double, 2, Nodes>& slopes, double content, const Vec3& warp,
                   GaussPoint<Nodes, 2>& out, Vec3& normal) {
    using Mat2 = Eigen::Matrix2d;
    Eigen::Matrix<double, 3, 2> edges = Eigen::Matrix<double, 3, 2>::Zero();
    for (int n = 0; n < Nodes; ++n) edges += (x[n] - x[0]) * slopes.col(n).transpose();
    normal = edges.col(0).cross(edges.col(1));
    const double extent = normal.norm();
    if (!(extent > kLeastExtent * edges.colwise().norm().prod()) || !std::isfinite(extent)) return false;
    normal /= extent;
    const Vec3 along = warp - normal * normal.dot(warp);
    if (!(along.norm() > kLeastExtent * warp.norm())) return false;
    Eigen::Matrix<double, 3, 2> axes;
    axes.col(0) = along.normalized();
    axes.col(1) = normal.cross(axes.col(0));
    const Mat2 inverse = Mat2(axes.transpose() * edges).inverse();
    for (int n = 0; n < Nodes; ++n) Eigen::Vector2d::Map(out.g[n]) = inverse.transpose() * slopes.col(n);
    out.weight = content * extent;
    return true;
}

template <int Nodes, int Dim>
Eigen::Matrix<double, Dim, Nodes> simplex_slopes() {
    Eigen::Matrix<double, Dim, Nodes> out;
    out << Eigen::Matrix<double, Dim, 1>::Constant(-1), Eigen::Matrix<double, Dim, Dim>::Identity();
    return out;
}

}  // namespace

bool tri3_point(const Vec3 (&x)[3], const Vec3& warp, GaussPoint<3, 2>& out) {
    Vec3 normal;
    return surface_point<3>(x, simplex_slopes<3, 2>(), 0.5, warp, out, normal);
}

bool quad4_points(const Vec3 (&x)[4], const Vec3& warp, GaussPoint<4, 2> (&out)[4]) {
    const Vec3 facing = (x[2] - x[0]).cross(x[3] - x[1]);  // twice its area as a vector
    for (int point = 0; point < 4; ++point) {
        const double xi[2] = {kGauss * kCorner[point][0], kGauss * kCorner[point][1]};
        Vec3 normal;
        if (!surface_point<4>(x, corner_slopes<4, 2>(xi), 1, warp, out[point], normal)) return false;
        if (!(normal.dot(facing) > 0)) return false;
    }
    return true;
}

Vec3 warp_of(const Vec3 (&x)[3], const double (&uv)[3][2]) {
    const double u1 = uv[1][0] - uv[0][0], v1 = uv[1][1] - uv[0][1];
    const double u2 = uv[2][0] - uv[0][0], v2 = uv[2][1] - uv[0][1];
    const double area = u1 * v2 - u2 * v1;
    if (!(std::abs(area) > kLeastExtent * std::sqrt((u1 * u1 + v1 * v1) * (u2 * u2 + v2 * v2)))) return Vec3::Zero();
    return ((x[1] - x[0]) * v2 - (x[2] - x[0]) * v1) / area;
}

bool tet4_point(const Vec3 (&x)[4], GaussPoint<4, 3>& out) {
    return solid_point<4>(x, simplex_slopes<4, 3>(), 1.0 / 6, out);
}

bool hex8_points(const Vec3 (&x)[8], GaussPoint<8, 3> (&out)[8]) {
    for (int point = 0; point < 8; ++point) {
        const double xi[3] = {kGauss * kCorner[point][0], kGauss * kCorner[point][1], kGauss * kCorner[point][2]};
        if (!solid_point<8>(x, corner_slopes<8, 3>(xi), 1, out[point])) return false;
    }
    return true;
}

bool meshless_point(const Vec3 (&x)[8], const double (&weight)[8], double volume, GaussPoint<8, 3>& out) {
    if (!(volume > 0)) return false;
    double sum = 0;
    Vec3 mean = Vec3::Zero();
    for (int n = 0; n < 8; ++n) {
        if (!(weight[n] >= 0)) return false;
        sum += weight[n];
        mean += weight[n] * (x[n] - x[0]);
    }
    if (!(sum > 0) || !std::isfinite(sum)) return false;
    mean = x[0] + mean / sum;
    Mat3 moment = Mat3::Zero();
    for (int n = 0; n < 8; ++n) moment += weight[n] / sum * (x[n] - mean) * (x[n] - mean).transpose();
    const double size = moment.trace();
    if (!(moment.determinant() > kLeastExtent * size * size * size) || !std::isfinite(size)) return false;
    const Mat3 inverse = moment.inverse();
    for (int n = 0; n < 8; ++n) Vec3::Map(out.g[n]) = weight[n] / sum * (inverse * (x[n] - mean));
    out.weight = volume;
    return true;
}

bool quadratic_bend_weights(const Vec3 (&x)[4], double (&weight)[4], double& area) {
    const Vec3 e = x[1] - x[0];
    double cotangent[2][2];  // [triangle][end of the edge]
    area = 0;
    for (int side = 0; side < 2; ++side) {
        const Vec3 r = x[2 + side] - x[0], s = x[2 + side] - x[1];
        const double twice = e.cross(r).norm();
        if (!(twice > kLeastExtent * e.norm() * r.norm()) || !std::isfinite(twice)) return false;
        cotangent[side][0] = e.dot(r) / twice;
        cotangent[side][1] = -e.dot(s) / twice;
        area += 0.5 * twice;
    }
    weight[0] = cotangent[0][1] + cotangent[1][1];
    weight[1] = cotangent[0][0] + cotangent[1][0];
    weight[2] = -cotangent[0][0] - cotangent[0][1];
    weight[3] = -cotangent[1][0] - cotangent[1][1];
    return true;
}

}  // namespace taut
