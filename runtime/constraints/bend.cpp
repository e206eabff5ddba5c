// Bend of a line through three points.  C = u_2 - u_1 [rad], u = d/|d|, d_1 = p_b - p_a, d_2 = p_c - p_b, p = x + R s:
// of size 2 sin(angle/2), across the line where that is small. With angular compliance span/EI the energy is that of a
// beam of which `span` metres bend at p_b,  EI/(2 span) |C|^2 = EI/span (1 - cos angle), and the moment EI/span sin.
// J_a = P_1/l_1 B_a, J_b = -(P_1/l_1 + P_2/l_2) B_b, J_c = P_2/l_2 B_c,  P = I - u u^T, B = (I, -hat r);
// K = sum over both stretches of B^T T B + lever parts, T the stiffness_of_bend of lambda . u(d):
//   T = ((u.q) P + u q_p^T + q_p u^T)/l^2,  q_p = P q,  q = lambda at d_2 and -lambda at d_1.
#include "constraints/bend.h"

#include <algorithm>
#include <cmath>

#include "constraints/constraint.h"
#include "constraints/lever.h"
#include "constraints/random.h"

namespace taut {
namespace {

using PointJacobian = Eigen::Matrix<double, 3, kDof>;

struct Stretch {
    Vec3 u;
    double length;
};

Stretch stretch_of(const Vec3& d) {
    const double length = d.norm();
    if (length > 1e-12) return {d / length, length};
    return {Vec3::UnitX(), 1e-12};
}

struct Points {
    Points(const BendData& bend, const Pose* x) {
        const Vec3* anchor[3] = {&bend.anchor_a, &bend.anchor_b, &bend.anchor_c};
        for (int n = 0; n < 3; ++n) r[n] = x[n].R * *anchor[n];
        for (int s = 0; s < 2; ++s) stretch[s] = stretch_of((x[s + 1].x - x[s].x) + (r[s + 1] - r[s]));
    }
    PointJacobian moves_with(int n) const {
        PointJacobian b;
        b << Mat3::Identity(), -hat(r[n]);
        return b;
    }

    Vec3 r[3];
    Stretch stretch[2];
};

// How u turns with its d.
Mat3 turning(const Stretch& s) { return (Mat3::Identity() - s.u * s.u.transpose()) / s.length; }

void evaluate_bend(const void* data, const Pose* x, double* error, double* jacobian) {
    const Points p(*static_cast<const BendData*>(data), x);
    Vec3::Map(error) = p.stretch[1].u - p.stretch[0].u;
    if (!jacobian) return;
    const Mat3 first = turning(p.stretch[0]), second = turning(p.stretch[1]);
    const Mat3 part[3] = {first, -(first + second), second};
    for (int n = 0; n < 3; ++n) {
        set_block(jacobian, 3, n, 0, part[n]);
        set_block(jacobian, 3, n, 3, -part[n] * hat(p.r[n]));
    }
}

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

void stiffness_of_bend(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const Points p(*static_cast<const BendData*>(data), x);
    Eigen::Map<Eigen::Matrix<double, 3 * kDof, 3 * kDof, Eigen::RowMajor>> sum(k);
    sum.setZero();
    for (int s = 0; s < 2; ++s) {
        const Vec3 q = (s == 0 ? -1 : 1) * Vec3::Map(lambda), pull = turning(p.stretch[s]) * q;
        const Mat3 t = stretch_stiffness(p.stretch[s], q, part);
        for (int n = s; n <= s + 1; ++n) {
            for (int m = s; m <= s + 1; ++m)
                sum.block<kDof, kDof>(kDof * n, kDof * m) +=
                    (n == m ? 1 : -1) * p.moves_with(n).transpose() * t * p.moves_with(m);
            sum.block<3, 3>(kDof * n + 3, kDof * n + 3) += lever_stiffness(n == s ? -pull : pull, p.r[n], part);
        }
    }
}

void sample_bend(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& bend = *static_cast<BendData*>(data);
    bend = {random.vector(), random.vector(), random.vector()};
    random.poses(x, 3);
}

}  // namespace

const ConstraintType kBend{
    "bend", 3, 3, sizeof(BendData), Bound::free, true, 0b111, evaluate_bend, stiffness_of_bend, nullptr, sample_bend};

}  // namespace taut
