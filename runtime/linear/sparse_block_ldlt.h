// Sparse L D L^T of a symmetric quasi-definite matrix in blocks of 3 and 6 rows.
//
// Unknowns come in two kinds: nodes, whose diagonal block is positive definite, and multipliers, whose
// diagonal block becomes negative definite once freedoms for its rows are eliminated. The elimination order sees to
// that (Tournier et al. 2015, eq. 21, is such a matrix), so no other pivoting is needed.
#pragma once

#include <algorithm>
#include <limits>

#include "base/memory.h"
#include "linear/elimination_order.h"
#include "linear/panels.h"

namespace taut {

// Where block (i, j) is among the entries of a matrix; for i != j the mirrored block follows by symmetry.
struct BlockPlace {
    uint32_t begin = 0;     // of its numbers, column by column
    uint8_t height = 0;     // of a column
    bool mirrored = false;  // what is stored is block (j, i)
};

// rows x columns numbers, row-major, for the part of a block that begins at (row, column).
struct BlockPiece {
    const double* m;
    int rows, columns, ld;
    int row = 0, column = 0;
    double weight = 1;
};

class SparseBlockLdlt {
public:
    explicit SparseBlockLdlt(Memory& memory);

    // --- symbolic, when the graph changes
    void begin(uint32_t unknowns);
    // size 3 or 6; rows of a multiplier that are not padding, 0 where its diagonal block is negative definite by
    // itself.
    void set_unknown(uint32_t i, int size, bool multiplier, int rows = 6);
    int size(uint32_t i) const { return unknown_[i].size; }
    void link(uint32_t i, uint32_t j);
    // In this order of elimination, or without one as EliminationOrder finds it.
    void analyse(std::span<const uint32_t> order = {});
    // In place of that: how many multiplications a factor would take; infinite where they are more than so many.
    double cost(double most);
    // As it is eliminated: with it and the same links all comes out the same bit by bit.
    std::span<const uint32_t> order() const { return order_; }
    bool analysed() const { return analysed_; }
    void forget() { analysed_ = false; }

    BlockPlace place(uint32_t i, uint32_t j) const;  // of a block that was linked, or i = j

    // --- numeric: entries stay as they are while the matrix is factored
    void clear() { std::fill(number_.begin(), number_.end(), 0.0); }
    void add(BlockPlace at, const BlockPiece& piece);  // give each pair of unknowns once
    // size x size numbers of an unknown's own block, row-major.
    void read(uint32_t i, double* out) const;
    void keep() { std::copy(number_.begin(), number_.end(), kept_.begin()); }
    void restore() { std::copy(kept_.begin(), kept_.end(), number_.begin()); }  // the entries last kept
    // False if a pivot is not of the sign that its kind demands or not finite.
    bool factor(const PanelKernels& kernels = panel_kernels());
    // x: 6 doubles an unknown (a block of 3 uses the first three), right-hand side in, solution out.
    void solve(double* x, const PanelKernels& kernels = panel_kernels()) const;

    uint32_t unknowns() const { return static_cast<uint32_t>(unknown_.size()); }
    uint32_t blocks() const { return blocks_; }  // below the diagonal, fill included

private:
    struct Entry {     // a block of A
        uint64_t key;  // earlier position << 32 | later one
        size_t value;  // of its first number in the panels
        uint32_t ld, begin;
        uint8_t rows, columns;
    };

    uint32_t triples(uint32_t i) const { return unknown_[i].size / 3u; }
    void find_parents();
    void sort_by_tree();
    void order_by_tree(std::span<const uint32_t> order);
    double find_columns(double most = std::numeric_limits<double>::infinity());
    void find_panels();
    void find_updates();
    void find_entries();
    void load();
    PanelMatrix matrix() const;

    bool analysed_ = false;
    uint32_t blocks_ = 0;
    Array<Unknown> unknown_;
    Array<uint64_t> links_;
    Array<uint32_t> order_, position_;               // and its inverse
    Array<uint32_t> parent_;                         // in the elimination tree, by position
    Array<uint32_t> column_begin_, column_, pivot_;  // blocks of L and first pivot, by position
    Array<uint32_t> panel_of_;                       // of each pivot
    Array<Panel> panel_;
    Array<PanelUpdate> update_;
    Array<PanelRun> run_;
    Array<uint32_t> row_;
    Array<double> sign_;
    Array<Entry> entry_;           // ascending: in the order of the panels
    Array<double> number_, kept_;  // of entries
    mutable Array<double> value_, inverse_, scratch_, work_;
};

}  // namespace taut
