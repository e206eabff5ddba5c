// Shapes under way: when they meet, beside a look at their gap at many moments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <numeric>
#include <vector>

#include "collision_oracle.h"
#include "starts.h"

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

// A hilly ground of 1 m cells, as a height field, and as the same triangles in a mesh where asked for.
Shape hills(bool as_mesh) {
    constexpr uint32_t kSide = 41;
    std::vector<float> heights;
    for (uint32_t row = 0; row < kSide; ++row)
        for (uint32_t column = 0; column < kSide; ++column)
            heights.push_back(0.4f * std::sin(0.9f * float(row)) * std::cos(1.1f * float(column)));
    Shape shape;
    shape.kind = ShapeKind::surface;
    shape.size = Vec3f::Ones();
    shape.surface = build_height_field({kSide, kSide, 1, 1, heights}, oracle::memory());
    if (!as_mesh) return shape;
    const std::vector<Vec3f> points = oracle::triangles_of(shape);
    std::vector<uint32_t> indices(points.size());
    std::iota(indices.begin(), indices.end(), 0u);
    shape.surface = build_mesh(points, indices, false, oracle::memory());
    return shape;
}

// A shape that comes down on them, and turns about a point up to so far away [m].
Ways way_down(ShapeKind kind, double far, Random& random) {
    Ways ways(kind, ShapeKind::sphere, random);
    ways.b = hills(random.uniform(0, 1) < 0.5);
    const Vec3 place(random.uniform(10, 30), random.uniform(0.6, 1.4), random.uniform(10, 30));
    const Vec3 lever = random.uniform(0, far) * random.unit();
    const Vec3 velocity = 10 * Vec3(random.uniform(-2, 2), random.uniform(-5, -1), random.uniform(-2, 2));
    const Vec3 spin = random.uniform(0, 6) * random.unit();
    const double reach = spin_radius(ways.a, lever.norm());
    ways.motion_a = {{place, random.rotation()}, place + lever, velocity, spin, reach};
    ways.motion_b = {{Vec3::Zero(), Mat3f::Identity()}, Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), 100};
    ways.depth = 0.25 * thickness(ways.a);
    return ways;
}

TEST_P(ImpactOfSolid, OnASurfaceIsNotLateAndNothingDeepIsMissed) {
    Random random(37);
    int found = 0, late = 0, far = 0, shallow = 0, missed = 0;
    for (int i = 0; i < runs(40); ++i) {
        const Ways ways = way_down(GetParam(), 1, random);
        const Looks looks(ways);
        const double met = ways.impact(), deepest = looks.least(0, 2 * kHorizon);
        if (std::isinf(met)) {
            missed += looks.least(0, kHorizon) < 0 && deepest < -1.1 * ways.depth - 1e-3;
            continue;
        }
        ++found;
        late += met > 0 && looks.least(0, met) < 0.4 * kReach && ways.gap(met) < 0.4 * kReach;
        far += ways.gap(met) > 1.01 * kReach;
        shallow += met > 0 && deepest > -0.9 * ways.depth + 1e-3;
    }
    EXPECT_GT(found, runs(10));
    EXPECT_EQ(late, 0);
    EXPECT_EQ(missed, 0);
    EXPECT_LE(far, 1 + found / 50);  // grazes
    EXPECT_LE(shallow, 1 + found / 50);
}

double processor_time() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// On the mean as much as few looks at the gap, where a way that grazes took 64 of them: parts of a pole that tips over
// onto hills, some 20 m from the centre that it turns about.
TEST(Impact, OnASurfaceCostsFewLooksAtTheGap) {
#if defined(TAUT_INSTRUMENTED) || defined(_WIN32)
    GTEST_SKIP() << "instrumented, or by a clock that ticks each 15 ms";
#endif
    Random random(41);
    double searched = 0, looked = 0;
    for (int i = 0; i < 300; ++i) {
        const Ways ways = way_down(ShapeKind::box, 20, random);
        const double begin = processor_time();
        const double met = ways.impact();
        const double then = processor_time();
        if (!(met > 0 && std::isfinite(met))) continue;
        searched += then - begin;
        EXPECT_GE(ways.gap(met), 0);
        looked += processor_time() - then;
    }
    EXPECT_LT(searched, 4 * looked);
}

INSTANTIATE_TEST_SUITE_P(Queries, ImpactOfSolid, testing::ValuesIn(kSolids),
                         [](const auto& one) { return std::string(name(one.param)); });

}  // namespace
}  // namespace taut::collision
