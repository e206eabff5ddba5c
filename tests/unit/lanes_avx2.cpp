// The lanes' AVX2 build for lanes_test.cpp; nothing but the lanes may be compiled for that processor.
#include <immintrin.h>

#include "lanes_operations.h"

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC push_options
#pragma GCC target("avx2")
#if !defined(__AVX2__)
#define __AVX2__ 1  // before GCC 13 the pragma does so too late for the lines below
#endif
#endif

#include "simd/lanes.h"

#if defined(__AVX2__)
namespace taut::test {
namespace {

void operations(const float* a, const float* b, const float* c, const float* d, float* out) {
    run_operations<Avx2Lanes>(a, b, c, d, out);
}
void transpose(const float* rows, std::size_t stride, float* columns, float* back) {
    run_transpose<Avx2Lanes>(rows, stride, columns, back);
}

}  // namespace
}  // namespace taut::test
#define TAUT_TEST_AVX2 1
#endif

#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC pop_options
#endif

taut::test::LanesBuild taut::test::avx2_build() {
#if defined(TAUT_TEST_AVX2)
    return {operations, transpose};
#else
    return {nullptr, nullptr};
#endif
}
