// Products by rows of blocks. Every row has a sum of its own for each column of blocks, and nothing is fused: the width
// of vectors makes no difference to any bit.
#pragma once

#include "linear/block_rows.h"

namespace taut {
namespace {

#if defined(__AVX2__)
constexpr size_t kRowWidth = 4;
#else
constexpr size_t kRowWidth = 2;
#endif
constexpr size_t kRowVectors = 4 / kRowWidth;  // of three numbers and one without meaning

typedef double RowVector __attribute__((vector_size(8 * kRowWidth)));

void multiply(const BlockRows& a, uint32_t first, uint32_t end, uint32_t origin, const double* x, double* out) {
    for (uint32_t p = first; p < end; ++p) {
        RowVector sum[3][kRowVectors] = {};
        for (uint32_t b = a.begin[p]; b < a.begin[p + 1]; ++b) {
            const double* const from = x + 3 * size_t{a.column[b] - origin};
            const double* const block = a.block + 9 * size_t{b};
            for (size_t c = 0; c < 3; ++c)
                for (size_t v = 0; v < kRowVectors; ++v) {
                    RowVector column;
                    __builtin_memcpy(&column, block + 3 * c + kRowWidth * v, sizeof column);
                    sum[c][v] += column * from[c];
                }
        }
        double all[4];
        for (size_t v = 0; v < kRowVectors; ++v) {
            const RowVector row = sum[0][v] + sum[1][v] + sum[2][v];
            __builtin_memcpy(all + kRowWidth * v, &row, sizeof row);
        }
        for (size_t r = 0; r < 3; ++r) out[3 * size_t{p - origin} + r] = all[r];
    }
}

}  // namespace
}  // namespace taut
