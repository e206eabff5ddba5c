// The matrix of one block: its nodes and the multipliers of the locked rows of its ties, which are joints and elements.
// Elastic elements (block_elastic.cpp) are folded into the nodes, and so are bounded rows (active_set.h) of blocks
// without them: J^T J / c stands for -J^T mu, mu = (target - J v) / c. Where there are elements, bounded rows are
// solved on a copy of the nodes that they touch (contact_split.h).
//
//   [ M + h^2 K + B^T B / c   -J^T ] [v+]   [ M v* + contact impulses + h^2 K s + B^T goal / c ]
//   [ -J                       -c  ] [mu] = [ -target                                          ]
//                     (Tournier et al. 2015, eq. 21, s instead of 0: only fast motion is damped)
#pragma once

#include "solvers/active_set.h"
#include "solvers/contact_split.h"
#include "solvers/energy_guard.h"

namespace taut {

// Of a block's nodes.
inline void copy_velocities(const System& system, const Block& block, const Array<Velocity>& from,
                            Array<Velocity>& to) {
    for (const uint32_t node : block.nodes) to[system.at(node)] = from[system.at(node)];
}

class BlockSolve {
public:
    BlockSolve(Substep& s, Block& b)
        : set(s, b), split(s, b, set), s_(s), sys_(s.system), b_(b), nodes_(static_cast<uint32_t>(b.nodes.size())) {}

    void analyse();
    // Where elastic elements are evaluated; one block after the other.
    void foresee();
    // Gases that it has nodes of, and memory for what they do; one block after the other.
    void find_gases();
    // Factors at this substep's poses and solves from the unconstrained velocity, in rounds over the active set and
    // twice where the force demands it.
    bool solve_first();
    // Same factor, with what contacts of the sweeps have changed since.
    void solve_again();
    // Velocities without the push of overlaps, into System::kept.
    void solve_relaxed();
    // Relaxed solution, forces and memory.
    void finish();
    // By how much a lever or line of its joints turns in this substep, at most [rad].
    double largest_turn() const;
    // Displacements that close the joints at the moved positions; false if they are closed well enough.
    bool settle();

    ActiveSet set;
    ContactSplit split;  // of blocks with elastic elements, instead of rounds over the active set

    // One block after the other.
    void gather_rows();

private:
    const RowBlock& row(uint32_t j) const { return sys_.rows.block[b_.first_row_block + j]; }
    // Joints, then elements with multipliers.
    uint32_t ties() const { return static_cast<uint32_t>(b_.joints.size() + b_.elements.size()); }
    uint32_t local(uint32_t sweep_node) const { return sys_.place[sweep_node]; }  // in b_.nodes, or kNone
    int size_of(uint32_t i) const { return b_.matrix.size(i); }                   // 3: a particle
    bool looped() const;
    bool ties_make_loops() const;
    bool holds(const RowBlock& block, int n) const;
    bool gives(const RowBlock& block) const;

    // block_matrix.cpp
    void list_unknowns(Array<Unknown>& out) const;
    void list_links(Array<uint64_t>& out, Array<uint64_t>& slight) const;
    void find_places();
    BlockPlace& place(uint32_t j, uint32_t which);
    BlockPlace place(const BoundedRow& row, int n, int m);
    void assemble(bool with_old);
    void add_new_stiffness();
    void add_mass(uint32_t i);
    bool has_locks(const RowBlock& block) const;
    void stiffness_of(const RowBlock& block, const double* force, double* k) const;
    void add_stiffness(uint32_t j, const double* force);
    void add_rows(uint32_t j);
    void add_bounded();
    double loop_compliance(const RowBlock& block, int r) const;
    bool stands(const RowBlock& block) const;

