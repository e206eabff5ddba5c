// Materials: what they say of simple tension and shear, and the constants that they refuse. Their energies are compared
// in continuum_test.cpp.
#include <gtest/gtest.h>

#include <limits>

#include "continuum_lab.h"

namespace taut::test {
namespace {

TEST(Materials, OrthotropicOnesAnswerTensionAndShear) {
    double c[36];
    const OrthotropicSolid wood{{12e9, 0.9e9, 0.5e9}, {0.4, 0.3, 0.35}, {0.03e9, 0.6e9, 0.7e9}};
    ASSERT_TRUE(orthotropic_solid(wood, c));
    const Matrix solid = Eigen::Map<RowMajor>(c, 6, 6);
    EXPECT_EQ(solid, solid.transpose());
    EXPECT_GT(least_eigenvalue(solid), 0);
    const Vector pulled = solid * Vector::Unit(6, 0) * 1e6, across = solid * Vector::Unit(6, 1) * 1e6;
    EXPECT_NEAR(pulled[0], 1e6 / 12e9, 1e-18);
    EXPECT_NEAR(pulled[1], -0.35 * pulled[0], 1e-18);
    EXPECT_NEAR(pulled[2], -0.3 * pulled[0], 1e-18);
    EXPECT_NEAR(across[2], -0.4 * across[1], 1e-18);
    for (int r = 0; r < 3; ++r) EXPECT_NEAR(solid(r + 3, r + 3) * wood.shear[r], 1, 1e-15);
    double s[9];
    ASSERT_TRUE(orthotropic_sheet({{2e6, 1e6}, 0.2, 3e5}, s));
    const Matrix sheet = Eigen::Map<RowMajor>(s, 3, 3);
    EXPECT_EQ(sheet, sheet.transpose());
    EXPECT_NEAR(sheet(1, 0), -0.2 * sheet(0, 0), 1e-20);
    EXPECT_NEAR(sheet(2, 2) * 3e5, 1, 1e-15);
}

TEST(Materials, RefuseWhatWouldNotResist) {
    const double infinite = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
    double alpha;
    for (const MaterialCase& material : material_cases()) {
        const auto made = [&](double young, double poisson) {
            double c[36];
            return material.make({young, poisson}, c, alpha);
        };
        SCOPED_TRACE(material.name);
        EXPECT_TRUE(made(1e6, 0.3));
        EXPECT_TRUE(made(1e-3, 0.49));
        for (const double young : {0.0, -1.0, nan, infinite}) EXPECT_FALSE(made(young, 0.3));
        for (const double poisson : {-1.0, 1.0, -infinite, nan}) EXPECT_FALSE(made(1e6, poisson));
        EXPECT_EQ(made(1e6, 0.5), material.dim == 2);
        EXPECT_EQ(made(1e6, -0.2), std::string_view(material.name) != "fixed corotated");
    }
    double solid[36] = {7}, sheet[9] = {7};
    EXPECT_TRUE(orthotropic_solid({{1e9, 1e9, 1e9}, {-0.6, -0.6, -0.6}, {1e9, 1e9, 1e9}}, solid));
    solid[0] = 7;
    EXPECT_FALSE(orthotropic_solid({{1e9, 1e9, 1e9}, {0.6, 0.6, 0.6}, {1e9, 1e9, 1e9}}, solid));
    EXPECT_FALSE(orthotropic_solid({{1e9, 1e9, 1e9}, {1.1, 0, 0}, {1e9, 1e9, 1e9}}, solid));
    EXPECT_FALSE(orthotropic_solid({{1e9, 1e9, 1e9}, {0, 0, 0}, {1e9, 0, 1e9}}, solid));
    EXPECT_FALSE(orthotropic_solid({{1e9, 1e9, nan}, {0, 0, 0}, {1e9, 1e9, 1e9}}, solid));
    EXPECT_FALSE(orthotropic_solid({{1e9, 1e9, 1e9}, {0, nan, 0}, {1e9, 1e9, 1e9}}, solid));
    EXPECT_FALSE(orthotropic_sheet({{1e6, 4e6}, 0.5, 1e6}, sheet));
    EXPECT_FALSE(orthotropic_sheet({{1e6, 4e6}, nan, 1e6}, sheet));
    EXPECT_FALSE(orthotropic_sheet({{1e6, 4e6}, 0.1, -1}, sheet));
    EXPECT_EQ(solid[0], 7);
    EXPECT_EQ(sheet[0], 7);
    EXPECT_EQ(plate_stiffness({1e9, 0.3}, 0), 0);
    EXPECT_NEAR(plate_stiffness({1e9, 0.5}, 0.001), 1.0 / 9, 1e-12);
}

}  // namespace
}  // namespace taut::test
