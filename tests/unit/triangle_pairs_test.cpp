// Distances of triangles' features in lanes against those of detect/nearest.h, one by one.
#include "detect/triangle_pairs.h"

#include <gtest/gtest.h>

#include <random>

#include "detect/nearest.h"

namespace taut::test {
namespace {

struct TwoTriangles {
    Vec3f a[3], b[3];
};

TwoTriangles any_two(std::mt19937& random) {
    std::uniform_real_distribution<float> at(-1, 1);
    const Vec3f shift = 0.7f * Vec3f(at(random), at(random), at(random));
    TwoTriangles two;
    for (int k = 0; k < 3; ++k) {
        two.a[k] = Vec3f(at(random), at(random), at(random));
        two.b[k] = shift + Vec3f(at(random), at(random), at(random));
    }
    return two;
}

// Those nearer than the reach, but for a rounding of it either way.
uint32_t near_of(const TwoTriangles& two, float reach) {
    uint32_t near = 0;
    const auto& [a, b] = two;
    for (int k = 0; k < 3; ++k) {
        const Vec3f one[4] = {a[k], b[0], b[1], b[2]}, other[4] = {b[k], a[0], a[1], a[2]};
        if (nearest_of_face(one).distance() < reach) near |= NearFeatures::corner(k);
        if (nearest_of_face(other).distance() < reach) near |= NearFeatures::other_corner(k);
        for (int n = 0; n < 3; ++n) {
            const Vec3f both[4] = {a[k], a[(k + 1) % 3], b[n], b[(n + 1) % 3]};
            if (nearest_of_segments(both).distance() < reach) near |= NearFeatures::edges(k, n);
        }
    }
    return near;
}

void put(const TwoTriangles& two, float reach, TrianglePairs& pairs, int lane) {
    for (int k = 0; k < 3; ++k)
        for (int c = 0; c < 3; ++c) {
            pairs.corner[0][k][c][lane] = two.a[k][c];
            pairs.corner[1][k][c][lane] = two.b[k][c];
        }
    pairs.reach[lane] = reach;
    pairs.moved[lane] = 1e3f;  // whatever lies beside may get over it
}

TEST(TrianglePairs, FindsWhatIsWithinReach) {
    std::mt19937 random(7);
    uint32_t found = 0;
    for (int run = 0; run < 400; ++run) {
        TrianglePairs pairs{};
        TwoTriangles two[kLanes];
        const float reach = 0.05f + 0.002f * static_cast<float>(run);
        for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
            two[lane] = any_two(random);
            put(two[lane], reach, pairs, lane);
        }
        kTrianglePairsScalar.test(pairs);
        for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
            const uint32_t got = pairs.near[lane] & ~NearFeatures::cut;
            const uint32_t least = near_of(two[lane], 0.999f * reach), most = near_of(two[lane], 1.1f * reach + 1e-4f);
            EXPECT_EQ(got & least, least) << run << " misses in lane " << lane;
            EXPECT_EQ(got & ~most, 0u) << run << " finds what is far in lane " << lane;
            found += got != 0;
        }
    }
    EXPECT_GT(found, 1000u);
}

TEST(TrianglePairs, FindsNothingWithoutReach) {
    std::mt19937 random(8);
    TrianglePairs pairs{};
    for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) put(any_two(random), -1, pairs, lane);
    kTrianglePairsScalar.test(pairs);
    for (const uint32_t near : pairs.near) EXPECT_EQ(near & ~NearFeatures::cut, 0u);
}

TEST(TrianglePairs, HaveTheSameBitsInTheWidestBuild) {
    std::mt19937 random(9);
    for (int run = 0; run < 200; ++run) {
        TrianglePairs one{};
        for (int lane = 0; lane < static_cast<int>(kLanes); ++lane) {
            put(any_two(random), 0.3f, one, lane);
            one.moved[lane] = 0.05f * static_cast<float>(lane);
        }
        TrianglePairs other = one;
        kTrianglePairsScalar.test(one);
        triangle_pair_kernel().test(other);
        for (uint32_t lane = 0; lane < kLanes; ++lane) EXPECT_EQ(one.near[lane], other.near[lane]) << run;
    }
}

}  // namespace
}  // namespace taut::test
