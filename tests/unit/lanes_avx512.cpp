// The lanes' AVX-512 build for lanes_test.cpp. This one file is to be compiled with -mavx512f and -mavx512dq;
// without, that test is skipped.
#include "simd/lanes.h"

#include "lanes_operations.h"

taut::test::LanesBuild taut::test::avx512_build() {
#if defined(__AVX512DQ__)
    return {run_operations<Avx512Lanes>, run_transpose<Avx512Lanes>};
#else
    return {nullptr, nullptr};
#endif
}
