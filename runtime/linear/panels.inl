// Factorisation and solution by panels. Every place of a vector has a sum of its own, and nothing is fused: the width
// of vectors makes no difference to any bit.
#pragma once

#include "linear/panels.h"

namespace taut {
namespace {

#if defined(__AVX2__)
constexpr size_t kWidth = 4;
#else
constexpr size_t kWidth = 2;
#endif

typedef double Vector __attribute__((vector_size(8 * kWidth)));
// From and to any address of a double.
inline Vector load(const double* p) {
    Vector v;
    __builtin_memcpy(&v, p, sizeof v);
    return v;
}
inline void store(double* p, const Vector& v) { __builtin_memcpy(p, &v, sizeof v); }

// Inverse of the symmetric 3 x 3 matrix in the lower triangle of a, definite of the given sign.
inline bool invert(const double* a, size_t ld, double sign, double* inverse) {
    auto good = [&](double reciprocal) { return sign * reciprocal > 0 && __builtin_isfinite(reciprocal); };
    const double r0 = 1 / a[0], l10 = a[1] * r0, l20 = a[2] * r0;
    const double r1 = 1 / (a[ld + 1] - l10 * a[1]), e21 = a[ld + 2] - l20 * a[1], l21 = e21 * r1;
    const double r2 = 1 / (a[2 * ld + 2] - l20 * a[2] - l21 * e21);
    const double w20 = l10 * l21 - l20, i20 = w20 * r2, i21 = -l21 * r2, i10 = w20 * i21 - l10 * r1;
    inverse[0] = r0 + l10 * l10 * r1 + w20 * i20;
    inverse[1] = inverse[3] = i10;
    inverse[2] = inverse[6] = i20;
    inverse[4] = r1 - l21 * i21;
    inverse[5] = inverse[7] = i21;
    inverse[8] = r2;
    return good(r0) && good(r1) && good(r2);
}

// out = a d, d 3 x 3; writes whole vectors.
inline void scale(double* out, const double* a, size_t ld, const double* d, size_t rows) {
    for (size_t i = 0; i < rows; i += kWidth) {
        const Vector a0 = load(a + i), a1 = load(a + ld + i), a2 = load(a + 2 * ld + i);
        for (size_t c = 0; c < 3; ++c) store(out + c * ld + i, a0 * d[c] + a1 * d[3 + c] + a2 * d[6 + c]);
    }
}

// Three columns of x -= l a^T, l with k columns; a: three rows.
template <size_t Triples>
inline void subtract(double* x, size_t ldx, const double* l, const double* a, size_t ld, size_t k) {
    constexpr size_t kVectors = (3 * Triples + kWidth - 1) / kWidth, kLast = kVectors - 1;
    Vector sum[3][kVectors];
    for (size_t c = 0; c < 3; ++c)
        for (size_t v = 0; v < kVectors; ++v) sum[c][v] = load(x + c * ldx + kWidth * v);
    for (; k > 0; --k, l += ld, a += ld)
        for (size_t v = 0; v < kVectors; ++v) {
            const Vector e = load(l + kWidth * v);
            for (size_t c = 0; c < 3; ++c) sum[c][v] -= e * a[c];
        }
    for (size_t c = 0; c < 3; ++c) {
        for (size_t v = 0; v < kLast; ++v) store(x + c * ldx + kWidth * v, sum[c][v]);
        __builtin_memcpy(x + c * ldx + kWidth * kLast, &sum[c][kLast], (3 * Triples - kWidth * kLast) * sizeof(double));
    }
}

inline void subtract(double* x, size_t ldx, const double* l, const double* a, size_t ld, size_t k, size_t triples) {
    for (; triples >= kWidth; triples -= kWidth, x += 3 * kWidth, l += 3 * kWidth)
        subtract<kWidth>(x, ldx, l, a, ld, k);
    if (triples == 3) subtract<3>(x, ldx, l, a, ld, k);
    if (triples == 2) subtract<2>(x, ldx, l, a, ld, k);
    if (triples == 1) subtract<1>(x, ldx, l, a, ld, k);
}

// Eliminates the panel's pivots one after another; l becomes its columns of L.
inline bool eliminate(const PanelMatrix& m, const Panel& p, double* l) {
    const size_t ld = p.ld();
    double* a = m.value + p.value;
    for (size_t k = 0; k < p.pivots; ++k) {
        double* diagonal = a + 3 * k * (ld + 1);
        double* inverse = m.inverse + 9 * (p.first + k);
        if (k > 0) subtract(diagonal, ld, l + 3 * k, a + 3 * k, ld, 3 * k, p.rows - k);
        if (!invert(diagonal, ld, m.sign[p.first + k], inverse)) return false;
        scale(l + 3 * k * (ld + 1) + 3, diagonal + 3, ld, inverse, ld - 3 * (k + 1));
    }
    return true;
}

bool factor(const PanelMatrix& m) {
    double* l = m.scratch;
    for (const Panel* p = m.panel; p != m.panel_end; ++p) {
        if (!eliminate(m, *p, l)) return false;
        const double* a = m.value + p->value;
        for (const PanelUpdate* u = m.update + p->update_begin; u != m.update + p->update_end; ++u) {
            const Panel& to = m.panel[u->panel];
            for (size_t q = u->begin; q < u->end; ++q) {  // a pivot of that panel
                double* column = m.value + to.value + 3 * to.ld() * (m.row[p->row_begin + q] - to.first);
                for (const PanelRun* run = m.run + u->run_begin; run != m.run + u->run_end; ++run) {
                    if (run->end <= q) continue;
                    const size_t from = run->from < q ? q : run->from;
                    subtract(column + 3 * (run->to + from - run->from), to.ld(), l + 3 * from, a + 3 * q, p->ld(),
                             3 * p->pivots, run->end - from);
                }
            }
        }
    }
    return true;
}

inline void times(const double* d, const double* x, double* out) {
    for (size_t r = 0; r < 3; ++r) out[r] = d[r] * x[0] + d[3 + r] * x[1] + d[6 + r] * x[2];
}

void solve(const PanelMatrix& m, double* x) {
    for (const Panel* p = m.panel; p != m.panel_end; ++p) {
        const size_t ld = p->ld();
        const uint32_t* row = m.row + p->row_begin;
        for (size_t k = 0; k < p->pivots; ++k) {
            const double* a = m.value + p->value + 3 * k * ld;
            double u[3];
            times(m.inverse + 9 * (p->first + k), x + 4 * row[k], u);
            for (size_t c = 0; c < 3; ++c) x[4 * row[k] + c] = u[c];
            for (size_t i = k + 1; i < p->rows; ++i)
                for (size_t w = 0; w < 4; w += kWidth) {
                    const double* below = a + 3 * i + w;
                    double* to = x + 4 * row[i] + w;
                    store(to, load(to) - (load(below) * u[0] + load(below + ld) * u[1] + load(below + 2 * ld) * u[2]));
                }
        }
    }
    for (const Panel* p = m.panel_end; p-- != m.panel;) {
        const size_t ld = p->ld();
        const uint32_t* row = m.row + p->row_begin;
        for (size_t k = p->pivots; k-- > 0;) {
            const double* a = m.value + p->value + 3 * k * ld;
            Vector sum[3][4 / kWidth] = {};
            for (size_t i = k + 1; i < p->rows; ++i)
                for (size_t c = 0; c < 3; ++c)
                    for (size_t w = 0; w < 4; w += kWidth)
                        sum[c][w / kWidth] += load(a + c * ld + 3 * i + w) * load(x + 4 * row[i] + w);
            double dot[3], z[3];
            for (size_t c = 0; c < 3; ++c) dot[c] = sum[c][0][0] + sum[c][0][1] + sum[c][2 / kWidth][2 % kWidth];
            times(m.inverse + 9 * (p->first + k), dot, z);
            for (size_t c = 0; c < 3; ++c) x[4 * row[k] + c] -= z[c];
        }
    }
}

}  // namespace
}  // namespace taut
