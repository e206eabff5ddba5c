#include "deformables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "csv.h"
#include "experiment.h"
#include "forms.h"
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

}  // namespace

void cloth_ratio(const fs::path& folder) {
    // Without multipliers the links' matrix would have it whatever the world says.
    const Contender without{"taut_no_k", "Taut, no geometric stiffness", [](scenes::Scene scene) {
                                scene.world.geometric_stiffness = 0;
                                std::unique_ptr<Engine> engine = make_taut_engine(scene);
                                take_as_rows(*engine);
                                return engine;
                            }};
    Csv csv(folder / "cloth_ratio.csv", "engine,ratio,peak_pct,end_pct,energy_max,finite,step_ms");
    for (const double ratio : {1.0, 10.0, 100.0, 500.0})
        for (const Contender& contender : {taut_as_shipped(), without, bullet(1), bullet(4)}) {
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

}  // namespace bench
