// Lanes in three builds: the same bits for every operation.
#include "simd/lanes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>

#include "lanes_operations.h"

namespace taut::test {
namespace {

constexpr LanesBuild kScalar{run_operations<ScalarLanes>, run_transpose<ScalarLanes>};
constexpr LanesBuild kBase{run_operations<BaseLanes>, run_transpose<BaseLanes>};

struct alignas(64) Wide {
    float f[kWide];
};

// Numbers of every size, with zeros of both signs, equal pairs, denormals and infinities among them.
class Numbers {
public:
    explicit Numbers(uint64_t seed) : engine_(seed) {}
    float next() {
        constexpr float kSpecial[] = {0.0f,   -0.0f,   1.0f,  -1.0f,
                                      1e-40f, -1e-40f, 3e38f, std::numeric_limits<float>::infinity()};
        if (engine_() % 8 == 0) return kSpecial[engine_() % 8];
        std::uniform_real_distribution<float> number(-1, 1), exponent(-20, 20);
        return number(engine_) * std::exp2(exponent(engine_));
    }
    Wide wide() {
        Wide e;
        for (float& f : e.f) f = next();
        return e;
    }

private:
    std::mt19937_64 engine_;
};

// The bits, except that one NaN is as good as another.
void expect_same(const float* a, const float* b, size_t count) {
    for (size_t i = 0; i < count; ++i) {
        if (std::isnan(a[i]) && std::isnan(b[i])) continue;
        uint32_t x, y;
        std::memcpy(&x, a + i, sizeof x);
        std::memcpy(&y, b + i, sizeof y);
        ASSERT_EQ(x, y) << "entry " << i << ": " << a[i] << " and " << b[i];
    }
}

void expect_same_build(const LanesBuild& build) {
    Numbers numbers(1);
    for (int i = 0; i < 20000; ++i) {
        const Wide a = numbers.wide(), b = i % 4 ? numbers.wide() : a, c = numbers.wide(), d = numbers.wide();
        alignas(64) float expected[kWide * kOperations], got[kWide * kOperations];
        kScalar.operations(a.f, b.f, c.f, d.f, expected);
        build.operations(a.f, b.f, c.f, d.f, got);
        expect_same(expected, got, kWide * kOperations);
        if (testing::Test::HasFatalFailure()) return;
    }
    for (size_t stride : {8, 16}) {
        alignas(64) float rows[16 * kWide], columns[2][8 * kWide], back[2][16 * kWide] = {};
        for (float& f : rows) f = numbers.next();
        kScalar.transpose(rows, stride, columns[0], back[0]);
        build.transpose(rows, stride, columns[1], back[1]);
        expect_same(columns[0], columns[1], 8 * kWide);
        expect_same(back[0], back[1], 16 * kWide);
    }
}

TEST(ScalarLanes, ComputeWhatEachNumberDoes) {
    Numbers numbers(2);
    for (int i = 0; i < 5000; ++i) {
        const Wide a = numbers.wide(), b = numbers.wide(), c = numbers.wide(), d = numbers.wide();
        alignas(64) float out[kWide * kOperations], expected[kWide * kOperations];
        kScalar.operations(a.f, b.f, c.f, d.f, out);
        for (size_t k = 0; k < kWide; ++k) {
            expected[k] = a.f[k] + b.f[k];
            expected[kWide + k] = a.f[k] - b.f[k];
            expected[2 * kWide + k] = a.f[k] * b.f[k];
            expected[3 * kWide + k] = a.f[k] / b.f[k];
            expected[4 * kWide + k] = a.f[k] > b.f[k] ? a.f[k] : b.f[k];
            expected[5 * kWide + k] = std::sqrt(a.f[k] > 0 ? a.f[k] : 0.0f);
            expected[6 * kWide + k] = a.f[k] > b.f[k] ? c.f[k] : d.f[k];
            expected[7 * kWide + k] = *std::max_element(a.f, a.f + kWide) + 0.0f;
        }
        expect_same(expected, out, kWide * kOperations);
    }
}

TEST(ScalarLanes, TransposeThereAndBack) {
    for (size_t stride : {8, 16}) {
        alignas(64) float rows[16 * kWide], columns[8 * kWide], back[16 * kWide];
        for (size_t i = 0; i < 16 * kWide; ++i) rows[i] = back[i] = static_cast<float>(i);
        for (size_t r = 0; r < kWide; ++r)
            for (size_t c = 0; c < 8; ++c) back[r * stride + c] = -1;
        kScalar.transpose(rows, stride, columns, back);
        for (size_t r = 0; r < kWide; ++r)
            for (size_t c = 0; c < 8; ++c) {
                EXPECT_EQ(columns[kWide * c + r], rows[r * stride + c]);
                EXPECT_EQ(back[r * stride + c], rows[r * stride + c]);
            }
    }
}

TEST(BaseLanes, HaveTheBitsOfTheScalarOnes) { expect_same_build(kBase); }

#if defined(__x86_64__)
TEST(Avx2Lanes, HaveTheBitsOfTheScalarOnes) {
    if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
    expect_same_build(avx2_build());
}

TEST(Avx512Lanes, HaveTheBitsOfTheScalarOnes) {
    if (!__builtin_cpu_supports("avx512dq")) GTEST_SKIP() << "this processor has no AVX-512";
    expect_same_build(avx512_build());
}
#endif

}  // namespace
}  // namespace taut::test
