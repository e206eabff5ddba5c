// Rays, casts and distances of every kind against marches along signed distances and searches over all axes.
#include <gtest/gtest.h>

#include <cmath>

#include "collision_oracle.h"

using namespace taut;
using namespace taut::collision;
using namespace taut::collision::oracle;

namespace {

constexpr ShapeKind kAll[] = {ShapeKind::plane, ShapeKind::box,      ShapeKind::sphere, ShapeKind::capsule,
                              ShapeKind::hull,  ShapeKind::cylinder, ShapeKind::cone,   ShapeKind::tapered_capsule};
constexpr ShapeKind kSolids[] = {ShapeKind::box,      ShapeKind::sphere, ShapeKind::capsule,        ShapeKind::hull,
                                 ShapeKind::cylinder, ShapeKind::cone,   ShapeKind::tapered_capsule};

struct QueryOfKind : testing::TestWithParam<ShapeKind> {};

std::string kind_name(const testing::TestParamInfo<ShapeKind>& info) { return name(info.param); }

// Goes along by the distance that is certainly free. Negative: past the end; nan: grazes.
double march(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along) {
    const double length = along.norm();
    double s = 0;
    for (int step = 0; step < 20000; ++step) {
        const double free = distance_at_least(shape, at, from + s / length * along);
        if (free < 1e-9) return s / length;
        s += free;
        if (s > length) return -1;
    }
    return std::nan("");
}

struct Cast {
    Placement at;
    Vec3 from, along;
};

// From around a shape to somewhere near its middle, or past it.
Cast random_ray(Random& random, const Vec3& origin) {
    Cast cast;
    cast.at = {origin + random.uniform(0, 1) * random.unit(), random.rotation()};
    const Vec3 target = cast.at.position + random.uniform(0, 0.7) * random.unit();
    cast.from = target + random.uniform(1.0, 6) * random.unit();
    cast.along = random.uniform(0.8, 2) * (target - cast.from);
    return cast;
}

void expect_as_marched(ShapeKind kind, uint32_t seed, const Vec3& origin, double tolerance) {
    Random random(seed);
    int hits = 0, misses = 0, unclear = 0;
    for (int i = 0; i < 4000; ++i) {
        const Shape shape = random_shape(kind, random);
        const Cast cast = random_ray(random, origin);
        Hit hit;
        const bool met = cast_ray(shape, cast.at, cast.from, cast.along, 1, hit);
        const double expected = march(shape, cast.at, cast.from, cast.along);
        if (std::isnan(expected)) {
            ++unclear;
            continue;
        }
        ASSERT_EQ(met, expected >= 0) << name(kind) << " " << i << " seed " << seed;
        (met ? hits : misses)++;
        if (!met) continue;
        // A hull's merged faces lie a little off its points, more so along a flat ray.
        const double slope = std::max(0.01, -hit.normal.dot(cast.along) / cast.along.norm());
        const double slack = kind == ShapeKind::hull ? 2e-4 / slope : tolerance;
        ASSERT_NEAR(hit.fraction * cast.along.norm(), expected * cast.along.norm(), slack) << i;
        if (hit.inside) continue;
        EXPECT_LT(hit.normal.dot(cast.along), 0) << i;
        EXPECT_NEAR(hit.normal.norm(), 1, 1e-9);
        EXPECT_NEAR(distance_at_least(shape, cast.at, hit.point), 0, std::min(slack, 2e-4));
        // Off the surface along the normal distance grows as fast as can be.
        EXPECT_NEAR(distance_at_least(shape, cast.at, hit.point + 1e-3 * hit.normal), 1e-3,
                    2e-5 + std::min(slack, 2e-4))
            << i;
    }
    EXPECT_GT(hits, 400) << name(kind);
    EXPECT_GT(hits + misses, 3900);
    EXPECT_LT(unclear, 40);
}

TEST_P(QueryOfKind, RayMeetsWhatAMarchMeets) { expect_as_marched(GetParam(), 1, Vec3::Zero(), 2e-5); }

TEST_P(QueryOfKind, RayMeetsTheSameTenKilometresAway) {
    expect_as_marched(GetParam(), 2, Vec3(10000, -7000, 8000), 2e-5);
}

TEST_P(QueryOfKind, RayFromInsideIsToldSo) {
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Shape shape = random_shape(GetParam(), random);
        const Placement at = {random.uniform(0, 5) * random.unit(), random.rotation()};
        const Vec3 within = at.position + 0.5 * random.unit();
        const bool inside = distance_at_least(shape, at, within) < -1e-5;
        if (!inside) continue;
        const Vec3 along = 3 * random.unit();
        Hit hit;
        ASSERT_TRUE(cast_ray(shape, at, within, along, 1, hit));
        EXPECT_TRUE(hit.inside);
        EXPECT_EQ(hit.fraction, 0);
        EXPECT_LT((hit.normal + along.normalized()).norm(), 1e-12);
        EXPECT_TRUE(contains(shape, at, within));
    }
}

