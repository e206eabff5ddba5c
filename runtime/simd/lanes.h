// kLanes floats side by side, in builds with the same bits: scalar, SSE2 or NEON, AVX2 and AVX-512. Only IEEE
// operations (add, sub, mul, div, sqrt, compare), no fused multiply-add, so each lane computes what the scalar does.
// One register of the widest build, which has 32 of them; two of the next: what they compute does not wait for each
// other.
// Used by kernels that are templates over the type: no function here is shared between builds.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

#include "simd/width.h"

namespace taut {

template <class N, int Width>
struct ScalarLanesOf {
    using Number = N;
    using Lanes = ScalarLanesOf;
    static constexpr int kWidth = Width;
    Number f[Width];

    static Lanes load(const Number* p) {
        Lanes r;
        for (int i = 0; i < Width; ++i) r.f[i] = p[i];
        return r;
    }
    static Lanes all(Number x) {
        Lanes r;
        for (Number& e : r.f) e = x;
        return r;
    }
    void store(Number* p) const {
        for (int i = 0; i < Width; ++i) p[i] = f[i];
    }
    template <class Op>
    static Lanes zip(const Lanes& a, const Lanes& b, Op op) {
        Lanes r;
        for (int i = 0; i < Width; ++i) r.f[i] = op(a.f[i], b.f[i]);
        return r;
    }
    friend Lanes operator+(const Lanes& a, const Lanes& b) {
        return zip(a, b, [](Number x, Number y) { return x + y; });
    }
    friend Lanes operator-(const Lanes& a, const Lanes& b) {
        return zip(a, b, [](Number x, Number y) { return x - y; });
    }
    friend Lanes operator*(const Lanes& a, const Lanes& b) {
        return zip(a, b, [](Number x, Number y) { return x * y; });
    }
    friend Lanes operator/(const Lanes& a, const Lanes& b) {
        return zip(a, b, [](Number x, Number y) { return x / y; });
    }
    static Lanes max(const Lanes& a, const Lanes& b) {
        return zip(a, b, [](Number x, Number y) { return x > y ? x : y; });
    }
    static Lanes sqrt(const Lanes& a) {
        return zip(a, a, [](Number x, Number) {
            if constexpr (sizeof(Number) == sizeof(float))
                return __builtin_sqrtf(x);
            else
                return __builtin_sqrt(x);
        });
    }
    // a > b ? yes : no
    static Lanes if_greater(const Lanes& a, const Lanes& b, const Lanes& yes, const Lanes& no) {
        Lanes r;
        for (int i = 0; i < Width; ++i) r.f[i] = a.f[i] > b.f[i] ? yes.f[i] : no.f[i];
        return r;
    }
    // a > b, a bit a lane
    static unsigned greater(const Lanes& a, const Lanes& b) {
        unsigned bits = 0;
        for (int i = 0; i < Width; ++i) bits |= static_cast<unsigned>(a.f[i] > b.f[i]) << i;
        return bits;
    }
    static Number largest(const Lanes& a) {
        Number most = a.f[0];
        for (int i = 1; i < Width; ++i) most = a.f[i] > most ? a.f[i] : most;
        return most;
    }
    // Whether any lane of any of them is not 0.
    template <class... Each>
    static bool any(const Each&... lanes) {
        bool found = false;
        for (int i = 0; i < Width; ++i) found = found || ((lanes.f[i] != 0) || ...);
        return found;
    }
    // Rows of eight or four numbers, one for each lane, become columns: out[c] holds component c of all lanes.
    template <int Columns>
    static void transpose(const Number* const row[Width], Lanes (&out)[Columns]) {
        for (int c = 0; c < Columns; ++c)
            for (int lane = 0; lane < Width; ++lane) out[c].f[lane] = row[lane][c];
    }
    template <int Columns>
    static void transpose_back(const Lanes (&in)[Columns], Number* const row[Width]) {
        for (int c = 0; c < Columns; ++c)
            for (int lane = 0; lane < Width; ++lane) row[lane][c] = in[c].f[lane];
    }
};
using ScalarLanes = ScalarLanesOf<float, kLanes>;

// Twice as many lanes as R has.
template <class R>
struct Twice {
    using Number = typename R::Number;
    static constexpr int kWidth = 2 * R::kWidth;
    R lo, hi;

