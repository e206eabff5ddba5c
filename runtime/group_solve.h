// All substeps that a group of islands takes in a frame. No other group touches it.
#pragma once

#include "base/clock.h"
#include "detect/surface_contacts.h"
#include "integrate/integrate.h"
#include "integrate/substeps.h"
#include "solvers/solver.h"
#include "world.h"

namespace taut {

class GroupSolve {
public:
    GroupSolve(World& world, uint32_t index, const Solver& solver, const SolverSettings& settings, SolverReport& report,
               StageWatch& watch);

    void run() {
        build();
        while (!clock_.done()) {
            begin();
            assemble();
            Substep substep = next();
            solve(substep);
            if (substep.is_too_long()) {
                shorten();
                continue;
            }
            commit(substep);
            relax(substep);
            clock_.advance(substep.turn);
        }
        end();
    }

private:
    void build();                   // rows and lanes for the frame
    void begin();                   // x, v -> x_n, u*; contacts of blocks
    void renew_surfaces();          // x, v -> contacts of surfaces, where these miss what comes
    void assemble();                // poses -> C, J, K
    Substep next();                 // as solvers see it
    void solve(Substep& substep);   // -> u, impulses
    void shorten();                 // what was solved is not kept
    void commit(Substep& substep);  // u -> x
    void relax(Substep& substep);   // u -> v, forces
    void end();                     // impulses of lanes -> forces

    Measured measured() const { return {system_, group_, w_.partition, w_.nodes, w_.pairs, gravity_, clock_.number()}; }
    void tell(Stage stage) { taut::tell(w_, {stage, index_, clock_.number()}); }

    World& w_;
    System& system_;
    Group& group_;
    const uint32_t index_;
    const Solver& solver_;
    const SolverSettings& settings_;
    SolverReport& report_;
    StageWatch& watch_;
    const Vec3 gravity_;
    Substeps clock_;
    const bool airy_;              // air acts on surfaces of its soft bodies
    const bool one_step_, lends_;  // the scheme has one step; motions are lent to the seats
    MotionLoan loan_;
    bool loaded_ = false, sane_ = false;  // the nodes, as far as is known
    Array<Renewed> renewed_;              // by node; empty: contacts of surfaces are as the frame began
    double surfaces_found_ = 0;           // when they were, of the frame [s]
};

}  // namespace taut
