// Distances of segments in closed form against GJK's search, and against all pairs of their points.
#include <gtest/gtest.h>

#include "collision/queries/couple.h"
#include "collision_oracle.h"

using namespace taut;
using namespace taut::collision;
using namespace taut::collision::oracle;

namespace {

Shape round(float radius, float half) { return half > 0 ? capsule(radius, half) : sphere(radius); }

// Every fifth is parallel, or nearly so, to the other.
Mat3f turned(Random& random, int i, const Mat3f& other) {
    if (i % 5 != 0) return random.rotation();
    const Vec3 by = i % 10 == 0 ? Vec3(Vec3::Zero()) : Vec3(1e-4 * random.unit());
    return other * rotation_from_vector(by).toRotationMatrix().cast<float>();
}

double least_of_points(const collision::Line& a, const collision::Line& b) {
    constexpr int kParts = 200;
    double least = 1e300;
    for (int i = 0; i <= kParts; ++i) {
        const Vec3 p = a.from + double(i) / kParts * a.step;
        least = std::min(least, (b.from + b.nearest(p) * b.step - p).norm());
    }
    return least;
}

}  // namespace

TEST(LineDistance, AgreesWithGjk) {
    Random random(11);
    for (int i = 0; i < 5000; ++i) {
        const Shape a = round(0.1f, i % 7 ? float(random.uniform(0.05, 1)) : 0.0f),
                    b = round(0.2f, i % 11 ? float(random.uniform(0.05, 1)) : 0.0f);
        const Placement at_a = {Vec3::Zero(), random.rotation()};
        const Placement at_b = {random.uniform(0.3, 3) * random.unit(), turned(random, i, at_a.rotation)};
        const Couple couple(a, at_a, b, at_b);
        PairCache cache;
        const collision::Pair pair = {a, b,    at_a, at_b, {at_a.rotation.transpose() * at_b.rotation, Vec3f::Zero()},
                                      0, cache};
        const Distance found = couple.distance(Vec3::Zero(), couple.hint());
        const Distance searched = gjk(Difference(pair), couple.to_a(at_b.position), couple.hint(), kQueryGap);
        ASSERT_EQ(found.apart, searched.apart) << i;
        ASSERT_NEAR(found.separation, searched.separation, 1e-8) << i;
        ASSERT_NEAR(couple.proven(Vec3::Zero(), found.normal), found.separation, 1e-6) << i;
    }
}

TEST(LineDistance, IsThatOfTheNearestPoints) {
    Random random(12);
    for (int i = 0; i < 2000; ++i) {
        const collision::Line a = {random.unit(), random.uniform(0, 2) * random.unit()};
        const collision::Line b = {random.unit(),
                                   i % 3 ? Vec3(random.uniform(0, 2) * random.unit()) : Vec3(-1.5 * a.step)};
        const double coarse = least_of_points(a, b);
        const Distance found = line_distance(a, b);
        ASSERT_LE(found.separation, coarse + 1e-12) << i;
        ASSERT_GE(found.separation, coarse - 0.5 * a.step.norm() / 200) << i;
    }
}

TEST(LineDistance, OfLinesThatMeetHasNoDirection) {
    const collision::Line a = {Vec3(-1, 0, 0), Vec3(2, 0, 0)}, b = {Vec3(0, -1, 0), Vec3(0, 2, 0)};
    EXPECT_FALSE(line_distance(a, b).apart);
}