    static Twice load(const Number* p) { return {R::load(p), R::load(p + R::kWidth)}; }
    static Twice all(Number x) { return {R::all(x), R::all(x)}; }
    void store(Number* p) const {
        lo.store(p);
        hi.store(p + R::kWidth);
    }
    friend Twice operator+(Twice a, Twice b) { return {a.lo + b.lo, a.hi + b.hi}; }
    friend Twice operator-(Twice a, Twice b) { return {a.lo - b.lo, a.hi - b.hi}; }
    friend Twice operator*(Twice a, Twice b) { return {a.lo * b.lo, a.hi * b.hi}; }
    friend Twice operator/(Twice a, Twice b) { return {a.lo / b.lo, a.hi / b.hi}; }
    static Twice max(Twice a, Twice b) { return {R::max(a.lo, b.lo), R::max(a.hi, b.hi)}; }
    static Twice sqrt(Twice a) { return {R::sqrt(a.lo), R::sqrt(a.hi)}; }
    static Twice if_greater(Twice a, Twice b, Twice yes, Twice no) {
        return {R::if_greater(a.lo, b.lo, yes.lo, no.lo), R::if_greater(a.hi, b.hi, yes.hi, no.hi)};
    }
    static Number largest(Twice a) { return R::largest(R::max(a.lo, a.hi)); }
    static unsigned greater(Twice a, Twice b) { return R::greater(a.lo, b.lo) | R::greater(a.hi, b.hi) << R::kWidth; }
    template <class... Lanes>
    static bool any(Lanes... lanes) {
        return R::any(lanes.lo..., lanes.hi...);
    }
    template <int Columns>
    static void transpose(const Number* const row[kWidth], Twice (&out)[Columns]) {
        R lo_[Columns], hi_[Columns];
        R::transpose(row, lo_);
        R::transpose(row + R::kWidth, hi_);
#pragma GCC unroll 8
        for (int c = 0; c < Columns; ++c) out[c] = {lo_[c], hi_[c]};
    }
    template <int Columns>
    static void transpose_back(const Twice (&in)[Columns], Number* const row[kWidth]) {
        R a_[Columns], b_[Columns];
#pragma GCC unroll 8
        for (int c = 0; c < Columns; ++c) a_[c] = in[c].lo, b_[c] = in[c].hi;
        R::transpose_back(a_, row);
        R::transpose_back(b_, row + R::kWidth);
    }
};

// BaseLanes: what every machine of this kind has, also for code that comes in one build.
#if defined(__SSE2__)
struct Sse2Register {
    using Number = float;
    static constexpr int kWidth = 4;
    __m128 f;

    static Sse2Register load(const float* p) { return {_mm_load_ps(p)}; }
    static Sse2Register all(float x) { return {_mm_set1_ps(x)}; }
    void store(float* p) const { _mm_store_ps(p, f); }
    friend Sse2Register operator+(Sse2Register a, Sse2Register b) { return {_mm_add_ps(a.f, b.f)}; }
    friend Sse2Register operator-(Sse2Register a, Sse2Register b) { return {_mm_sub_ps(a.f, b.f)}; }
    friend Sse2Register operator*(Sse2Register a, Sse2Register b) { return {_mm_mul_ps(a.f, b.f)}; }
    friend Sse2Register operator/(Sse2Register a, Sse2Register b) { return {_mm_div_ps(a.f, b.f)}; }
    static Sse2Register max(Sse2Register a, Sse2Register b) { return {_mm_max_ps(a.f, b.f)}; }
    static Sse2Register sqrt(Sse2Register a) { return {_mm_sqrt_ps(a.f)}; }
    static Sse2Register if_greater(Sse2Register a, Sse2Register b, Sse2Register yes, Sse2Register no) {
        const __m128 mask = _mm_cmpgt_ps(a.f, b.f);
        return {_mm_or_ps(_mm_and_ps(mask, yes.f), _mm_andnot_ps(mask, no.f))};
    }
    static unsigned greater(Sse2Register a, Sse2Register b) {
        return static_cast<unsigned>(_mm_movemask_ps(_mm_cmpgt_ps(a.f, b.f)));
    }
    static float largest(Sse2Register a) {
        const __m128 two = _mm_max_ps(a.f, _mm_movehl_ps(a.f, a.f));
        return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
    }
    // All bits together are 0 or -0 only where each is.
    template <class... More>
    static bool any(Sse2Register a, More... more) {
        ((a.f = _mm_or_ps(a.f, more.f)), ...);
        return _mm_movemask_ps(_mm_cmpneq_ps(a.f, _mm_setzero_ps())) != 0;
    }
    template <int Columns>
    static void transpose(const float* const row[4], Sse2Register (&out)[Columns]) {
        for (int half = 0; half < Columns / 4; ++half) {
            __m128 r[4];
#pragma GCC unroll 8
            for (int i = 0; i < 4; ++i) r[i] = _mm_load_ps(row[i] + 4 * half);
            _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
#pragma GCC unroll 8
            for (int i = 0; i < 4; ++i) out[4 * half + i].f = r[i];
        }
    }
    template <int Columns>
    static void transpose_back(const Sse2Register (&in)[Columns], float* const row[4]) {
        for (int half = 0; half < Columns / 4; ++half) {
            __m128 r[4];
#pragma GCC unroll 8
            for (int i = 0; i < 4; ++i) r[i] = in[4 * half + i].f;
            _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
#pragma GCC unroll 8
            for (int i = 0; i < 4; ++i) _mm_store_ps(row[i] + 4 * half, r[i]);
        }
    }
};
using BaseLanes = Twice<Twice<Sse2Register>>;
#elif defined(__aarch64__)
struct NeonRegister {
    using Number = float;
    static constexpr int kWidth = 4;
    float32x4_t f;

