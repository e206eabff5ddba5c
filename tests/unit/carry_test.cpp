// What contacts carry from one frame to the next is what they carried before, however their points lie.
#include "detect/carry.h"

#include <gtest/gtest.h>

#include <random>

namespace taut::test {
namespace {

class Points {
public:
    explicit Points(uint32_t seed) : random_(seed) {}

    float between(double lo, double hi) {
        return static_cast<float>(std::uniform_real_distribution<double>(lo, hi)(random_));
    }
    Vec3f within(double most) {
        const float x = between(-most, most), y = between(-most, most);
        return {x, y, between(-most, most)};
    }
    // One to four about a place in a plane across the normal, some of them in one place but for rounding.
    collision::Manifold manifold(const Vec3f& about, uint32_t first_feature) {
        collision::Manifold out;
        out.normal = (Vec3f::UnitY() + within(0.3)).normalized();
        const Vec3f u = tangent_of(out.normal), v = out.normal.cross(u);
        out.count = 1 + static_cast<int>(random_() % 4);
        for (int i = 0; i < out.count; ++i) {
            const bool same = i > 0 && random_() % 2 == 0;
            const float spread = same ? 1e-7f : 0.2f, x = between(-spread, spread), y = between(-spread, spread);
            out.points[i].position = (same ? out.points[i - 1].position : about) + x * u + y * v;
            out.points[i].feature = first_feature + static_cast<uint32_t>(i);
        }
        return out;
    }
    bool heads() { return random_() % 2 == 0; }

private:
    std::mt19937 random_;
};

float sum_of(const ContactForce* force, int count) {
    float sum = 0;
    for (int i = 0; i < count; ++i) sum += force[i].normal;
    return sum;
}

TEST(Carry, KeepsTheSumOfWhatRoundShapesCarryAndPullsNowhere) {
    for (const double far : {0.0, 3.0, 300.0}) {
        Points points(5);
        for (int run = 0; run < 20000; ++run) {
            const Vec3f about = points.within(far);
            const collision::Manifold old = points.manifold(about, 0);
            Pair last, pair;
            pair.patch = 0.01f;
            for (int k = 0; k < old.count; ++k) last.force[k].normal = points.between(0, 1);
            const float before = sum_of(last.force, old.count);
            pair.manifold = points.manifold(about + points.within(0.05), points.heads() ? 0 : 8);
            carry(old, last, pair);
            EXPECT_NEAR(sum_of(pair.force, pair.manifold.count), before, 1e-3f * before) << run << ", " << far << " m";
            for (int i = 0; i < pair.manifold.count; ++i) {
                EXPECT_GE(pair.force[i].normal, -1e-3f * before) << run << ", " << far << " m";
                EXPECT_LE(pair.force[i].normal, 1.001f * before) << run << ", " << far << " m";
            }
        }
    }
}

}  // namespace
}  // namespace taut::test
