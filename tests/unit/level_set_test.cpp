// Level sets of shapes beside the distance queries, their derivatives beside finite differences; the grid of a mesh.
#include "collision/level_set.h"

#include <gtest/gtest.h>

#include <random>

#include "collision/distance_grid.h"
#include "collision_oracle.h"

namespace taut::collision {
namespace {

Shape shape_of_size(ShapeKind kind, const Vec3f& size) {
    Shape shape;
    shape.kind = kind;
    shape.size = size;
    return shape;
}

Shape round_hull() {
    std::mt19937 random(3);
    std::normal_distribution<float> normal;
    std::vector<Vec3f> points;
    for (int i = 0; i < 24; ++i) points.push_back(Vec3f(normal(random), normal(random), normal(random)).normalized());
    Shape shape = shape_of_size(ShapeKind::hull, Vec3f::Zero());
    const char* reason = nullptr;
    shape.hull = build_hull(points, 32, 1e-3f, &reason, oracle::memory());
    return shape;
}

class LevelSetOf : public testing::TestWithParam<int> {
protected:
    Shape shape() const {
        switch (GetParam()) {
            case 0:
                return shape_of_size(ShapeKind::plane, Vec3f(1, 2, -1).normalized());
            case 1:
                return shape_of_size(ShapeKind::box, {0.5f, 0.8f, 0.3f});
            case 2:
                return shape_of_size(ShapeKind::sphere, {0.7f, 0, 0});
            case 3:
                return shape_of_size(ShapeKind::capsule, {0.3f, 0.6f, 0});
            case 4:
                return round_hull();
            case 5:
                return shape_of_size(ShapeKind::cylinder, {0.5f, 0.6f, 0});
            case 6:
                return shape_of_size(ShapeKind::cone, {0.6f, 0.7f, 0});
            default:
                return shape_of_size(ShapeKind::tapered_capsule, {0.5f, 0.6f, 0.2f});
        }
    }
    // A point within 1.5 m of the middle.
    Vec3 point() {
        std::uniform_real_distribution<double> uniform(-1.5, 1.5);
        return Vec3(uniform(random_), uniform(random_), uniform(random_));
    }

private:
    std::mt19937 random_{7};
};

TEST_P(LevelSetOf, IsAsFarAsTheQuerySays) {
    const Shape of = shape();
    for (int i = 0; i < 2000; ++i) {
        const Vec3 x = point();
        const LevelSet level = level_set(of, x);
        EXPECT_NEAR(level.distance, find_gap(x, of, {}).distance, 5e-4) << x.transpose();
        EXPECT_NEAR(level.gradient.norm(), 1, 1e-12);
    }
}

// Outside, and inside of what is round: x - phi grad phi is on the surface. Within rims of cones the nearest face may
// end.
TEST_P(LevelSetOf, LeadsToItsSurface) {
    const Shape of = shape();
    for (int i = 0; i < 2000; ++i) {
        const Vec3 x = point();
        const LevelSet level = level_set(of, x);
        EXPECT_NEAR(level_set(of, Vec3(x - level.distance * level.gradient)).distance, 0, of.hull ? 1e-6 : 1e-12)
            << x.transpose();
    }
}

TEST_P(LevelSetOf, HasTheDerivativesOfDifferences) {
    constexpr double kStep = 1e-6;
    const Shape of = shape();
    int kinks = 0;
    for (int i = 0; i < 1000; ++i) {
        const Vec3 x = point();
        const LevelSet level = level_set(of, x);
        Vec3 slope;
        Mat3 curvature;
        bool kink = false;
        for (int k = 0; k < 3; ++k) {
            const LevelSet more = level_set(of, Vec3(x + kStep * Vec3::Unit(k)));
            const LevelSet less = level_set(of, Vec3(x - kStep * Vec3::Unit(k)));
            slope[k] = (more.distance - less.distance) / (2 * kStep);
            curvature.col(k) = (more.gradient - less.gradient) / (2 * kStep);
            kink = kink || (more.curvature - less.curvature).norm() > 1e-3 * (1 + level.curvature.squaredNorm());
        }
        if (kink || curvature.norm() > 1e4) {  // a ridge, or the border of two features
            ++kinks;
            continue;
        }
        EXPECT_LT((slope - level.gradient).norm(), 1e-8) << x.transpose();
        EXPECT_LT((curvature - level.curvature).norm(), 1e-6 * (1 + level.curvature.squaredNorm())) << x.transpose();
    }
    EXPECT_LT(kinks, 10);
}
INSTANTIATE_TEST_SUITE_P(Kinds, LevelSetOf, testing::Range(0, 8));

// ---------------------------------------------------------------- sampled

Shape closed_box(const Vec3f& half, bool inward, bool open) {
    std::vector<Vec3f> vertices;
    for (int i = 0; i < 8; ++i)
        vertices.push_back({i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z()});
    std::vector<uint32_t> indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                     2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    if (open) indices.resize(indices.size() - 3);
    for (size_t i = 0; inward && i < indices.size(); i += 3) std::swap(indices[i], indices[i + 1]);
    Shape shape = shape_of_size(ShapeKind::surface, Vec3f::Ones());
    shape.surface = build_mesh(vertices, indices, false, oracle::memory());
    return shape;
}

TEST(DistanceGrid, IsAsFarAsTheBox) {
    const Vec3f half(0.5f, 0.8f, 0.3f);
    const Shape mesh = closed_box(half, false, false), box = shape_of_size(ShapeKind::box, half);
    const char* reason = "";
    constexpr double kCell = 0.05;
    const auto grid = sample_distance(mesh, kCell, &reason, oracle::memory());
    ASSERT_TRUE(grid) << reason;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    int inside = 0;
    for (int i = 0; i < 5000; ++i) {
        const Vec3 x = 0.99 * Vec3(uniform(random), uniform(random), uniform(random)).cwiseProduct(half.cast<double>());
        const LevelSet level = grid->at(x), exact = level_set(box, x);
        inside += level.distance < 0;
        EXPECT_NEAR(level.distance, exact.distance, kCell) << x.transpose();
    }
    EXPECT_GT(inside, 4980);  // edges are rounded
    EXPECT_TRUE(std::isinf(grid->at({2, 0, 0}).distance));
    EXPECT_GT(grid->at({0.53, 0, 0}).distance, 0);
}

// Exactly those of what is interpolated, not of what it stands for.
TEST(DistanceGrid, HasTheDerivativesOfDifferences) {
    constexpr double kStep = 1e-6;
    const char* reason = "";
    const auto grid = sample_distance(closed_box({0.5f, 0.8f, 0.3f}, false, false), 0.1, &reason, oracle::memory());
    ASSERT_TRUE(grid) << reason;
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.02, 0.98);
    for (int i = 0; i < 500; ++i) {
        Vec3 x = grid->corner;
        for (int k = 0; k < 3; ++k) x[k] += grid->cell * (random() % (grid->nodes[k] - 3) + 0.5 + uniform(random));
        const LevelSet level = grid->at(x);
        for (int k = 0; k < 3; ++k) {
            const LevelSet more = grid->at(x + kStep * Vec3::Unit(k)), less = grid->at(x - kStep * Vec3::Unit(k));
            EXPECT_NEAR((more.distance - less.distance) / (2 * kStep), level.gradient[k], 1e-8);
            EXPECT_LT(((more.gradient - less.gradient) / (2 * kStep) - level.curvature.col(k)).norm(), 1e-6);
        }
    }
}

TEST(DistanceGrid, RefusesWhatHasNoInside) {
    const char* reason = nullptr;
    EXPECT_FALSE(sample_distance(closed_box({1, 1, 1}, false, true), 0.1, &reason, oracle::memory()));
    EXPECT_STREQ(reason, "an open surface has no inside");
    EXPECT_FALSE(sample_distance(closed_box({1, 1, 1}, true, false), 0.1, &reason, oracle::memory()));
    EXPECT_STREQ(reason, "its triangles look inward");
    EXPECT_FALSE(sample_distance(closed_box({1, 1, 1}, false, false), 1e-3, &reason, oracle::memory()));
}

}  // namespace
}  // namespace taut::collision
