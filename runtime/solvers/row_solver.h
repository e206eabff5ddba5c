// What the solvers of rows have in common: a problem is made for each phase of a substep, iterated and stored. Each of
// them is a function over a Problem (system/problem.h) and knows neither phases nor constraint types.
#pragma once

#include "solvers/solver.h"
#include "solvers/stepping.h"

namespace taut {

// Sums over the rows of each island: what one island does never hangs on another.
template <class Value>
void sum_by_island(const Problem& problem, Array<double>& sums, Value&& value) {
    std::fill(sums.begin(), sums.end(), 0.0);
    for (const Unit& unit : problem.units()) sums[unit.island] += value(unit);
}

// A dot product by islands, in the metric of the inverse diagonal: a . D^-1 b.
inline void scaled_dot(const Problem& problem, const Array<double>& a, const Array<double>& b, Array<double>& sums) {
    sum_by_island(problem, sums, [&](const Unit& unit) {
        return problem.of(unit, a).dot(problem.inverse(unit, problem.of(unit, b)));
    });
}
inline void dot(const Problem& problem, const Array<double>& a, const Array<double>& b, Array<double>& sums) {
    sum_by_island(problem, sums, [&](const Unit& unit) { return problem.of(unit, a).dot(problem.of(unit, b)); });
}

using Iterate = void (*)(Problem&, const IterationSettings&);

template <Iterate iterate, uint32_t default_count, Rigid rigid>
void run_pass(Substep& s, const RowPass& pass, Phase phase, bool first) {
    RowSettings rows = s.settings.rows;
    rows.part = pass.part;
    rows.linear = pass.linear;
    rows.pushes = pass.pushes;
    Problem problem(s.system, s.scratch.problem, rows, phase, rigid);
    IterationSettings settings = s.settings.iteration;
    settings.count = s.settings.sweeps ? s.settings.sweeps : default_count;
    if (phase == Phase::relax)
        settings.relaxation *= s.settings.velocity_gain;
    else if (first)
        problem.warm_start(settings.count);
    else
        problem.go_on();
    iterate(problem, settings);
    problem.store();
}

template <Iterate iterate, uint32_t default_count, Rigid rigid>
void project(Substep& s) {
    const std::span<const RowPass> passes = passes_of(s.settings.stepping);
    for (const RowPass& pass : passes) {
        run_pass<iterate, default_count, rigid>(s, pass, Phase::project, &pass == passes.data());
        if (!pass.pushes) s.scratch.unpushed = s.system.exact;
    }
}

template <Iterate iterate, uint32_t default_count, Rigid rigid>
void relax(Substep& s) {
    if (s.settings.stepping == Stepping::post_stabilised) {
        s.system.exact = s.scratch.unpushed;
        return;
    }
    if (s.settings.velocity_gain == 0) return;
    for (const RowPass& pass : passes_of(s.settings.stepping))
        if (pass.pushes) run_pass<iterate, default_count, rigid>(s, pass, Phase::relax, false);
}

template <Iterate iterate, uint32_t default_count = 30, Rigid rigid = Rigid::exact>
constexpr Solver row_solver(const char* name) {
    return {name, false, false, project<iterate, default_count, rigid>, nullptr, relax<iterate, default_count, rigid>};
}

}  // namespace taut
