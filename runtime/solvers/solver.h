// The contract between solvers and the step. A solver is one file over the assembled system; it knows no
// constraint type. Adding one is its file and one line in list.cpp.
#pragma once

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <span>

#include "partition/partition.h"
#include "solvers/bounded_row.h"
#include "solvers/stepping.h"
#include "system/axis_rows.h"
#include "system/impacts.h"
#include "system/problem.h"
#include "system/system.h"
#include "threads/team.h"

namespace taut {

// How momentum grows over iterations; see jacobi.cpp.
enum class MomentumRule : uint8_t { nesterov, power };

// Of solvers that iterate over a Problem.
struct IterationSettings {
    uint32_t count = 0;     // iterations
    double relaxation = 1;  // omega: share of each step that is taken
    MomentumRule momentum = MomentumRule::nesterov;
    bool fixed_step = false;  // 1 / rho in place of a step measured in each iteration
};

struct MinimisationSettings;
struct MinimisationMemory;

struct SolverSettings {
    uint32_t sweeps;  // iterations a substep; 0: the solver's own default
    bool geometric_stiffness;
    double velocity_filter;  // kappa; 0: the slow velocity is taken as zero
    double gravity_squared;  // |g|^2 [m^2/s^4], scale of the energy guard
    const ContactKernels* kernels;
    const JointKernels* joint_kernels;
    const ElementKernels* element_kernels;
    const GrainKernels* grain_kernels;
    const SurfaceKernels* surface_kernels;
    bool adaptive_damping = false;     // |K| in the place of K; see adaptive_damping.h
    double restitution_threshold = 0;  // [m/s]
    RowSettings rows{};
    IterationSettings iteration{};
    const MinimisationSettings* minimisation = nullptr;  // null: its defaults
    Stepping stepping = Stepping::projection;            // of row solvers
    double velocity_gain = 1;  // k_v: share of an iteration's step that relaxing velocities take; 0: they stay
};

struct SolverReport {
    std::atomic<uint32_t> solves{0}, resolves{0}, rounds{0}, guard_trips{0}, failures{0};
    uint32_t unfinished = 0;  // minimisations that ended before their tolerance
    float direct_us = 0;      // spent in direct solves
    double residual = 0;      // largest |J v + c mu - target| of direct solves [m/s]
};

// Memory of minimisation, which few worlds have: made at its first use.
class MinimisationHolder {
public:
    explicit MinimisationHolder(Memory& memory) : memory_(memory) {}
    ~MinimisationHolder();
    MinimisationHolder(const MinimisationHolder&) = delete;
    MinimisationHolder& operator=(const MinimisationHolder&) = delete;

    MinimisationMemory& get();  // throws std::bad_alloc

private:
    Memory& memory_;
    MinimisationMemory* made_ = nullptr;
};

// Memory that solvers use during a substep, kept so that steady scenes allocate nothing.
struct SolverScratch {
    explicit SolverScratch(Memory& memory) : problem(memory), minimisation(memory), bounded(memory), unpushed(memory) {}

    ProblemMemory problem;
    MinimisationHolder minimisation;
    Array<BoundedRow> bounded;  // of the group's blocks
    Array<Velocity> unpushed;   // by seat: of a pass without push
};

// One substep of one group.
struct Substep {
    Team& team;
    System& system;
    Group& group;
    Array<Block>& blocks;
    const Nodes& nodes;
    const SolverSettings& settings;
    SolverReport& report;
    SolverScratch& scratch;
    bool last;  // of the frame
    // Sweeps that correct, and those that relax, take the colours of contacts from the last to the first. In turns,
    // each against the other: in one order alone a wall of ten rows or more kept swaying.
    bool corrects_backward = false, relaxes_backward = false;
    // Of the levers and lines of joints [rad]: by how much they may turn, and do.
    double most_turn = std::numeric_limits<double>::infinity(), turn = 0;
    Impacts* impacts = nullptr;

    // What was solved is not kept: the step tries a shorter one.
    bool is_too_long() const { return turn > most_turn; }
    // Slower impacts do not bounce [m/s]; see restitution.h.
    double least_impact() const {
        return std::max(settings.restitution_threshold, std::sqrt(settings.gravity_squared) * system.scheme.h);
    }
};

struct Solver {
    const char* name;
    bool direct;  // joints and towers form blocks; else they come as rows to sweep, by colour
    bool lanes;   // contacts and swept joints come in lanes; else contacts are rows after those of the joints
    // From system.exact = v* to the velocity that moves the positions, with the push of overlapping contacts. Of a
    // substep that is too long only impulses and forces are left, for the next solve to start from.
    void (*solve)(Substep&);
    // After the positions moved, may be null: what the linearisation left of the position error, as displacements in
    // System::correction of the blocks marked corrected.
    void (*settle)(Substep&);
    // From the velocity that moved the positions to the one that is kept, without that push.
    void (*relax)(Substep&);
    bool energies = false;  // elements come without rows, as Rows::elastic, and nothing else comes at all
};

// In the order of taut_solver.
std::span<const Solver* const> solvers();

extern const Solver kBlockLdlt, kProjectedGaussSeidel, kAcceleratedJacobi, kJacobi, kNonlinearGaussSeidel,
    kMinimumResidual, kConjugateResiduals, kConjugateGradients, kMinimisation;

}  // namespace taut
