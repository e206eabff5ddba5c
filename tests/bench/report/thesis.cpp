#include "thesis.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <vector>

#include "csv.h"
#include "engine.h"
#include "methods.h"
#include "scenes/catalogue.h"
#include "scenes/soft_meshes.h"
#include "soft_metrics.h"
#include "vector.h"

namespace bench {

namespace {

// A sheet in a world of one solver, step by step.
class SheetRun {
public:
    explicit SheetRun(const scenes::Scene& scene)
        : shape_(scene.cloths.front()),
          stiffness_(1 / static_cast<double>(scene.cloths.front().def.stretch_compliance[0])),
          gravity_(-static_cast<double>(scene.world.gravity.y)),
          engine_(make_taut_engine(scene)) {}

    double step() {  // [ms]
        const auto begin = std::chrono::steady_clock::now();
        engine_->step();
        return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    }
    // Mean change of length of warp and weft [1]: the thesis' sum over constraints but for their number and length.
    double error() {
        double sum = 0;
        for_strains([&](double strain, double) { sum += std::fabs(strain); });
        return sum / static_cast<double>(shape_.edges.size());
    }
    // Of motion and height, over that of the vertices at rest at y = 0 [J].
    double motion() {
        engine_->read_cloth(0, state_);
        double sum = 0;
        for (size_t i = 0; i < shape_.mass.size(); ++i) {
            const Vec v = of(state_.velocities[i]);
            sum += shape_.mass[i] * (0.5 * dot(v, v) + gravity_ * state_.points[i].y);
        }
        return sum;
    }
    // Root mean square of bodies [m/s].
    double speed(const std::vector<int>& bodies) const {
        double sum = 0;
        for (const int body : bodies) {
            const Vec v = of(engine_->motion(static_cast<size_t>(body)).linear_velocity);
            sum += dot(v, v);
        }
        return std::sqrt(sum / static_cast<double>(bodies.size()));
    }
    double elastic() {  // [J]
        double sum = 0;
        for_strains([&](double strain, double rest) { sum += 0.5 * stiffness_ * std::pow(strain * rest, 2); });
        return sum;
    }

private:
    template <class Act>
    void for_strains(Act&& act) {
        engine_->read_cloth(0, state_);
        for (const SoftShape::Edge& edge : shape_.edges)
            act(length(of(state_.points[edge.b]) - of(state_.points[edge.a])) / edge.rest - 1, edge.rest);
    }

