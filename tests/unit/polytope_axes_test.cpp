// Which faces and edges of polytopes separate most, and whether two edges decide where they touch, against the axes
// between all of their features.
#include "collision/narrowphase/polytope_axes.h"
#include "starts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "collision/hull.h"
#include "collision_oracle.h"

namespace taut::collision {
namespace {

using oracle::Random;

// How far two polytopes are apart along a unit axis.
float apart_along(const PolytopePair& pair, const Vec3f& n) {
    return n.dot(pair.b_in_a.position) - highest(pair.a, n) - highest(pair.b, pair.b_in_a.rotation.transpose() * -n);
}

// The most along the normals of all faces and across all pairs of edges, both ways.
float most_apart(const PolytopePair& pair) {
    float most = -1e30f;
    const auto ask = [&](const Vec3f& n) { most = std::max(most, apart_along(pair, n)); };
    for (const Face& face : pair.a.faces) ask(face.normal);
    for (const Face& face : pair.b.faces) ask(-(pair.b_in_a.rotation * face.normal));
    for (const Edge& a : pair.a.edges)
        for (const Edge& b : pair.b.edges) {
            const Vec3f along_b = pair.b_in_a.rotation * pair.b.direction(b), n = pair.a.direction(a).cross(along_b);
            if (n.norm() < 1e-4f * pair.a.direction(a).norm() * along_b.norm()) continue;
            ask(n.normalized());
            ask(-n.normalized());
        }
    return most;
}

// Hulls whose least overlap is about so deep.
PolytopePair overlapping(const Hull& a, const Hull& b, double depth, Random& random) {
    const Vec3f along = random.unit().cast<float>();
    const Mat3f rotation = random.rotation();
    double near = 0, far = 4;
    for (int i = 0; i < 20; ++i) {
        const double middle = 0.5 * (near + far);
        const PolytopePair pair(a.view(), b.view(), {rotation, float(middle) * along});
        (most_apart(pair) > float(-depth) ? far : near) = middle;
    }
    return {a.view(), b.view(), {rotation, float(near) * along}};
}

// Two random hulls, their least overlap from least to most deep [m].
struct RandomOverlap {
    RandomOverlap(uint32_t seed, double least, double most)
        : random(seed),
          a(oracle::random_shape(ShapeKind::hull, random)),
          b(oracle::random_shape(ShapeKind::hull, random)),
          pair(overlapping(*a.hull, *b.hull, random.uniform(least, most), random)) {}

    Random random;
    Shape a, b;
    PolytopePair pair;
};

// The face found separates as much as any of its polytope; of b, where that is more than is asked.
TEST(BestFace, SeparatesMostOfAllFaces) {
    constexpr float kAll = -1e30f, kWide = 1, kRounding = 1e-5f;
    for (uint32_t seed = 1; seed <= runs(500u); ++seed) {
        SCOPED_TRACE(seed);
        const RandomOverlap overlap(seed, -0.05, 0.05);
        const PolytopePair& pair = overlap.pair;
        float most_of_a = kAll, most_of_b = kAll;
        for (const Face& face : pair.a.faces) most_of_a = std::max(most_of_a, apart_along(pair, face.normal));
        for (const Face& face : pair.b.faces)
            most_of_b = std::max(most_of_b, apart_along(pair, -(pair.b_in_a.rotation * face.normal)));
        const Separation of_a = best_face_a(pair, kWide), of_b = best_face_b(pair, kAll, kWide);
        EXPECT_NEAR(of_a.distance, most_of_a, kRounding);
        EXPECT_NEAR(of_b.distance, most_of_b, kRounding);
        EXPECT_NEAR(apart_along(pair, pair.normal(of_a.axis)), most_of_a, kRounding);
        EXPECT_NEAR(apart_along(pair, pair.normal(of_b.axis)), most_of_b, kRounding);
        for (const float less : {0.0001f, 0.01f}) {
            const Separation asked = best_face_b(pair, of_b.distance - less, kWide);
            EXPECT_EQ(asked.axis, of_b.axis);
            EXPECT_EQ(asked.distance, of_b.distance);
        }
        EXPECT_LE(best_face_b(pair, of_b.distance, kWide).distance, of_b.distance);
    }
}

// No axis separates by ask more than edges that decide; most edges that bear an overlap of up to a centimetre do.
TEST(EdgesDecide, OnlyWhereNoAxisSeparatesMore) {
    constexpr float kAsk = 0.0025f, kRounding = 2e-5f;
    int bear = 0, decide = 0;
    for (uint32_t seed = 1; seed <= 300; ++seed) {
        SCOPED_TRACE(seed);
        const RandomOverlap overlap(seed, -0.005, 0.03);
        const PolytopePair& pair = overlap.pair;
        const float most = most_apart(pair);
        for (size_t i = 0; i < pair.a.edges.size(); ++i)
            for (size_t j = 0; j < pair.b.edges.size(); ++j) {
                const Axis axis = {AxisKind::edges, uint8_t(i), uint8_t(j)};
                const bool decides = edges_decide(pair, axis, kAsk);
                const float apart = apart_along(pair, pair.normal(axis));
                EXPECT_TRUE(!decides || most <= apart + kAsk + kRounding)
                    << i << " " << j << ": " << apart << ", " << most;
                if (most > -kAsk || most < -4 * kAsk || apart < most - 1e-6f) continue;
                ++bear;
                decide += decides;
            }
    }
    EXPECT_GE(bear, 25);
    EXPECT_GE(2 * decide, bear) << decide << " of " << bear;
}

// Edges that cannot separate by what is asked are left out; the pair that does separate most is found all the same.
TEST(BestEdges, AreFoundWhereTheySeparateByAsMuchAsIsAsked) {
    constexpr float kDeep = 0.1f, kAll = -1e30f, kRounding = 1e-5f;
    int found = 0, left_out = 0;
    for (uint32_t seed = 1; seed <= runs(1000u); ++seed) {
        SCOPED_TRACE(seed);
        const RandomOverlap overlap(seed, -0.02, 0.03);
        const PolytopePair& pair = overlap.pair;
        const Separation face_a = best_face_a(pair, 1), face_b = best_face_b(pair, kAll, 1);
        const Vec3f normal = pair.normal(face_a.distance > face_b.distance ? face_a.axis : face_b.axis);
        const Separation most = best_edges(pair, normal, kDeep, kAll);
        if (most.distance == kAll) continue;
        ++found;
        EXPECT_LE(most.distance, most_apart(pair) + kRounding);
        for (const float less : {kRounding, 0.001f, 0.01f}) {
            const Separation asked = best_edges(pair, normal, kDeep, most.distance - less);
            EXPECT_EQ(asked.axis, most.axis);
            EXPECT_EQ(asked.distance, most.distance);
        }
        const Separation more = best_edges(pair, normal, kDeep, most.distance + 0.01f);
        EXPECT_LE(more.distance, most.distance);
        left_out += more.distance < most.distance;
    }
    EXPECT_GE(found, runs(900));
    EXPECT_GE(left_out, runs(100));
}

}  // namespace
}  // namespace taut::collision
