// One-sided Jacobi: the columns of B = F V are turned pair by pair until they are orthogonal (Hestenes 1958). It keeps
// small singular values to full accuracy, which the eigenvalues of F^T F do not, and needs a square root alone.
#include "constraints/singular_values.h"

#include <cmath>
#include <limits>
#include <utility>

namespace taut {
namespace {

constexpr double kRounding = 4 * std::numeric_limits<double>::epsilon();

template <int Dim>
bool turn_pair(Eigen::Matrix<double, 3, Dim>& b, Eigen::Matrix<double, Dim, Dim>& v, int p, int q) {
    const double pp = b.col(p).squaredNorm(), qq = b.col(q).squaredNorm(), pq = b.col(p).dot(b.col(q));
    if (!(pq * pq > kRounding * kRounding * pp * qq)) return false;
    const double cotangent = (qq - pp) / (2 * pq);
    const double t = std::copysign(1.0, cotangent) / (std::abs(cotangent) + std::sqrt(1 + cotangent * cotangent));
    const double c = 1 / std::sqrt(1 + t * t), s = c * t;
    const auto turn = [&](auto& m) {
        const auto first = m.col(p).eval();
        m.col(p) = c * first - s * m.col(q);
        m.col(q) = s * first + c * m.col(q);
    };
    turn(b);
    turn(v);
    return true;
}

// Columns by falling length; one of each pair that changes places is turned round, which keeps det V.
template <int Dim>
void sort_columns(Eigen::Matrix<double, 3, Dim>& b, Eigen::Matrix<double, Dim, Dim>& v) {
    const auto exchange = [](auto& m, int p) {
        const auto first = m.col(p).eval();
        m.col(p) = m.col(p + 1);
        m.col(p + 1) = -first;
    };
    for (int end = Dim - 1; end > 0; --end)
        for (int p = 0; p < end; ++p)
            if (b.col(p).squaredNorm() < b.col(p + 1).squaredNorm()) exchange(b, p), exchange(v, p);
}

// The direction of a without its part along u, of b where a leaves none.
Vec3 unit_across(const Vec3& u, const Vec3& a, const Vec3& b) {
    for (const Vec3& each : {a, b}) {
        const Vec3 across = each - u * u.dot(each);
        const double length = across.norm();
        if (length > 1e-8 * each.norm()) return across / length;
    }
    return u.unitOrthogonal();
}

}  // namespace

template <int Dim>
SingularValues<Dim> singular_values(const Eigen::Matrix<double, 3, Dim>& f) {
    constexpr int kSweeps = 10;  // it converges quadratically: 4 or 5 do
    SingularValues<Dim> at;
    auto b = f;
    at.v.setIdentity();
    for (int sweep = 0, turned = 1; turned && sweep < kSweeps; ++sweep) {
        turned = 0;
        for (int p = 0; p < Dim; ++p)
            for (int q = p + 1; q < Dim; ++q) turned += turn_pair<Dim>(b, at.v, p, q);
    }
    sort_columns<Dim>(b, at.v);
    Mat3 v = Mat3::Identity();  // what U is where F leaves it open
    v.topLeftCorner<Dim, Dim>() = at.v;
    const double length = b.col(0).norm();
    at.u.col(0) = length > 0 ? Vec3(b.col(0) / length) : Vec3(v.col(0));
    const bool thin = !(b.col(1).norm() > kRounding * length);
    at.u.col(1) = thin ? unit_across(at.u.col(0), v.col(1), v.col(2)) : unit_across(at.u.col(0), b.col(1), v.col(1));
    at.u.col(2) = at.u.col(0).cross(at.u.col(1));
    for (int i = 0; i < Dim; ++i) at.sigma[i] = at.u.col(i).dot(b.col(i));
    return at;
}

template SingularValues<2> singular_values<2>(const Eigen::Matrix<double, 3, 2>&);
template SingularValues<3> singular_values<3>(const Eigen::Matrix<double, 3, 3>&);

}  // namespace taut
