// Angle between two triangles over their common edge.  C = theta - rest [rad], of the points 0 and 1 of the edge, 2 of
// the first triangle and 3 of the second; theta = 0 where they lie flat on two sides of it, and grows as 2 and 3 rise
// to the side of the normals. With e = p_1 - p_0, r_2 = p_2 - p_0, r_3 = p_3 - p_0, normals m_2 = e x r_2, m_3 = r_3 x
// e,
//   dtheta/dr_i = h_i = |e| m_i/|m_i|^2,   dtheta/de = -t_2 h_2 - t_3 h_3,   t_i = r_i.e/|e|^2
// (Bridson et al. 2003; Grinspun et al. 2003), and K = -lambda d2theta/dx2 by differentiating these once more, a part
// of each triangle; its positive part is bounded by the sum of theirs. The energy of a plate of bending stiffness kappa
// [N m] is 1/2 kappa 3 |e|^2/(A_2 + A_3) C^2.
#include <algorithm>
#include <cmath>

#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

// One of the two triangles, r its third point: h, t and what h turns by.
struct DihedralSide {
    Vec3 r, normal;
    double sign;  // dm/dr = sign hat(e)
    Vec3 h = Vec3::Zero();
    double t = 0;
    Mat3 by_normal = Mat3::Zero();  // dh/dm where |e| stays

    // Height over the edge is not told from none below a millionth of its length.
    DihedralSide(const Vec3& e, const Vec3& point, double side) : r(point), normal(side * e.cross(point)), sign(side) {
        const double edge = e.squaredNorm();
        if (!(edge > 1e-24)) return;
        const double square = std::max(normal.squaredNorm(), 1e-12 * edge * edge), length = std::sqrt(edge);
        h = length / square * normal;
        t = r.dot(e) / edge;
        by_normal = length / square * (Mat3::Identity() - 2 / square * normal * normal.transpose());
    }
};

struct Dihedral {
    static constexpr int kRows = 1, kPoints = 4;
    static constexpr uint8_t kAngular = 1;
    struct Data {
        double rest;
    };
    using SideHessian = Eigen::Matrix<double, 6, 6>;  // of e, r
    using Gradient = Eigen::Matrix<double, 4, 3, Eigen::RowMajor>;

    struct Fold {
        Vec3 e;
        DihedralSide side[2];
        explicit Fold(const Vec3* p) : e(p[1] - p[0]), side{{e, p[2] - p[0], 1}, {e, p[3] - p[0], -1}} {}
    };

    static void evaluate(const Data& data, const Vec3* p, double* error, double* jacobian) {
        constexpr double kPi = 3.14159265358979324;
        const Fold fold(p);
        const auto& [a, b] = fold.side;
        const double angle = angle_of(fold.e.dot(b.normal.cross(a.normal)), fold.e.norm() * a.normal.dot(b.normal));
        const double bend = angle - data.rest;
        *error = bend > kPi ? bend - 2 * kPi : bend < -kPi ? bend + 2 * kPi : bend;
        if (jacobian) Eigen::Map<Gradient>{jacobian} = gradient(fold);
    }

    static Gradient gradient(const Fold& fold) {
        const auto& [a, b] = fold.side;
        Gradient j;
        j.row(1) = -(a.t * a.h + b.t * b.h).transpose();
        j.row(2) = a.h.transpose();
        j.row(3) = b.h.transpose();
        j.row(0) = -(j.row(1) + j.row(2) + j.row(3));
        return j;
    }

    static SideHessian side_hessian(const Vec3& e, const DihedralSide& at) {
        const double edge = e.squaredNorm();
        if (!(edge > 1e-24)) return SideHessian::Zero();
        const Mat3 by_r = at.sign * at.by_normal * hat(e);
        const Mat3 by_e = -at.sign * at.by_normal * hat(at.r) + at.h * e.transpose() / edge;
        const Vec3 slope = (at.r - 2 * at.t * e) / edge;  // dt/de
        const Mat3 own = -(at.h * slope.transpose() + at.t * by_e);
        SideHessian out;
        out << 0.5 * (own + own.transpose()), by_e.transpose(), by_e, 0.5 * (by_r + by_r.transpose());
        return out;
    }