    static NeonRegister load(const float* p) { return {vld1q_f32(p)}; }
    static NeonRegister all(float x) { return {vdupq_n_f32(x)}; }
    void store(float* p) const { vst1q_f32(p, f); }
    friend NeonRegister operator+(NeonRegister a, NeonRegister b) { return {vaddq_f32(a.f, b.f)}; }
    friend NeonRegister operator-(NeonRegister a, NeonRegister b) { return {vsubq_f32(a.f, b.f)}; }
    friend NeonRegister operator*(NeonRegister a, NeonRegister b) { return {vmulq_f32(a.f, b.f)}; }
    friend NeonRegister operator/(NeonRegister a, NeonRegister b) { return {vdivq_f32(a.f, b.f)}; }
    // The instruction for it takes not-a-number from either side.
    static NeonRegister max(NeonRegister a, NeonRegister b) { return if_greater(a, b, a, b); }
    static NeonRegister sqrt(NeonRegister a) { return {vsqrtq_f32(a.f)}; }
    static NeonRegister if_greater(NeonRegister a, NeonRegister b, NeonRegister yes, NeonRegister no) {
        return {vbslq_f32(vcgtq_f32(a.f, b.f), yes.f, no.f)};
    }
    static unsigned greater(NeonRegister a, NeonRegister b) {
        constexpr uint32_t kBits[4] = {1, 2, 4, 8};
        return vaddvq_u32(vandq_u32(vcgtq_f32(a.f, b.f), vld1q_u32(kBits)));
    }
    static float largest(NeonRegister a) {
        const NeonRegister two = max(a, {vextq_f32(a.f, a.f, 2)});
        return vgetq_lane_f32(max(two, {vextq_f32(two.f, two.f, 1)}).f, 0);
    }
    template <class... More>
    static bool any(NeonRegister a, More... more) {
        uint32x4_t bits = vreinterpretq_u32_f32(a.f);
        ((bits = vorrq_u32(bits, vreinterpretq_u32_f32(more.f))), ...);
        return vmaxvq_u32(vshlq_n_u32(bits, 1)) != 0;  // all but the sign
    }
    template <int Columns>
    static void transpose(const float* const row[4], NeonRegister (&out)[Columns]) {
        for (int half = 0; half < Columns / 4; ++half) {
            float32x4_t r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) r[i] = vld1q_f32(row[i] + 4 * half);
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) out[4 * half + i].f = r[i];
        }
    }
    template <int Columns>
    static void transpose_back(const NeonRegister (&in)[Columns], float* const row[4]) {
        for (int half = 0; half < Columns / 4; ++half) {
            float32x4_t r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) r[i] = in[4 * half + i].f;
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) vst1q_f32(row[i] + 4 * half, r[i]);
        }
    }

