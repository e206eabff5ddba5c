// Bending of two triangles: angles of known folds, and the quadratic form beside them.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "continuum_lab.h"

namespace taut::test {
namespace {

// Two triangles over an edge of some length, the second folded up by an angle.
struct FoldedPair {
    explicit FoldedPair(double angle, uint64_t seed = 1) {
        Random random(seed);
        const double length = random.between(0.5, 2), first = random.between(0.5, 2), second = random.between(0.5, 2);
        const double along = random.between(0, 1), other = random.between(0, 1);
        x[0] = Vec3::Zero();
        x[1] = Vec3(length, 0, 0);
        x[2] = Vec3(length * along, first, 0);
        x[3] = Vec3(length * other, -second * std::cos(angle), second * std::sin(angle));
        const Mat3 turn = random.rotation().toRotationMatrix();
        for (Vec3& each : x) each = turn * each + Vec3(1, 2, -1);
        edge = length;
        area = 0.5 * length * (first + second);
    }
    void put(Single& at) const {
        for (int n = 0; n < 4; ++n) at.pose[n].x = x[n];
    }
    Vec3 x[4];
    double edge, area;
};

double turned_by(const Single& at) { return at.error()[0]; }

TEST(Bending, AnglesAreThoseOfKnownFolds) {
    for (int step = -31; step <= 31; ++step) {
        const double angle = 0.1 * step;
        Single at(kDihedralElement);
        FoldedPair(angle, static_cast<uint64_t>(step + 40)).put(at);
        at.data[0] = 0;
        EXPECT_NEAR(turned_by(at), angle, 1e-14);
        at.data[0] = 0.3;
        EXPECT_NEAR(std::remainder(turned_by(at) - (angle - 0.3), 2 * std::numbers::pi), 0, 1e-14);
        EXPECT_LE(std::abs(turned_by(at)), std::numbers::pi);
    }
}

// Past the fold the short way round goes on the other side.
TEST(Bending, FollowsTheShortWayToItsRest) {
    Single at(kDihedralElement);
    FoldedPair(-3).put(at);
    at.data[0] = 3;
    EXPECT_NEAR(turned_by(at), 2 * std::numbers::pi - 6, 1e-13);
}

TEST(Bending, QuadraticFormIsTheChordOfTheAngle) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Single at(kQuadraticBendElement);
        double weight[4], area;
        const FoldedPair flat(0, seed);
        ASSERT_TRUE(quadratic_bend_weights(flat.x, weight, area));
        EXPECT_NEAR(area, flat.area, 1e-13);
        at.data.assign(weight, weight + 4);
        for (const double angle : {0.0, 0.1, -0.7, 2.0, 3.1}) {
            FoldedPair(angle, seed).put(at);
            EXPECT_NEAR(at.error().norm(), 2 * flat.edge * std::abs(std::sin(0.5 * angle)), 1e-13);
        }
    }
}

// Of plates of the same stiffness: the energies agree to second order in the angle.
TEST(Bending, FormsAgreeForSmallAngles) {
    constexpr double kPlate = 2.5;
    for (const double angle : {0.1, 0.01}) {
        const FoldedPair flat(0, 3), bent(angle, 3);
        double weight[4], area;
        ASSERT_TRUE(quadratic_bend_weights(flat.x, weight, area));
        Single hinge(kDihedralElement), quadratic(kQuadraticBendElement);
        quadratic.data.assign(weight, weight + 4);
        bent.put(hinge);
        bent.put(quadratic);
        const double a = hinge.energy(Matrix::Constant(1, 1, kPlate * 3 * flat.edge * flat.edge / area));
        const double b = quadratic.energy(kPlate * 3 / area * Matrix::Identity(3, 3));
        EXPECT_NEAR(b / a, 1, angle * angle / 11);
        const Vector force = quadratic.force(kPlate * 3 / area * Matrix::Identity(3, 3));
        const Vector other = hinge.force(Matrix::Constant(1, 1, kPlate * 3 * flat.edge * flat.edge / area));
        EXPECT_LE((force - other).norm(), angle * force.norm());
    }
}

// A triangle without height has a finite force and no stiffness beyond what its edge can bear.
TEST(Bending, StaysFiniteOfFlatTriangles) {
    for (const double height : {0.0, 1e-200, 1e-12, 1e-6}) {
        Single at(kDihedralElement);
        FoldedPair(0.5).put(at);
        at.pose[2].x = at.pose[0].x + 0.3 * (at.pose[1].x - at.pose[0].x) + Vec3(0, 0, height);
        EXPECT_TRUE(at.error().allFinite());
        EXPECT_TRUE(at.jacobian().allFinite());
        EXPECT_LE(largest(at.jacobian()), 3e6);
        EXPECT_TRUE(at.stiffness(Vector::Ones(1), Curvature::positive).allFinite());
        at.pose[1] = at.pose[0];
        EXPECT_EQ(largest(at.jacobian()), 0);
        EXPECT_TRUE(at.stiffness(Vector::Ones(1), Curvature::positive).allFinite());
    }
}

}  // namespace
}  // namespace taut::test
