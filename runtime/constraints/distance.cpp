// Distance between two points.  C = |d| - length [m], d = p_1 - p_0;  j_1 = u^T = d^T/|d|, j_0 = -u^T;
// k_11 = k_00 = -k_01 = (-lambda/|d|) (I - u u^T)                     (Tournier et al. 2015, eq. 14 and 18)
// lambda < 0 is tension; k is positive only then. Between particles the element type "link", between points of bodies
// the joint "distance".
#include "constraints/distance.h"

#include "constraints/point_element.h"
#include "constraints/random.h"

namespace taut {
namespace {

struct Distance {
    static constexpr int kRows = 1, kPoints = 2;
    static constexpr uint8_t kAngular = 0;
    struct Data {
        double length;
    };

    static Vec3 unit(const Vec3& d, double length) {
        return length > 1e-12 ? Vec3(d / length) : Vec3(Vec3::UnitX());  // any direction will do to part them again
    }

    static void evaluate(const Data& rod, const Vec3* p, double* error, double* jacobian) {
        const Vec3 d = p[1] - p[0];
        const double length = d.norm();
        *error = length - rod.length;
        if (!jacobian) return;
        const Vec3 u = unit(d, length);
        Vec3::Map(jacobian) = -u;
        Vec3::Map(jacobian + 3) = u;
    }

    static void stiffness(const Data&, const Vec3* p, const double* lambda, Curvature part, double* k) {
        if (part == Curvature::positive && *lambda >= 0) return;
        const Vec3 d = p[1] - p[0];
        const double length = d.norm();
        const Vec3 u = unit(d, length);
        const Mat3 t = -*lambda / std::max(length, 1e-12) * (Mat3::Identity() - u * u.transpose());
        Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> out(k);
        out.block<3, 3>(0, 0) = out.block<3, 3>(3, 3) = t;
        out.block<3, 3>(0, 3) = out.block<3, 3>(3, 0) = -t;
    }

    static Vec3 line(const Data&, const Vec3* p) {
        const Vec3 d = p[1] - p[0];
        const double length = d.norm();
        return std::max(length, 1e-12) * unit(d, length);
    }
};

static_assert(sizeof(Anchored<Distance>) == sizeof(DistanceData));

void sample_distance(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    auto& rod = *static_cast<DistanceData*>(data);
    rod = {random.vector(), random.vector(), 0.5 + random.unit()};
    random.poses(x, Distance::kPoints);
}

void sample_link(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    *static_cast<double*>(data) = 0.5 + random.unit();
    random.poses(x, Distance::kPoints);
}

}  // namespace

constinit const ConstraintType kDistance = anchored_type<Distance>("distance", sample_distance);
constinit const ElementType kLinkElement = point_element<Distance>("link", sample_link, &ElementKernels::link);

}  // namespace taut
