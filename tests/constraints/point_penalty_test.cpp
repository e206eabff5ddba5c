// The penalty of a point and a triangle beside finite differences, over faces, edges and corners.
#include "constraints/point_penalty.h"

#include <gtest/gtest.h>

#include <random>

namespace taut {
namespace {

constexpr double kPenalty = 3e4;

struct PenaltyCase {
    Vec3 x[4];  // the point, then the corners

    PenaltyTerms terms() const {
        const Vec3 triangle[3] = {x[1], x[2], x[3]};
        return point_penalty(kPenalty, x[0], triangle);
    }
    TrianglePoint nearest() const {
        const Vec3 triangle[3] = {x[1], x[2], x[3]};
        return nearest_on_triangle(x[0], triangle);
    }
};

class PointPenalty : public testing::Test {
protected:
    // Anywhere about a triangle.
    PenaltyCase draw() {
        PenaltyCase out;
        for (Vec3& each : out.x)
            for (int k = 0; k < 3; ++k) each[k] = uniform_(random_);
        return out;
    }

private:
    std::mt19937 random_{11};
    std::uniform_real_distribution<double> uniform_{-1, 1};
};

TEST_F(PointPenalty, IsOfTheNearestPoint) {
    for (int i = 0; i < 200; ++i) {
        const PenaltyCase at = draw();
        const TrianglePoint found = at.nearest();
        const auto distance = [&](double a, double b, double c) {
            return (at.x[0] - a * at.x[1] - b * at.x[2] - c * at.x[3]).norm();
        };
        const double own = distance(found.weight[0], found.weight[1], found.weight[2]);
        EXPECT_NEAR(found.weight[0] + found.weight[1] + found.weight[2], 1, 1e-12);
        double least = own;
        constexpr int kParts = 60;
        for (int a = 0; a <= kParts; ++a)
            for (int b = 0; a + b <= kParts; ++b)
                least =
                    std::min(least, distance(double(a) / kParts, double(b) / kParts, double(kParts - a - b) / kParts));
        EXPECT_GE(least, own - 1e-12);
        EXPECT_NEAR(at.terms().energy, kPenalty * own * own * own, 1e-6 * kPenalty);
    }
}

TEST_F(PointPenalty, HasTheDerivativesOfDifferences) {
    constexpr double kStep = 1e-6;
    int seen[4] = {};
    for (int i = 0; i < 600; ++i) {
        PenaltyCase at = draw();
        const int corners = at.nearest().corners;
        const PenaltyTerms terms = at.terms();
        const Vec3 triangle[3] = {at.x[1], at.x[2], at.x[3]};
        double hessian[144];
        point_penalty_hessian(kPenalty, at.x[0], triangle, hessian);
        bool same = true;
        Eigen::Matrix<double, 12, 12> found;
        Eigen::Matrix<double, 12, 1> slope;
        for (int k = 0; k < 12; ++k) {
            PenaltyCase more = at, less = at;
            more.x[k / 3][k % 3] += kStep;
            less.x[k / 3][k % 3] -= kStep;
            same = same && more.nearest().corners == corners && less.nearest().corners == corners;
            const PenaltyTerms a = more.terms(), b = less.terms();
            slope[k] = (a.energy - b.energy) / (2 * kStep);
            for (int l = 0; l < 12; ++l)
                found(l, k) = (a.gradient[l / 3][l % 3] - b.gradient[l / 3][l % 3]) / (2 * kStep);
        }
        if (!same) continue;  // at the border of two features
        ++seen[corners];
        const double size = kPenalty * (1 + found.norm() / kPenalty);
        for (int k = 0; k < 12; ++k) {
            EXPECT_NEAR(slope[k], terms.gradient[k / 3][k % 3], 1e-7 * size);
            for (int l = 0; l < 12; ++l) EXPECT_NEAR(found(k, l), hessian[12 * k + l], 1e-5 * size) << corners;
        }
    }
    for (const int corners : {1, 2, 3}) EXPECT_GT(seen[corners], 20) << corners;
}

}  // namespace
}  // namespace taut
