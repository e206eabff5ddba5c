// Eight floats side by side, in three builds with the same bits: scalar, SSE2 and AVX2. Only IEEE operations
// (add, sub, mul, div, sqrt, compare), no fused multiply-add, so each lane computes what the scalar does.
// Used by kernels that are templates over the type: no function here is shared between builds.
#pragma once

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace taut {

struct ScalarLanes {
    float f[8];

    static ScalarLanes load(const float* p) {
        ScalarLanes r;
        for (int i = 0; i < 8; ++i) r.f[i] = p[i];
        return r;
    }
    static ScalarLanes all(float x) {
        ScalarLanes r;
        for (float& e : r.f) e = x;
        return r;
    }
    void store(float* p) const {
        for (int i = 0; i < 8; ++i) p[i] = f[i];
    }
    template <class Op>
    static ScalarLanes zip(const ScalarLanes& a, const ScalarLanes& b, Op op) {
        ScalarLanes r;
        for (int i = 0; i < 8; ++i) r.f[i] = op(a.f[i], b.f[i]);
        return r;
    }
    friend ScalarLanes operator+(const ScalarLanes& a, const ScalarLanes& b) {
        return zip(a, b, [](float x, float y) { return x + y; });
    }
    friend ScalarLanes operator-(const ScalarLanes& a, const ScalarLanes& b) {
        return zip(a, b, [](float x, float y) { return x - y; });
    }
    friend ScalarLanes operator*(const ScalarLanes& a, const ScalarLanes& b) {
        return zip(a, b, [](float x, float y) { return x * y; });
    }
    friend ScalarLanes operator/(const ScalarLanes& a, const ScalarLanes& b) {
        return zip(a, b, [](float x, float y) { return x / y; });
    }
    static ScalarLanes max(const ScalarLanes& a, const ScalarLanes& b) {
        return zip(a, b, [](float x, float y) { return x > y ? x : y; });
    }
    static ScalarLanes sqrt(const ScalarLanes& a) {
        return zip(a, a, [](float x, float) { return __builtin_sqrtf(x); });
    }
    // a > b ? yes : no
    static ScalarLanes if_greater(const ScalarLanes& a, const ScalarLanes& b, const ScalarLanes& yes,
                                  const ScalarLanes& no) {
        ScalarLanes r;
        for (int i = 0; i < 8; ++i) r.f[i] = a.f[i] > b.f[i] ? yes.f[i] : no.f[i];
        return r;
    }
    // row[k] of eight rows of eight floats become column k: out[c] holds component c of all lanes.
    static void transpose(const float* const row[8], ScalarLanes out[8]) {
        for (int c = 0; c < 8; ++c)
            for (int lane = 0; lane < 8; ++lane) out[c].f[lane] = row[lane][c];
    }
    static void transpose_back(const ScalarLanes in[8], float* const row[8]) {
        for (int c = 0; c < 8; ++c)
            for (int lane = 0; lane < 8; ++lane) row[lane][c] = in[c].f[lane];
    }
};

#if defined(__SSE2__)
struct Sse2Lanes {
    __m128 lo, hi;

    static Sse2Lanes load(const float* p) { return {_mm_load_ps(p), _mm_load_ps(p + 4)}; }
    static Sse2Lanes all(float x) { return {_mm_set1_ps(x), _mm_set1_ps(x)}; }
    void store(float* p) const {
        _mm_store_ps(p, lo);
        _mm_store_ps(p + 4, hi);
    }
    friend Sse2Lanes operator+(Sse2Lanes a, Sse2Lanes b) { return {_mm_add_ps(a.lo, b.lo), _mm_add_ps(a.hi, b.hi)}; }
    friend Sse2Lanes operator-(Sse2Lanes a, Sse2Lanes b) { return {_mm_sub_ps(a.lo, b.lo), _mm_sub_ps(a.hi, b.hi)}; }
    friend Sse2Lanes operator*(Sse2Lanes a, Sse2Lanes b) { return {_mm_mul_ps(a.lo, b.lo), _mm_mul_ps(a.hi, b.hi)}; }
    friend Sse2Lanes operator/(Sse2Lanes a, Sse2Lanes b) { return {_mm_div_ps(a.lo, b.lo), _mm_div_ps(a.hi, b.hi)}; }
    static Sse2Lanes max(Sse2Lanes a, Sse2Lanes b) { return {_mm_max_ps(a.lo, b.lo), _mm_max_ps(a.hi, b.hi)}; }
    static Sse2Lanes sqrt(Sse2Lanes a) { return {_mm_sqrt_ps(a.lo), _mm_sqrt_ps(a.hi)}; }
    static Sse2Lanes if_greater(Sse2Lanes a, Sse2Lanes b, Sse2Lanes yes, Sse2Lanes no) {
        return {choose(_mm_cmpgt_ps(a.lo, b.lo), yes.lo, no.lo), choose(_mm_cmpgt_ps(a.hi, b.hi), yes.hi, no.hi)};
    }
    static void transpose(const float* const row[8], Sse2Lanes out[8]) {
        for (int half = 0; half < 2; ++half) {
            for (int side = 0; side < 2; ++side) {
                __m128 r[4];
                for (int i = 0; i < 4; ++i) r[i] = _mm_load_ps(row[4 * side + i] + 4 * half);
                _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
                for (int i = 0; i < 4; ++i) (side ? out[4 * half + i].hi : out[4 * half + i].lo) = r[i];
            }
        }
    }
    static void transpose_back(const Sse2Lanes in[8], float* const row[8]) {
        for (int half = 0; half < 2; ++half) {
            for (int side = 0; side < 2; ++side) {
                __m128 r[4];
                for (int i = 0; i < 4; ++i) r[i] = side ? in[4 * half + i].hi : in[4 * half + i].lo;
                _MM_TRANSPOSE4_PS(r[0], r[1], r[2], r[3]);
                for (int i = 0; i < 4; ++i) _mm_store_ps(row[4 * side + i] + 4 * half, r[i]);
            }
        }
    }

private:
    static __m128 choose(__m128 mask, __m128 yes, __m128 no) {
        return _mm_or_ps(_mm_and_ps(mask, yes), _mm_andnot_ps(mask, no));
    }
};
#endif

// What every machine of this kind has, for code that comes in one build.
#if defined(__SSE2__)
using BaseLanes = Sse2Lanes;
#else
using BaseLanes = ScalarLanes;
#endif

#if defined(__AVX2__)
struct Avx2Lanes {
    __m256 f;

    static Avx2Lanes load(const float* p) { return {_mm256_load_ps(p)}; }
    static Avx2Lanes all(float x) { return {_mm256_set1_ps(x)}; }
    void store(float* p) const { _mm256_store_ps(p, f); }
    friend Avx2Lanes operator+(Avx2Lanes a, Avx2Lanes b) { return {_mm256_add_ps(a.f, b.f)}; }
    friend Avx2Lanes operator-(Avx2Lanes a, Avx2Lanes b) { return {_mm256_sub_ps(a.f, b.f)}; }
    friend Avx2Lanes operator*(Avx2Lanes a, Avx2Lanes b) { return {_mm256_mul_ps(a.f, b.f)}; }
    friend Avx2Lanes operator/(Avx2Lanes a, Avx2Lanes b) { return {_mm256_div_ps(a.f, b.f)}; }
    static Avx2Lanes max(Avx2Lanes a, Avx2Lanes b) { return {_mm256_max_ps(a.f, b.f)}; }
    static Avx2Lanes sqrt(Avx2Lanes a) { return {_mm256_sqrt_ps(a.f)}; }
    static Avx2Lanes if_greater(Avx2Lanes a, Avx2Lanes b, Avx2Lanes yes, Avx2Lanes no) {
        return {_mm256_blendv_ps(no.f, yes.f, _mm256_cmp_ps(a.f, b.f, _CMP_GT_OQ))};
    }
    static void transpose(const float* const row[8], Avx2Lanes out[8]) {
        __m256 r[8];
        for (int i = 0; i < 8; ++i) r[i] = _mm256_load_ps(row[i]);
        transpose8(r);
        for (int i = 0; i < 8; ++i) out[i].f = r[i];
    }
    static void transpose_back(const Avx2Lanes in[8], float* const row[8]) {
        __m256 r[8];
        for (int i = 0; i < 8; ++i) r[i] = in[i].f;
        transpose8(r);
        for (int i = 0; i < 8; ++i) _mm256_store_ps(row[i], r[i]);
    }

private:
    static void transpose8(__m256 r[8]) {
        __m256 s[8], t[8];
        for (int i = 0; i < 8; i += 2) {
            s[i] = _mm256_unpacklo_ps(r[i], r[i + 1]);
            s[i + 1] = _mm256_unpackhi_ps(r[i], r[i + 1]);
        }
        for (int i = 0; i < 8; i += 4) {
            t[i] = _mm256_shuffle_ps(s[i], s[i + 2], 0x44);
            t[i + 1] = _mm256_shuffle_ps(s[i], s[i + 2], 0xee);
            t[i + 2] = _mm256_shuffle_ps(s[i + 1], s[i + 3], 0x44);
            t[i + 3] = _mm256_shuffle_ps(s[i + 1], s[i + 3], 0xee);
        }
        for (int i = 0; i < 4; ++i) {
            r[i] = _mm256_permute2f128_ps(t[i], t[i + 4], 0x20);
            r[i + 4] = _mm256_permute2f128_ps(t[i], t[i + 4], 0x31);
        }
    }
};
#endif

}  // namespace taut
