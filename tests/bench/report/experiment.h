// One run of one scene in one engine, as the sections of the report ask for it.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "metrics.h"

namespace bench {

// An engine with its settings, as a curve of the report.
struct Contender {
    const char* name;   // in the CSV files
    const char* label;  // in words
    std::function<std::unique_ptr<Engine>(scenes::Scene)> make;
};

Contender taut_as_shipped();          // four substeps at least, velocity filter 0.25
Contender taut_plain();               // four substeps, plain implicit Euler damping: velocity filter 0
Contender taut_without_stiffness();   // four substeps, no geometric stiffness
Contender bullet(uint32_t substeps);  // btSequentialImpulseConstraintSolver, ten iterations
Contender ode(uint32_t substeps);     // dWorldStep, the direct solver
Contender ode_quickstep();            // dWorldQuickStep, 20 sweeps

struct Outcome {
    ChainFigures chain;
    double step_us = 0;          // median wall time of a frame
    double solve_us = 0;         // median of a substep's assembly and direct solve; 0: not told
    std::vector<double> energy;  // after each step, 1: the start's
};

// Runs the scene's own number of steps.
Outcome run(const scenes::Scene& scene, const Contender& contender);

// Whether a chain comes through ten seconds of steps of h without substeps: total energy at most 1.05 of the
// start's over hanging straight, no joint open by more than 25 % of a link. Plain scheme: velocity filter 0.
enum class Stiffness { none, plain, adaptive };  // geometric: left out, as shipped, with adaptive damping
bool survives(const scenes::Scene& scene, double h, Stiffness stiffness);

}  // namespace bench
