// Time integration: implicit Euler, Newmark and BDF2 (Frâncu 2016, section 6.5) against the exact motion of springs,
// with every solver.
#include <array>
#include <cstdio>

#include "lab.h"
#include "starts.h"

namespace {

using namespace lab;

constexpr taut_body kWorld{0};

struct Way {
    taut_solver solver;
    taut_scheme scheme;
};

std::vector<Way> all_ways() {
    std::vector<Way> ways;
    for (uint32_t s = 0; s < TAUT_SOLVER_MINIMISATION; ++s)  // which takes no joints
        for (const taut_scheme scheme : {TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2})
            ways.push_back({static_cast<taut_solver>(s), scheme});
    return ways;
}

class SchemeOf : public testing::TestWithParam<Way> {
protected:
    // Steps of a length, without substeps, converged.
    std::function<void(taut_world_def&)> steps_of(double length) const {
        return [way = GetParam(), length](taut_world_def& def) {
            def.solver = way.solver;
            def.scheme = way.scheme;
            def.time_step = static_cast<float>(length);
            def.substeps = 1;
            def.fixed_substeps = 1;
            def.sweeps = def.solver == TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL ? 0 : 50;
            def.gravity = {};
        };
    }
};

std::string name_of(const testing::TestParamInfo<Way>& way) {
    constexpr const char* kNames[] = {"implicit_euler", "newmark", "bdf2"};
    return std::string(taut_solver_name(way.param.solver)) + "_" + kNames[way.param.scheme];
}

INSTANTIATE_TEST_SUITE_P(Every, SchemeOf, testing::ValuesIn(all_ways()), name_of);

constexpr double kMass = 2, kLength = 1, kAmplitude = 0.2, kOmega = 6;  // of a spring [kg, m, m, rad/s]

// A particle on a spring along which it swings: the most that it is off the exact motion in 2 s.
double error_of(const std::function<void(taut_world_def&)>& change, double step) {
    const World world(change);
    const taut_body body = world.particle(kMass, {kLength + kAmplitude, 0, 0});
    world.rod(kWorld, {}, body, {}, kLength, 1 / (kMass * kOmega * kOmega));
    double worst = 0;
    const int steps = static_cast<int>(std::lround(2 / step));
    for (int i = 1; i <= steps; ++i) {
        world.step();
        const double exact = kLength + kAmplitude * std::cos(kOmega * i * step);
        worst = std::max(worst, std::abs(position(body).x - exact));
    }
    return worst;
}

// Half the step, half the error of implicit Euler and a quarter of the others'.
TEST_P(SchemeOf, ConvergesWithItsOrder) {
    const double step = 1.0 / 256, whole = error_of(steps_of(step), step),
                 half = error_of(steps_of(step / 2), step / 2);
    const double order = std::log2(whole / half);
    const double expected = GetParam().scheme == TAUT_SCHEME_IMPLICIT_EULER ? 1 : 2;
    EXPECT_NEAR(order, expected, 0.2) << whole << " and " << half << " m";
}

// Of the spring, relative to what it had.
double energy_left(const std::function<void(taut_world_def&)>& change, int steps) {
    const World world(change);
    const taut_body body = world.particle(kMass, {kLength + kAmplitude, 0, 0});
    world.rod(kWorld, {}, body, {}, kLength, 1 / (kMass * kOmega * kOmega));
    world.step(steps);
    const double x = position(body).x - kLength, v = norm(velocity(body));
    return (x * x + v * v / (kOmega * kOmega)) / (kAmplitude * kAmplitude);
}

// Per step the amplitude shrinks by 1 / (1 + (omega h)^2) in implicit Euler, not at all in Newmark's, and BDF2 damps by
// the fourth power of omega h.
TEST_P(SchemeOf, KeepsEnergyAsItsEquationsSay) {
    const double step = 1.0 / 60, wh = kOmega * step;
    const int steps = 600;
    const double left = energy_left(steps_of(step), steps);
    const double expected[] = {std::pow(1 + wh * wh, -steps), 1, std::exp(-0.5 * std::pow(wh, 4) * steps)};
    const double within[] = {1e-3, 2e-3, 0.02};
    EXPECT_NEAR(left, expected[GetParam().scheme], within[GetParam().scheme]);
}

// Two particles on a spring that meets a wall: momentum is what the wall gave, and none comes after it.
TEST_P(SchemeOf, KeepsMomentumAfterAHit) {
    const World world([this](taut_world_def& def) {
        steps_of(1.0 / 60)(def);
        def.contact_events = 0;
    });
    world.add_ground();
    const taut_body low =
        world.add({.shape = world.sphere(0.1), .position = {0, 0.5, 0}, .velocity = {1, -2, 0}, .mass = 1});
    const taut_body high =
        world.add({.shape = world.sphere(0.1), .position = {0, 1.5, 0}, .velocity = {1, -2, 0}, .mass = 1});
    world.rod(low, {}, high, {}, 1, 1e-3);
    const auto momentum = [&] { return velocity(low) + velocity(high); };
    double up = 0;
    for (int i = 0; i < 90; ++i) {
        world.step();
        const bool clear = position(low).y > 0.15;
        if (clear && up == 0 && momentum().y > 0) up = momentum().y;
        if (!clear || up == 0) continue;
        EXPECT_NEAR(momentum().y, up, 2e-3) << "step " << i;
    }
    EXPECT_GT(up, 0.05);
}

// A square net of undamped springs, hung by two springs at its corners.
class Net {
public:
    explicit Net(const std::function<void(taut_world_def&)>& change) : world_(change) {
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                node_[i][j] = world_.particle(kNode, {kSpacing * i, 0, kSpacing * j});
            }
        for (const int i : {0, kSide - 1}) world_.rod(kWorld, hook(i), node_[i][0], {}, kSpacing, kCompliance);
        for_springs([&](taut_body a, taut_body b) { world_.rod(a, {}, b, {}, kSpacing, kCompliance); });
    }
    void step() { world_.step(); }
    // Kinetic, of the springs and of height.
    double energy() const {
        double sum = 0;
        for (const auto& row : node_)
            for (const taut_body node : row)
                sum += 0.5 * kNode * dot(velocity(node), velocity(node)) + kNode * kG * position(node).y;
        const auto add = [&](const Vec& a, const Vec& b) {
            const double stretch = norm(a - b) - kSpacing;
            sum += 0.5 / kCompliance * stretch * stretch;
        };
        for_springs([&](taut_body a, taut_body b) { add(position(a), position(b)); });
        for (const int i : {0, kSide - 1}) add(position(node_[i][0]), hook(i));
        return sum;
    }
    static int side() { return kSide; }
    Vec at(int i, int j) const { return position(node_[i][j]); }
    double height() const { return position(node_[kSide / 2][kSide - 1]).y; }

private:
    static constexpr int kSide = 8;
    static constexpr double kNode = 0.1, kSpacing = 0.25, kCompliance = 1e-2;

