// With line search Newton's method converges from everywhere, in steps of any length.
#include "bench/newton_map.h"

#include <gtest/gtest.h>

#include <cstdio>

namespace {

// Without the search none fails in short steps, a fifth in long ones.
TEST(NewtonMap, FailsAtLongStepsWithoutTheSearchAlone) {
    constexpr int kSize = 10;
    constexpr double kShort = 1 / 900.0, kLong = 1 / 30.0;  // [s]
    for (const double h : bench::NewtonMap::kSteps) {
        const bench::NewtonMap plain(h, false, kSize), searched(h, true, kSize);
        std::printf("h = 1/%g s: %d of %d fail without the search, %d with it (%.1f solves)\n", 1 / h, plain.failed(),
                    kSize * kSize, searched.failed(), searched.mean());
        EXPECT_EQ(searched.failed(), 0) << h;
        if (h < kShort) {
            EXPECT_EQ(plain.failed(), 0) << h;
        }
        if (h > kLong) {
            EXPECT_GT(plain.failed(), kSize * kSize / 5) << h;
        }
    }
}

}  // namespace
