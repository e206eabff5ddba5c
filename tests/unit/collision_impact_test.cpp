// Shapes under way: when they meet, beside a look at their gap at many moments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "starts.h"
#include "collision_oracle.h"

namespace taut::collision {
namespace {

using oracle::name;
using oracle::Random;
using oracle::random_shape;

constexpr double kHorizon = 1.0 / 48, kReach = 2.5e-3;  // [s], [m]
constexpr ShapeKind kSolids[] = {ShapeKind::box,      ShapeKind::sphere, ShapeKind::capsule,        ShapeKind::hull,
                                 ShapeKind::cylinder, ShapeKind::cone,   ShapeKind::tapered_capsule};

// Turns about a point up to 0.2 m from its origin, by up to 40 rad/s.
Motion random_motion(const Shape& shape, const Vec3& at, const Vec3& velocity, Random& random) {
    const Vec3 lever = random.uniform(0, 0.2) * random.unit();
    const Mat3f rotation = random.rotation();
    const Vec3 spin = random.uniform(0, 40) * random.unit();
    return {{at, rotation}, at + lever, velocity, spin, spin_radius(shape, lever.norm())};
}

// Two shapes on their ways, most of them towards each other.
struct Ways {
    Shape a, b;
    Motion motion_a, motion_b;
    double depth;

    Ways(ShapeKind one, ShapeKind other, Random& random)
        : a(random_shape(one, random)), b(random_shape(other, random)) {
        const Vec3 from(1e3, 0, -1e3), to = from + random.uniform(0.4, 3) * random.unit();
        const Vec3 towards = random.uniform(0.2, 3) * (to - from + random.uniform(0, 0.5) * random.unit()) / kHorizon;
        motion_a = random_motion(a, from, 0.5 * towards, random);
        motion_b = random_motion(b, to, -0.5 * towards, random);
        depth = 0.25 * std::min(thickness(a), thickness(b));
    }
    double gap(double t) const { return find_gap(a, motion_a.after(t), b, motion_b.after(t)).distance; }
    double impact() const { return find_impact(a, motion_a, b, motion_b, kReach, depth, kHorizon); }
};

// The gap on the way, at so many moments of two horizons, which is as far as depths are looked for.
struct Looks {
    static constexpr int kNumber = 240;
    double gap[kNumber + 1];

    explicit Looks(const Ways& ways) {
        for (int i = 0; i <= kNumber; ++i) gap[i] = ways.gap(moment(i));
    }
    static double moment(int i) { return 2 * kHorizon * i / kNumber; }
    double least(double from, double to) const {
        double found = 1e30;
        for (int i = 0; i <= kNumber; ++i)
            if (moment(i) >= from && moment(i) <= to) found = std::min(found, gap[i]);
        return found;
    }
};

struct ImpactOfSolid : testing::TestWithParam<ShapeKind> {};

// No moment is after that at which they are as near as reach, and what passes deep is found. Depths are told to a
// tenth, and 3 mm.
TEST_P(ImpactOfSolid, IsNotLateAndNothingDeepIsMissed) {
    Random random(31);
    int found = 0, late = 0, far = 0, shallow = 0, missed = 0;
    for (const ShapeKind other : kSolids) {
        for (int i = 0; i < runs(60); ++i) {
            const Ways ways(GetParam(), other, random);
            const Looks looks(ways);
            const double met = ways.impact(), deepest = looks.least(0, 2 * kHorizon);
            if (std::isinf(met)) {
                missed += looks.least(0, kHorizon) < 0 && deepest < -1.2 * ways.depth - 3e-3;
                continue;
            }
            ++found;
            late += looks.least(0, met) < 0.4 * kReach && ways.gap(met) < 0.4 * kReach && met > 0;
            far += ways.gap(met) > 1.01 * kReach;
            shallow += met > 0 && deepest > -0.7 * ways.depth + 3e-3;
        }
    }
    EXPECT_GT(found, runs(100));
    EXPECT_EQ(late, 0);
    EXPECT_EQ(missed, 0);
    EXPECT_LE(far, 1 + found / 50);  // grazes
    EXPECT_LE(shallow, 1 + found / 50);
}

INSTANTIATE_TEST_SUITE_P(Queries, ImpactOfSolid, testing::ValuesIn(kSolids),
                         [](const auto& one) { return std::string(name(one.param)); });

}  // namespace
}  // namespace taut::collision
