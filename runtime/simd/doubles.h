// kDoubles numbers of double precision side by side, in builds with the same bits, as of floats (lanes.h).
#pragma once

#include "simd/lanes.h"

namespace taut {

using ScalarDoubles = ScalarLanesOf<double, kDoubles>;

#if defined(__SSE2__)
struct Sse2DoubleRegister {
    using Number = double;
    using Register = Sse2DoubleRegister;
    static constexpr int kWidth = 2;
    __m128d f;

    static Register load(const double* p) { return {_mm_loadu_pd(p)}; }
    static Register all(double x) { return {_mm_set1_pd(x)}; }
    void store(double* p) const { _mm_storeu_pd(p, f); }
    friend Register operator+(Register a, Register b) { return {_mm_add_pd(a.f, b.f)}; }
    friend Register operator-(Register a, Register b) { return {_mm_sub_pd(a.f, b.f)}; }
    friend Register operator*(Register a, Register b) { return {_mm_mul_pd(a.f, b.f)}; }
    friend Register operator/(Register a, Register b) { return {_mm_div_pd(a.f, b.f)}; }
    static Register max(Register a, Register b) { return {_mm_max_pd(a.f, b.f)}; }
    static Register sqrt(Register a) { return {_mm_sqrt_pd(a.f)}; }
    static Register if_greater(Register a, Register b, Register yes, Register no) {
        const __m128d mask = _mm_cmpgt_pd(a.f, b.f);
        return {_mm_or_pd(_mm_and_pd(mask, yes.f), _mm_andnot_pd(mask, no.f))};
    }
    static unsigned greater(Register a, Register b) {
        return static_cast<unsigned>(_mm_movemask_pd(_mm_cmpgt_pd(a.f, b.f)));
    }
};
using BaseDoubles = Twice<Twice<Sse2DoubleRegister>>;
#elif defined(__aarch64__)
struct NeonDoubleRegister {
    using Number = double;
    using Register = NeonDoubleRegister;
    static constexpr int kWidth = 2;
    float64x2_t f;

    static Register load(const double* p) { return {vld1q_f64(p)}; }
    static Register all(double x) { return {vdupq_n_f64(x)}; }
    void store(double* p) const { vst1q_f64(p, f); }
    friend Register operator+(Register a, Register b) { return {vaddq_f64(a.f, b.f)}; }
    friend Register operator-(Register a, Register b) { return {vsubq_f64(a.f, b.f)}; }
    friend Register operator*(Register a, Register b) { return {vmulq_f64(a.f, b.f)}; }
    friend Register operator/(Register a, Register b) { return {vdivq_f64(a.f, b.f)}; }
    static Register max(Register a, Register b) { return if_greater(a, b, a, b); }
    static Register sqrt(Register a) { return {vsqrtq_f64(a.f)}; }
    static Register if_greater(Register a, Register b, Register yes, Register no) {
        return {vbslq_f64(vcgtq_f64(a.f, b.f), yes.f, no.f)};
    }
    static unsigned greater(Register a, Register b) {
        const uint64x2_t mask = vcgtq_f64(a.f, b.f);
        return static_cast<unsigned>((vgetq_lane_u64(mask, 0) & 1) | (vgetq_lane_u64(mask, 1) & 2));
    }
};
using BaseDoubles = Twice<Twice<NeonDoubleRegister>>;
#else
using BaseDoubles = ScalarDoubles;
#endif

#if defined(__AVX2__)
struct Avx2DoubleRegister {
    using Number = double;
    using Register = Avx2DoubleRegister;
    static constexpr int kWidth = 4;
    __m256d f;

    static Register load(const double* p) { return {_mm256_loadu_pd(p)}; }
    static Register all(double x) { return {_mm256_set1_pd(x)}; }
    void store(double* p) const { _mm256_storeu_pd(p, f); }
    friend Register operator+(Register a, Register b) { return {_mm256_add_pd(a.f, b.f)}; }
    friend Register operator-(Register a, Register b) { return {_mm256_sub_pd(a.f, b.f)}; }
    friend Register operator*(Register a, Register b) { return {_mm256_mul_pd(a.f, b.f)}; }
    friend Register operator/(Register a, Register b) { return {_mm256_div_pd(a.f, b.f)}; }
    static Register max(Register a, Register b) { return {_mm256_max_pd(a.f, b.f)}; }
    static Register sqrt(Register a) { return {_mm256_sqrt_pd(a.f)}; }
    static Register if_greater(Register a, Register b, Register yes, Register no) {
        return {_mm256_blendv_pd(no.f, yes.f, _mm256_cmp_pd(a.f, b.f, _CMP_GT_OQ))};
    }
    static unsigned greater(Register a, Register b) {
        return static_cast<unsigned>(_mm256_movemask_pd(_mm256_cmp_pd(a.f, b.f, _CMP_GT_OQ)));
    }
};
using Avx2Doubles = Twice<Avx2DoubleRegister>;
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
struct Avx512DoubleRegister {
    using Number = double;
    using Register = Avx512DoubleRegister;
    static constexpr int kWidth = 8;
    __m512d f;

    static Register load(const double* p) { return {_mm512_loadu_pd(p)}; }
    static Register all(double x) { return {_mm512_set1_pd(x)}; }
    void store(double* p) const { _mm512_storeu_pd(p, f); }
    friend Register operator+(Register a, Register b) { return {_mm512_add_pd(a.f, b.f)}; }
    friend Register operator-(Register a, Register b) { return {_mm512_sub_pd(a.f, b.f)}; }
    friend Register operator*(Register a, Register b) { return {_mm512_mul_pd(a.f, b.f)}; }
    friend Register operator/(Register a, Register b) { return {_mm512_div_pd(a.f, b.f)}; }
    static Register max(Register a, Register b) { return {_mm512_max_pd(a.f, b.f)}; }
    static Register sqrt(Register a) { return {_mm512_sqrt_pd(a.f)}; }
    static Register if_greater(Register a, Register b, Register yes, Register no) {
        return {_mm512_mask_blend_pd(_mm512_cmp_pd_mask(a.f, b.f, _CMP_GT_OQ), no.f, yes.f)};
    }
    static unsigned greater(Register a, Register b) { return _mm512_cmp_pd_mask(a.f, b.f, _CMP_GT_OQ); }
};
using Avx512Doubles = Avx512DoubleRegister;
#endif

}  // namespace taut
