// Rays, casts and distances at meshes and height fields against planes, and each against all of its triangles.
#include <gtest/gtest.h>

#include <cmath>

#include "collision_oracle.h"
#include "starts.h"

using namespace taut;
using namespace taut::collision;
using namespace taut::collision::oracle;

namespace {

// Heights of a wavy ground [m].
float wave(int row, int column) { return 0.3f * float((row * 7 + column * 3) % 5) / 4; }

Shape ground(const Vec3f& scale = Vec3f::Ones()) {
    constexpr uint32_t kSide = 33;
    std::vector<float> heights;
    for (uint32_t row = 0; row < kSide; ++row) {
        for (uint32_t column = 0; column < kSide; ++column) heights.push_back(wave(int(row), int(column)));
    }
    Shape shape;
    shape.kind = ShapeKind::surface;
    shape.size = scale;
    shape.surface = build_height_field({kSide, kSide, 0.5f, 0.5f, heights}, oracle::memory());
    return shape;
}

// The same triangles as a mesh.
Shape as_mesh(const Shape& field) {
    const std::vector<Vec3f> points = oracle::triangles_of(field);
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < points.size(); ++i) indices.push_back(i);
    Shape shape;
    shape.kind = ShapeKind::surface;
    shape.size = Vec3f::Ones();
    shape.surface = build_mesh(points, indices, false, oracle::memory());
    return shape;
}

const Placement kAt = {Vec3(10000, 50, -7000), Mat3f(Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()))};

Vec3 in_world(const Vec3& local) { return kAt.position + kAt.rotation.cast<double>() * local; }

TEST(SurfaceQueries, NoRayFromAboveSlipsThrough) {
    Random random(1);
    const Shape field = ground(), mesh = as_mesh(field);
    for (int i = 0; i < 3000; ++i) {
        const Vec3 above(random.uniform(0.5, 15.5), random.uniform(0.4, 5), random.uniform(0.5, 15.5));
        // Every third aims at a vertex.
        const int row = 1 + int(random.uniform(0, 30)), column = 1 + int(random.uniform(0, 30));
        const Vec3 below = i % 3 == 0 ? Vec3(0.5 * column, double(wave(row, column)), 0.5 * row)
                                      : Vec3(random.uniform(0.5, 15.5), -0.5, random.uniform(0.5, 15.5));
        const Vec3 from = in_world(above), along = 1.01 * (in_world(below) - from);
        Hit at_field, at_mesh;
        ASSERT_TRUE(cast_ray(field, kAt, from, along, 1, at_field)) << i;
        ASSERT_TRUE(cast_ray(mesh, kAt, from, along, 1, at_mesh)) << i;
        EXPECT_NEAR(at_field.fraction * along.norm(), at_mesh.fraction * along.norm(), 1e-5) << i;
        EXPECT_LT(at_field.normal.dot(along), 0);
        EXPECT_FALSE(at_field.inside);
    }
}

TEST(SurfaceQueries, RaysFromBehindPass) {
    const Shape field = ground();
    Hit hit;
    EXPECT_FALSE(cast_ray(field, kAt, in_world({5, -3, 5}), in_world({5, 9, 5}) - in_world({5, -3, 5}), 1, hit));
    EXPECT_TRUE(cast_ray(field, kAt, in_world({5, 9, 5}), in_world({5, -3, 5}) - in_world({5, 9, 5}), 1, hit));
}

TEST(SurfaceQueries, MirroredSurfacesLookTheOtherWay) {
    Shape field = ground({1, -2, 1});
    Hit hit;
    const Vec3 below = in_world({5.1, -9, 5.2}), above = in_world({5.1, 9, 5.2});
    EXPECT_TRUE(cast_ray(field, kAt, below, above - below, 1, hit));
    EXPECT_LT(hit.normal.dot(above - below), 0);
    EXPECT_FALSE(cast_ray(field, kAt, above, below - above, 1, hit));
}

TEST(SurfaceQueries, CastsEndInTouchAndTriangleNumbersSayWhere) {
    Random random(2);
    const Shape field = ground();
    for (const ShapeKind kind : {ShapeKind::box, ShapeKind::sphere, ShapeKind::capsule, ShapeKind::hull,
                                 ShapeKind::cylinder, ShapeKind::cone, ShapeKind::tapered_capsule}) {
        for (int i = 0; i < 60; ++i) {
            const Shape shape = random_shape(kind, random);
            Placement from = {in_world({random.uniform(2, 14), 3, random.uniform(2, 14)}), random.rotation()};
            const Vec3 along = kAt.rotation.cast<double>() * Vec3(random.uniform(-3, 3), -4, random.uniform(-3, 3));
            Hit hit;
            if (!cast_shape(shape, from, along, field, kAt, 1, hit)) continue;
            ASSERT_FALSE(hit.inside);
            EXPECT_LT(hit.normal.dot(along), 0);
            from.position += hit.fraction * along;
            const Gap gap = find_gap(shape, from, field, kAt);
            EXPECT_NEAR(gap.distance, 0, 1e-4) << name(kind) << " " << i;
            const std::vector<Vec3f> points = oracle::triangles_of(field);
            ASSERT_LT(hit.feature, points.size() / 3);
            const Vec3f local = (kAt.rotation.cast<double>().transpose() * (hit.point - kAt.position)).cast<float>();
            const Vec3f a = points[3 * hit.feature], b = points[3 * hit.feature + 1], c = points[3 * hit.feature + 2];
            EXPECT_NEAR((b - a).cross(c - a).normalized().dot(local - a), 0, 1e-3f);
        }
    }
}

TEST(SurfaceQueries, DistanceIsThatToTheNearestTriangle) {
    const Shape field = ground({1, 0.001f, 1});  // nearly flat
    Random random(3);
    for (int i = 0; i < runs(300); ++i) {
        const double height = random.uniform(0.05, 20);
        const Gap gap = find_gap(in_world({random.uniform(1, 15), height, random.uniform(1, 15)}), field, kAt);
        EXPECT_NEAR(gap.distance, height, 1e-3);
        const Vec3 aside = in_world({-height, 0, 8});
        EXPECT_NEAR(find_gap(aside, field, kAt).distance, height, 1e-3);
    }
    EXPECT_FALSE(contains(field, kAt, in_world({5, -1, 5})));
}

}  // namespace
