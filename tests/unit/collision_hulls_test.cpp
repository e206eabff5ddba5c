// Hulls as meshes make them, with faces that are nearly in one plane, slivers and needles, against each other, boxes
// and capsules: whatever overlaps is found, as deep as it is.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "collision/hull.h"
#include "collision_oracle.h"
#include "hull_points.h"
#include "starts.h"

namespace taut::collision {
namespace {

using hull_points::Like;
using oracle::Core;
using oracle::Random;

constexpr float kHullMargin = 0.02f;
constexpr double kHullBias = 0.0026, kHullRelativeBias = 0.11;  // as in collision_pairs_test.cpp

Shape hull_like(Like like, hull_points::Maker& maker) {
    while (true) {
        std::vector<Vec3f> points;
        for (const auto& [x, y, z] : maker.make(like)) points.emplace_back(x, y, z);
        if (const Shape shape = oracle::hull(points); shape.hull) return shape;
    }
}

// How deep the oracle has two shapes in each other, found by no code of the library.
struct HullOverlap {
    Shape a, b;
    Placement at_a, at_b;
    double depth() const {
        const Core one = oracle::core(a, at_a), other = oracle::core(b, at_b);
        return -separation(one, other);
    }
};

// At random, b so far along a direction that it reaches into a by at most a depth that is often small.
HullOverlap random_overlap(const Shape& a, const Shape& b, Random& random) {
    HullOverlap out{a, b, {}, {}};
    out.at_a = {random.uniform(0, 3) * random.unit(), random.rotation()};
    out.at_b = {Vec3::Zero(), random.rotation()};
    const Vec3 way = random.unit();
    const double most = random.uniform(0, 0.3) * random.uniform(0, 1);
    const Core one = oracle::core(a, out.at_a), other = oracle::core(b, out.at_b);
    out.at_b.position = way * (one.reach(way) + one.radius + other.reach(-way) + other.radius - most);
    return out;
}

void expect_found(const HullOverlap& pair) {
    PairCache cache;
    Manifold m;
    collide(pair.a, pair.at_a, pair.b, pair.at_b, kHullMargin, cache, m);
    const double depth = pair.depth(), allowed = kHullBias + kHullRelativeBias * depth;
    if (depth < 1e-4) return;
    ASSERT_GT(m.count, 0) << "missed, " << depth << " m deep";
    double deepest = 1e30;
    for (int i = 0; i < m.count; ++i) deepest = std::min(deepest, double(m.points[i].separation));
    EXPECT_NEAR(-deepest, depth, allowed);
    // Pushing b out by the depth along the normal frees it.
    HullOverlap freed = pair;
    freed.at_b.position -= (deepest - 1e-4) * m.normal.cast<double>();
    EXPECT_LT(freed.depth(), allowed);
}

class HullsLike : public testing::TestWithParam<Like> {};

TEST_P(HullsLike, MissNothingAmongThemselves) {
    hull_points::Maker maker(100 + uint32_t(GetParam()));
    Random random(200 + uint32_t(GetParam()));
    for (const Like other : hull_points::kAll) {
        for (int run = 0; run < starts(150) && !HasFailure(); ++run) {
            SCOPED_TRACE(testing::Message() << hull_points::name(other) << " run " << run);
            const Shape a = hull_like(GetParam(), maker), b = hull_like(other, maker);
            expect_found(random_overlap(a, b, random));
        }
    }
}

TEST_P(HullsLike, MissNoBoxAndNoCapsule) {
    hull_points::Maker maker(300 + uint32_t(GetParam()));
    Random random(400 + uint32_t(GetParam()));
    const Shape others[] = {oracle::box(0.4f, 0.2f, 0.3f), oracle::box(0.4f, 0.002f, 0.3f), oracle::capsule(0.1f, 0.2f),
                            oracle::sphere(0.2f)};
    for (int run = 0; run < starts(400) && !HasFailure(); ++run) {
        SCOPED_TRACE(testing::Message() << "run " << run);
        const Shape hull = hull_like(GetParam(), maker), &other = others[run % 4];
        expect_found(run % 3 ? random_overlap(hull, other, random) : random_overlap(other, hull, random));
    }
}

// The axis nearly along an edge between faces that are nearly one: of such edges rounding says what is across.
TEST(HullAndCapsule, AlongAFlatRidge) {
    Random random(800);
    for (int run = 0; run < starts(2000) && !testing::Test::HasFailure(); ++run) {
        SCOPED_TRACE(testing::Message() << "run " << run);
        const float ridge = 0.1f + float(random.uniform(0.0005, 0.003));
        std::vector<Vec3f> points;
        for (const float x : {-0.3f, 0.3f}) {
            for (const float z : {-0.2f, 0.2f}) points.insert(points.end(), {{x, -0.1f, z}, {x, 0.1f, z}});
            points.insert(points.end(), {{x, ridge, 0.05f}, {x, -ridge, -0.05f}});
        }
        const Mat3f turn = random.rotation();
        for (Vec3f& p : points) p = turn * p;
        const double off = std::pow(10, random.uniform(-7, -2));
        const Vec3f at = 0.12f * random.unit().cast<float>();
        const Quat along_x = rotation_from_vector(0.5 * 3.14159265358979 * Vec3::UnitZ());
        const Mat3 rotation =
            turn.cast<double>() * (rotation_from_vector(off * random.unit()) * along_x).toRotationMatrix();
        expect_found({oracle::hull(points),
                      oracle::capsule(0.05f, 0.1f),
                      {Vec3::Zero(), Mat3f::Identity()},
                      {(turn * at).cast<double>(), rotation.cast<float>()}});
    }
}

// With what the pair remembers from further and further out.
TEST_P(HullsLike, MissNothingAlongAWay) {
    hull_points::Maker maker(500 + uint32_t(GetParam()));
    Random random(600 + uint32_t(GetParam()));
    for (int run = 0; run < starts(10) && !HasFailure(); ++run) {
        const Shape a = hull_like(GetParam(), maker), b = hull_like(GetParam(), maker);
        HullOverlap pair = random_overlap(a, b, random);
        const Vec3 way = random.uniform(0.001, 0.01) * random.unit();
        pair.at_b.position -= 15 * way;
        PairCache cache;
        Manifold m;
        for (int step = 0; step < 30; ++step, pair.at_b.position += way) {
            collide(pair.a, pair.at_a, pair.b, pair.at_b, kHullMargin, cache, m);
            ASSERT_TRUE(m.count > 0 || pair.depth() < 1e-4) << "run " << run << " step " << step;
        }
    }
}

// Faces are convex, and their corners in their planes, as far as merging went: 2e-4 of the extent.
TEST_P(HullsLike, HaveConvexFaces) {
    hull_points::Maker maker(700 + uint32_t(GetParam()));
    for (int run = 0; run < starts(200) && !HasFailure(); ++run) {
        SCOPED_TRACE(testing::Message() << "run " << run);
        const Shape shape = hull_like(GetParam(), maker);
        const Polytope& p = shape.hull->view();
        const float slack = 4e-4f * 2 * p.outer_radius;
        EXPECT_GT(p.inner_radius, 0);
        EXPECT_GT(mass_properties(shape, 1).mass, 0);
        for (const Face& face : p.faces) {
            for (const Vec3f& v : p.vertices) EXPECT_LE(face.normal.dot(v), face.offset);
            for (const uint8_t corner : p.loop_of(face)) {
                const Vec3f& v = p.vertices[corner];
                EXPECT_NEAR(face.normal.dot(v), face.offset, slack);
                for (const Side& side : p.sides_of(face))
                    EXPECT_LE(side.x * face.u.dot(v) + side.y * face.v.dot(v), side.offset + slack);
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(All, HullsLike, testing::ValuesIn(hull_points::kAll),
                         [](const auto& param) { return hull_points::name(param.param); });

}  // namespace
}  // namespace taut::collision
