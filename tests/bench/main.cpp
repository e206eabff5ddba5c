// taut-bench: runs one scene without pictures and prints its figures as one JSON object on one line.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>

#include "heap.h"
#include "load_scenes.h"
#include "metrics.h"
#include "options.h"
#include "scenes/taut_world.h"
#include "solve_report.h"
#include "step_times.h"

namespace bench {

namespace {

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

// A scene and who steps it.
struct Subject {
    Options options;
    scenes::Scene scene;

    std::unique_ptr<Engine> engine() const { return make_engine(options, scene); }
    uint32_t steps() const {
        return options.steps.value_or(static_cast<uint32_t>(std::lround(scene.steps * options.rate / 60)));
    }
};

Subject subject(const Options& options) {
    scenes::Scene scene = scenes::make_scene(
        options.scene, {options.seed, options.mesh, options.swept, options.from_point, options.line_search},
        bench_families());
    if (options.rate != 60) scene.world.time_step = static_cast<float>(1 / options.rate);
    scene.world.report = options.report.empty() ? 0 : 1;
    if (options.substeps) scene.world.substeps = *options.substeps;
    if (options.solver && options.engine == "taut") scene.world.solver = scenes::solver_named(*options.solver);
    if (!options.geometric_stiffness) scene.world.geometric_stiffness = 0;
    scene.world.adaptive_damping = options.adaptive_damping ? 1 : 0;
    scene.world.sleeping = options.sleep ? 1 : 0;
    scene.world.threads = options.engine == "taut" ? options.threads : 1;
    return {options, scene};
}

// The same for what it is measured beside.
Subject other_subject(Options options) {
    options.threads = 1;
    if (options.beside != "one-thread") {
        options.engine = options.beside;
        options.substeps.reset();
        options.solver.reset();
    }
    return subject(options);
}

// As in a program that has run for a while: the heap holds what the scene will take, and its code was called before, by
// the first steps of a world of its own.
void warm(const Subject& subject) {
    constexpr size_t kHeap = size_t{64} << 20;  // bytes; boxes2000 takes 7e6, ragdolls100 11e6
    constexpr int kSteps = 2;
    warm_heap(kHeap);
    const std::unique_ptr<Engine> engine = subject.engine();
    for (int i = 0; i < kSteps; ++i) engine->step();
}

template <class After>
StepTimes time_steps(Engine& engine, uint32_t steps, After&& after_step) {
    StepTimes times;
    for (uint32_t step = 0; step < steps; ++step) {
        const auto begin = std::chrono::steady_clock::now();
        const double worked = thread_ms();
        engine.step();
        const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
        times.add(took.count(), thread_ms() - worked, engine.stage_times());
        after_step(step);
    }
    return times;
}

// Once more from the start. Steps that end in another state are not the same work.
void run_again(const Subject& subject, uint64_t state_hash, StepTimes& times) {
    const std::unique_ptr<Engine> engine = subject.engine();
    times.keep_least(time_steps(*engine, subject.steps(), [](uint32_t) {}));
    if (engine->state_hash() != state_hash) throw std::runtime_error("two runs of the scene end in different states");
}

// What another takes for the scene.
struct Other {
    explicit Other(const Options& options) : of(other_subject(options)) {
        if (!options.cold) warm(of);
        const std::unique_ptr<Engine> engine = of.engine();
        times = time_steps(*engine, of.steps(), [](uint32_t) {});
        state_hash = engine->state_hash();
    }

    Subject of;
    StepTimes times;
    uint64_t state_hash = 0;
};

std::string hexadecimal(uint64_t number) {
    char digits[20];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(number));
    return digits;
}

// False, with a line that says why: a limit was asked for that does not hold.
bool holds_limits(const Options& options, const Spike& spike, double ratio) {
    const bool spikes = options.spike_limit > 0 && spike.ratio > options.spike_limit;
    const bool lags = options.ratio_limit > 0 && ratio > options.ratio_limit;
    if (spikes)
        std::fprintf(stderr, "taut-bench: step %zu took %.2f times the median, most of it in stage %s\n", spike.step,
                     spike.ratio, spike.stage);
    if (lags)
        std::fprintf(stderr, "taut-bench: the mean step took %.3f times that of %s\n", ratio, options.beside.c_str());
    return !spikes && !lags;
}

int run(const Options& options) {
    const Subject ours = subject(options);
    const scenes::Scene& scene = ours.scene;
    if (!options.cold) warm(ours);
    const double before = thread_ms();
    const std::unique_ptr<Engine> engine = ours.engine();
    const double made = thread_ms() - before;
    uint64_t bytes = engine->bytes();
    Metrics metrics(scene, *engine, ours.steps());
    std::optional<SolveReportFile> report;
    if (!options.report.empty()) report.emplace(options.report);
    SolveTime solve;
    StepTimes times = time_steps(*engine, ours.steps(), [&](uint32_t step) {
        const SolveTime last = engine->solve_time();
        solve.microseconds += last.microseconds;
        solve.solves += last.solves;
        metrics.after_step(step);
        bytes = std::max(bytes, engine->bytes());
        if (report) report->add(engine->world(), step);
    });
    std::optional<Other> other;
    if (!options.beside.empty()) other.emplace(options);
    for (uint32_t i = 1; i < options.runs; ++i) {
        run_again(ours, engine->state_hash(), times);
        if (other) run_again(other->of, other->state_hash, other->times);
    }
    nlohmann::ordered_json json;
    json["engine"] = engine->name();
    json["scene"] = scene.name;
    json["threads"] = scene.world.threads;
    json["bodies"] = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                   [](const scenes::Body& body) { return body.kind != TAUT_BODY_STATIC; });
    json["steps"] = ours.steps();
    json["runs"] = options.runs;
    json["made_ms"] = made;
    if (bytes > 0) json["bytes_max"] = bytes;
    times.report(json);
    const Spike spike = times.worst_after(options.warm_up);
    spike.report(json);
    const double ratio = other ? times.mean() / other->times.mean() : 0;
    if (other) {
        json["beside"] = options.beside;
        json["beside_mean_ms"] = other->times.mean();
        json["beside_median_ms"] = other->times.median();
        json["mean_ratio"] = ratio;
        json["median_ratio"] = times.median() / other->times.median();
    }
    json["finite"] = metrics.finite() ? 1 : 0;
    json["state_hash"] = hexadecimal(engine->state_hash());
    metrics.report(json);
    if (solve.solves > 0) json["solve_us"] = solve.microseconds / solve.solves;
    json["solver"] = engine->solver();
    json["substeps"] = engine->substeps();
    json["seed"] = options.seed;
    json["geometric_stiffness"] = options.geometric_stiffness ? 1 : 0;
    json["adaptive_damping"] = options.adaptive_damping ? 1 : 0;
    if (options.sleep) json["asleep"] = engine->asleep();
    std::printf("%s\n", json.dump().c_str());
    return holds_limits(options, spike, ratio) ? kFine : kRunFailed;
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
