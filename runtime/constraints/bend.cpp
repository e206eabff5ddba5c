// Bend of a line through three points.  C = u_2 - u_1 [rad], u = d/|d|, d_1 = p_1 - p_0, d_2 = p_2 - p_1:
// of size 2 sin(angle/2), across the line where that is small. With angular compliance span/EI the energy is that of a
// beam of which `span` metres bend at p_1,  EI/(2 span) |C|^2 = EI/span (1 - cos angle), and the moment EI/span sin.
// j_0 = P_1/l_1, j_1 = -(P_1/l_1 + P_2/l_2), j_2 = P_2/l_2,  P = I - u u^T;
// k = sum over both stretches of T, the stiffness of lambda . u(d) between its ends:
//   T = ((u.q) P + u q_p^T + q_p u^T)/l^2,  q_p = P q,  q = lambda at d_2 and -lambda at d_1.
#include "constraints/bend.h"

#include <cmath>

#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct Stretch {
    Vec3 u;
    double length;
};

Stretch stretch_of(const Vec3& d) {
    const double length = d.norm();
    if (length > 1e-12) return {d / length, length};
    return {Vec3::UnitX(), 1e-12};
}

// How u turns with its d.
Mat3 turning(const Stretch& s) { return (Mat3::Identity() - s.u * s.u.transpose()) / s.length; }

// T of q. In the plane of u and q_p it is [0 a; a b]/l^2, a = |q_p|, b = u.q, and b/l^2 across that plane.
Mat3 stretch_stiffness(const Stretch& s, const Vec3& q, Curvature part) {
    const double b = s.u.dot(q), scale = 1 / (s.length * s.length);
    const Vec3 across = q - b * s.u;
    const Mat3 projection = Mat3::Identity() - s.u * s.u.transpose();
    if (part == Curvature::raw) return scale * (b * projection + s.u * across.transpose() + across * s.u.transpose());
    const double a = across.norm();
    if (a < 1e-8 * std::abs(b)) return scale * (std::max(b, 0.0) * projection + a * Mat3::Identity());
    if (a == 0) return Mat3::Zero();
    const Vec3 v = across / a, w = s.u.cross(v);
    const double larger = 0.5 * (b + std::sqrt(b * b + 4 * a * a));
    const Vec3 e = (a * s.u + larger * v) / std::sqrt(a * a + larger * larger);
    return scale * (larger * e * e.transpose() + std::max(b, 0.0) * w * w.transpose());
}

struct Bend {
    static constexpr int kRows = 3, kPoints = 3;
    static constexpr uint8_t kAngular = 0b111;
    struct Data {};

    static void evaluate(const Data&, const Vec3* p, double* error, double* jacobian) {
        const Stretch first = stretch_of(p[1] - p[0]), second = stretch_of(p[2] - p[1]);
        Vec3::Map(error) = second.u - first.u;
        if (!jacobian) return;
        Eigen::Map<Eigen::Matrix<double, 9, 3, Eigen::RowMajor>> j(jacobian);
        j.topRows<3>() = turning(first);
        j.bottomRows<3>() = turning(second);
        j.middleRows<3>(3) = -(j.topRows<3>() + j.bottomRows<3>());
    }

    static void stiffness(const Data&, const Vec3* p, const double* lambda, Curvature part, double* k) {
        Eigen::Map<Eigen::Matrix<double, 9, 9, Eigen::RowMajor>> sum(k);
        for (int s = 0; s < 2; ++s) {
            const Vec3 q = (s == 0 ? -1 : 1) * Vec3::Map(lambda);
            const Mat3 t = stretch_stiffness(stretch_of(p[s + 1] - p[s]), q, part);
            for (int n = s; n <= s + 1; ++n)
                for (int m = s; m <= s + 1; ++m) sum.block<3, 3>(3 * n, 3 * m) += (n == m ? 1 : -1) * t;
        }
    }
};

static_assert(sizeof(Anchored<Bend>) == sizeof(BendData));

void sample_bend(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& bend = *static_cast<BendData*>(data);
    bend = {random.vector(), random.vector(), random.vector()};
    random.poses(x, Bend::kPoints);
}

void sample_points(uint64_t seed, void*, Pose* x) { Random(seed).poses(x, Bend::kPoints); }

}  // namespace

constinit const ConstraintType kBend = anchored_type<Bend>("bend", sample_bend);
constinit const ElementType kBendElement = point_element<Bend>("bend of points", sample_points);

}  // namespace taut
