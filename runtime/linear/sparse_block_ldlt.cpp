#include "linear/sparse_block_ldlt.h"

#include <algorithm>
#include <cmath>

namespace taut {
namespace {

constexpr int kLd = 6;

// inverse of the symmetric positive definite N x N matrix m, by Cholesky; false if a pivot is not positive.
template <int N>
bool invert_positive(const double* m, double sign, double* inverse) {
    double l[N][N], recip[N];
    for (int j = 0; j < N; ++j) {
        double d = sign * m[j * kLd + j];
        for (int k = 0; k < j; ++k) d -= l[j][k] * l[j][k];
        if (!(d > 0 && std::isfinite(d))) return false;
        const double root = std::sqrt(d);
        recip[j] = 1 / root;
        for (int i = j + 1; i < N; ++i) {
            double s = sign * m[i * kLd + j];
            for (int k = 0; k < j; ++k) s -= l[i][k] * l[j][k];
            l[i][j] = s * recip[j];
        }
    }
    double w[N][N];  // inverse of l, lower
    for (int j = 0; j < N; ++j) {
        w[j][j] = recip[j];
        for (int i = j + 1; i < N; ++i) {
            double s = 0;
            for (int k = j; k < i; ++k) s += l[i][k] * w[k][j];
            w[i][j] = -s * recip[i];
        }
    }
    for (int i = 0; i < N; ++i)
        for (int j = 0; j <= i; ++j) {
            double s = 0;
            for (int k = i; k < N; ++k) s += w[k][i] * w[k][j];
            inverse[i * kLd + j] = inverse[j * kLd + i] = sign * s;
        }
    return std::isfinite(recip[N - 1]);
}

// out[R][N] = a[R][N] d[N][N]
template <int R, int N>
void multiply(const double* a, const double* d, double* out) {
    for (int r = 0; r < R; ++r) {
        double row[N] = {};
        for (int n = 0; n < N; ++n)
            for (int c = 0; c < N; ++c) row[c] += a[r * kLd + n] * d[n * kLd + c];
        for (int c = 0; c < N; ++c) out[r * kLd + c] = row[c];
    }
}

// x[R][C] -= l[R][N] t[N][C]
template <int R, int N, int C>
void multiply_subtract(double* x, const double* l, const double* t) {
    for (int r = 0; r < R; ++r) {
        double row[C];
        for (int c = 0; c < C; ++c) row[c] = x[r * kLd + c];
        for (int n = 0; n < N; ++n)
            for (int c = 0; c < C; ++c) row[c] -= l[r * kLd + n] * t[n * kLd + c];
        for (int c = 0; c < C; ++c) x[r * kLd + c] = row[c];
    }
}

template <int N>
using UpdateTable = void (*[2][2])(double*, const double*, const double*);

}  // namespace

SparseBlockLdlt::SparseBlockLdlt(Memory& memory)
    : unknown_(memory),
      position_(memory),
      unknown_at_(memory),
      size_at_(memory),
      links_(memory),
      column_begin_(memory),
      row_of_(memory),
      target_begin_(memory),
      target_(memory),
      diagonal_(memory),
      inverse_(memory),
      below_(memory),
      scaled_(memory),
      work_(memory) {}

void SparseBlockLdlt::begin(uint32_t unknowns) {
    analysed_ = false;
    unknown_.assign(unknowns, Unknown{});
    links_.clear();
}

void SparseBlockLdlt::set_unknown(uint32_t i, int size, bool multiplier, int rows) {
    unknown_[i] = {static_cast<uint8_t>(size), multiplier, static_cast<uint8_t>(std::min(rows, size))};
}

void SparseBlockLdlt::link(uint32_t i, uint32_t j) {
    if (i != j) links_.push_back(static_cast<uint64_t>(std::min(i, j)) << 32 | std::max(i, j));
}

void SparseBlockLdlt::analyse() {
    const uint32_t n = unknowns();
    const EliminationOrder elimination(*unknown_.get_allocator().memory, unknown_, links_);
    unknown_at_.assign(elimination.order.begin(), elimination.order.end());
    position_.resize(n);
    size_at_.resize(n);
    for (uint32_t k = 0; k < n; ++k) {
        position_[unknown_at_[k]] = k;
        size_at_[k] = unknown_[unknown_at_[k]].size;
    }
    column_begin_.assign(1, 0);
    row_of_.clear();
    for (uint32_t k = 0; k < n; ++k) {
        const auto first = static_cast<std::ptrdiff_t>(row_of_.size());
        for (uint32_t j : elimination.neighbours[unknown_at_[k]]) row_of_.push_back(position_[j]);
        std::sort(row_of_.begin() + first, row_of_.end());
        column_begin_.push_back(static_cast<uint32_t>(row_of_.size()));
    }
    target_begin_.assign(1, 0);
    target_.clear();
    for (uint32_t k = 0; k < n; ++k) {
        for (uint32_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p)
            for (uint32_t q = column_begin_[k]; q < p; ++q) target_.push_back(find(row_of_[p], row_of_[q]));
        target_begin_.push_back(static_cast<uint32_t>(target_.size()));
    }
    diagonal_.resize(n * kStride);
    inverse_.resize(n * kStride);
    below_.resize(row_of_.size() * kStride);
    scaled_.resize(row_of_.size() * kStride);
    work_.resize(n * kLd);
    analysed_ = true;
}

uint32_t SparseBlockLdlt::find(uint32_t row, uint32_t column) const {
    const auto begin = row_of_.begin() + column_begin_[column], end = row_of_.begin() + column_begin_[column + 1];
    return static_cast<uint32_t>(std::lower_bound(begin, end, row) - row_of_.begin());
}

void SparseBlockLdlt::clear() {
    std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
    std::fill(below_.begin(), below_.end(), 0.0);
}

void SparseBlockLdlt::add(uint32_t i, uint32_t j, const double* m, int rows, int columns, int ld, int row, int column) {
    const uint32_t pi = position_[i], pj = position_[j];
    if (pi >= pj) {
        double* block = (pi == pj ? &diagonal_[pi * kStride] : below(find(pi, pj))) + row * kLd + column;
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) block[r * kLd + c] += m[r * ld + c];
    } else {
        double* block = below(find(pj, pi)) + column * kLd + row;
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns; ++c) block[c * kLd + r] += m[r * ld + c];
    }
}

