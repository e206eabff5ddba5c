// The bounded rows of a block by their own dense matrix, so that the block's sparse one is factored once whatever comes
// and goes: A never sees a contact. With x_0 the solution without them,
//   x = x_0 + A^-1 J^T mu,   s J x + c mu = goal within the bounds of mu,   D = J A^-1 J^T + c
// is solved by projected Gauss-Seidel on D, one contact after the other: pushes, then the two tangents of its friction
// together, clipped to the disc that the push leaves them; drives and friction of joints within their limits.
//
//   rows     in D are those with an impulse, and those that would close without one. A^-1 between the nodes that these
//            touch comes from columns of L^-1 on their ways to the root. Where x shows others that close too, they
//            come in and D is made anew
//   done     where no row misses its law by more than kMiss
// Rows need no softness of their own here, but for what is meant to be soft.
#pragma once

#include "solvers/active_set.h"

namespace taut {

class ContactSpace {
public:
    ContactSpace(Substep& s, Block& b, ActiveSet& set) : s_(s), sys_(s.system), b_(b), set_(set), of_(b.space) {}

    // Memory for all bounded rows; one block after the other.
    void make_room();
    // The matrix was factored anew.
    void forget() { of_.built = false; }
    // After a solve with the impulses as they are: impulses that obey the laws of the rows, once that is solved again.
    // False if none changed.
    bool improve();
    // Which rows are on, after the last solve.
    void note_state();

private:
    bool takes(const BoundedRow& row) const;
    bool take_in();
    void list_touched();
    void bound_impulses();
    void yield_to_gas(size_t side);
    void build();
    template <class Act>
    void for_entries(const BoundedRow& row, Act&& act) const;
    double sweep();
    void change(uint32_t first, uint32_t count, const double* to);
    double bound_of(const BoundedRow& lead) const;
    size_t ld() const { return (of_.row.size() + 3) / 4 * 4; }
    double diagonal(uint32_t i) const { return of_.matrix[i * (ld() + 1)]; }
    BoundedRow& row(uint32_t i) { return set_.rows()[of_.row[i]]; }

    Substep& s_;
    System& sys_;
    Block& b_;
    ActiveSet& set_;
    ContactSpaceMemory& of_;
};

}  // namespace taut
