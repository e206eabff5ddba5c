#include "experiment.h"

#include <algorithm>
#include <chrono>

namespace bench {

namespace {

std::vector<double>::iterator middle(std::vector<double>& values) {
    return values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
}

double median(std::vector<double> values) {
    std::nth_element(values.begin(), middle(values), values.end());
    return *middle(values);
}

}  // namespace

Contender taut_as_shipped() {
    return {"taut", "Taut", [](const scenes::Scene& scene) { return make_taut_engine(scene); }};
}

Contender taut_plain() {
    return {"taut_plain", "Taut, plain implicit Euler", [](scenes::Scene scene) {
                scene.world.velocity_filter = 0;
                return make_taut_engine(scene);
            }};
}

Contender taut_without_stiffness() {
    return {"taut_no_k", "Taut, no geometric stiffness", [](scenes::Scene scene) {
                scene.world.geometric_stiffness = 0;
                return make_taut_engine(scene);
            }};
}

Contender bullet(uint32_t substeps) {
    return {substeps == 1 ? "bullet" : "bullet_4", substeps == 1 ? "Bullet" : "Bullet, 4 substeps",
            [substeps](const scenes::Scene& scene) { return make_bullet_engine(scene, substeps); }};
}

Contender ode(uint32_t substeps) {
    return {substeps == 1 ? "ode" : "ode_4", substeps == 1 ? "ODE" : "ODE, 4 substeps",
            [substeps](const scenes::Scene& scene) { return make_ode_engine(scene, substeps, OdeSolver::step); }};
}

Contender ode_quickstep() {
    return {"ode_quickstep", "ODE quickstep",
            [](const scenes::Scene& scene) { return make_ode_engine(scene, 1, OdeSolver::quickstep); }};
}

Outcome run(const scenes::Scene& scene, const Contender& contender) {
    std::unique_ptr<Engine> engine = contender.make(scene);
    Metrics metrics(scene, *engine, scene.steps);
    Outcome outcome;
    std::vector<double> times, solves;
    for (uint32_t step = 0; step < scene.steps; ++step) {
        auto begin = std::chrono::steady_clock::now();
        engine->step();
        times.push_back(std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - begin).count());
        SolveTime last = engine->solve_time();
        if (last.solves > 0) solves.push_back(last.microseconds / last.solves);
        metrics.after_step(step);
        outcome.energy.push_back(metrics.chain().energy);
    }
    outcome.chain = metrics.chain();
    outcome.step_us = median(times);
    if (!solves.empty()) outcome.solve_us = median(solves);
    return outcome;
}

bool survives(const scenes::Scene& scene, double h, Stiffness stiffness) {
    constexpr double kSeconds = 10, kMostEnergy = 1.05, kMostGap = 0.25;
    scenes::Scene plain = scene;
    plain.world.time_step = static_cast<float>(h);
    plain.world.substeps = plain.world.fixed_substeps = 1;
    plain.world.velocity_filter = 0;
    plain.world.geometric_stiffness = stiffness == Stiffness::none ? 0 : 1;
    plain.world.adaptive_damping = stiffness == Stiffness::adaptive ? 1 : 0;
    std::unique_ptr<Engine> engine = make_taut_engine(plain);
    auto steps = static_cast<uint32_t>(kSeconds / h);
    Metrics metrics(plain, *engine, steps);
    for (uint32_t step = 0; step < steps; ++step) {
        engine->step();
        metrics.after_step(step);
        ChainFigures f = metrics.chain();
        if (!metrics.finite() || !(f.energy_most <= kMostEnergy) || !(f.gap_most <= kMostGap)) return false;
    }
    return true;
}

}  // namespace bench