TEST_P(QueryOfKind, RayFromFarAwayLosesNoDigits) {
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        const Shape shape = random_shape(GetParam(), random);
        const Placement at = {Vec3(3, 4, 5), random.rotation()};
        const Vec3 direction = random.unit();
        const Vec3 target = at.position + 0.1 * random.unit();
        Hit near, far;
        const bool met = cast_ray(shape, at, target - 10 * direction, 20 * direction, 1, near);
        if (!met || near.inside) continue;  // a plane; a hull beside its middle
        if (!cast_ray(shape, at, target - 9000 * direction, 18000 * direction, 1, far) || far.inside) {
            EXPECT_EQ(GetParam(), ShapeKind::plane);
            continue;
        }
        EXPECT_LT((near.point - far.point).norm(), 1e-9);
    }
}

TEST_P(QueryOfKind, PointsNearestAreOnTheSurfaceAndAlongTheNormal) {
    Random random(5);
    for (int i = 0; i < 2000; ++i) {
        const Shape shape = random_shape(GetParam(), random);
        const Placement at = {Vec3(1e4, 0, 0) + random.unit(), random.rotation()};
        const Vec3 point = at.position + random.uniform(0.1, 3) * random.unit();
        const Gap gap = find_gap(point, shape, at);
        // Inside cylinders and cones the least push is found by search.
        const double tolerance = gap.distance < 0 ? 1e-3 : 1e-4;
        EXPECT_NEAR(distance_at_least(shape, at, gap.on_b), 0, tolerance) << i;
        EXPECT_LT((gap.on_a + gap.distance * gap.normal - gap.on_b).norm(), 1e-5);
        EXPECT_GT(gap.distance, distance_at_least(shape, at, point) - tolerance) << i;
        const bool clear = std::fabs(gap.distance) > 1e-4;
        if (clear) {
            EXPECT_EQ(contains(shape, at, point), gap.distance < 0) << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Queries, QueryOfKind, testing::ValuesIn(kAll), kind_name);

struct QueryOfSolid : testing::TestWithParam<ShapeKind> {};

// How far a plane across the normal keeps a and b apart: less than or equal to their distance.
double apart_along(const Vec3& normal, const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b) {
    const Core one = core(a, at_a), other = core(b, at_b);
    return -other.reach(-normal) - one.reach(normal) - one.radius - other.radius;
}

// Two points bound the distance from above, the plane between them from below.
TEST_P(QueryOfSolid, GapLiesBetweenItsPointsAndItsPlane) {
    Random random(6);
    for (const ShapeKind other : kSolids) {
        for (int i = 0; i < 300; ++i) {
            const Shape a = random_shape(GetParam(), random), b = random_shape(other, random);
            const Placement at_a = {Vec3(0, 1e4, 0), random.rotation()};
            const Placement at_b = {at_a.position + random.uniform(0.3, 3) * random.unit(), random.rotation()};
            const Gap gap = find_gap(a, at_a, b, at_b);
            const bool apart = gap.distance > 0;
            if (std::fabs(gap.distance) > 1e-5) {
                EXPECT_EQ(overlap(a, at_a, b, at_b), !apart);
            }
            EXPECT_NEAR((gap.on_b - gap.on_a).dot(gap.normal), gap.distance, 1e-9);
            EXPECT_NEAR(apart_along(gap.normal, a, at_a, b, at_b), gap.distance, 2e-5) << name(other) << " " << i;
            if (!apart) continue;
            EXPECT_NEAR(distance_at_least(a, at_a, gap.on_a), 0, 2e-4) << name(other) << " " << i;
            EXPECT_NEAR(distance_at_least(b, at_b, gap.on_b), 0, 2e-4) << name(other) << " " << i;
        }
    }
}

// Deep overlaps: no search finds a push that is much less.
TEST_P(QueryOfSolid, OverlapIsTheLeastPushThatASearchFinds) {
    Random random(11);
    for (const ShapeKind other : kSolids) {
        for (int i = 0; i < 30; ++i) {
            const Shape a = random_shape(GetParam(), random), b = random_shape(other, random);
            const Placement at_a = {Vec3::Zero(), random.rotation()};
            const Placement at_b = {random.uniform(0.1, 0.5) * random.unit(), random.rotation()};
            const double expected = separation(core(a, at_a), core(b, at_b));
            const double found = find_gap(a, at_a, b, at_b).distance;
            if (expected < -1e-3) {
                EXPECT_NEAR(found, expected, 2.6e-3 - 0.11 * expected) << name(other) << " " << i;
            }
        }
    }
}

// At the end a plane across the normal still parts them, which it did better all the way there, and the point met is
// on both; one in a thousand is up to half a millimetre beside one of them.
TEST_P(QueryOfSolid, CastEndsInTouch) {
    Random random(7);
    int hits = 0, starts_inside = 0, beside = 0;
    for (const ShapeKind other : kSolids) {
        for (int i = 0; i < 300; ++i) {
            const Shape a = random_shape(GetParam(), random), b = random_shape(other, random);
            const Cast cast = random_ray(random, Vec3(-1e4, 0, 0));
            Placement from = {cast.from, random.rotation()};
            Hit hit;
            const bool met = cast_shape(a, from, cast.along, b, cast.at, 1, hit);
            if (met && hit.inside) {
                ++starts_inside;
                EXPECT_TRUE(overlap(a, from, b, cast.at));
                EXPECT_EQ(hit.fraction, 0);
                continue;
            }
            from.position += (met ? hit.fraction : 1) * cast.along;
            if (!met) {
                EXPECT_FALSE(overlap(a, from, b, cast.at)) << name(other) << " " << i;
                continue;
            }
            ++hits;
            EXPECT_NEAR(apart_along(hit.normal, b, cast.at, a, from), 0, 2e-5) << name(other) << " " << i;
            EXPECT_LT(hit.normal.dot(cast.along), 0);
            EXPECT_NEAR(distance_at_least(b, cast.at, hit.point), 0, 1e-3) << name(other) << " " << i;
            EXPECT_LT(distance_at_least(a, from, hit.point), 1e-3) << hit.fraction << name(other) << " " << i;
            beside += std::max(std::fabs(distance_at_least(b, cast.at, hit.point)),
                               distance_at_least(a, from, hit.point)) > 2e-4;
        }
    }
    EXPECT_GT(hits, 700);
    EXPECT_LE(beside, hits / 100);
    EXPECT_GT(starts_inside, 0);
}

// A small ball is nearly a ray, but at tips: both agree, near the origin and far from it.
TEST_P(QueryOfSolid, SmallBallMeetsWhatARayMeets) {
    Random random(8);
    const Shape ball = sphere(1e-3f);
    for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(-10000, 10000, 500)}) {
        for (int i = 0; i < 1000; ++i) {
            const Shape shape = random_shape(GetParam(), random);
            const Cast cast = random_ray(random, origin);
            Hit ray, swept;
            const bool ray_met = cast_ray(shape, cast.at, cast.from, cast.along, 1, ray);
            const bool met = cast_shape(ball, {cast.from, Mat3f::Identity()}, cast.along, shape, cast.at, 1, swept);
            if (!ray_met || ray.inside || -ray.normal.dot(cast.along.normalized()) < 0.2) continue;
            ASSERT_TRUE(met) << i;
            EXPECT_NEAR(swept.fraction * cast.along.norm(), ray.fraction * cast.along.norm(), 2e-2) << i;
            EXPECT_LE(swept.fraction, ray.fraction + 1e-4);
        }
    }
}