    static Vec hook(int i) { return {kSpacing * i, kSpacing, 0}; }
    template <class Visit>
    void for_springs(Visit visit) const {
        for (int i = 0; i < kSide; ++i)
            for (int j = 0; j < kSide; ++j) {
                if (i + 1 < kSide) visit(node_[i][j], node_[i + 1][j]);
                if (j + 1 < kSide) visit(node_[i][j], node_[i][j + 1]);
            }
    }

    World world_;
    taut_body node_[kSide][kSide];
};

// Lost in so many frames, and most ever gained, relative to the energy that the fall turned over.
std::pair<double, double> lost_and_gained(const std::function<void(taut_world_def&)>& change, int frames) {
    Net net(change);
    const double start = net.energy();
    double most = 0, deepest = 0;
    for (int frame = 0; frame < frames; ++frame) {
        net.step();
        most = std::max(most, net.energy() - start);
        deepest = std::min(deepest, net.height());
    }
    const double turned = 64 * 0.1 * kG * -0.5 * deepest;
    return {(start - net.energy()) / turned, most / turned};
}

TEST(Scheme, NewmarkKeepsTheEnergyOfASpringNet) {
    for (const taut_solver solver : {TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, TAUT_SOLVER_CONJUGATE_GRADIENTS}) {
        const auto with = [&](taut_scheme scheme, uint32_t substeps) {
            return lost_and_gained(
                [=](taut_world_def& def) {
                    def.solver = solver;
                    def.scheme = scheme;
                    def.substeps = substeps;
                    def.fixed_substeps = 1;
                    def.sweeps = 30;
                },
                asked_starts("all") ? 1200 : 300);
        };
        const auto [lost, gained] = with(TAUT_SCHEME_NEWMARK, 4);
        const auto [damped, none] = with(TAUT_SCHEME_IMPLICIT_EULER, 1);
        std::printf("%s: Newmark loses %.4f and gains %.4f, implicit Euler loses %.3f\n", taut_solver_name(solver),
                    lost, gained, damped);
        EXPECT_NEAR(lost, 0, 0.01);
        EXPECT_LE(gained, 0.01);
        EXPECT_GE(damped, 0.3);
        EXPECT_LE(none, 0.01);
    }
}

