// Entries of the inverse by panels: with Y = L^-1 S of chosen columns S, S^T A^-1 S = Y^T D^-1 Y. A column is zero but
// on the way from its pivot to the root.
#pragma once

#include "linear/panels.inl"

namespace taut {
namespace {

// x (3 rows) -= l u, l: 3 rows at each of k columns `ld` apart, u: k rows; all rows are of whole fours.
inline void subtract_rows(double* x, size_t ldx, const double* l, size_t ld, const double* u, size_t k, size_t width) {
    constexpr size_t kStrip = 4 / kWidth;  // vectors taken together
    for (size_t at = 0; at < width; at += 4) {
        Vector sum[3][kStrip];
        for (size_t r = 0; r < 3; ++r)
            for (size_t v = 0; v < kStrip; ++v) sum[r][v] = load(x + r * ldx + at + kWidth * v);
        for (size_t c = 0; c < k; ++c)
            for (size_t v = 0; v < kStrip; ++v) {
                const Vector e = load(u + c * width + at + kWidth * v);
                for (size_t r = 0; r < 3; ++r) sum[r][v] -= e * l[c * ld + r];
            }
        for (size_t r = 0; r < 3; ++r)
            for (size_t v = 0; v < kStrip; ++v) store(x + r * ldx + at + kWidth * v, sum[r][v]);
    }
}

// Four rows of out += x^T u over k rows of x and u, from column `from` on.
inline void add_products(double* out, size_t ld, const double* x, const double* u, size_t k, size_t width, size_t row,
                         size_t from) {
    constexpr size_t kStrip = 4 / kWidth;
    for (size_t at = from; at < width; at += 4) {
        Vector sum[4][kStrip];
        for (size_t r = 0; r < 4; ++r)
            for (size_t v = 0; v < kStrip; ++v) sum[r][v] = load(out + (row + r) * ld + at + kWidth * v);
        for (size_t c = 0; c < k; ++c)
            for (size_t v = 0; v < kStrip; ++v) {
                const Vector e = load(u + c * width + at + kWidth * v);
                for (size_t r = 0; r < 4; ++r) sum[r][v] += e * x[c * width + row + r];
            }
        for (size_t r = 0; r < 4; ++r)
            for (size_t v = 0; v < kStrip; ++v) store(out + (row + r) * ld + at + kWidth * v, sum[r][v]);
    }
}

// u = D^-1 x of three rows.
inline void scale_rows(double* u, const double* x, const double* inverse, size_t width) {
    for (size_t at = 0; at < width; at += kWidth) {
        const Vector x0 = load(x + at), x1 = load(x + width + at), x2 = load(x + 2 * width + at);
        for (size_t r = 0; r < 3; ++r)
            store(u + r * width + at, x0 * inverse[r] + x1 * inverse[3 + r] + x2 * inverse[6 + r]);
    }
}

void inverse(const PanelMatrix& m, const PanelStrips& strips, double* out, size_t ld) {
    double* u = strips.scratch;
    for (const Panel* p = m.panel; p != m.panel_end; ++p) {
        const PanelStrip& strip = strips.strip[p - m.panel];
        if (strip.begin == strip.end) continue;
        const size_t width = strip.width();
        double* x = strips.value + strip.value;
        const double* a = m.value + p->value;
        for (size_t k = 0; k < p->pivots; ++k) {
            double* own = x + 3 * k * width;
            if (k > 0) subtract_rows(own, width, a + 3 * k, p->ld(), u, 3 * k, width);
            scale_rows(u + 3 * k * width, own, m.inverse + 9 * (p->first + k), width);
        }
        for (size_t i = p->pivots; i < p->rows; ++i) {
            const uint32_t pivot = m.row[p->row_begin + i], at = strips.panel_of[pivot];
            const PanelStrip& above = strips.strip[at];
            double* to = strips.value + above.value + 3 * (pivot - m.panel[at].first) * above.width() +
                         3 * static_cast<size_t>(strip.begin - above.begin);
            subtract_rows(to, above.width(), a + 3 * i, p->ld(), u, 3 * p->pivots, width);
        }
        double* corner = out + 3 * static_cast<size_t>(strip.begin) * (ld + 1);
        for (size_t row = 0; row < width; row += 4) add_products(corner, ld, x, u, 3 * p->pivots, width, row, row);
    }
}

void add_rows(double* x, size_t size, const double* const* row, const double* a, size_t rows) {
    for (size_t at = 0; at < size; at += kWidth) {
        Vector sum = load(x + at);
        for (size_t i = 0; i < rows; ++i) sum += load(row[i] + at) * a[i];
        store(x + at, sum);
    }
}

}  // namespace
}  // namespace taut
