// Homes follow the votes of those who had a run in hand, and lists that grow and shrink.
#include "threads/homes.h"

#include <gtest/gtest.h>

namespace taut::test {
namespace {

constexpr uint32_t kRun = Homes::kRun;

struct HomesTest : testing::Test {
    Memory memory{taut_hooks{}};
    Homes homes{memory};

    void vote(uint32_t part, uint32_t run, uint32_t times) {
        for (uint32_t i = 0; i < times; ++i) homes.vote(part, run * kRun + i);
    }
    uint32_t of(uint32_t run) const { return homes(run * kRun); }
};

TEST_F(HomesTest, AreEvenAtFirst) {
    homes.settle(3, 9 * kRun);
    for (uint32_t run = 0; run < 9; ++run) EXPECT_EQ(of(run), run / 3);
    EXPECT_EQ(homes(kRun - 1), 0u);
    homes.settle(3, 9 * kRun);  // nobody had anything
    for (uint32_t run = 0; run < 9; ++run) EXPECT_EQ(of(run), run / 3);
}

TEST_F(HomesTest, GoToWhoHadMost) {
    homes.settle(2, 4 * kRun);
    vote(0, 0, 10), vote(1, 0, 11);
    vote(0, 1, 12), vote(1, 1, 11);
    vote(1, 3, 1);
    EXPECT_EQ(of(3), 1u);  // as it was
    EXPECT_EQ(of(0), 0u);
    homes.settle(2, 4 * kRun);
    EXPECT_EQ(of(0), 1u);
    EXPECT_EQ(of(1), 0u);
    EXPECT_EQ(of(2), 0u);  // as the run before
    EXPECT_EQ(of(3), 1u);
    vote(1, 1, 1);  // votes of before are over
    homes.settle(2, 4 * kRun);
    EXPECT_EQ(of(1), 1u);
}

TEST_F(HomesTest, GrowAndShrink) {
    homes.vote(0, 0);  // before there is a list: none to have a run of
    homes.settle(2, 2 * kRun);
    vote(1, 0, 1);
    homes.settle(2, 2 * kRun);
    vote(1, 1, 1), vote(0, 0, 1);
    homes.settle(2, 5 * kRun + 1);
    EXPECT_EQ(of(0), 0u);
    for (uint32_t run = 1; run < 6; ++run) EXPECT_EQ(of(run), 1u);
    homes.vote(1, 6 * kRun);  // beyond
    homes.vote(2, 0);
    homes.settle(2, 1);
    EXPECT_EQ(of(0), 0u);
    EXPECT_EQ(of(1), 0u);
    homes.settle(2, 0);
    homes.settle(2, 4 * kRun);
    for (uint32_t run = 0; run < 4; ++run) EXPECT_LT(of(run), 2u);
}

TEST_F(HomesTest, OfOneThreadAreNone) {
    homes.settle(1, 4 * kRun);
    vote(0, 3, 5);
    homes.settle(1, 4 * kRun);
    EXPECT_EQ(of(3), 0u);
}

}  // namespace
}  // namespace taut::test
