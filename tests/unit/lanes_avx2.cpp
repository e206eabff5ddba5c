// The lanes' AVX2 build for lanes_test.cpp, compiled with -mavx2.
#include "simd/lanes.h"

#include "lanes_operations.h"

taut::test::LanesBuild taut::test::avx2_build() { return {run_operations<Avx2Lanes>, run_transpose<Avx2Lanes>}; }