private:
    static void transpose4(float32x4_t (&r)[4]) {
        const float32x4x2_t low = vtrnq_f32(r[0], r[1]), high = vtrnq_f32(r[2], r[3]);
        r[0] = vcombine_f32(vget_low_f32(low.val[0]), vget_low_f32(high.val[0]));
        r[1] = vcombine_f32(vget_low_f32(low.val[1]), vget_low_f32(high.val[1]));
        r[2] = vcombine_f32(vget_high_f32(low.val[0]), vget_high_f32(high.val[0]));
        r[3] = vcombine_f32(vget_high_f32(low.val[1]), vget_high_f32(high.val[1]));
    }
};
using BaseLanes = Twice<Twice<NeonRegister>>;
#else
using BaseLanes = ScalarLanes;
#endif

#if defined(__AVX2__)
struct Avx2Register {
    using Number = float;
    static constexpr int kWidth = 8;
    __m256 f;

    static Avx2Register load(const float* p) { return {_mm256_load_ps(p)}; }
    static Avx2Register all(float x) { return {_mm256_set1_ps(x)}; }
    void store(float* p) const { _mm256_store_ps(p, f); }
    friend Avx2Register operator+(Avx2Register a, Avx2Register b) { return {_mm256_add_ps(a.f, b.f)}; }
    friend Avx2Register operator-(Avx2Register a, Avx2Register b) { return {_mm256_sub_ps(a.f, b.f)}; }
    friend Avx2Register operator*(Avx2Register a, Avx2Register b) { return {_mm256_mul_ps(a.f, b.f)}; }
    friend Avx2Register operator/(Avx2Register a, Avx2Register b) { return {_mm256_div_ps(a.f, b.f)}; }
    static Avx2Register max(Avx2Register a, Avx2Register b) { return {_mm256_max_ps(a.f, b.f)}; }
    static Avx2Register sqrt(Avx2Register a) { return {_mm256_sqrt_ps(a.f)}; }
    static Avx2Register if_greater(Avx2Register a, Avx2Register b, Avx2Register yes, Avx2Register no) {
        return {_mm256_blendv_ps(no.f, yes.f, _mm256_cmp_ps(a.f, b.f, _CMP_GT_OQ))};
    }
    static unsigned greater(Avx2Register a, Avx2Register b) {
        return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(a.f, b.f, _CMP_GT_OQ)));
    }
    static float largest(Avx2Register a) {
        const __m128 four = _mm_max_ps(_mm256_castps256_ps128(a.f), _mm256_extractf128_ps(a.f, 1));
        const __m128 two = _mm_max_ps(four, _mm_movehl_ps(four, four));
        return _mm_cvtss_f32(_mm_max_ss(two, _mm_shuffle_ps(two, two, 1)));
    }
    template <class... More>
    static bool any(Avx2Register a, More... more) {
        ((a.f = _mm256_or_ps(a.f, more.f)), ...);
        return _mm256_movemask_ps(_mm256_cmp_ps(a.f, _mm256_setzero_ps(), _CMP_NEQ_UQ)) != 0;
    }
    // By half rows: what crosses the halves of a register is slow on many processors, and loads and stores need not.
    template <int Columns>
    static void transpose(const float* const row[8], Avx2Register (&out)[Columns]) {
#pragma GCC unroll 2
        for (int half = 0; half < Columns / 4; ++half) {
            __m256 r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) r[i] = _mm256_loadu2_m128(row[i + 4] + 4 * half, row[i] + 4 * half);
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) out[4 * half + i].f = r[i];
        }
    }
    template <int Columns>
    static void transpose_back(const Avx2Register (&in)[Columns], float* const row[8]) {
#pragma GCC unroll 2
        for (int half = 0; half < Columns / 4; ++half) {
            __m256 r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) r[i] = in[4 * half + i].f;
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) _mm256_storeu2_m128(row[i + 4] + 4 * half, row[i] + 4 * half, r[i]);
        }
    }

private:
    // Four by four, in either half.
    static void transpose4(__m256 (&r)[4]) {
        const __m256 a = _mm256_unpacklo_ps(r[0], r[1]), b = _mm256_unpackhi_ps(r[0], r[1]);
        const __m256 c = _mm256_unpacklo_ps(r[2], r[3]), d = _mm256_unpackhi_ps(r[2], r[3]);
        r[0] = _mm256_shuffle_ps(a, c, 0x44);
        r[1] = _mm256_shuffle_ps(a, c, 0xee);
        r[2] = _mm256_shuffle_ps(b, d, 0x44);
        r[3] = _mm256_shuffle_ps(b, d, 0xee);
    }
};
using Avx2Lanes = Twice<Avx2Register>;
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
struct Avx512Register {
    using Number = float;
    static constexpr int kWidth = 16;
    __m512 f;

