// Products of a sparse matrix of 3x3 blocks, by rows, with a vector. Built twice, with the same bits: for any processor
// and for AVX2.
#pragma once

#include <cstddef>
#include <cstdint>

namespace taut {

struct BlockRows {
    const uint32_t* begin;   // by row, and one past the last
    const uint32_t* column;  // by block
    const double* block;     // nine each, by columns; kBlockPadding numbers more than there are
};

constexpr size_t kBlockPadding = 3;  // whole vectors are read past the end of a column

// out = A x of rows [first, end), with x and out from that of `origin` on.
using MultiplyRows = void (*)(const BlockRows& a, uint32_t first, uint32_t end, uint32_t origin, const double* x,
                              double* out);

extern const MultiplyRows kMultiplyRowsBase, kMultiplyRowsAvx2;

MultiplyRows multiply_rows();  // the fastest that the processor can run

}  // namespace taut
