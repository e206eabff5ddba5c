// Sparse L D L^T of a symmetric quasi-definite matrix in blocks of 3 and 6 rows.
//
// Unknowns come in two kinds: nodes, whose diagonal block is positive definite, and multipliers, whose
// diagonal block becomes negative definite once freedoms for its rows are eliminated. The elimination order sees to
// that (Tournier et al. 2015, eq. 21, is such a matrix), so no other pivoting is needed.
#pragma once

#include <span>

#include "base/math.h"
#include "base/memory.h"
#include "linear/elimination_order.h"

namespace taut {

class SparseBlockLdlt {
public:
    explicit SparseBlockLdlt(Memory& memory);

    // --- symbolic, when the graph changes
    void begin(uint32_t unknowns);
    // size 3 or 6; rows of a multiplier that are not padding.
    void set_unknown(uint32_t i, int size, bool multiplier, int rows = 6);
    void link(uint32_t i, uint32_t j);
    void analyse();
    bool analysed() const { return analysed_; }
    void forget() { analysed_ = false; }

    // --- numeric
    void clear();
    // Adds rows x columns of m (row-major, leading dimension ld) into block (i, j) at (row, column); for i != j the
    // mirrored block follows by symmetry, so give each pair once.
    void add(uint32_t i, uint32_t j, const double* m, int rows, int columns, int ld, int row = 0, int column = 0);
    // False if a pivot is not of the sign that its kind demands or not finite.
    bool factor();
    // x: 6 doubles an unknown (a block of 3 uses the first three), right-hand side in, solution out.
    void solve(double* x) const;

    uint32_t unknowns() const { return static_cast<uint32_t>(unknown_.size()); }
    uint32_t blocks() const { return static_cast<uint32_t>(row_of_.size()); }  // below the diagonal, fill included

private:
    static constexpr int kStride = 36;  // doubles a block, row-major with leading dimension 6

    double* below(uint32_t slot) { return &below_[slot * kStride]; }
    uint32_t find(uint32_t row, uint32_t column) const;
    template <int N>
    bool eliminate(uint32_t k);

    bool analysed_ = false;
    Array<Unknown> unknown_;
    Array<uint32_t> position_, unknown_at_;  // order and its inverse
    Array<uint8_t> size_at_;                 // by position
    Array<uint64_t> links_;
    Array<uint32_t> column_begin_, row_of_;  // structure of L, by position
    Array<uint32_t> target_begin_, target_;  // replayed slots of the updates of each column
    Array<double> diagonal_, inverse_, below_, scaled_;
    mutable Array<double> work_;
};

}  // namespace taut