    // Of s times the Hessian of one side. Moves within the plane leave the angle, and so do moves out of it but for
    // their first order: what is left is a 2x4 matrix B between these, with the eigenvalues +-s_k of B = sum s_k y_k
    // z_k^T.
    static SideHessian positive_side(const Vec3& e, const DihedralSide& at, double s) {
        const double length = e.norm(), area = at.normal.norm();
        if (!(length > 1e-12 && area > 0)) return SideHessian::Zero();
        const Vec3 along = e / length, up = at.normal / area;
        Mat3 frame;
        frame << along, up.cross(along), up;
        SideHessian turn = SideHessian::Zero();
        turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = frame;
        const SideHessian h = s * (turn.transpose() * side_hessian(e, at) * turn);
        constexpr int kPlane[4] = {0, 1, 3, 4}, kUp[2] = {2, 5};
        const Eigen::Vector4d b[2] = {h(kPlane, kUp[0]), h(kPlane, kUp[1])};
        const double product = b[0].dot(b[1]);
        double c = 1, w = 0;  // cosine and sine of what makes y^T B orthogonal
        if (product != 0) {
            const double cotangent = (b[1].squaredNorm() - b[0].squaredNorm()) / (2 * product);
            const double t =
                std::copysign(1.0, cotangent) / (std::abs(cotangent) + std::sqrt(1 + cotangent * cotangent));
            c = 1 / std::sqrt(1 + t * t), w = c * t;
        }
        SideHessian out = SideHessian::Zero();
        for (const Eigen::Vector2d& y : {Eigen::Vector2d(c, -w), Eigen::Vector2d(w, c)}) {
            const Eigen::Vector4d z = y[0] * b[0] + y[1] * b[1];
            const double size = z.norm();
            if (!(size > 0)) continue;
            Eigen::Matrix<double, 6, 1> direction;
            direction(kPlane) = z / size;
            direction(kUp) = y;
            out += 0.5 * size * direction * direction.transpose();
        }
        return turn * out * turn.transpose();
    }

    // Adds one side's to the nodes'; the columns of node 0 are those that leave none over.
    static void add_side(const SideHessian& h, int point, PointStiffness<Dihedral>& k) {
        const int node[2] = {1, point};
        for (int n = 0; n < 2; ++n)
            for (int m = 0; m < 2; ++m) {
                const Mat3 block = h.block<3, 3>(3 * n, 3 * m);
                k.block<3, 3>(3 * node[n], 3 * node[m]) += block;
                k.block<3, 3>(0, 3 * node[m]) -= block;
                k.block<3, 3>(3 * node[n], 0) -= block;
                k.block<3, 3>(0, 0) += block;
            }
    }

    static PointStiffness<Dihedral> curvature(const Fold& fold, double s, Curvature part) {
        PointStiffness<Dihedral> k = PointStiffness<Dihedral>::Zero();
        for (int i = 0; i < 2 && s != 0; ++i) {
            const DihedralSide& at = fold.side[i];
            add_side(part == Curvature::raw ? SideHessian(s * side_hessian(fold.e, at)) : positive_side(fold.e, at, s),
                     2 + i, k);
        }
        return k;
    }

    static void stiffness(const Data&, const Vec3* p, const double* lambda, Curvature part, double* k) {
        PointStiffness<Dihedral>::Map(k) = curvature(Fold(p), -*lambda, part);
    }
    static void hessian(const Data&, const Vec3* p, const double* lambda, const double* d, double softness,
                        Curvature part, double* k) {
        const Fold fold(p);
        const Gradient slopes = gradient(fold);
        const auto j = Eigen::Matrix<double, 12, 1>::Map(slopes.data());
        PointStiffness<Dihedral>::Map(k) = curvature(fold, -*lambda, part) + *d / softness * j * j.transpose();
    }
};

// Two triangles about as high as the edge is long, bent by less than a right angle from their rest.
void sample_dihedral(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    *static_cast<double*>(data) = random.between(-0.7, 0.7);
    random.poses(x, 4);
    const Quat turn = random.rotation(), fold = rotation_from_vector(Vec3(random.between(-1.5, 1.5), 0, 0));
    const Vec3 at[4] = {Vec3::Zero(), Vec3::UnitX(), Vec3(0.5, 1, 0), fold * Vec3(0.5, -1, 0)}, place = random.vector();
    for (int n = 0; n < 4; ++n) x[n].x = place + turn * (at[n] + 0.2 * random.vector());
}

}  // namespace

constinit const ElementType kDihedralElement =
    point_element<Dihedral>("dihedral", sample_dihedral, &ElementKernels::dihedral);

}  // namespace taut
