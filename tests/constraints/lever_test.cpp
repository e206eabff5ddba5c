// The closed form of the lever's positive part, and the types' degenerate cases in figures.
#include <gtest/gtest.h>

#include "constraints/distance.h"
#include "constraints/lever.h"
#include "constraints/random.h"
#include "instance.h"

namespace taut::test {
namespace {

TEST(Lever, NeedsForceAndArm) {
    const Vec3 v(1, -2, 3);
    for (const Vec3& zero : {Vec3(0, 0, 0), Vec3(1e-200, 0, 0)}) {
        EXPECT_EQ(lever_stiffness(zero, v, Curvature::positive), Mat3(Mat3::Zero()));
        EXPECT_EQ(lever_stiffness(v, zero, Curvature::positive), Mat3(Mat3::Zero()));
        EXPECT_TRUE(lever_stiffness(zero, v, Curvature::raw).allFinite());
    }
}

TEST(Lever, PulledAlongItIsAPendulum) {  // |f||r| about both axes across, none about the arm
    Random random(5);
    for (int i = 0; i < 50; ++i) {
        const Vec3 r = random.vector(), f = 3.5 * r, axis = r.normalized();
        const Mat3 k = lever_stiffness(f, r, Curvature::positive);
        const Mat3 expected = f.norm() * r.norm() * (Mat3::Identity() - axis * axis.transpose());
        EXPECT_LE((k - expected).norm(), 1e-14 * f.norm() * r.norm());
    }
}

TEST(Lever, PushedAlongItNothingIsKept) {
    Random random(6);
    for (int i = 0; i < 50; ++i) {
        const Vec3 r = random.vector();
        EXPECT_LE(lever_stiffness(-2 * r, r, Curvature::positive).norm(), 1e-15);
    }
}

// All the way from pull to push, and finely around both ends, where the eigenvectors lose their meaning. Within 1e-4
// of the ends the form is that of the end itself: wrong by half that angle at most.
TEST(Lever, IsTheExactPositivePartAtEveryAngle) {
    Random random(7);
    std::vector<double> angles;
    for (int i = 0; i <= 64; ++i) angles.push_back(i * std::numbers::pi / 64);
    for (double tiny = 1e-9; tiny < 1e-2; tiny *= 1.7) {
        angles.push_back(tiny);
        angles.push_back(std::numbers::pi - tiny);
    }
    for (double angle : angles) {
        const Vec3 r = 3 * random.vector(), across = r.cross(random.vector()).normalized();
        const Vec3 f = 20 * random.unit() * (Eigen::AngleAxisd(angle, across) * r);
        const double scale = f.norm() * r.norm(), from_end = std::min(angle, std::numbers::pi - angle);
        const Matrix raw = symmetric(lever_stiffness(f, r, Curvature::raw));
        const Mat3 k = lever_stiffness(f, r, Curvature::positive);
        const double tolerance = from_end < 1.1e-4 ? 0.6e-4 : 1e-11;
        EXPECT_LE(largest(k - positive_part(raw)), tolerance * scale) << "angle " << angle;
        EXPECT_GE(least_eigenvalue(k), -1e-12 * scale) << "angle " << angle;
        EXPECT_GE(least_eigenvalue(k - raw), -tolerance * scale) << "angle " << angle;
    }
}

// A rod in tension between two particles is stiff across by tension over length; in compression it is not.
TEST(Distance, IsStiffAcrossByTensionOverLength) {
    DistanceData rod;
    rod.length = 2;
    Pose x[2];
    x[1].x = Vec3(0, 2.5, 0);
    RowMajor k(12, 12);
    double lambda = -30;
    kDistance.stiffness(&rod, x, &lambda, Curvature::positive, k.data());
    const Mat3 across = (Vec3(1, 0, 1) * (30 / 2.5)).asDiagonal();
    EXPECT_LE((k.block<3, 3>(0, 0) - across).norm(), 1e-13);
    EXPECT_LE((k.block<3, 3>(6, 6) - across).norm(), 1e-13);
    EXPECT_LE((k.block<3, 3>(0, 6) + across).norm(), 1e-13);
    lambda = 30;
    kDistance.stiffness(&rod, x, &lambda, Curvature::positive, k.data());
    EXPECT_EQ(k.norm(), 0);
}

// Points of a rod on top of each other: a unit direction to part them along, and forces that stay equal and opposite.
TEST(Distance, HasADirectionWhereItsPointsCoincide) {
    DistanceData rod;
    rod.length = 1;
    Pose x[2];
    x[0].x = x[1].x = Vec3(3, 4, 5);
    double error = 0, jacobian[12];
    kDistance.evaluate(&rod, x, &error, jacobian);
    EXPECT_EQ(error, -1);
    const Vec3 a = Vec3::Map(jacobian), b = Vec3::Map(jacobian + 6);
    EXPECT_DOUBLE_EQ(b.norm(), 1);
    EXPECT_EQ(a, -b);
}

}  // namespace
}  // namespace taut::test
