#include "forms.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>

#include "api/access.h"
#include "csv.h"
#include "engine.h"
#include "scenes/catalogue.h"
#include "scenes/soft_meshes.h"
#include "sheet_system.h"

namespace bench {

namespace {

struct Row {
    const char *element, *form;
    double paper;  // table 2
    SheetPlan plan;
    double stiffness;  // of links in the stiffness form [N/m]
    bool compliance, precise;
};

double milliseconds(const std::function<void()>& act) {
    const auto begin = std::chrono::steady_clock::now();
    act();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

void take_as_rows(const Engine& engine) {
    const taut::Hold hold(taut::world_of(engine.world()), taut::Use::write);
    for (taut::ElementSet& set : hold.world()->elements.set) set.form = taut::ElementForm::rows;
}

// The paper gives neither masses nor step nor thickness. 0.1 kg a vertex and 10 ms here; its figures of triangles are
// met with a sheet as thick as it is wide, as where Gauss points are weighed by area; one of 1 mm stands beside it.
void conditioning(const fs::path& folder) {
    constexpr int kSteps = 100, kEvery = 10;
    constexpr double kSpring = 1e15;  // the paper's [N/m]
    SheetPlan links, thick, thin;
    thick.links = thin.links = false;
    thick.thickness = 1;
    const Row rows[] = {{"links", "compliance", 1e5, links, 0, true, false},
                        {"links", "stiffness", 1e12, links, kSpring, false, true},
                        {"triangles", "compliance", 1e3, thick, 0, true, false},
                        {"triangles", "stiffness", 1e6, thick, 0, false, false},
                        {"triangles_1mm", "compliance", 0, thin, 0, true, false},
                        {"triangles_1mm", "stiffness", 0, thin, 0, false, false}};
    Csv curve(folder / "conditioning.csv", "element,form,time_s,condition,condition_scaled");
    Csv table(folder / "table2.csv", "element,form,unknowns,condition_max,condition_scaled_max,paper");
    for (const Row& row : rows) {
        SheetSystem sheet(row.plan);
        double most = 0, most_scaled = 0;
        long unknowns = 0;
        for (int step = 1; step <= kSteps; ++step) {
            sheet.step();
            if (step % kEvery != 0) continue;
            sheet.assemble();
            const Sparse a = row.compliance ? sheet.compliance_form() : sheet.stiffness_form(row.stiffness);
            const double found = condition(a, row.precise), scaled = condition(equilibrated(a), row.precise);
            most = std::max(most, found);
            most_scaled = std::max(most_scaled, scaled);
            unknowns = a.rows();
            curve.row(row.element, row.form, row.plan.h * step, found, scaled);
        }
        table.row(row.element, row.form, unknowns, most, most_scaled, row.paper > 0 ? number(row.paper) : "");
        say("table 2: %s, %s: %.1e, scaled %.1e (paper: %.0e)\n", row.element, row.form, most, most_scaled, row.paper);
    }
}

// Half a second after its release. Both systems have one solution, which a direct solve tells. Of the systems as they
// are, and scaled to rows of one size.
void minres(const fs::path& folder) {
    constexpr uint32_t kMost = 10000;                                    // the paper's
    constexpr double kVelocity[] = {0.1, 1e-2, 1e-3}, kResidual = 1e-6;  // relative, where it counts as solved
    constexpr int kSteps = 50;
    Csv curve(folder / "minres.csv", "form,scaled,iteration,residual,velocity_error");
    Csv table(
        folder / "minres_iterations.csv",
        "form,thickness_m,scaled,iterations_to_residual_1e-6,to_velocity_0.1,to_velocity_1e-2,to_velocity_1e-3,paper");
    for (const double thickness : {1.0, 1e-3}) {
        SheetPlan plan;
        plan.links = false;
        plan.side = 20;
        plan.mass = 0.025;
        plan.thickness = thickness;
        SheetSystem sheet(plan);
        for (int step = 0; step < kSteps; ++step) sheet.step();
        sheet.assemble();
        const Sparse forms[] = {sheet.compliance_form(), sheet.stiffness_form()};
        const Vector sides[] = {sheet.compliance_side(), sheet.stiffness_side()};
        Eigen::SparseLU<Sparse> direct(forms[0]);
        const Vector exact = Vector(direct.solve(sides[0])).head(sheet.freedoms());
        for (const bool stiff : {false, true})
            for (const bool scaled : {false, true}) {
                const char* form = stiff ? "stiffness" : "compliance";
                const Sparse& a = forms[stiff];
                const Vector scale = scaled ? equilibration(a) : Vector::Ones(a.rows());
                const Sparse system = scale.asDiagonal() * a * scale.asDiagonal();
                uint32_t by_residual = 0, by_velocity[3] = {};  // 0: not yet
                double next = 1;
                minimum_residuals(system, scale.cwiseProduct(sides[stiff]), kMost,
                                  [&](uint32_t k, double residual, const Vector& y) {
                                      const Vector x = scale.cwiseProduct(y);
                                      const double off = (x.head(exact.size()) - exact).norm() / exact.norm();
                                      if (thickness == 1 && (k >= next || k == kMost)) {
                                          curve.row(form, scaled, k, residual, off);
                                          next = std::max(next + 1, 1.03 * next);
                                      }
                                      if (by_residual == 0 && residual <= kResidual) by_residual = k;
                                      for (int i = 0; i < 3; ++i)
                                          if (off > kVelocity[i])
                                              by_velocity[i] = 0;
                                          else if (by_velocity[i] == 0)
                                              by_velocity[i] = k;
                                      return residual > 1e-12;
                                  });
                const auto text = [](uint32_t k) { return k > 0 ? std::to_string(k) : std::string("never"); };
                table.row(form, thickness, scaled, text(by_residual), text(by_velocity[0]), text(by_velocity[1]),
                          text(by_velocity[2]), stiff ? "never in 10000" : "some 1000");
                say("minimum residuals, %g m, %s%s: %s iterations to a residual of 1e-6, %s to a tenth of the "
                    "velocity, %s to a thousandth\n",
                    thickness, form, scaled ? ", scaled" : "", text(by_residual).c_str(), text(by_velocity[0]).c_str(),
                    text(by_velocity[2]).c_str());
            }
    }
}

void beam_forms(const fs::path& folder) {
    constexpr int kNodes[3] = {11, 3, 3};
    constexpr double kSize[3] = {0.5, 0.1, 0.1}, kSeconds = 3;
    struct Form {
        const char* name;
        bool rows, curvature;
    };
    Csv csv(folder / "beam_forms.csv", "form,time_s,sink_m");
    std::vector<double> reference;
    for (const Form& form :
         {Form{"stiffness", false, true}, Form{"compliance", true, true}, Form{"compliance_without", true, false}}) {
        scenes::Scene scene = scenes::make_scene("beam_e1_n30");
        scenes::Solid beam = scenes::box_of_tets(kSize, kNodes, {-kSize[0] / 2, 1, -kSize[2] / 2});
        beam.def = scene.solids.front().def;
        for (int j = 0; j < kNodes[1]; ++j)
            for (int k = 0; k < kNodes[2]; ++k) beam.pinned.push_back(scenes::box_vertex(kNodes, 0, j, k));
        scene.solids.front() = beam;
        scene.world.geometric_stiffness = form.curvature ? 1 : 0;
        const std::unique_ptr<Engine> engine = make_taut_engine(scene);
        if (form.rows) take_as_rows(*engine);
        const uint32_t tip = scenes::box_vertex(kNodes, kNodes[0] - 1, 1, 1);
        const double start = beam.points[tip].y;
        SoftState state;
        double apart = 0, most = 0, took = 0;
        const auto frames = static_cast<size_t>(kSeconds / static_cast<double>(scene.world.time_step));
        for (size_t frame = 0; frame < frames; ++frame) {
            took += milliseconds([&] { engine->step(); });
            engine->read_solid(0, state);
            const double sink = start - state.points[tip].y;
            csv.row(form.name, static_cast<double>(scene.world.time_step) * static_cast<double>(frame + 1), sink);
            if (!form.rows) reference.push_back(sink);
            apart = std::max(apart, std::fabs(sink - reference[frame]));
            most = std::max(most, reference[frame]);
        }
        say("beam, %s: at most %.3g %% of its swing from the stiffness form, %.2f ms a frame\n", form.name,
            100 * apart / most, took / static_cast<double>(frames));
    }
}

}  // namespace bench