    // Not every array of lanes begins at a multiple of 64 bytes.
    static Avx512Register load(const float* p) { return {_mm512_loadu_ps(p)}; }
    static Avx512Register all(float x) { return {_mm512_set1_ps(x)}; }
    void store(float* p) const { _mm512_storeu_ps(p, f); }
    friend Avx512Register operator+(Avx512Register a, Avx512Register b) { return {_mm512_add_ps(a.f, b.f)}; }
    friend Avx512Register operator-(Avx512Register a, Avx512Register b) { return {_mm512_sub_ps(a.f, b.f)}; }
    friend Avx512Register operator*(Avx512Register a, Avx512Register b) { return {_mm512_mul_ps(a.f, b.f)}; }
    friend Avx512Register operator/(Avx512Register a, Avx512Register b) { return {_mm512_div_ps(a.f, b.f)}; }
    static Avx512Register max(Avx512Register a, Avx512Register b) { return {_mm512_max_ps(a.f, b.f)}; }
    static Avx512Register sqrt(Avx512Register a) { return {_mm512_sqrt_ps(a.f)}; }
    static Avx512Register if_greater(Avx512Register a, Avx512Register b, Avx512Register yes, Avx512Register no) {
        return {_mm512_mask_blend_ps(_mm512_cmp_ps_mask(a.f, b.f, _CMP_GT_OQ), no.f, yes.f)};
    }
    static unsigned greater(Avx512Register a, Avx512Register b) { return _mm512_cmp_ps_mask(a.f, b.f, _CMP_GT_OQ); }
    static float largest(Avx512Register a) { return _mm512_reduce_max_ps(a.f); }
    template <class... More>
    static bool any(Avx512Register a, More... more) {
        ((a.f = _mm512_or_ps(a.f, more.f)), ...);
        return _mm512_cmp_ps_mask(a.f, _mm512_setzero_ps(), _CMP_NEQ_UQ) != 0;
    }
    // By half rows, four of which fill a register.
    template <int Columns>
    static void transpose(const float* const row[16], Avx512Register (&out)[Columns]) {
#pragma GCC unroll 2
        for (int half = 0; half < Columns / 4; ++half) {
            __m512 r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) {
                __m512 rows = _mm512_castps128_ps512(_mm_load_ps(row[i] + 4 * half));
                rows = _mm512_insertf32x4(rows, _mm_load_ps(row[i + 4] + 4 * half), 1);
                rows = _mm512_insertf32x4(rows, _mm_load_ps(row[i + 8] + 4 * half), 2);
                r[i] = _mm512_insertf32x4(rows, _mm_load_ps(row[i + 12] + 4 * half), 3);
            }
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) out[4 * half + i].f = r[i];
        }
    }
    template <int Columns>
    static void transpose_back(const Avx512Register (&in)[Columns], float* const row[16]) {
#pragma GCC unroll 2
        for (int half = 0; half < Columns / 4; ++half) {
            __m512 r[4];
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) r[i] = in[4 * half + i].f;
            transpose4(r);
#pragma GCC unroll 4
            for (int i = 0; i < 4; ++i) {
                _mm_store_ps(row[i] + 4 * half, _mm512_castps512_ps128(r[i]));
                _mm_store_ps(row[i + 4] + 4 * half, _mm512_extractf32x4_ps(r[i], 1));
                _mm_store_ps(row[i + 8] + 4 * half, _mm512_extractf32x4_ps(r[i], 2));
                _mm_store_ps(row[i + 12] + 4 * half, _mm512_extractf32x4_ps(r[i], 3));
            }
        }
    }

private:
    // Four by four, in each quarter.
    static void transpose4(__m512 (&r)[4]) {
        const __m512 a = _mm512_unpacklo_ps(r[0], r[1]), b = _mm512_unpackhi_ps(r[0], r[1]);
        const __m512 c = _mm512_unpacklo_ps(r[2], r[3]), d = _mm512_unpackhi_ps(r[2], r[3]);
        r[0] = _mm512_shuffle_ps(a, c, 0x44);
        r[1] = _mm512_shuffle_ps(a, c, 0xee);
        r[2] = _mm512_shuffle_ps(b, d, 0x44);
        r[3] = _mm512_shuffle_ps(b, d, 0xee);
    }
};
using Avx512Lanes = Avx512Register;
#endif

}  // namespace taut
