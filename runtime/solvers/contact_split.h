// The bounded rows of a block by splitting its nodes in two, so that its sparse matrix is factored once and sees no
// contact, however many there are (alternating direction method of multipliers: Gabay and Mercier 1976; Boyd et al.
// 2011, sections 3.1, 3.4). Elements and ties act on the velocities x of the touched nodes, the laws of rows on z, and
//   x-step   (A + R) x = b + J^T mu + R z
//   z-step   least |z - y|_R with the laws of the rows, y = a x + (1 - a) z - R^-1 J^T mu, by sweeps over the rows;
//            the impulses mu that this takes are those of x as well once x = z
//   R        of a node between what A says of it and what it bears: the geometric mean of both. In a direction in
//            which elements have the mass a and contacts the mass g an error falls to (1 - q^2) / 2 of it,
//            q = (1 - s) / (1 + s), s = sqrt(a / g)
// Bodies that nothing but contacts holds are not split: their part of A is a mass, and z has it as it is.
#pragma once

#include "solvers/row_laws.h"

namespace taut {

class ContactSplit {
public:
    ContactSplit(Substep& s, Block& b, ActiveSet& set) : s_(s), sys_(s.system), b_(b), set_(set), of_(b.split) {}

    // Touched nodes and memory for them; one block after the other.
    void make_room();
    // R from what A is without it, into A.
    void add_metric();
    // The matrix was factored anew.
    void forget() { of_.built = false; }
    // R z onto the known side.
    void add_known(double* side) const;
    // After the last solve: what hangs together freely by as much as the impulses R (x - z) that its nodes miss make of
    // it as a whole, and by what contacts answer to that: momentum is kept after any number of steps.
    void move_free_parts();
    // After a solve with z and the impulses as they are: those of the next one. Returns by how much the two halves and
    // the laws are missed [m/s].
    double improve();
    double near() const;  // what may be missed [m/s]
    // From the velocities at the substep's start on, without impulses and without friction.
    void begin_anew();

    // See row_laws.h.
    BoundedRow& row(uint32_t i) { return set_.rows()[of_.row[i]]; }
    double miss(uint32_t i) const { return miss_of(of_.row[i]); }
    double stiffness(uint32_t i) const { return of_.stiffness[of_.row[i]]; }
    void change(uint32_t first, uint32_t count, const double* by);

private:
    class WholeParts;

    bool is_split(uint32_t slot) const { return b_.hold[of_.node[slot]] != NodeHold::loose; }
    int size_of(uint32_t slot) const { return b_.matrix.size(of_.node[slot]); }
    std::span<RowTouch> touches(uint32_t row) const {
        return {of_.touch.data() + of_.begin[row], of_.touch.data() + of_.begin[row + 1]};
    }
    double* at(Array<double>& of, size_t slot) const { return of.data() + slot * kDof * kDof; }
    double mass_of(uint32_t place) const { return s_.nodes.mass[b_.nodes[place]].mass; }
    double miss_of(uint32_t place) const;
    void begin_at_start();
    void find_loads();
    void find_free_parts();
    void list_rows();
    void build();

    Substep& s_;
    System& sys_;
    Block& b_;
    ActiveSet& set_;
    ContactSplitMemory& of_;
};

}  // namespace taut
