// Every operation of the lanes on given numbers, as a template over the build. Include after simd/lanes.h.
#pragma once

#include <cstddef>

namespace taut::test {

constexpr std::size_t kWide = kLanes, kOperations = 8;

// a, b, c, d: kLanes numbers each, aligned to 64; out: kOperations times kLanes.
template <class F>
void run_operations(const float* a, const float* b, const float* c, const float* d, float* out) {
    const F x = F::load(a), y = F::load(b);
    (x + y).store(out);
    (x - y).store(out + kWide);
    (x * y).store(out + 2 * kWide);
    (x / y).store(out + 3 * kWide);
    F::max(x, y).store(out + 4 * kWide);
    F::sqrt(F::max(x, F::all(0))).store(out + 5 * kWide);
    F::if_greater(x, y, F::load(c), F::load(d)).store(out + 6 * kWide);
    F::all(F::largest(x) + 0.0f).store(out + 7 * kWide);  // of zeros either may be found
}

// rows: kLanes rows of eight at a stride. columns: what lane k of component c holds; back: the rows again.
template <class F>
void run_transpose(const float* rows, std::size_t stride, float* columns, float* back) {
    const float* from[kWide];
    float* to[kWide];
    for (std::size_t i = 0; i < kWide; ++i) {
        from[i] = rows + i * stride;
        to[i] = back + i * stride;
    }
    F lanes[8];
    F::transpose(from, lanes);
    for (std::size_t i = 0; i < 8; ++i) lanes[i].store(columns + kWide * i);
    F::transpose_back(lanes, to);
}

struct LanesBuild {
    void (*operations)(const float*, const float*, const float*, const float*, float*);
    void (*transpose)(const float*, std::size_t, float*, float*);
};
// Null where the compiler cannot build it here.
LanesBuild avx2_build();
LanesBuild avx512_build();

}  // namespace taut::test
