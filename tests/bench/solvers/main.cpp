// taut-solvers FOLDER: how fast every solver of rows converges, on one substep each of a hanging net, 3000 grains, 2000
// boxes and a bridge (Frâncu 2016, figures 6.1, 6.3, 8.8 to 8.10, tables 8.1 and 8.3). All start from the same
// velocities and impulses; FOLDER/solvers.csv holds what each leaves after n iterations, and the time it took.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "api/access.h"
#include "scenes/catalogue.h"
#include "scenes/taut_world.h"
#include "solvers/row_solver.h"
#include "world.h"

namespace {

using namespace taut;

constexpr uint32_t kCounts[] = {1, 2, 4, 8, 15, 30, 60, 120, 240};

struct Plan {
    const char* name;
    scenes::Scene (*make)();
    int frames;  // before the substep that is looked at
};

// 30 x 30 particles of 10 g on rigid rods of 4 cm, hung by two corners.
scenes::Scene hanging_net() {
    constexpr int kSide = 30;
    constexpr float kSpacing = 0.04f;
    scenes::Scene scene;
    taut_world_def_init(&scene.world);
    const auto rod = [&](int a, int b, taut_pos at, float length) {
        scenes::Joint joint;
        joint.kind = TAUT_JOINT_DISTANCE;
        joint.body_a = a;
        joint.body_b = b;
        joint.anchor_a = at;
        joint.length = length;
        scene.joints.push_back(joint);
    };
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            scenes::Body body;
            body.position = {double(kSpacing * float(i)), 0, double(kSpacing * float(j))};
            body.mass = 0.01f;
            body.kind = TAUT_BODY_PARTICLE;
            scene.bodies.push_back(body);
        }
    for (int i = 0; i < kSide; ++i)
        for (int j = 0; j < kSide; ++j) {
            const int at = i * kSide + j;
            if (i + 1 < kSide) rod(at, at + kSide, {}, kSpacing);
            if (j + 1 < kSide) rod(at, at + 1, {}, kSpacing);
        }
    for (const int corner : {0, kSide * (kSide - 1)}) {
        const taut_pos hook = {scene.bodies[size_t(corner)].position.x, double(kSpacing), 0};
        rod(scenes::kWorld, corner, hook, kSpacing);
    }
    return scene;
}

// With rows for the contacts between grains.
scenes::Scene grains_as_bodies() {
    scenes::Scene scene = scenes::make_scene("grains3000_r0.5", {});
    for (scenes::Body& body : scene.bodies) body.grain = false;
    return scene;
}

const Plan kPlans[] = {
    {"net", hanging_net, 60},
    {"grains3000", grains_as_bodies, 150},
    {"boxes2000", [] { return scenes::make_scene("boxes2000", {}); }, 120},
    {"bridge", [] { return scenes::make_scene("bridge", {}); }, 120},
};

// A solver under a setting that the thesis compares.
struct Contender {
    const char* name;
    const Solver* solver;
    IterationSettings settings;
};

const Contender kContenders[] = {
    {"gauss_seidel", &kNonlinearGaussSeidel, {}},
    {"sor_1.2", &kNonlinearGaussSeidel, {0, 1.2}},
    {"jacobi", &kJacobi, {}},
    {"accelerated_jacobi_nesterov", &kAcceleratedJacobi, {}},
    {"accelerated_jacobi_power", &kAcceleratedJacobi, {0, 1, MomentumRule::power}},
    {"minimum_residual", &kMinimumResidual, {}},
    {"minimum_residual_fixed", &kMinimumResidual, {0, 1, MomentumRule::nesterov, true}},
    {"conjugate_residuals", &kConjugateResiduals, {}},
    {"conjugate_gradients", &kConjugateGradients, {}},
};

