// taut-bench: runs one scene without pictures and prints its figures as one JSON object on one line.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <optional>

#include "heap.h"
#include "metrics.h"
#include "scenes/catalogue.h"
#include "scenes/taut_world.h"
#include "step_times.h"

namespace bench {

namespace {

enum ExitCode { kFine = 0, kRunFailed = 1, kBadArguments = 2 };

struct Options {
    std::string scene, engine = "taut";
    std::optional<uint32_t> steps, substeps;
    std::optional<std::string> solver;
    uint32_t threads = 1;
    uint64_t seed = 0;
    bool geometric_stiffness = true;
    bool adaptive_damping = false;
    bool sleep = false;
    bool cold = false;
    uint32_t warm_up = 0;
    double spike_limit = 0;
};

void print_scenes() {
    for (const scenes::Family& family : scenes::families())
        if (!family.needs_mesh)
            std::printf("%-22s %4u steps  %s (as in %s)\n", family.pattern, family.steps, family.description,
                        family.example);
}

std::optional<Options> read_options(int argc, char** argv, int* exit_code) {
    Options options;
    uint32_t steps = 0, substeps = 0;
    std::string solver;
    bool list = false, no_stiffness = false;
    CLI::App app{
        "Runs a scene without pictures and prints its figures as one JSON object on one line.\n"
        "Exit codes: 0 fine, 1 the run failed, 2 bad arguments."};
    app.add_option("--scene", options.scene, "scene by name, see --list");
    CLI::Option* steps_flag =
        app.add_option("--steps", steps, "steps (default: the scene's)")->check(CLI::Range(1, 10000000));
    app.add_option("--threads", options.threads, "threads of a step; the peers step on one")->check(CLI::Range(1, 64));
    app.add_option("--engine", options.engine, "taut; bullet or ode in builds with TAUT_BENCH_PEERS");
    CLI::Option* substeps_flag =
        app.add_option("--substeps", substeps, "least substeps of a step")->check(CLI::Range(1, 64));
    CLI::Option* solver_flag = app.add_option("--solver", solver,
                                              "block_ldlt, projected_gauss_seidel or accelerated_jacobi;\n"
                                              "of ode: step (default with joints) or quickstep");
    app.add_option("--seed", options.seed, "above 0: a random start, the same for the same seed");
    app.add_flag("--no-geometric-stiffness", no_stiffness, "leave it out, for comparison");
    app.add_flag("--adaptive-damping", options.adaptive_damping, "damp by the size of the geometric stiffness");
    app.add_flag("--sleep", options.sleep, "let what came to rest sleep; not for the peers");
    app.add_flag("--cold", options.cold, "begin with memory that is new and code that never ran");
    app.add_option("--warm-up", options.warm_up, "steps before the worst one is looked for");
    app.add_option("--spike-limit", options.spike_limit, "fail if the worst step takes so many times the median");
    app.add_flag("--list", list, "print all scenes");
    app.footer(kFieldHelp);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        *exit_code = app.exit(error, std::cout, std::cerr) == 0 ? kFine : kBadArguments;
        return std::nullopt;
    }
    if (list) {
        print_scenes();
        *exit_code = kFine;
        return std::nullopt;
    }
    if (options.scene.empty()) throw scenes::BadScene("--scene NAME is required, see --list");
    if (steps_flag->count() > 0) options.steps = steps;
    if (substeps_flag->count() > 0) options.substeps = substeps;
    if (solver_flag->count() > 0) options.solver = solver;
    options.geometric_stiffness = !no_stiffness;
    return options;
}

std::unique_ptr<Engine> make_engine(const Options& options, const scenes::Scene& scene) {
    if (options.engine == "taut") return make_taut_engine(scene);
    if (options.engine != "bullet" && options.engine != "ode")
        throw scenes::BadScene("--engine: '" + options.engine + "' is none of taut, bullet and ode");
#ifdef TAUT_BENCH_PEERS
    uint32_t substeps = options.substeps.value_or(1);
    if (options.engine == "ode") {
        OdeSolver solver = ode_solver_for(scene);
        if (options.solver && *options.solver != "step" && *options.solver != "quickstep")
            throw scenes::BadScene("--solver: ODE has step and quickstep");
        if (options.solver) solver = *options.solver == "step" ? OdeSolver::step : OdeSolver::quickstep;
        return make_ode_engine(scene, substeps, solver);
    }
    if (options.solver) throw scenes::BadScene("--solver is for taut and ode only");
    return make_bullet_engine(scene, substeps);
#else
    throw scenes::BadScene("--engine " + options.engine + ": this build has no peers, see -DTAUT_BENCH_PEERS=ON");
#endif
}

// As in a program that has run for a while: the heap holds what the scene will take, and its code was called before, by
// the first steps of a world of its own.
void warm(const Options& options, const scenes::Scene& scene) {
    constexpr size_t kHeap = size_t{64} << 20;  // bytes; boxes2000 takes 7e6, ragdolls100 11e6
    constexpr int kSteps = 2;
    warm_heap(kHeap);
    const std::unique_ptr<Engine> engine = make_engine(options, scene);
    for (int i = 0; i < kSteps; ++i) engine->step();
}

int run(const Options& options) {
    scenes::Scene scene = scenes::make_scene(options.scene, {options.seed, ""});
    if (options.substeps) scene.world.substeps = *options.substeps;
    if (options.solver && options.engine == "taut") scene.world.solver = scenes::solver_named(*options.solver);
    if (!options.geometric_stiffness) scene.world.geometric_stiffness = 0;
    scene.world.adaptive_damping = options.adaptive_damping ? 1 : 0;
    scene.world.sleeping = options.sleep ? 1 : 0;
    scene.world.threads = options.engine == "taut" ? options.threads : 1;
    if (!options.cold) warm(options, scene);
    uint32_t steps = options.steps.value_or(scene.steps);
    std::unique_ptr<Engine> engine = make_engine(options, scene);
    Metrics metrics(scene, *engine, steps);
    StepTimes times;
    SolveTime solve;
    for (uint32_t step = 0; step < steps; ++step) {
        auto begin = std::chrono::steady_clock::now();
        const double worked = thread_ms();
        engine->step();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
        times.add(took.count(), thread_ms() - worked, engine->stage_times());
        SolveTime last = engine->solve_time();
        solve.microseconds += last.microseconds;
        solve.solves += last.solves;
        metrics.after_step(step);
    }
    char hash[20];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(engine->state_hash()));
    nlohmann::ordered_json json;
    json["engine"] = engine->name();
    json["scene"] = scene.name;
    json["threads"] = scene.world.threads;
    json["bodies"] = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                   [](const scenes::Body& body) { return body.kind != TAUT_BODY_STATIC; });
    json["steps"] = steps;
    times.report(json);
    const Spike spike = times.worst_after(options.warm_up);
    spike.report(json);
    json["finite"] = metrics.finite() ? 1 : 0;
    json["state_hash"] = hash;
    metrics.report(json);
    if (solve.solves > 0) json["solve_us"] = solve.microseconds / solve.solves;
    json["solver"] = engine->solver();
    json["substeps"] = engine->substeps();
    json["seed"] = options.seed;
    json["geometric_stiffness"] = options.geometric_stiffness ? 1 : 0;
    json["adaptive_damping"] = options.adaptive_damping ? 1 : 0;
    if (options.sleep) json["asleep"] = engine->asleep();
    std::printf("%s\n", json.dump().c_str());
    if (options.spike_limit > 0 && spike.ratio > options.spike_limit) {
        std::fprintf(stderr, "taut-bench: step %zu took %.2f times the median, most of it in stage %s\n", spike.step,
                     spike.ratio, spike.stage);
        return kRunFailed;
    }
    return kFine;
}

}  // namespace

}  // namespace bench

int main(int argc, char** argv) {
    try {
        int code = 0;
        std::optional<bench::Options> options = bench::read_options(argc, argv, &code);
        return options ? bench::run(*options) : code;
    } catch (const scenes::BadScene& error) {
        std::fprintf(stderr, "taut-bench: %s\n", error.what());
        return bench::kBadArguments;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "taut-bench: %s\n", error.what());
        return bench::kRunFailed;
    }
}
