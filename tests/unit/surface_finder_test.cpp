// Nearest points of features, and when two on their way first come within a reach.
#include "detect/surface_finder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace taut {
namespace {

class FeatureDraw {
public:
    explicit FeatureDraw(uint32_t seed) : engine_(seed) {}

    float in(float low, float high) { return std::uniform_real_distribution<float>(low, high)(engine_); }
    Vec3f point(float size) { return {in(-size, size), in(-size, size), in(-size, size)}; }

private:
    std::mt19937 engine_;
};

// The least distance over a grid on the two features, each point of the second found in closed form.
float sampled_face(const Vec3f (&x)[4], int steps) {
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i <= steps; ++i)
        for (int k = 0; k + i <= steps; ++k) {
            const float s = static_cast<float>(i) / static_cast<float>(steps);
            const float t = static_cast<float>(k) / static_cast<float>(steps);
            least = std::min(least, (x[0] - (1 - s - t) * x[1] - s * x[2] - t * x[3]).norm());
        }
    return least;
}
float sampled_segments(const Vec3f (&x)[4], int steps) {
    float least = std::numeric_limits<float>::infinity();
    for (int i = 0; i <= steps; ++i)
        for (int k = 0; k <= steps; ++k) {
            const float s = static_cast<float>(i) / static_cast<float>(steps);
            const float t = static_cast<float>(k) / static_cast<float>(steps);
            least = std::min(least, ((1 - s) * x[0] + s * x[1] - (1 - t) * x[2] - t * x[3]).norm());
        }
    return least;
}

void expect_consistent(const Nearest& near, const Vec3f (&x)[4], int first) {
    Vec3f apart = Vec3f::Zero();
    float of_first = 0, of_second = 0;
    for (int i = 0; i < 4; ++i) {
        apart += near.weight[i] * x[i];
        (i < first ? of_first : of_second) += near.weight[i];
        EXPECT_GE(i < first ? near.weight[i] : -near.weight[i], -1e-6f);
    }
    EXPECT_NEAR(of_first, 1, 1e-5f);
    EXPECT_NEAR(of_second, -1, 1e-5f);
    EXPECT_LT((apart - near.apart).norm(), 1e-5f);
}

TEST(Nearest, PointOfAFaceIsTheLeastOfAllItsPoints) {
    FeatureDraw draw(1);
    for (int trial = 0; trial < 300; ++trial) {
        const Vec3f x[4] = {draw.point(1), draw.point(1), draw.point(1), draw.point(1)};
        const Nearest near = nearest_of_face(x);
        expect_consistent(near, x, 1);
        const float sampled = sampled_face(x, 60);
        EXPECT_LE(near.distance(), sampled + 1e-5f);
        EXPECT_GE(near.distance(), sampled - 0.06f);
        const Vec3f normal = (x[2] - x[1]).cross(x[3] - x[1]).normalized();
        if (near.inside) {
            EXPECT_NEAR(std::abs(normal.dot(x[0] - x[1])), near.distance(), 1e-4f);
        }
    }
}

TEST(Nearest, PointsOfEdgesAreTheLeastOfAllTheirs) {
    FeatureDraw draw(2);
    for (int trial = 0; trial < 300; ++trial) {
        const Vec3f x[4] = {draw.point(1), draw.point(1), draw.point(1), draw.point(1)};
        const Nearest near = nearest_of_segments(x);
        expect_consistent(near, x, 2);
        const float sampled = sampled_segments(x, 60);
        EXPECT_LE(near.distance(), sampled + 1e-5f);
        EXPECT_GE(near.distance(), sampled - 0.06f);
        if (!near.inside) continue;
        EXPECT_NEAR(near.apart.dot(x[1] - x[0]), 0, 1e-4f);
        EXPECT_NEAR(near.apart.dot(x[3] - x[2]), 0, 1e-4f);
    }
}

TEST(Nearest, ParallelEdgesMeetInTheMiddleOfWhatTheyShare) {
    const Vec3f x[4] = {{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {5, 1, 0}};
    const Nearest near = nearest_of_segments(x);
    EXPECT_NEAR(near.distance(), 1, 1e-6f);
    EXPECT_NEAR(near.weight[1], 0.75f, 1e-6f);  // between 1 and 2
}

TEST(Nearest, DegenerateFeaturesHaveDistances) {
    const Vec3f p(1, 2, 3), q(0, 0, 0), line[4] = {p, q, q, Vec3f(0, 0, 1)}, points[4] = {p, p, q, q};
    EXPECT_NEAR(nearest_of_face(line).distance(), (p - Vec3f(0, 0, 1)).norm(), 1e-6f);
    EXPECT_NEAR(nearest_of_segments(points).distance(), p.norm(), 1e-6f);
    EXPECT_FALSE(nearest_of_face(line).inside);
}

// The first of a thousand moments at which they are as near; none: infinite.
float sampled_meeting(const Passing& passing, float reach, float time) {
    for (int k = 0; k <= 1000; ++k) {
        Vec3f at[4];
        passing.at(time * static_cast<float>(k) / 1000, at);
        if (passing.nearest(at).distance() <= reach) return time * static_cast<float>(k) / 1000;
    }
    return std::numeric_limits<float>::infinity();
}

TEST(Passing, NoneThatMeetsIsMissed) {
    FeatureDraw draw(3);
    int met = 0, false_alarms = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        Passing passing{};
        passing.of = trial % 2 == 0 ? Passing::Of::vertex_face : Passing::Of::edge_edge;
        for (int i = 0; i < 4; ++i) passing.x[i] = draw.point(0.1f), passing.v[i] = draw.point(10);
        const float reach = 0.005f, time = 1.0f / 60;
        Nearest near;
        float when = 0;
        const bool meets = meet(passing, reach, time, near, when),
                   does = std::isfinite(sampled_meeting(passing, reach, time));
        met += does;
        false_alarms += meets && !does;
        EXPECT_TRUE(meets || !does) << trial;
    }
    EXPECT_GT(met, 200);
    EXPECT_LT(false_alarms, 2 * met);  // those that were near when the steps were through
}

TEST(Passing, WhatIsThroughIsPulledBackToTheSideItCameFrom) {
    Passing passing{};
    passing.of = Passing::Of::vertex_face;
    passing.x[0] = {0.2f, -0.01f, 0.2f};  // below the triangle, which it was above
    passing.x[1] = {0, 0, 0}, passing.x[2] = {0, 0, 1}, passing.x[3] = {1, 0, 0};
    const SurfaceTouch of{{0, 1}, 0.5f, 0, 0.005f, 0.003f};
    SurfaceContact was, contact;
    was.normal = Vec3f::UnitY();
    ASSERT_TRUE(touch(passing, of, 0.01f, &was, Vec3f::Zero(), contact));
    EXPECT_NEAR(contact.normal.y(), 1, 1e-6f);
    EXPECT_NEAR(contact.gap, -0.015f, 1e-6f);
    passing.x[0].y() = -0.004f;
    ASSERT_TRUE(touch(passing, of, 0.01f, nullptr, Vec3f::Zero(), contact));  // that was never above
    EXPECT_NEAR(contact.normal.y(), -1, 1e-6f);
    EXPECT_NEAR(contact.gap, -0.001f, 1e-6f);
    ASSERT_TRUE(touch(passing, of, 0.01f, nullptr, Vec3f::UnitY(), contact));  // of a solid that looks up
    EXPECT_NEAR(contact.normal.y(), 1, 1e-6f);
}

}  // namespace
}  // namespace taut