TEST_P(QueryOfSolid, CastAtAPlaneStopsAtTheLowestPoint) {
    Random random(9);
    for (int i = 0; i < 1000; ++i) {
        const Shape shape = random_shape(GetParam(), random);
        const Shape ground = plane(random.unit().cast<float>());
        const Vec3 normal = ground.size.cast<double>();
        const Placement at = {random.unit(), Mat3f::Identity()};
        const Placement from = {at.position + 2 * normal + random.unit(), random.rotation()};
        const double lowest = -core(shape, from).reach(-normal) - core(shape, from).radius - normal.dot(at.position);
        const Vec3 along = -4 * normal + 3 * random.unit();
        Hit hit;
        ASSERT_TRUE(cast_shape(shape, from, along, ground, at, 1, hit) || lowest > -normal.dot(along)) << i;
        if (lowest > -normal.dot(along)) continue;
        EXPECT_NEAR(hit.fraction, std::max(0.0, lowest / -normal.dot(along)), 1e-5) << i;
        EXPECT_LT((hit.normal - normal).norm(), 1e-6);
        EXPECT_EQ(hit.inside, lowest < 0) << lowest;
        EXPECT_NEAR(find_gap(shape, from, ground, at).distance, lowest, 1e-5);
        EXPECT_NEAR(find_gap(ground, at, shape, from).distance, lowest, 1e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Queries, QueryOfSolid, testing::ValuesIn(kSolids), kind_name);

// |p + t v| = r_a + r_b, the smaller root.
TEST(Cast, BallMeetsBallWhereTheQuadraticSays) {
    Random random(10);
    for (int i = 0; i < 5000; ++i) {
        const Shape a = random_shape(ShapeKind::sphere, random), b = random_shape(ShapeKind::sphere, random);
        const Cast cast = random_ray(random, Vec3(0, 1e4, 0));
        const Vec3 p = cast.from - cast.at.position;
        const double radii = double(a.size.x()) + double(b.size.x());
        const double v2 = cast.along.squaredNorm(), pv = p.dot(cast.along),
                     square = pv * pv - v2 * (p.squaredNorm() - radii * radii);
        const double expected = square < 0 ? 2 : (-pv - std::sqrt(square)) / v2;
        Hit hit;
        const bool met = cast_shape(a, {cast.from, Mat3f::Identity()}, cast.along, b, cast.at, 1, hit);
        if (p.norm() < radii || std::fabs(square) < 1e-3 * v2) continue;
        ASSERT_EQ(met, expected >= 0 && expected <= 1) << i;
        if (met) {
            EXPECT_NEAR(hit.fraction, expected, 1e-4);
        }
    }
}

// Beside a look at many places of the way: what overlaps at one of them is met no later, what is met is touched there.
TEST(Cast, BallMeetsAHullWhereTheyFirstOverlap) {
    Random random(12);
    int met = 0, missed = 0;
    for (int i = 0; i < 2000; ++i) {
        const Shape stone = random_shape(ShapeKind::hull, random), ball = random_shape(ShapeKind::sphere, random);
        const Cast cast = random_ray(random, Vec3(0, 1e4, 0));
        const auto overlap_at = [&](double t) {
            return overlap(ball, {cast.from + t * cast.along, Mat3f::Identity()}, stone, cast.at);
        };
        int first = 0;
        while (first <= 100 && !overlap_at(0.01 * first)) ++first;
        Hit hit;
        const bool found = cast_shape(ball, {cast.from, Mat3f::Identity()}, cast.along, stone, cast.at, 1, hit);
        if (first <= 100) {
            ASSERT_TRUE(found) << i;
            EXPECT_LE(hit.fraction, 0.01 * first) << i;
        }
        if (!found) {
            ++missed;
            continue;
        }
        ++met;
        const Placement there = {cast.from + hit.fraction * cast.along, Mat3f::Identity()};
        EXPECT_LT(find_gap(ball, there, stone, cast.at).distance, 1e-4) << i;
    }
    EXPECT_GT(met, 300);
    EXPECT_GT(missed, 100);
}

// To a millimetre from ten kilometres away.
TEST(Cast, BallFromAfarMeetsAHullThatItJustReaches) {
    std::vector<Vec3f> corners;
    for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.5f : -0.5f);
    const Shape cube = oracle::hull(corners), ball = sphere(0.25f);
    const Placement at = {Vec3::Zero(), Mat3f::Identity()}, from = {Vec3(1e4, 0.1, -0.2), Mat3f::Identity()};
    for (const double depth : {1e-3, -1e-3}) {
        Hit hit;
        EXPECT_EQ(cast_shape(ball, from, Vec3(0.75 - depth - 1e4, 0, 0), cube, at, 1, hit), depth > 0);
    }
}

TEST(Cast, WhatTouchesAndLeavesIsNotMet) {
    const Shape crate = box(0.5f, 0.5f, 0.5f);
    const Placement below = {Vec3::Zero(), Mat3f::Identity()}, above = {Vec3(0, 1 + 1e-7, 0), Mat3f::Identity()};
    Hit hit;
    EXPECT_FALSE(cast_shape(crate, above, Vec3(0, 1, 0), crate, below, 1, hit));
    EXPECT_FALSE(cast_shape(crate, above, Vec3(1, 0.1, 0), crate, below, 1, hit));
    EXPECT_TRUE(cast_shape(crate, above, Vec3(0, -1, 0), crate, below, 1, hit));
    EXPECT_LT(hit.fraction, 1e-5);
    EXPECT_FALSE(hit.inside);
}

}  // namespace
