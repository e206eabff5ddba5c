// Polynomials and rotations against libm.
#include "base/math.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace taut::test {
namespace {

constexpr double kHalfPi = 1.57079632679489661923;
constexpr double kClose = 1e-14;

TEST(Sinc, IsSineOverX) {
    EXPECT_EQ(sinc(0), 1);
    double worst = 0;
    for (int i = 1; i <= 2000; ++i) {
        const double x = kHalfPi * i / 2000;
        worst = std::max(worst, std::abs(sinc(x) - std::sin(x) / x));
        EXPECT_EQ(sinc(-x), sinc(x));
    }
    EXPECT_LE(worst, kClose);
    for (double x = 1e-300; x < 0.1; x *= 10) EXPECT_NEAR(sinc(x), std::sin(x) / x, kClose) << "x " << x;
}

TEST(Cosine, IsCosine) {
    EXPECT_EQ(cosine(0), 1);
    double worst = 0;
    for (int i = -2000; i <= 2000; ++i) {
        const double x = kHalfPi * i / 2000;
        worst = std::max(worst, std::abs(cosine(x) - std::cos(x)));
    }
    EXPECT_LE(worst, kClose);
}

TEST(DecayOver, IsTheExponential) {
    EXPECT_EQ(decay_over(0).left, 1);
    EXPECT_EQ(decay_over(0).mean, 1);
    for (double x = 1e-300; x < 1e6; x *= 1.7) {
        const Decay found = decay_over(x);
        EXPECT_NEAR(found.left, std::exp(-x), 1e-13 * std::exp(-x)) << "x " << x;
        EXPECT_NEAR(found.mean, -std::expm1(-x) / x, 1e-13 / std::max(1.0, x)) << "x " << x;
    }
    EXPECT_EQ(decay_over(1e6).left, 0);
}

TEST(AngleOf, IsTheArcTangentAllAround) {
    double worst = 0;
    for (double radius : {1e-300, 1e-9, 1.0, 1e9, 1e150})
        for (int i = -20000; i <= 20000; ++i) {
            const double y = radius * std::sin(i * kHalfPi / 10000), x = radius * std::cos(i * kHalfPi / 10000);
            worst = std::max(worst, std::abs(angle_of(y, x) - std::atan2(y, x)));
            EXPECT_EQ(angle_of(-y, x), y == 0 ? angle_of(y, x) : -angle_of(y, x));
        }
    EXPECT_LE(worst, 9e-16);
    for (double tiny = 1e-300; tiny < 0.1; tiny *= 10) EXPECT_NEAR(angle_of(tiny, 1), std::atan(tiny), 3e-16 * tiny);
}

TEST(AngleOf, HasOneValueOnTheCutAndAtTheOrigin) {
    EXPECT_EQ(angle_of(0.0, -1), 2 * kHalfPi);
    EXPECT_EQ(angle_of(-0.0, -1), 2 * kHalfPi);
    EXPECT_EQ(angle_of(0, 0), 0);
    EXPECT_EQ(angle_of(1, 0), kHalfPi);
    EXPECT_EQ(angle_of(-1, 0), -kHalfPi);
}

Vec3 direction(std::mt19937_64& engine) {
    std::normal_distribution<double> number;
    return Vec3(number(engine), number(engine), number(engine)).normalized();
}

// Of any size: each halving of a large angle doubles the rounding.
TEST(RotationFromVector, IsTheRotationByItsLengthAboutItsDirection) {
    std::mt19937_64 engine(1);
    for (double angle : {0.0, 1e-300, 1e-12, 1e-3, 0.5, 1.0, 2.0, 2.9, 3.0, 3.1, 3.2, 5.0, 6.3, 20.0, 400.0}) {
        double worst = 0;
        for (int i = 0; i < 100; ++i) {
            const Vec3 axis = direction(engine);
            const Quat q = rotation_from_vector(angle * axis);
            worst = std::max({worst, std::abs(q.w() - std::cos(angle / 2)),
                              (q.vec() - std::sin(angle / 2) * axis).norm(), std::abs(q.norm() - 1)});
        }
        EXPECT_LE(worst, kClose * (1 + angle)) << "angle " << angle;
    }
}

TEST(RotationFromVector, OfTheOppositeIsTheInverse) {
    std::mt19937_64 engine(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 theta = 0.01 * i * direction(engine);
        const Quat q = rotation_from_vector(theta), back = rotation_from_vector(-theta);
        EXPECT_EQ(q.w(), back.w());
        EXPECT_EQ(q.vec(), Vec3(-back.vec()));
    }
}

TEST(RotationFromVector, OfNoTurnIsIdentity) {
    EXPECT_EQ(rotation_from_vector(Vec3::Zero()).coeffs(), Quat::Identity().coeffs());
}

// exp(hat(theta)) = I + hat(theta) + O(theta^2): the sign convention that Jacobians rely on.
TEST(Hat, IsTheCrossProductAndTheDerivativeOfTheRotation) {
    std::mt19937_64 engine(3);
    for (int i = 0; i < 100; ++i) {
        const Vec3 a = direction(engine), b = 3 * direction(engine);
        EXPECT_LE((hat(a) * b - a.cross(b)).norm(), 1e-15 * 10);
        EXPECT_EQ(hat(a).transpose(), Mat3(-hat(a)));
        const double step = 1e-5;
        const Vec3 moved = (rotation_from_vector(step * a) * b - rotation_from_vector(-step * a) * b) / (2 * step);
        EXPECT_LE((moved - a.cross(b)).norm(), 1e-9);
    }
}

TEST(Sym3, PacksAndUnpacks) {
    Mat3 m;
    m << 1, 4, 5, 4, 2, 6, 5, 6, 3;
    EXPECT_EQ(Sym3::of(m).matrix(), m);
}

}  // namespace
}  // namespace taut::test