    SoftShape shape_;
    double stiffness_, gravity_;  // of a link [N/m], [m/s^2]
    std::unique_ptr<Engine> engine_;
    SoftState state_;
};

constexpr Method kGaussSeidel{"gauss_seidel", TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, 0};
constexpr Method kOverRelaxed{"sor_1.2", TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, 1.2};
constexpr Method kJacobi{"accelerated_jacobi", TAUT_SOLVER_ACCELERATED_JACOBI, 0};
constexpr Method kImprovedJacobi{"improved_jacobi_0.5", TAUT_SOLVER_ACCELERATED_JACOBI, 0.5, TAUT_MOMENTUM_POWER};
constexpr Method kMinimumResidual{"minimum_residual", TAUT_SOLVER_MINIMUM_RESIDUAL, 0};
constexpr Method kConjugateResiduals{"conjugate_residuals", TAUT_SOLVER_CONJUGATE_RESIDUALS, 0};
constexpr Method kDirect{"direct", TAUT_SOLVER_BLOCK_LDLT, 0};

// Links along the threads alone.
scenes::Scene thesis_sheet(int side, const Method& method, uint32_t iterations, float step) {
    scenes::Scene scene = scenes::make_scene("cloth_hang" + std::to_string(side));
    scene.cloths.front().def.shear_compliance = INFINITY;
    as_in_thesis(scene, method, iterations, step);
    return scene;
}

// Error over time, as lines of solver, time and error; the last error.
double curve_of(Csv& csv, const Method& method, const scenes::Scene& scene, double seconds) {
    SheetRun run(scene);
    const auto step = static_cast<double>(scene.world.time_step);
    double error = 0;
    for (int frame = 1; frame * step <= seconds; ++frame) {
        run.step();
        error = run.error();
        csv.row(method.name, frame * step, error);
    }
    return error;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

}  // namespace

void cloth_solvers(const fs::path& folder) {
    constexpr uint32_t kIterations = 30, kTimed = 15;
    constexpr int kSide = 50;
    Csv curve(folder / "cloth_solvers.csv", "solver,time_s,error");
    Csv cost(folder / "cloth_solvers_cost.csv", "solver,iterations,step_ms,error");
    for (const Method& method : {kGaussSeidel, kOverRelaxed, kJacobi, kMinimumResidual, kConjugateResiduals, kDirect}) {
        const double error = curve_of(curve, method, thesis_sheet(kSide, method, kIterations, kShort), 2);
        say("sheet of 50 x 50, %s: mean strain %.3g after 2 s\n", method.name, error);
        for (const uint32_t iterations : {8u, 12u, 20u, 35u, 60u}) {
            SheetRun timed(thesis_sheet(kSide, method, iterations, kShort));
            std::vector<double> times;
            for (uint32_t frame = 0; frame < kTimed; ++frame) times.push_back(timed.step());
            cost.row(method.name, iterations, median(times), timed.error());
            if (is_direct(method)) break;
        }
    }
}

void cloth_rest(const fs::path& folder) {
    constexpr double kSeconds = 2;
    constexpr int kMeant = 60;  // of the last frames
    Csv csv(folder / "cloth_rest.csv", "solver,iterations,error");
    for (const Method& method : {kGaussSeidel, kJacobi, kConjugateResiduals})
        for (const uint32_t iterations : {2u, 4u, 9u, 18u, 35u}) {
            const scenes::Scene scene = thesis_sheet(50, method, iterations, kShort);
            SheetRun run(scene);
            const int frames = static_cast<int>(kSeconds / static_cast<double>(kShort));
            double sum = 0;
            for (int frame = 0; frame < frames; ++frame) {
                run.step();
                if (frame >= frames - kMeant) sum += run.error() / kMeant;
            }
            csv.row(method.name, iterations, sum);
            say("sheet of 50 x 50 at rest, %s, %u iterations: mean strain %.3g\n", method.name, iterations, sum);
        }
}

void cloth_large(const fs::path& folder) {
    constexpr uint32_t kIterations = 15;
    Csv csv(folder / "cloth_large.csv", "solver,time_s,error");
    for (const Method& method : {kGaussSeidel, kOverRelaxed, kJacobi, kImprovedJacobi, kConjugateResiduals, kDirect}) {
        const double error = curve_of(csv, method, thesis_sheet(100, method, kIterations, kLong), 2);
        say("sheet of 100 x 100, %s: mean strain %.3g after 2 s\n", method.name, error);
    }
}

void solver_times(const fs::path& folder) {
    constexpr uint32_t kIterations = 15, kTimed = 12;
    struct Case {
        const char* scene;
        uint32_t before;                           // frames until it works
        double serial, dual, quad, jacobi_serial;  // the thesis' Gauss-Seidel, and accelerated Jacobi [ms]
        double jacobi_dual, jacobi_quad;
    };
    constexpr double kNone = 0;
    // Tables 8.3 (one thread), 8.1 (two cores) and 8.2 (four).
    constexpr Case kCases[] = {{"boxes2000", 60, kNone, 140, 82.5, kNone, 90, 40},
                               {"cloth_hang50", 10, kNone, 6.3, kNone, kNone, 2.7, kNone},
                               {"cloth_hang100", 10, 39, 27.5, 15.4, 51, 19, 3.5},
                               {"cloth_hang150", 10, kNone, kNone, 36.3, kNone, kNone, 15},
                               {"grains_box3000", 60, 5.2, kNone, kNone, 6.5, kNone, kNone}};
    const auto text = [](double ms) { return ms > 0 ? number(ms) : std::string(); };
    Csv csv(folder / "solver_times.csv", "scene,solver,threads,step_ms,paper_1_ms,paper_2_cores_ms,paper_4_cores_ms");
    for (const Case& c : kCases)
        for (const bool jacobi : {false, true})
            for (const uint32_t threads : {1u, 2u}) {
                const Method& method = jacobi ? kJacobi : kGaussSeidel;
                scenes::Scene scene = scenes::make_scene(c.scene);
                as_in_thesis(scene, method, kIterations, kLong);
                scene.world.threads = threads;
                const std::unique_ptr<Engine> engine = make_taut_engine(scene);
                for (uint32_t i = 0; i < c.before; ++i) engine->step();
                std::vector<double> times;
                for (uint32_t i = 0; i < kTimed; ++i) {
                    const auto begin = std::chrono::steady_clock::now();
                    engine->step();
                    times.push_back(
                        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count());
                }
                csv.row(c.scene, method.name, threads, median(times), text(jacobi ? c.jacobi_serial : c.serial),
                        text(jacobi ? c.jacobi_dual : c.dual), text(jacobi ? c.jacobi_quad : c.quad));
                say("%s, %s, %u threads: %.2f ms\n", c.scene, method.name, threads, median(times));
            }
}

void cloth_energy(const fs::path& folder) {
    constexpr uint32_t kIterations = 25;  // the thesis'
    constexpr double kSide = 1;           // [m]
    constexpr Method kGradients{"conjugate_gradients", TAUT_SOLVER_CONJUGATE_GRADIENTS, 0},
        kLinearGradients{"linear_gradients", TAUT_SOLVER_CONJUGATE_GRADIENTS, 0, TAUT_MOMENTUM_NESTEROV,
                         TAUT_STEPPING_VELOCITY};
    struct Curve {
        const char* name;
        Method method;
        taut_scheme scheme;
        double damping;      // over stiffness, in steps
        float gamma = 0.5f;  // of Newmark; beta: (gamma + 1/2)^2 / 4, which damps fast motion most
    };
    const auto sheet = [&](int n, double stiffness, const Curve& curve) {
        scenes::Scene scene = scenes::soft_hall(2);
        scenes::Cloth cloth = scenes::grid_cloth(n, n, kSide, kSide, 0);
        cloth.def.kind = TAUT_CLOTH_LINKS;
        for (float& each : cloth.def.stretch_compliance) each = static_cast<float>(1 / stiffness);
        cloth.def.shear_compliance = INFINITY;
        cloth.def.filter.mask = 0;
        cloth.def.damping = static_cast<float>(curve.damping) * kLong;
        cloth.pinned = {0, static_cast<uint32_t>(n - 1)};
        scene.add_cloth(std::move(cloth));
        as_in_thesis(scene, curve.method, kIterations, kLong);
        scene.world.scheme = curve.scheme;
        scene.world.newmark_gamma = curve.gamma;
        scene.world.newmark_beta = 0.25f * (curve.gamma + 0.5f) * (curve.gamma + 0.5f);
        return scene;
    };
    const auto run = [&](Csv& csv, const char* what, const scenes::Scene& scene, const Curve& curve, double seconds,
                         bool elastic) {
        SheetRun of(scene);
        const double start = of.motion();
        double energy = 0;
        for (int frame = 1; frame * static_cast<double>(kLong) <= seconds; ++frame) {
            of.step();
            energy = of.motion() + (elastic ? of.elastic() : 0) - start;
            csv.row(curve.name, frame * static_cast<double>(kLong), energy);
        }
        say("%s, %s: energy %.4g J over its start after %g s\n", what, curve.name, energy, seconds);
    };
    {
        Csv csv(folder / "sheet_energy.csv", "curve,time_s,energy_j");
        for (const Curve& curve : {Curve{"conjugate_gradients", kGradients, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"gauss_seidel", kGaussSeidel, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"linear_gradients", kLinearGradients, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"direct", kDirect, TAUT_SCHEME_IMPLICIT_EULER, 0}})
            run(csv, "sheet of 15 x 15, 200 N/m", sheet(15, 200, curve), curve, 500 * static_cast<double>(kLong), true);
    }
    {
        Csv csv(folder / "rubber_energy.csv", "curve,time_s,energy_j");
        for (const Curve& curve : {Curve{"conjugate_gradients", kGradients, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"gauss_seidel", kGaussSeidel, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"gauss_seidel_newmark", kGaussSeidel, TAUT_SCHEME_NEWMARK, 0},
                                   Curve{"gauss_seidel_newmark_0.55", kGaussSeidel, TAUT_SCHEME_NEWMARK, 0, 0.55f},
                                   Curve{"direct", kDirect, TAUT_SCHEME_IMPLICIT_EULER, 0},
                                   Curve{"direct_newmark", kDirect, TAUT_SCHEME_NEWMARK, 0}})
            run(csv, "rubber of 10 x 10, 2 N/m", sheet(10, 2, curve), curve, 20, true);
    }
    Csv csv(folder / "damped_energy.csv", "curve,time_s,energy_j");
    for (const Curve& curve : {Curve{"gauss_seidel", kGaussSeidel, TAUT_SCHEME_IMPLICIT_EULER, 0},
                               Curve{"gauss_seidel_10h", kGaussSeidel, TAUT_SCHEME_IMPLICIT_EULER, 10},
                               Curve{"gauss_seidel_newmark_h", kGaussSeidel, TAUT_SCHEME_NEWMARK, 1},
                               Curve{"direct", kDirect, TAUT_SCHEME_IMPLICIT_EULER, 0},
                               Curve{"direct_10h", kDirect, TAUT_SCHEME_IMPLICIT_EULER, 10}})
        run(csv, "sheet of 40 x 40, 2 kN/m", sheet(40, 2000, curve), curve, 6, false);
}

void mixing(const fs::path& folder) {
    constexpr uint32_t kIterations = 30;
    constexpr double kSeconds = 3, kBurst = 1;  // kBurst: mean strain with which a sheet is given up
    constexpr auto kSolver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL;
    constexpr auto kNone = TAUT_MOMENTUM_NESTEROV;
    constexpr Method kMethods[] = {
        {"position_based", kSolver, 0, kNone, TAUT_STEPPING_PROJECTION, 1, 0},
        {"velocity", kSolver, 0, kNone, TAUT_STEPPING_VELOCITY, 0.5, 0},
        {"links_first", kSolver, 0, kNone, TAUT_STEPPING_LINKS_FIRST, 1, 1},
        {"velocity_first", kSolver, 0, kNone, TAUT_STEPPING_VELOCITY_FIRST, 1, 0},
        {"post_stabilised", kSolver, 0, kNone, TAUT_STEPPING_POST_STABILISED, 1, 1},
        {"sequential_positions", kSolver, 0, kNone, TAUT_STEPPING_PROJECTION, 1, 0.1},
    };
    Csv csv(folder / "mixing.csv", "method,time_s,strain,speed_m_s");
    for (const Method& method : kMethods) {
        scenes::Scene scene = scenes::make_scene("grains_on_cloth");
        as_in_thesis(scene, method, kIterations, kLong);
        const std::vector<int> pile = scene.roles.pile;
        SheetRun run(scene);
        double strain = 0, fastest = 0;
        for (int frame = 1; frame * static_cast<double>(kLong) <= kSeconds && strain < kBurst; ++frame) {
            run.step();
            const double now = run.error(), speed = run.speed(pile);
            strain = std::max(strain, now);
            fastest = std::max(fastest, speed);
            csv.row(method.name, frame * static_cast<double>(kLong), now, speed);
        }
        say("grains on cloth, %s: mean strain %.3g and speed %.3g m/s at most\n", method.name, strain, fastest);
    }
}

}  // namespace bench