    // block_elastic.cpp
    template <class Act>
    void for_elastic(Act&& act) const;
    template <class Act>
    void for_couplings(Act&& act) const;
    template <class Batch>
    void gather_before(const Batch& batch, uint32_t i, double* out) const;
    bool foresees(const ElementSet& of) const;
    void link_elastic(Array<uint64_t>& out) const;
    void find_elastic_places();
    void find_parts();
    void assemble_elastic();
    void take_elastic_forces();
    double elastic_work() const;
    bool has_energy_forms() const;
    void along_way(uint32_t seat, double part, Vec3& u, Vec3& way) const;
    double elastic_energy(double part, double* slope) const;
    void elastic_damping(double& linear, double& square) const;
    double linearisation_error() const;
    void relinearise(double part);

    // block_search.cpp
    struct Way;
    Way way_of_step(bool with_old) const;
    void add_stiffness_along(Way& way) const;
    double part_of_step(const Way& way, bool& done) const;
    void begin_way(const Array<Velocity>& at);
    void begin_still();
    void begin_search(bool with_old);
    void go_part(double part);
    bool search(bool with_old);
    bool linearise_again(bool with_old);

    // block_gas.cpp
    template <class Act>
    void for_gas(const GasLoad& gas, Act&& act) const;
    double* gas_response(size_t i) { return b_.gas_response.data() + i * (unknowns() + 1); }
    void find_gas_responses();
    void yield_to_gas(double* x, size_t gases);

    // block_solve.cpp
    Vec3 line_turn(const RowBlock& block) const;
    double lever_turn(const RowBlock& block) const;
    void slow_velocities(const RowBlock& block, double* slow) const;
    void filter_lines();
    bool splits() const { return b_.elastic_runs > 0 && !set.empty(); }
    bool approach_laws();
    void solve_laws();
    bool solve_round();
    void advance(bool first);
    void stop_short();
    bool factor_rounds();
    bool factor_softly(bool with_old);
    void right_hand_side();
    double known_rate(const RowBlock& block, int r) const;
    double error_of(const RowBlock& block, int r) const {
        return sys_.rows.error[block.row + static_cast<uint32_t>(r)];
    }
    void solve_linear();
    void solve_known();
    void take_solution();
    void take_forces();
    bool outgrown(const RowBlock& block, const double* force) const;
    bool force_grew() const;

    // block_gain.cpp
    bool ideal(const RowBlock& block, int r) const;
    double tie_work() const;
    double energy_between(const Array<Velocity>& a, const Array<Velocity>& b) const;
    double slow_closing() const;
    void solve_closing(double part);
    void limit_gain();
    double fastest_between(const Array<Velocity>& a, const Array<Velocity>& b) const;
    void limit_push();
    void limit_bounce();

    size_t unknowns() const { return (nodes_ + ties()) * kDof; }
    // The second half of Block::solution: while rounds go on the iterate (active_set.h), then the iterate less the
    // solution of the last round.
    double* iterate() { return b_.solution.data() + unknowns(); }
    // The third: of each node the velocity from which a step of the search goes to System::exact.
    double* way_begin(uint32_t i) { return b_.solution.data() + 2 * unknowns() + size_t{i} * kDof; }
    const double* way_begin(uint32_t i) const { return const_cast<BlockSolve*>(this)->way_begin(i); }
    // Of a node h^2 K s, of a tie how fast its rows close their gaps [1/s].
    double* known(uint32_t i) { return &b_.known[i * kDof]; }
    double* tie_force(uint32_t j) { return &b_.force[j * kMaxRows]; }
    const double* tie_force(uint32_t j) const { return &b_.force[j * kMaxRows]; }

    Substep& s_;
    System& sys_;
    Block& b_;
    uint32_t nodes_;
    double began_off_ = -1;  // what the first step towards the laws of rows missed; -1: none yet [m/s]
    bool relaxed_ = false;   // System::kept belongs to the present solution
    bool renewed_ = false;   // the matrix has K of new forces
    EnergyGain gained_;      // by a guarded block's solution, before limit_gain
};

}  // namespace taut