// What a solver changes of a substep.
struct State {
    explicit State(const World& w)
        : exact(w.system.exact),
          impulse(w.system.rows.impulse),
          jacobian(w.system.rows.jacobian),
          joints(w.joints.record) {}
    void restore(World& w) const {
        w.system.exact = exact;
        w.system.rows.impulse = impulse;
        w.system.rows.jacobian = jacobian;
        std::copy(joints.begin(), joints.end(), w.joints.record.begin());  // rows point into it
    }

    Array<Velocity> exact;
    Array<double> impulse, jacobian;
    Array<Joint> joints;
};

// Looks on at the first substep of one step.
class Measurement final : public StageObserver {
public:
    Measurement(std::ostream& out, const char* scene, SolverScratch& scratch)
        : out_(out), scene_(scene), scratch_(scratch) {}

    void after(World& w, const StageEnd& end) override {
        if (end.stage != Stage::assemble || end.substep != 0) return;
        const State state(w);
        for (const Contender& contender : kContenders)
            for (const uint32_t count : kCounts) {
                state.restore(w);
                measure(w, end.group, contender, count);
            }
        state.restore(w);
    }

private:
    // Mean error of a row [m], as one more step of the diagonal would mend it: h |mu - proj(mu - D^-1 r)| D.
    double error(World& w, const RowSettings& rows) {
        Problem problem(w.system, scratch_.problem, rows, Phase::project, Rigid::exact);
        problem.use_whole_masses();
        problem.evaluate();
        Problem::Vector &r = problem.scratch(0), &z = problem.scratch(1);
        problem.residual(r);
        problem.direction(r, z);
        double sum = 0;
        size_t rows_counted = 0;
        for (const Unit& unit : problem.units()) {
            const RowVector step = problem.inverse(unit, problem.of(unit, r));
            const double scale = step.norm() > 0 ? problem.of(unit, r).norm() / step.norm() : 0;
            sum += scale * problem.of(unit, z).lpNorm<1>();
            rows_counted += unit.rows;
        }
        return w.system.scheme.h * sum / static_cast<double>(std::max<size_t>(1, rows_counted));
    }

    void measure(World& w, uint32_t group, const Contender& contender, uint32_t count) {
        RowSettings rows;
        rows.stabilisation = 1;
        SolverSettings settings{count,   true,    0,     9.81 * 9.81, nullptr, nullptr,           nullptr,
                                nullptr, nullptr, false, 0,           rows,    contender.settings};
        SolverReport report;
        Substep substep{w.team,   w.system, w.partition.groups[group], w.partition.blocks, w.nodes, settings, report,
                        scratch_, true};
        const auto begin = std::chrono::steady_clock::now();
        contender.solver->solve(substep);
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
        const double left = error(w, rows);
        out_ << scene_ << ',' << contender.name << ',' << count << ',' << left << ',' << taken.count() << '\n';
        std::fprintf(stderr, "%-11s %-28s %4u iterations: %.3e m, %7.2f ms\n", scene_, contender.name, count, left,
                     taken.count());
    }

    std::ostream& out_;
    const char* scene_;
    SolverScratch& scratch_;
};

void look_at(const Plan& plan, std::ostream& out) {
    scenes::Scene scene = plan.make();
    scene.world.solver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL;
    scene.world.fixed_substeps = 1;
    scenes::TautWorld world(scene);
    for (int i = 0; i < plan.frames; ++i) world.step();
    Hold hold(world_of(world.world), Use::write);
    World& within = *hold.world();
    SolverScratch scratch(within.memory);
    Measurement measurement(out, plan.name, scratch);
    within.observer = &measurement;
    step(within);
    within.observer = nullptr;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: taut-solvers FOLDER\n");
        return 2;
    }
    try {
        const std::filesystem::path folder = argv[1];
        std::filesystem::create_directories(folder);
        std::ofstream out(folder / "solvers.csv");
        out.precision(6);
        out << "scene,solver,iterations,error_m,time_ms\n";
        for (const Plan& plan : kPlans) look_at(plan, out);
        out.close();
        if (!out) throw std::runtime_error("could not write solvers.csv");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
    return 0;
}
