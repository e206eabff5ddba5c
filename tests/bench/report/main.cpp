// taut-report FOLDER [SECTION ...]: measures what the report shows and writes it there as CSV files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "csv.h"
#include "deformables.h"
#include "experiment.h"
#include "forms.h"
#include "newton_map.h"
#include "scenes/catalogue.h"
#include "thesis.h"

namespace bench {

namespace {

scenes::Scene scene(const std::string& family, double r, uint64_t seed = 0) {
    return scenes::make_scene(family + "_r" + number(r), {seed, ""});
}

// Table 1 of Tournier et al. 2015: elongation of a loaded cable, 10 s in single steps of 0.01 s.
void table_1(const fs::path& folder) {
    Csv csv(folder / "table1.csv", "rods,tonnes,geometric_stiffness,elongation_pct,diverged");
    for (int rods : {10, 50})
        for (double tonnes = 1; tonnes <= 1e15; tonnes *= 1000)
            for (bool stiffness : {true, false}) {
                Contender contender = stiffness ? taut_as_shipped() : taut_without_stiffness();
                ChainFigures f = run(scene("cable" + std::to_string(rods), tonnes), contender).chain;
                csv.row(rods, tonnes, stiffness, 100 * f.stretch_most, f.blew_up);
                say("table 1: %d rods, %g t, %s: %.1e %%%s\n", rods, tonnes, stiffness ? "K" : "no K",
                    100 * f.stretch_most, f.blew_up ? ", diverged" : "");
            }
}

// The largest step that all these chains survive, and with it every smaller one of a geometric series within a
// decade: stability need not be monotonic, and a lucky large step alone does not count. Refined by bisection; 0:
// none from 0.1 ms on, which is the least that the interface takes, as 0.1 s is the largest.
double largest_stable_step(const std::vector<scenes::Scene>& chains, Stiffness stiffness) {
    constexpr double kLargest = 0.1, kLeast = 0.9999e-4, kRatio = 1.25892541;  // ten steps a decade
    constexpr int kDecade = 10, kBisections = 4;
    auto all_survive = [&](double h) {
        return std::all_of(chains.begin(), chains.end(),
                           [&](const scenes::Scene& chain) { return survives(chain, h, stiffness); });
    };
    double found = 0, above = 0, last = 0;
    int in_a_row = 0;
    for (double h = kLargest; h >= kLeast && in_a_row < kDecade; last = h, h /= kRatio) {
        if (!all_survive(h))
            in_a_row = 0;
        else if (in_a_row++ == 0)
            found = h, above = last;
    }
    if (in_a_row == 0) return 0;
    for (int i = 0; i < kBisections && above > 0; ++i) {
        double middle = std::sqrt(found * above);
        (all_survive(middle) ? found : above) = middle;
    }
    return found;
}

// Fig. 5 of the paper: feasible constant step of a chain against the weight at its end; released at rest, and from
// three random starts with velocities that contradict the joints.
void stable_step(const fs::path& folder) {
    Csv csv(folder / "stable_step.csv",
            "ratio,with_s,without_s,disturbed_with_s,disturbed_without_s,adaptive_s,disturbed_adaptive_s");
    for (double ratio = 1; ratio <= 1e6; ratio *= 10) {
        std::vector<scenes::Scene> rest = {scene("chain10", ratio)}, disturbed;
        for (uint64_t seed : {1, 2, 3}) disturbed.push_back(scene("chain10", ratio, seed));
        double with = largest_stable_step(rest, Stiffness::plain), without = largest_stable_step(rest, Stiffness::none),
               disturbed_with = largest_stable_step(disturbed, Stiffness::plain),
               disturbed_without = largest_stable_step(disturbed, Stiffness::none),
               adaptive = largest_stable_step(rest, Stiffness::adaptive),
               disturbed_adaptive = largest_stable_step(disturbed, Stiffness::adaptive);
        csv.row(ratio, with, without, disturbed_with, disturbed_without, adaptive, disturbed_adaptive);
        say("stable step: 1:%g: %.4f s with K, %.5f s without; disturbed %.4f and %.5f s; adaptive %.4f and %.4f s\n",
            ratio, with, without, disturbed_with, disturbed_without, adaptive, disturbed_adaptive);
    }
}

std::string joined(const std::vector<Outcome>& outcomes, size_t step) {
    std::string text;
    for (const Outcome& outcome : outcomes) {
        if (!text.empty()) text += ',';
        text += number(outcome.energy[step]);
    }
    return text;
}

void energy(const fs::path& folder) {
    struct Case {
        const char *family, *file;
        double ratio;
    };
    for (const Case& c : {Case{"swing", "energy_swing.csv", 10}, Case{"chain10", "energy_fall.csv", 1000}}) {
        scenes::Scene chain = scene(c.family, c.ratio);
        std::vector<Contender> contenders = {
            taut_as_shipped(), taut_plain(), taut_without_stiffness(), bullet(1), bullet(4), ode(1), ode(4)};
        std::string header = "time_s";
        std::vector<Outcome> outcomes;
        for (const Contender& contender : contenders) {
            header += std::string(",") + contender.name;
            outcomes.push_back(run(chain, contender));
            say("energy: %s, %s: %.4f at the end, %.4f at most\n", chain.name.c_str(), contender.label,
                outcomes.back().chain.energy, outcomes.back().chain.energy_most);
        }
        Csv csv(folder / c.file, header.c_str());
        for (size_t i = 0; i < chain.steps; ++i)
            csv.row(static_cast<double>(i + 1) * static_cast<double>(chain.world.time_step), joined(outcomes, i));
    }
}

// A row of joint error and cost.
void compare(Csv& csv, int links, double ratio, const Contender& contender) {
    Outcome o = run(scene("chain" + std::to_string(links), ratio), contender);
    csv.row(contender.name, links, ratio, 100 * o.chain.gap_most, o.chain.blew_up, o.chain.energy_most, o.step_us,
            o.solve_us > 0 ? number(o.solve_us) : "");
    say("%d links, 1:%g, %s: gap %.3g %%, %.1f us%s\n", links, ratio, contender.label, 100 * o.chain.gap_most,
        o.step_us, o.chain.blew_up ? ", blew up" : "");
}

constexpr const char* kCompared = "engine,links,ratio,joint_gap_pct,blew_up,energy_max,step_us,solve_us";

void links(const fs::path& folder) {
    Csv csv(folder / "links.csv", kCompared);
    for (double ratio : {1.0, 100.0, 1000.0})
        for (int count : {5, 10, 20, 50, 100, 200})
            for (const Contender& contender :
                 {taut_as_shipped(), bullet(1), bullet(4), ode(1), ode(4), ode_quickstep()})
                compare(csv, count, ratio, contender);
}

void mass_ratio(const fs::path& folder) {
    Csv csv(folder / "mass_ratio.csv", kCompared);
    for (double decade = 1; decade <= 1e6; decade *= 10)
        for (double ratio : {decade, 3 * decade}) {
            if (ratio > 1e6) break;
            for (const Contender& contender : {taut_as_shipped(), bullet(1), bullet(4), ode(1), ode(4)})
                compare(csv, 10, ratio, contender);
        }
}

// Figure 2 of Gast and Schroeder 2014: Newton's steps to convergence from each pixel, with line search and without.
void newton_map(const fs::path& folder) {
    constexpr int kSize = 80;  // pixels a side
    Csv csv(folder / "newton_map.csv", "step,searched,column,row,solves");
    for (size_t step = 0; step < std::size(NewtonMap::kSteps); ++step)
        for (const bool search : {false, true}) {
            const NewtonMap map(NewtonMap::kSteps[step], search, kSize);
            for (size_t i = 0; i < map.solves.size(); ++i)
                csv.row(step + 1, search, i % kSize, i / kSize, map.solves[i]);
            say("Newton's method, 1/%g s, %s: %d of %d fail, %.1f solves\n", 1 / NewtonMap::kSteps[step],
                search ? "with line search" : "without", map.failed(), kSize * kSize, map.mean());
        }
}

constexpr struct {
    const char* name;
    void (*measure)(const fs::path& folder);
} kSections[] = {
    {"table1", table_1},
    {"stable_step", stable_step},
    {"energy", energy},
    {"mass_ratio", mass_ratio},
    {"links", links},
    {"cloth_ratio", cloth_ratio},
    {"beam", beam},
    {"table2", conditioning},
    {"minres", minres},
    {"beam_forms", beam_forms},
    {"cloth_solvers", cloth_solvers},
    {"cloth_rest", cloth_rest},
    {"cloth_large", cloth_large},
    {"solver_times", solver_times},
    {"cloth_energy", cloth_energy},
    {"grains_error", grains_error},
    {"grains_velocity", grains_velocity},
    {"mixing", mixing},
    {"newton_map", newton_map},
};

int report(const std::vector<std::string>& arguments) {
    if (arguments.empty() || arguments[0].starts_with('-')) {
        std::fputs("taut-report FOLDER [SECTION ...] writes CSV files there; sections (default all):", stderr);
        for (const auto& section : kSections) say(" %s", section.name);
        say("\n");
        return 2;
    }
    fs::create_directories(arguments[0]);
    for (const auto& section : kSections)
        if (arguments.size() == 1 || std::count(arguments.begin() + 1, arguments.end(), section.name) > 0)
            section.measure(arguments[0]);
    return 0;
}

}  // namespace

}  // namespace bench

int main(int argc, char** argv) {
    try {
        return bench::report({argv + 1, argv + argc});
    } catch (const std::exception& error) {
        std::fprintf(stderr, "taut-report: %s\n", error.what());
        return 1;
    }
}
