// The lanes' AVX2 build for lanes_test.cpp. This one file is to be compiled with -mavx2; without, that test is skipped.
#include "simd/lanes.h"

#include "lanes_operations.h"

taut::test::LanesBuild taut::test::avx2_build() {
#if defined(__AVX2__)
    return {run_operations<Avx2Lanes>, run_transpose<Avx2Lanes>};
#else
    return {nullptr, nullptr};
#endif
}
