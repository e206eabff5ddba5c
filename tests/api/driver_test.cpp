// Random hosts: any order of calls with any arguments leaves the worlds whole. A failure prints its seed.
#include <gtest/gtest.h>

#include "driver.h"

using namespace taut_test;

namespace {

class RandomHost : public testing::TestWithParam<uint64_t> {};

TEST_P(RandomHost, BreaksNothing) {
    int number = 0;
    bool broken = false;
    Driver driver(random_source(GetParam()), [&](const char* call, const char* what) {
        broken = true;
        ADD_FAILURE() << "seed " << GetParam() << ", call " << number << ", " << call << ": " << what;
    });
    for (; number < 3000 && !broken; ++number) driver.call();
    // Both roads were travelled.
    EXPECT_GT(driver.accepted, 1000u);
    EXPECT_GT(driver.refused, 300u);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomHost, testing::Range<uint64_t>(1, 41));
// Broke something once.
INSTANTIATE_TEST_SUITE_P(Known, RandomHost, testing::Values<uint64_t>(1011));

}  // namespace
