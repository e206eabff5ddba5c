// The lanes' AVX-512 build for lanes_test.cpp, compiled with -mavx512f and -mavx512dq.
#include "simd/lanes.h"

#include "lanes_operations.h"

taut::test::LanesBuild taut::test::avx512_build() { return {run_operations<Avx512Lanes>, run_transpose<Avx512Lanes>}; }
