#include "options.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <iostream>

#include "load_scenes.h"
#include "metrics.h"
#include "solve_report.h"

namespace bench {

namespace {

void print_scenes() {
    for (const scenes::Family& family : bench_families())
        std::printf("%-22s %4u steps  %s (as in %s)\n", family.pattern, family.steps, family.description,
                    family.example);
}

}  // namespace

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
    app.add_option("--rate", options.rate, "steps a second; the scene lasts as long")->check(CLI::Range(10.0, 10000.0));
    CLI::Option* solver_flag = app.add_option("--solver", solver,
                                              "one of taut_solver: block_ldlt, projected_gauss_seidel ...;\n"
                                              "of ode: step (default with joints) or quickstep");
    app.add_option("--seed", options.seed, "above 0: a random start, the same for the same seed");
    app.add_flag("--swept", options.swept, "cloths and solids are swept, not solved directly");
    app.add_flag("--from-point", options.from_point, "what begins tangled has all its vertices in one point");
    app.add_flag("!--no-line-search", options.line_search, "minimisation takes each of Newton's steps as it comes");
    app.add_option("--mesh", options.mesh, "mesh file, of scenes that take one");
    app.add_flag("--no-geometric-stiffness", no_stiffness, "leave it out, for comparison");
    app.add_flag("--adaptive-damping", options.adaptive_damping, "damp by the size of the geometric stiffness");
    app.add_flag("--sleep", options.sleep, "let what came to rest sleep; not for the peers");
    app.add_flag("--cold", options.cold, "begin with memory that is new and code that never ran");
    app.add_option("--warm-up", options.warm_up, "steps before the worst one is looked for");
    app.add_option("--spike-limit", options.spike_limit, "fail if the worst step takes so many times the median");
    app.add_option("--runs", options.runs, "runs; of each step the quietest counts")->check(CLI::Range(1, 1000));
    app.add_option("--beside", options.beside, "what else steps the scene, in turns with this")
        ->check(CLI::IsMember({"one-thread", "bullet", "ode"}));
    app.add_option("--ratio-limit", options.ratio_limit,
                   "fail if the mean step takes more than this part of the other's");
    app.add_option("--report", options.report,
                   "FILE.csv: what each island's solves left, beside what was decided for it");
    app.add_flag("--list", list, "print all scenes");
    app.footer(std::string(kFieldHelp) + "\n" + kReportHelp);
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
    if (!options.report.empty() && options.engine != "taut") throw scenes::BadScene("--report is for taut only");
    if (options.ratio_limit > 0 && options.beside.empty()) throw scenes::BadScene("--ratio-limit asks for --beside");
    if (steps_flag->count() > 0) options.steps = steps;
    if (substeps_flag->count() > 0) options.substeps = substeps;
    if (solver_flag->count() > 0) options.solver = solver;
    options.geometric_stiffness = !no_stiffness;
    return options;
}

}  // namespace bench
