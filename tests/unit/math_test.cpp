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

TEST(SineCosine, AreThoseOfAnyAngle) {
    double worst = 0;
    for (double size : {1e-9, 1.0, 3.0, 30.0, 1e3, 1e6})
        for (int i = -5000; i <= 5000; ++i) {
            const double x = size * i / 5000;
            const SineCosine found = sine_cosine(x);
            worst = std::max({worst, std::abs(found.sine - std::sin(x)), std::abs(found.cosine - std::cos(x))});
        }
#if defined(_WIN32)
    EXPECT_LE(worst, 2e-15);  // that C library has pi to 66 bits
#else
    EXPECT_LE(worst, 3e-16);
#endif
    // What a quarter lacks of its rounded value (Muller 2016, table 1.1) is the cosine there.
    EXPECT_NEAR(sine_cosine(kHalfPi).cosine, 6.123233995736766e-17, 1e-31);
    EXPECT_NEAR(sine_cosine(2 * kHalfPi).sine, 1.2246467991473532e-16, 1e-31);
}

TEST(Hypotenuse, IsTheLengthWithinAnUlp) {
    std::mt19937_64 engine(5);
    std::uniform_real_distribution<double> exponent(-500, 500), apart(-60, 60), mantissa(1, 2);
    long double worst = 0;
    for (int i = 0; i < 200000; ++i) {
        const int scale = static_cast<int>(exponent(engine));
        const double x = std::ldexp(mantissa(engine), scale);
        const double y =
            std::ldexp(mantissa(engine), scale + static_cast<int>(i % 2 ? apart(engine) / 20 : apart(engine)));
        const long double exact = std::sqrt(static_cast<long double>(x) * x + static_cast<long double>(y) * y);
        worst = std::max(worst, std::abs(hypotenuse(x, y) - exact) / exact);
        EXPECT_EQ(hypotenuse(-y, x), hypotenuse(x, y));
    }
    EXPECT_LE(worst, 0x1p-52L);  // half an ulp is 2^-53 of a power of two
    EXPECT_EQ(hypotenuse(3, 4), 5);
    EXPECT_EQ(hypotenuse(0, 0), 0);
    EXPECT_EQ(hypotenuse(0x3p+1000, 0x4p+1000), 0x5p+1000);
    EXPECT_EQ(hypotenuse(0x3p-1060, 0x4p-1060), 0x5p-1060);
    EXPECT_EQ(hypotenuse(1e300, 1e-300), 1e300);
    EXPECT_TRUE(std::isnan(hypotenuse(std::nan(""), 1)));
    EXPECT_TRUE(std::isinf(hypotenuse(HUGE_VAL, 1)));
}

// What Eigen adds in which order, and what it takes for the least, hangs on the processor's registers.
TEST(Eigen, AddsFloatsInOneOrderEverywhere) {
    std::mt19937_64 engine(6);
    std::uniform_real_distribution<float> number(-1, 1);
    int told = 0;
    for (int i = 0; i < 1000; ++i) {
        Eigen::Matrix<float, 6, 1> a;
        Mat3f m, n;
        for (int k = 0; k < 6; ++k) a[k] = number(engine);
        for (int k = 0; k < 9; ++k) m.data()[k] = number(engine), n.data()[k] = number(engine);
        const Vec3f v = a.head<3>();
        EXPECT_EQ(v.sum(), v[0] + (v[1] + v[2]));
        EXPECT_EQ(v.dot(m.col(0)), v[0] * m(0, 0) + (v[1] * m(1, 0) + v[2] * m(2, 0)));
        EXPECT_EQ(a.sum(), ((a[0] + a[2]) + (a[1] + a[3])) + (a[4] + a[5]));
        const Mat3f product = m * n;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(product(r, c), m(r, 0) * n(0, c) + (m(r, 1) * n(1, c) + m(r, 2) * n(2, c)));
        told += (v[0] + v[1]) + v[2] != v.sum();
    }
    EXPECT_GT(told, 0);  // the other order is another number
}

TEST(Eigen, AddsDoublesInOneOrderEverywhere) {
    std::mt19937_64 engine(7);
    std::uniform_real_distribution<double> number(-1, 1);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 a(number(engine), number(engine), number(engine)), b(number(engine), number(engine), number(engine));
        EXPECT_EQ(a.sum(), (a[0] + a[1]) + a[2]);
        EXPECT_EQ(a.dot(b), (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2]);
        Mat3 m = hat(a) + b * a.transpose();
        const Mat3 product = m * m;
        for (int c = 0; c < 3; ++c) {
            for (int r = 0; r < 2; ++r)
                EXPECT_EQ(product(r, c), (m(r, 0) * m(0, c) + m(r, 1) * m(1, c)) + m(r, 2) * m(2, c));
            EXPECT_EQ(product(2, c), m(2, 0) * m(0, c) + (m(2, 1) * m(1, c) + m(2, 2) * m(2, c)));
        }
    }
}

TEST(Eigen, TakesTheFirstOfEqualsAndOfNotANumberEverywhere) {
    const auto same = [](double a, double b) {
        return std::isnan(a) ? std::isnan(b) : a == b && std::signbit(a) == std::signbit(b);
    };
    const double values[] = {0.0, -0.0, 1, -1, std::nan("")};
    for (const double x : values)
        for (const double y : values) {
            const double least = y < x ? y : x, largest = x < y ? y : x;
            const Vec3 low = Vec3::Constant(x).cwiseMin(Vec3::Constant(y)),
                       high = Vec3::Constant(x).cwiseMax(Vec3::Constant(y));
            const Eigen::Vector4f few = Eigen::Vector4f::Constant(static_cast<float>(x)),
                                  more = Eigen::Vector4f::Constant(static_cast<float>(y));
            const Eigen::Vector4f few_low = few.cwiseMin(more), few_high = few.cwiseMax(more);
            for (int k = 0; k < 3; ++k) {
                EXPECT_TRUE(same(low[k], least)) << x << ' ' << y;
                EXPECT_TRUE(same(high[k], largest)) << x << ' ' << y;
                EXPECT_TRUE(same(double{few_low[k]}, least)) << x << ' ' << y;
                EXPECT_TRUE(same(double{few_high[k]}, largest)) << x << ' ' << y;
            }
            EXPECT_TRUE(same(Eigen::Vector2d(x, y).minCoeff(), least)) << x << ' ' << y;
            EXPECT_TRUE(same(Eigen::Vector2d(x, y).maxCoeff(), largest)) << x << ' ' << y;
        }
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