template <int N>
bool SparseBlockLdlt::eliminate(uint32_t k) {
    // The scaled column L = A D^-1 replaces nothing: the updates below need A as well.
    constexpr UpdateTable<N> update = {{multiply_subtract<3, N, 3>, multiply_subtract<3, N, 6>},
                                       {multiply_subtract<6, N, 3>, multiply_subtract<6, N, 6>}};
    double* inverse = &inverse_[k * kStride];
    const double sign = unknown_[unknown_at_[k]].multiplier ? -1.0 : 1.0;
    if (!invert_positive<N>(&diagonal_[k * kStride], sign, inverse)) return false;

    const uint32_t first = column_begin_[k], last = column_begin_[k + 1];
    for (uint32_t p = first; p < last; ++p) {
        if (size_at_[row_of_[p]] == 3)
            multiply<3, N>(below(p), inverse, &scaled_[p * kStride]);
        else
            multiply<6, N>(below(p), inverse, &scaled_[p * kStride]);
    }
    for (uint32_t q = first; q < last; ++q) {  // A_j^T of the block in row j, then every block (i, j), i >= j
        const bool wide_q = size_at_[row_of_[q]] == 6;
        double transposed[N * kLd];
        const double* a = below(q);
        for (int c = 0; c < (wide_q ? 6 : 3); ++c)
            for (int n = 0; n < N; ++n) transposed[n * kLd + c] = a[c * kLd + n];
        update[wide_q][wide_q](&diagonal_[row_of_[q] * kStride], &scaled_[q * kStride], transposed);
        for (uint32_t p = q + 1; p < last; ++p) {
            const uint32_t i = p - first, pair = i * (i - 1) / 2 + (q - first);
            update[size_at_[row_of_[p]] == 6][wide_q](below(target_[target_begin_[k] + pair]), &scaled_[p * kStride],
                                                      transposed);
        }
    }
    return true;
}

bool SparseBlockLdlt::factor() {
    const uint32_t n = unknowns();
    for (uint32_t k = 0; k < n; ++k)
        if (!(size_at_[k] == 3 ? eliminate<3>(k) : eliminate<6>(k))) return false;
    return true;
}

void SparseBlockLdlt::solve(double* x) const {
    const uint32_t n = unknowns();
    double* y = work_.data();
    for (uint32_t k = 0; k < n; ++k)
        for (int c = 0; c < kLd; ++c) y[k * kLd + c] = c < size_at_[k] ? x[unknown_at_[k] * kLd + c] : 0.0;
    for (uint32_t k = 0; k < n; ++k) {
        const int columns = size_at_[k];
        for (uint32_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
            const double* l = &scaled_[p * kStride];
            double* to = y + row_of_[p] * kLd;
            for (int r = 0; r < size_at_[row_of_[p]]; ++r) {
                double s = 0;
                for (int c = 0; c < columns; ++c) s += l[r * kLd + c] * y[k * kLd + c];
                to[r] -= s;
            }
        }
    }
    for (uint32_t k = n; k-- > 0;) {
        const int columns = size_at_[k];
        const double* inverse = &inverse_[k * kStride];
        double z[kLd] = {};
        for (int r = 0; r < columns; ++r)
            for (int c = 0; c < columns; ++c) z[r] += inverse[r * kLd + c] * y[k * kLd + c];
        for (uint32_t p = column_begin_[k]; p < column_begin_[k + 1]; ++p) {
            const double* l = &scaled_[p * kStride];
            const double* from = y + row_of_[p] * kLd;
            for (int r = 0; r < size_at_[row_of_[p]]; ++r)
                for (int c = 0; c < columns; ++c) z[c] -= l[r * kLd + c] * from[r];
        }
        for (int c = 0; c < kLd; ++c) x[unknown_at_[k] * kLd + c] = y[k * kLd + c] = c < columns ? z[c] : 0.0;
    }
}

}  // namespace taut
