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

// Columns of L^-1 at chosen pivots, those among and under a panel's own: chosen ones follow each other there, as pivots
// are numbered from leaf to root.
struct PanelStrip {
    uint32_t begin, end;  // of the chosen ones
    size_t value;         // of its first row in PanelStrips::value; a row has `width` numbers
    size_t width() const { return (3 * static_cast<size_t>(end - begin) + kPanelPadding) / 4 * 4; }
};

struct PanelStrips {
    const PanelStrip* strip;   // of each panel
    const uint32_t* panel_of;  // of each pivot
    double* value;             // zeros and the identity at the chosen ones
    double* scratch;           // as large as the largest panel's
};

struct PanelKernels {
    const char* name;
    bool (*factor)(const PanelMatrix& m);            // false: a pivot is not of its sign, or not finite
    void (*solve)(const PanelMatrix& m, double* x);  // x: four numbers a pivot, the last without meaning
    // Upper triangle of A^-1 between the chosen ones onto out, row-major; rows and ld are of whole fours.
    void (*inverse)(const PanelMatrix& m, const PanelStrips& strips, double* out, size_t ld);
    // x += sum of a[i] times row i of m, of `rows` rows; x and rows are of whole fours.
    void (*add_rows)(double* x, size_t size, const double* const* row, const double* a, size_t rows);
};

extern const PanelKernels kPanelKernelsBase, kPanelKernelsAvx2;

const PanelKernels& panel_kernels();  // the fastest that the processor can run

}  // namespace taut
