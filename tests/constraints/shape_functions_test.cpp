// Rest shapes: contents, gradients that reproduce linear fields, and what is refused.
#include <gtest/gtest.h>

#include <limits>

#include "continuum_lab.h"

namespace taut::test {
namespace {

TEST(ShapeFunctions, ReproduceLinearFieldsAndFillTheirPatch) {
    for (const ShapeCase& shape : shape_cases())
        for (uint64_t seed = 1; seed <= 20; ++seed) {
            SCOPED_TRACE(testing::Message() << shape.name << ", seed " << seed);
            const Patch patch = shape.patch(seed);
            double content = 0;
            for (const ShapePoint& point : patch.points) {
                content += point.weight;
                Matrix x(3, static_cast<long>(point.nodes.size()));
                for (size_t n = 0; n < point.nodes.size(); ++n)
                    x.col(static_cast<long>(n)) = patch.rest[point.nodes[n]];
                EXPECT_LE(largest(point.g.rowwise().sum()), 1e-12);
                EXPECT_LE(largest(x * point.g.transpose() - patch.axes), 1e-12);
            }
            EXPECT_NEAR(content, patch.content, 1e-11);
        }
}

TEST(ShapeFunctions, OfFewerNeighboursLeaveTheOthersAlone) {
    const Vec3 x[8] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}};
    GaussPoint<8, 3> point;
    ASSERT_TRUE(meshless_point(x, {1, 2, 1, 1, 0.5, 0, 0, 0}, 0.1, point));
    for (int n = 5; n < 8; ++n) EXPECT_EQ(Vec3(Vec3::Map(point.g[n])).norm(), 0);
    EXPECT_EQ(point.weight, 0.1);
}

// The first axis follows u, whatever else the coordinates do.
TEST(ShapeFunctions, FollowTheWarpOfTextureCoordinates) {
    const Vec3 x[3] = {{1, 2, 3}, {2, 2, 3.5}, {1.2, 3, 3}};
    const double uv[3][2] = {{0.1, 0.2}, {0.7, 0.5}, {-0.3, 0.9}};
    const Vec3 warp = warp_of(x, uv);
    GaussPoint<3, 2> point;
    ASSERT_TRUE(tri3_point(x, warp, point));
    Eigen::Vector2d u = Eigen::Vector2d::Zero(), v = u;  // du/dX, dv/dX
    for (int n = 0; n < 3; ++n) {
        u += uv[n][0] * Eigen::Vector2d::Map(point.g[n]);
        v += uv[n][1] * Eigen::Vector2d::Map(point.g[n]);
    }
    EXPECT_NEAR(u.x() * warp.norm(), 1, 1e-12);
    EXPECT_NEAR(v.x(), 0, 1e-12);
    const double flat[3][2] = {{0, 0}, {1, 1}, {2, 2}};
    EXPECT_EQ(warp_of(x, flat).norm(), 0);
}

TEST(ShapeFunctions, RefuseWhatHasNoExtentOrIsInverted) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Vec3 o = Vec3::Zero(), x = Vec3::UnitX(), y = Vec3::UnitY(), z = Vec3::UnitZ();
    GaussPoint<3, 2> tri;
    EXPECT_TRUE(tri3_point({o, x, y}, x, tri));
    EXPECT_FALSE(tri3_point({o, x, 2 * x}, x, tri));
    EXPECT_FALSE(tri3_point({o, o, o}, x, tri));
    EXPECT_FALSE(tri3_point({o, x, y}, z, tri));
    EXPECT_FALSE(tri3_point({o, x, y}, o, tri));
    EXPECT_FALSE(tri3_point({o, x, Vec3(nan, 1, 0)}, x, tri));
    GaussPoint<4, 2> quad[4];
    EXPECT_TRUE(quad4_points({o, x, x + y, y}, x, quad));
    EXPECT_FALSE(quad4_points({o, x + y, x, y}, x, quad));          // crossed
    EXPECT_FALSE(quad4_points({o, x, 0.1 * (x + y), y}, x, quad));  // a corner turned in
    EXPECT_FALSE(quad4_points({o, x, 2 * x, 3 * x}, x, quad));
    GaussPoint<4, 3> tet;
    EXPECT_TRUE(tet4_point({o, x, y, z}, tet));
    EXPECT_FALSE(tet4_point({o, y, x, z}, tet));
    EXPECT_FALSE(tet4_point({o, x, y, x + y}, tet));
    EXPECT_FALSE(tet4_point({o, x, y, Vec3(0, 0, std::numeric_limits<double>::infinity())}, tet));
    GaussPoint<8, 3> hex[8];
    EXPECT_TRUE(hex8_points({o, x, x + y, y, z, x + z, x + y + z, y + z}, hex));
    EXPECT_FALSE(hex8_points({z, x + z, x + y + z, y + z, o, x, x + y, y}, hex));
    EXPECT_FALSE(hex8_points({o, x, x + y, y, o, x, x + y, y}, hex));
    EXPECT_TRUE(meshless_point({o, x, y, z, o, x, y, z}, {1, 1, 1, 1, 1, 1, 1, 1}, 1, hex[0]));
    EXPECT_FALSE(meshless_point({o, x, y, z, o, x, y, z}, {1, 1, 1, 0, 1, 1, 1, 0}, 1, hex[0]));  // in a plane
    EXPECT_FALSE(meshless_point({o, x, y, z, o, x, y, z}, {1, 1, 1, 1, 1, 1, 1, -1}, 1, hex[0]));
    EXPECT_FALSE(meshless_point({o, x, y, z, o, x, y, z}, {}, 1, hex[0]));
    EXPECT_FALSE(meshless_point({o, x, y, z, o, x, y, z}, {1, 1, 1, 1, 1, 1, 1, 1}, 0, hex[0]));
    double weight[4], area;
    EXPECT_TRUE(quadratic_bend_weights({o, x, y, x - y}, weight, area));
    EXPECT_FALSE(quadratic_bend_weights({o, x, 2 * x, -y}, weight, area));
    EXPECT_FALSE(quadratic_bend_weights({o, o, y, -y}, weight, area));
}

// Size is no matter.
TEST(ShapeFunctions, AreTheSameOfAnySize) {
    for (const double size : {1e-6, 1e6}) {
        const Vec3 o(1, 1, 1), x = o + size * Vec3::UnitX(), y = o + size * Vec3::UnitY(), z = o + size * Vec3::UnitZ();
        GaussPoint<4, 3> tet;
        ASSERT_TRUE(tet4_point({o, x, y, z}, tet));
        EXPECT_NEAR(tet.weight, size * size * size / 6, 1e-9 * size * size * size);
        GaussPoint<3, 2> tri;
        ASSERT_TRUE(tri3_point({o, x, y}, Vec3::UnitX(), tri));
        EXPECT_NEAR(tri.g[1][0], 1 / size, 1e-9 / size);
    }
}

}  // namespace
}  // namespace taut::test
