// Plastic flow of one Gauss point.
#include <gtest/gtest.h>

#include <limits>

#include "constraints/plasticity.h"
#include "continuum_lab.h"

namespace taut::test {
namespace {

constexpr Plasticity kClay{0.1, 2, 0.5};
constexpr double kAtOnce = std::numeric_limits<double>::infinity();

Vec3 stretches_of_set(const Mat3& m) { return Eigen::JacobiSVD<Matrix>(m).singularValues(); }
double strain_of(const Mat3& f) {
    const Vec3 sigma = stretches_of_set(f);
    return (sigma / std::cbrt(sigma.prod()) - Vec3::Ones()).norm();
}
Mat3 pulled(double stretch) {
    return random_rotation(1) * Vec3(stretch, 1 / std::sqrt(stretch), 1 / std::sqrt(stretch)).asDiagonal() *
           random_rotation(2);
}

TEST(Plasticity, BelowTheYieldNothingFlows) {
    Mat3 set = Mat3::Identity();
    for (const Mat3& f : {pulled(1.07), Mat3(0.5 * random_rotation(3)), Mat3(3 * random_rotation(3))})
        EXPECT_FALSE(flow(f, kClay, 1, set));  // a change of volume alone does not yield
    EXPECT_FALSE(flow(pulled(2) * Vec3(1, 1, -1).asDiagonal(), kClay, 1, set));
    EXPECT_FALSE(flow(pulled(2), kClay, 0, set));
    EXPECT_EQ(set, Mat3::Identity());
}

// What is left of the strain is the yield; the volume is kept, in directions of the stretches.
TEST(Plasticity, TheExcessFlows) {
    for (const double stretch : {1.2, 1.4, 0.8}) {
        Mat3 set = Mat3::Identity();
        const Mat3 f = pulled(stretch);
        EXPECT_TRUE(flow(f, {0.1, kAtOnce, 10}, 0.01, set));
        EXPECT_NEAR(set.determinant(), 1, 1e-14);
        EXPECT_NEAR(strain_of(f * set.inverse()), 0.1, 0.1 * strain_of(f));
        for (int i = 0; i < 20; ++i) flow(f, {0.1, kAtOnce, 10}, 0.01, set);
        EXPECT_NEAR(strain_of(f * set.inverse()), 0.1, 1e-9);
    }
}

// The rate is of time, not of steps.
TEST(Plasticity, CreepsAtItsRateWhateverTheStep) {
    const Mat3 f = pulled(1.2);
    const double yield = 0.02;
    for (const int steps : {100, 1000}) {
        Mat3 set = Mat3::Identity();
        for (int i = 0; i < steps; ++i) flow(f, {yield, 2, 10}, 0.5 / steps, set);
        const double left = (strain_of(f * set.inverse()) - yield) / (strain_of(f) - yield);
        EXPECT_NEAR(left, std::exp(-2 * 0.5), 0.02);
    }
}

// Led to a strain e step by step, of which y was elastic, it yields at y + H (e - y)/(1 + H) in the end and what flowed
// is (e - y)/(1 + H), for small e; let go and led there again nothing flows.
TEST(Plasticity, HardensByWhatHasFlowed) {
    const Plasticity law{0.005, kAtOnce, 10, 0.25};
    const double strain = 0.02, gone = (strain - law.yield) / (1 + law.hardening);
    Mat3 set = Mat3::Identity();
    double flowed = 0;
    const Vec3 way = Vec3(2, -1, -1) / std::sqrt(6.0);
    const auto at = [&](double size) { return Mat3((Vec3::Ones() + size * way).asDiagonal()); };
    for (int i = 1; i <= 200; ++i) {
        const double size = strain * i / 200;
        const bool flows = flow(at(size), law, 0.01, set, &flowed);
        if (std::abs(size - law.yield) > 0.02 * law.yield) {
            EXPECT_EQ(flows, size > law.yield) << i;
        }
    }
    EXPECT_NEAR(flowed, gone, 0.02 * gone);
    EXPECT_NEAR(strain_of(at(strain) * set.inverse()), law.yield + law.hardening * gone, 0.02 * strain);
    const double then = flowed;
    for (int i = 0; i < 99; ++i) EXPECT_FALSE(flow(at(gone + (strain - gone) * i / 100), law, 0.01, set, &flowed)) << i;
    EXPECT_EQ(flowed, then);
}
// The same of additive flow, which adds up exactly.
TEST(Plasticity, HardensAdditively) {
    const Plasticity law{0.005, kAtOnce, 10, 0.25};
    const double strain = 0.02, gone = (strain - law.yield) / (1 + law.hardening);
    double offset[6] = {}, flowed = 0;
    for (int i = 1; i <= 100; ++i) {
        const double e = strain * i / 100 / std::sqrt(6.0);
        const double rows[6] = {2 * e, -e, -e, 0, 0, 0};
        flow(rows, law, 0.01, offset, &flowed);
    }
    EXPECT_NEAR(flowed, gone, 1e-12);
    EXPECT_NEAR(offset[0], 2 * gone / std::sqrt(6.0), 1e-12);
}

TEST(Plasticity, SetsStopAtTheirLimit) {
    Mat3 set = Mat3::Identity();
    for (const double stretch : {1.5, 2.0, 4.0, 8.0})
        for (int i = 0; i < 50; ++i) {
            flow(pulled(stretch), {0.1, 100, 0.5}, 0.02, set);
            EXPECT_LE((stretches_of_set(set) - Vec3::Ones()).norm(), 0.5 * (1 + 1e-9));
            EXPECT_NEAR(set.determinant(), 1, 1e-12);
        }
    EXPECT_NEAR((stretches_of_set(set) - Vec3::Ones()).norm(), 0.5, 1e-9);
}

// An element whose gradients have taken the set over is at rest where the set is all of F, and as large as before.
TEST(Plasticity, ElementsForgetTheirSet) {
    for_materials([](const ElementType& type, const ShapeCase& shape, const MaterialCase& material) {
        if (shape.dim != 3) return;
        Single at(type, 3);
        const Matrix d = modulus_of(material, {30, 0.3}, at);
        const Mat3 set = random_rotation(5) * Vec3(1.25, 1, 0.8).asDiagonal() * random_rotation(6);
        at.set_f(random_rotation(7) * set);
        EXPECT_GT(at.force(d).norm(), 1) << type.name;
        std::vector<std::array<double, 3>> out(static_cast<size_t>(at.nodes()));
        apply_set(set, reinterpret_cast<const double(*)[3]>(at.data.data()), at.nodes(),
                  reinterpret_cast<double(*)[3]>(out.data()));
        std::copy_n(out[0].data(), 3 * at.nodes(), at.data.begin());
        EXPECT_LE(largest(at.f() - random_rotation(7)), 1e-12);
        EXPECT_LE(at.force(d).norm(), 1e-10) << type.name;
    });
}

TEST(Plasticity, OffsetsOfGreenStrainFlowToTheYield) {
    const double strain[6] = {0.3, -0.1, 0.2, 0.1, -0.2, 0.4};
    const auto norm = [](const double* e) {
        return std::sqrt(Vec3::Map(e).squaredNorm() + 0.5 * Vec3::Map(e + 3).squaredNorm());
    };
    double offset[6] = {};
    EXPECT_FALSE(flow(strain, {1, 1, 10}, 1, offset));
    const double volume[6] = {0.5, 0.5, 0.5, 0, 0, 0};
    EXPECT_FALSE(flow(volume, {0.1, 1, 10}, 1, offset));
    EXPECT_TRUE(flow(strain, {0.1, kAtOnce, 10}, 0.01, offset));
    EXPECT_NEAR(offset[0] + offset[1] + offset[2], 0, 1e-15);
    double elastic[6];
    for (int r = 0; r < 6; ++r) elastic[r] = strain[r] - offset[r] - (r < 3 ? 0.4 / 3 : 0);
    EXPECT_NEAR(norm(elastic), 0.1, 1e-14);
    EXPECT_FALSE(flow(strain, {0.1 + 1e-12, kAtOnce, 10}, 0.01, offset));
    double limited[6] = {};
    for (int i = 0; i < 30; ++i) flow(strain, {0.1, 20, 0.2}, 0.02, limited);
    EXPECT_NEAR(norm(limited), 0.2, 1e-14);
}

TEST(Plasticity, YieldOfAStressIsItsStrainInTension) {
    const Isotropic steel{2e11, 0.3};
    const double stress = 2.5e8, strain = stress / steel.young;
    const double mean = strain * (1 - 2 * steel.poisson) / 3;
    const Vec3 deviator(strain - mean, -steel.poisson * strain - mean, -steel.poisson * strain - mean);
    EXPECT_NEAR(yield_of_stress(stress, steel), deviator.norm(), 1e-15);
}

}  // namespace
}  // namespace taut::test
