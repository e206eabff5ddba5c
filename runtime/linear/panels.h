// The numbers of a sparse L D L^T, in panels: runs of pivots that share the rows below them. All is counted in triples,
// blocks of 3 rows or 3 columns; an unknown of six is two pivots. Built twice, with the same bits: for any processor
// and for AVX2.
#pragma once

#include <cstddef>
#include <cstdint>

namespace taut {

// Column-major: a column holds its own pivots' rows, then those below.
struct Panel {
    uint32_t first, pivots;    // numbers of its pivots
    uint32_t row_begin, rows;  // in PanelMatrix::row: pivots included
    uint32_t update_begin, update_end;
    size_t value;  // of its first number
    size_t ld() const { return 3 * static_cast<size_t>(rows); }
};

// What a panel's rows [begin, end), pivots of another panel, do to that one.
struct PanelUpdate {
    uint32_t panel, begin, end, run_begin, run_end;
};

// Rows [from, end) of a panel are rows to, to + 1 ... of the other.
struct PanelRun {
    uint32_t from, end, to;
};

struct PanelMatrix {
    const Panel* panel;
    const Panel* panel_end;
    const PanelUpdate* update;
    const PanelRun* run;
    const uint32_t* row;  // numbers of pivots, ascending in each panel
    const double* sign;   // of each pivot
    double* value;        // A, eliminated in place: L = A / D; kPanelPadding numbers more than there are
    double* inverse;      // of D, 9 numbers a pivot
    double* scratch;      // as large as the largest panel, padded
};

constexpr size_t kPanelPadding = 3;  // whole vectors are read and written past the end of a column

struct PanelKernels {
    const char* name;
    bool (*factor)(const PanelMatrix& m);            // false: a pivot is not of its sign, or not finite
    void (*solve)(const PanelMatrix& m, double* x);  // x: four numbers a pivot, the last without meaning
};

extern const PanelKernels kPanelKernelsBase, kPanelKernelsAvx2;

const PanelKernels& panel_kernels();  // the fastest that the processor can run

}  // namespace taut
