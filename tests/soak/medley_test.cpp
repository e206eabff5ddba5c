// Heavy and light things in one world, from many random starts.
#include <cmath>
#include <cstdio>

#include "soak/medley.h"

namespace {

using soak::Family;
using soak::Medley;

Medley::Outcome play(const Family& family, uint32_t start, uint32_t threads) {
    soak::Random random(start);
    Medley medley(threads);
    family.make(medley, random);
    return medley.run();
}

// So many starts from the first on.
void expect_bounds(const Family& family, uint32_t first, uint32_t count) {
    const soak::Bounds& bounds = family.bounds;
    Medley::Outcome most;
    uint32_t overlap = 0;
    for (uint32_t start = first; start < first + count; ++start) {
        const Medley::Outcome out = play(family, start, 1);
        EXPECT_LE(out.fastest, bounds.fastest) << "start " << start;
        EXPECT_LE(out.gap, bounds.gap) << "start " << start;
        EXPECT_LE(out.gain, bounds.driven ? HUGE_VAL : 0.01) << "start " << start;
        overlap += out.overlap > 1.0 / 3;
        most.fastest = std::max(most.fastest, out.fastest);
        most.gap = std::max(most.gap, out.gap);
        most.overlap = std::max(most.overlap, out.overlap);
    }
    EXPECT_LE(overlap, bounds.leaves_room ? count / 20 : count);
    std::printf("%s: up to %.1f m/s, joints open by %.1f mm, overlap %.2f cores in the end, %u of %u by a third\n",
                family.name, most.fastest, 1e3 * most.gap, most.overlap, overlap, count);
}

struct MedleyShort : testing::TestWithParam<Family> {};
TEST_P(MedleyShort, KeepsItsBounds) { expect_bounds(GetParam(), 1, 4); }

TEST_P(MedleyShort, IsTheSameOnAnyThreads) {
    for (const uint32_t start : {5u, 6u}) {
        const uint64_t alone = play(GetParam(), start, 1).hash;
        for (const uint32_t threads : {2u, 5u}) EXPECT_EQ(play(GetParam(), start, threads).hash, alone) << threads;
    }
}

struct MedleyLong : testing::TestWithParam<Family> {};
TEST_P(MedleyLong, KeepsItsBounds) { expect_bounds(GetParam(), 7001, 200); }

std::string family_name(const testing::TestParamInfo<Family>& tested) { return tested.param.name; }

const auto kFamilies = testing::ValuesIn(soak::families().begin(), soak::families().end());
INSTANTIATE_TEST_SUITE_P(Of, MedleyShort, kFamilies, family_name);
INSTANTIATE_TEST_SUITE_P(Of, MedleyLong, kFamilies, family_name);

}  // namespace
