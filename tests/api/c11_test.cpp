// Runs c11.c, which must be part of this program (weak, so that a build without C sources says so by itself).
#include <gtest/gtest.h>

extern "C" [[gnu::weak]] int taut_c11_run(void);

TEST(C11, HeadersAndABodyThatFalls) {
    if (!taut_c11_run) GTEST_SKIP() << "c11.c was not compiled into this program";
    EXPECT_EQ(taut_c11_run(), 0) << "the line of c11.c that failed";
}
