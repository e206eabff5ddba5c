#include "deformables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "csv.h"
#include "experiment.h"
#include "scenes/catalogue.h"
#include "vector.h"

namespace bench {

namespace {

struct Figures {
    nlohmann::ordered_json json;
    double step_ms = 0;  // median
};

Figures figures(const scenes::Scene& scene, const Contender& contender) {
    const std::unique_ptr<Engine> engine = contender.make(scene);
    Metrics metrics(scene, *engine, scene.steps);
    std::vector<double> times;
    for (uint32_t step = 0; step < scene.steps; ++step) {
        const auto begin = std::chrono::steady_clock::now();
        engine->step();
        times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
        metrics.after_step(step);
    }
    Figures result;
    metrics.report(result.json);
    result.json["finite"] = metrics.finite() ? 1 : 0;
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
    result.step_ms = times[times.size() / 2];
    return result;
}

// A sheet in a world of one solver, step by step: mean change of length of its warp and weft [1], as the thesis' sum
// over constraints but for their number and length.
class SheetRun {
public:
    explicit SheetRun(const scenes::Scene& scene) : shape_(scene.cloths.front()), engine_(make_taut_engine(scene)) {}

    double step() {  // [ms]
        const auto begin = std::chrono::steady_clock::now();
        engine_->step();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    }
    double error() {
        engine_->read_cloth(0, state_);
        double sum = 0;
        for (const SoftShape::Edge& edge : shape_.edges)
            sum += std::fabs(length(of(state_.points[edge.b]) - of(state_.points[edge.a])) / edge.rest - 1);
        return sum / static_cast<double>(shape_.edges.size());
    }

private:
    SoftShape shape_;
    std::unique_ptr<Engine> engine_;
    SoftState state_;
};

// The thesis' world: one step a frame without substeps.
scenes::Scene thesis_sheet(taut_solver solver, uint32_t iterations, double relaxation) {
    constexpr float kStep = 0.008f;
    scenes::Scene scene = scenes::make_scene("cloth_hang50");
    scene.world.time_step = kStep;
    scene.world.substeps = scene.world.fixed_substeps = 1;
    scene.world.solver = solver;
    scene.world.sweeps = iterations;
    if (relaxation > 0) scene.world.relaxation = static_cast<float>(relaxation);
    return scene;
}

struct Method {
    const char* name;
    taut_solver solver;
    double relaxation;  // 0: the solver's own
};
constexpr Method kMethods[] = {
    {"gauss_seidel", TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, 0},     {"sor_1.2", TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, 1.2},
    {"accelerated_jacobi", TAUT_SOLVER_ACCELERATED_JACOBI, 0},   {"minimum_residual", TAUT_SOLVER_MINIMUM_RESIDUAL, 0},
    {"conjugate_residuals", TAUT_SOLVER_CONJUGATE_RESIDUALS, 0}, {"direct", TAUT_SOLVER_BLOCK_LDLT, 0}};

}  // namespace

void cloth_ratio(const fs::path& folder) {
    Csv csv(folder / "cloth_ratio.csv", "engine,ratio,peak_pct,end_pct,energy_max,finite,step_ms");
    for (const double ratio : {1.0, 10.0, 100.0, 500.0})
        for (const Contender& contender : {taut_as_shipped(), taut_without_stiffness(), bullet(1), bullet(4)}) {
            const Figures f = figures(scenes::make_scene("cloth_row20_r" + number(ratio)), contender);
            const auto value = [&](const char* name) { return f.json[name].get<double>(); };
            csv.row(contender.name, ratio, value("peak_pct"), value("end_pct"), value("energy_max"),
                    f.json["finite"].get<int>(), f.step_ms);
            say("cloth 1:%g, %s: %.3g %% at most, %.3g %% at the end, %.1f ms\n", ratio, contender.label,
                value("peak_pct"), value("end_pct"), f.step_ms);
        }
}

void beam(const fs::path& folder) {
    Csv csv(folder / "beam.csv", "young_mpa,poisson,solve,tip_ratio,finite,step_ms");
    for (const char* poisson : {"30", "49"})
        for (const char* young : {"1", "10", "100"})
            for (const bool direct : {true, false}) {
                scenes::Scene scene = scenes::make_scene(std::string("beam_e") + young + "_n" + poisson);
                scene.solids[0].def.solve = direct ? TAUT_DEFORMABLE_DIRECT : TAUT_DEFORMABLE_SWEPT;
                const Figures f = figures(scene, taut_as_shipped());
                const double ratio = f.json["tip_ratio"].get<double>();
                csv.row(young, "0." + std::string(poisson), direct ? "direct" : "swept", ratio,
                        f.json["finite"].get<int>(), f.step_ms);
                say("beam of %s MPa, nu .%s, %s: tip at %.3f of theory, %.1f ms\n", young, poisson,
                    direct ? "direct" : "swept", ratio, f.step_ms);
            }
}

void cloth_solvers(const fs::path& folder) {
    constexpr uint32_t kFrames = 250, kIterations = 30;  // two seconds
    Csv curve(folder / "cloth_solvers.csv", "solver,time_s,error");
    Csv cost(folder / "cloth_solvers_cost.csv", "solver,iterations,step_ms,error");
    for (const Method& method : kMethods) {
        const bool direct = method.solver == TAUT_SOLVER_BLOCK_LDLT;
        SheetRun run(thesis_sheet(method.solver, direct ? 0 : kIterations, method.relaxation));
        double error = 0;
        for (uint32_t frame = 0; frame < kFrames; ++frame) {
            run.step();
            error = run.error();
            curve.row(method.name, 0.008 * (frame + 1), error);
        }
        say("sheet of 50 x 50, %s: mean strain %.3g after 2 s\n", method.name, error);
        for (const uint32_t iterations : {8u, 15u, 30u, 60u}) {
            constexpr uint32_t kTimed = 30;
            SheetRun timed(thesis_sheet(method.solver, direct ? 0 : iterations, method.relaxation));
            std::vector<double> times;
            for (uint32_t frame = 0; frame < kTimed; ++frame) times.push_back(timed.step());
            std::sort(times.begin(), times.end());
            cost.row(method.name, iterations, times[kTimed / 2], timed.error());
            if (direct) break;
        }
    }
}

}  // namespace bench
