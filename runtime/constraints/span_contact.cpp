// Contact of a segment between two nodes, whose point moves as (1 - t) x_0 + t x_2: with a body, or another segment; or
// of a point of a surface that shares the motion of up to three nodes.
// C = basis sum w_i p_i + offset [m], p = x + R s, sum w_i = 0;  J_i = w_i basis (I, -hat r_i), r = R s, of node 0 +
// skin; K: the force w_i basis^T lambda at each lever R s, as the skin does not turn.  Rows and bound as of the plain
// contact (contact.cpp).
#include "constraints/span_contact.h"

#include <algorithm>

#include "constraints/constraint.h"
#include "constraints/lever.h"
#include "constraints/random.h"

namespace taut {
namespace {

constexpr int kNodes = 4;

void evaluate_span_contact(const void* data, const Pose* x, double* error, double* jacobian) {
    const auto& point = *static_cast<const SpanContactData*>(data);
    Vec3 apart = Vec3::Zero();
    for (int n = 0; n < kNodes; ++n) {
        const Vec3 core = x[n].R * point.anchor[n], r = n == 0 ? Vec3(core + point.skin) : core;
        apart += point.weight[n] * ((x[n].x - x[0].x) + r);
        if (!jacobian) continue;
        set_block(jacobian, 3, n, 0, point.weight[n] * point.basis);
        set_block(jacobian, 3, n, 3, -point.weight[n] * point.basis * hat(r));
    }
    Vec3::Map(error) = point.basis * apart + point.offset;
}

void stiffness_of_span_contact(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const auto& point = *static_cast<const SpanContactData*>(data);
    const Vec3 f = point.basis.transpose() * Vec3::Map(lambda);
    Eigen::Map<Eigen::Matrix<double, kNodes * kDof, kNodes * kDof, Eigen::RowMajor>> sum(k);
    sum.setZero();
    for (int n = 0; n < kNodes; ++n)
        sum.block<3, 3>(kDof * n + 3, kDof * n + 3) =
            lever_stiffness(point.weight[n] * f, x[n].R * point.anchor[n], part);
}

void sample_span_contact(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& point = *static_cast<SpanContactData*>(data);
    const double t = random.unit(), s = random.unit();
    for (Vec3& anchor : point.anchor) anchor = random.vector();
    const double weight[kNodes] = {t - 1, 1 - s, -t, s};
    std::copy(weight, weight + kNodes, point.weight);
    point.offset = random.vector();
    point.basis = random.rotation().toRotationMatrix();
    random.poses(x, kNodes);
}

}  // namespace

const ConstraintType kSpanContact{"span_contact",
                                  3,
                                  4,
                                  sizeof(SpanContactData),
                                  Bound::cone,
                                  false,
                                  0,
                                  evaluate_span_contact,
                                  stiffness_of_span_contact,
                                  nullptr,
                                  sample_span_contact};

}  // namespace taut