// Figure 8.11, from 30 to 240 Hz without substeps: with gamma = 0.55 and beta = (gamma + 1/2)^2 / 4 Newmark's scheme
// loses less than implicit Euler by either solver of the figure, and gains nothing.
TEST(Scheme, TunedNewmarkKeepsMoreOfARubberNetThanImplicitEuler) {
    constexpr float kGamma = 0.55f;
    for (const double hz : {30.0, 60.0, 120.0, 240.0}) {
        const auto with = [&](taut_solver solver, taut_scheme scheme) {
            return lost_and_gained(
                [=](taut_world_def& def) {
                    def.solver = solver;
                    def.scheme = scheme;
                    def.newmark_gamma = kGamma;
                    def.newmark_beta = 0.25f * (kGamma + 0.5f) * (kGamma + 0.5f);
                    def.time_step = static_cast<float>(1 / hz);
                    def.substeps = def.fixed_substeps = 1;
                    def.sweeps = 25;
                },
                static_cast<int>(5 * hz));
        };
        const double gradients = with(TAUT_SOLVER_CONJUGATE_GRADIENTS, TAUT_SCHEME_IMPLICIT_EULER).first,
                     projection = with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, TAUT_SCHEME_IMPLICIT_EULER).first;
        const auto [lost, gained] = with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL, TAUT_SCHEME_NEWMARK);
        std::printf("%g Hz: Newmark loses %.3f and gains %.1e, implicit Euler %.3f, by gradients %.3f\n", hz, lost,
                    gained, projection, gradients);
        EXPECT_LT(lost, 0.8 * std::min(gradients, projection));
        EXPECT_LE(gained, 1e-3);
    }
}

// Section 6.8: implicit integration of springs and projection with regularised constraints are one problem, whose
// primal and dual unknowns the two solve for. A quarter of a second of the falling net, both converged.
TEST(Scheme, EnergyFormAndRegularisedProjectionAgree) {
    const auto with = [](taut_solver solver) {
        return [=](taut_world_def& def) {
            def.solver = solver;
            def.substeps = 2;
            def.fixed_substeps = 1;
            def.sweeps = 300;
        };
    };
    Net energy(with(TAUT_SOLVER_CONJUGATE_GRADIENTS)), projection(with(TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL));
    double motion = 0, difference = 0;
    for (int frame = 0; frame < 15; ++frame) {
        energy.step();
        projection.step();
    }
    for (int i = 0; i < Net::side(); ++i)
        for (int j = 0; j < Net::side(); ++j) {
            difference = std::max(difference, norm(energy.at(i, j) - projection.at(i, j)));
            motion = std::max(motion, std::abs(energy.at(i, j).y));
        }
    EXPECT_LE(difference, 1e-6 * motion);
    EXPECT_GT(motion, 0.2);
}

}  // namespace
