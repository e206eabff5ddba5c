// Runs c11.c, which is compiled as C.
#include <gtest/gtest.h>

extern "C" int taut_c11_run(void);

TEST(C11, HeadersAndABodyThatFalls) { EXPECT_EQ(taut_c11_run(), 0) << "the line of c11.c that failed"; }
