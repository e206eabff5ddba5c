// Distance.  C = |d| - length [m], d = p_b - p_a, p = x + R s;  u = d/|d|;
// J_b = (u^T, (r_b x u)^T), J_a = -(u^T, (r_a x u)^T);
// K = B^T (-lambda/|d|) (I - u u^T) B + lever parts,  B = (-I, hat r_a, I, -hat r_b)
//                                                     (Tournier et al. 2015, eq. 14 and 18; levers eq. 22)
// lambda < 0 is tension; the first part is positive only then.
#include "constraints/distance.h"

#include <algorithm>

#include "constraints/constraint.h"
#include "constraints/lever.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct Span {
    Vec3 ra, rb, u;
    double length;
};

Span span_of(const DistanceData& rod, const Pose* x) {
    Span s;
    s.ra = x[0].R * rod.anchor_a;
    s.rb = x[1].R * rod.anchor_b;
    const Vec3 d = (x[1].x - x[0].x) + (s.rb - s.ra);
    s.length = d.norm();
    s.u = s.length > 1e-12 ? Vec3(d / s.length) : Vec3(Vec3::UnitX());  // any direction will do to part them again
    return s;
}

void evaluate_distance(const void* data, const Pose* x, double* error, double* jacobian) {
    const auto& rod = *static_cast<const DistanceData*>(data);
    const Span s = span_of(rod, x);
    *error = s.length - rod.length;
    if (!jacobian) return;
    Vec3::Map(jacobian) = -s.u;
    Vec3::Map(jacobian + 3) = -s.ra.cross(s.u);
    Vec3::Map(jacobian + 6) = s.u;
    Vec3::Map(jacobian + 9) = s.rb.cross(s.u);
}

void stiffness_of_distance(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const auto& rod = *static_cast<const DistanceData*>(data);
    const Span s = span_of(rod, x);
    std::fill(k, k + 12 * 12, 0.0);
    const Vec3 f = *lambda * s.u;
    add_block(k, 3, 3, lever_stiffness(-f, s.ra, part));
    add_block(k, 9, 9, lever_stiffness(f, s.rb, part));
    if (part == Curvature::positive && *lambda >= 0) return;
    const Mat3 t = -*lambda / std::max(s.length, 1e-12) * (Mat3::Identity() - s.u * s.u.transpose());
    add_block(k, 0, 0, t);
    add_block(k, 0, 6, -t);
    add_block(k, 6, 0, -t);
    add_block(k, 6, 6, t);
    if (s.ra.isZero(0) && s.rb.isZero(0)) return;  // between particles
    const Mat3 a = hat(s.ra), b = hat(s.rb), ta = t * a, tb = t * b;
    const Mat3 lever[4][4] = {{Mat3::Zero(), -ta, Mat3::Zero(), tb},
                              {-ta.transpose(), a.transpose() * ta, ta.transpose(), -a.transpose() * tb},
                              {Mat3::Zero(), ta, Mat3::Zero(), -tb},
                              {tb.transpose(), -b.transpose() * ta, -tb.transpose(), b.transpose() * tb}};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) add_block(k, 3 * i, 3 * j, lever[i][j]);
}

Line line(const void* data, const Pose* x) {
    const Span s = span_of(*static_cast<const DistanceData*>(data), x);
    return {std::max(s.length, 1e-12) * s.u, s.ra, s.rb};
}

void sample_distance(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& rod = *static_cast<DistanceData*>(data);
    rod = {random.vector(), random.vector(), 0.5 + random.unit()};
    random.poses(x, 2);
}

}  // namespace

const ConstraintType kDistance{"distance",
                               1,
                               2,
                               sizeof(DistanceData),
                               Bound::free,
                               true,
                               0,
                               evaluate_distance,
                               stiffness_of_distance,
                               nullptr,
                               sample_distance,
                               line};

}  // namespace taut
