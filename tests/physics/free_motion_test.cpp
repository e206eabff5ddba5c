// Bodies that nothing touches: parabola, tumbling, and chains in free space.
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

struct Throw {
    const char* name;
    bool particle;
    uint32_t substeps;
    double gravity_scale;
};

void PrintTo(const Throw& t, std::ostream* out) { *out << t.name; }

class Projectile : public testing::TestWithParam<Throw> {};

// Symplectic Euler of step h, exactly: v_n = v_0 + n h g,  x_n = x_0 + n h v_0 + n (n + 1) / 2 h^2 g.
TEST_P(Projectile, FollowsTheStepsClosedFormAndTheParabolaToFirstOrder) {
    const Throw& t = GetParam();
    const Vec x0(1000, 2, -3), v0(3, 8, -1.5);
    World world([&](taut_world_def& def) { def.substeps = t.substeps; });
    const taut_body body = t.particle ? world.particle(2, x0, v0, t.gravity_scale)
                                      : world.add({.shape = world.box({0.5, 0.3, 0.1}),
                                                   .position = x0,
                                                   .velocity = v0,
                                                   .spin = {1, 2, 3},
                                                   .gravity_scale = t.gravity_scale});
    const Vec g = t.gravity_scale * Vec(world.def.gravity);
    const double h = static_cast<double>(world.def.time_step) / t.substeps;
    for (int frame = 1; frame <= 300; ++frame) {
        world.step();
        const double time = world.stepped(frame), n = time / h;
        const Vec exact = x0 + time * v0 + n * (n + 1) / 2 * h * h * g, parabola = x0 + time * v0 + time * time / 2 * g;
        const Vec moved = position(body) - x0;
        ASSERT_LT(norm(moved - (exact - x0)), 1e-9 * (1 + norm(exact - x0))) << "frame " << frame;
        ASSERT_NEAR(norm(position(body) - parabola), h / 2 * time * norm(g), 1e-6 * (1 + norm(exact - x0)));
        ASSERT_LT(norm(velocity(body) - (v0 + time * g)), 1e-6 * (1 + norm(v0 + time * g)));
    }
}

INSTANTIATE_TEST_SUITE_P(Thrown, Projectile,
                         testing::Values(Throw{"particle", true, 4, 1}, Throw{"box", false, 4, 1},
                                         Throw{"one_substep", false, 1, 1}, Throw{"upwards", true, 4, -0.5}),
                         [](const auto& tested) { return tested.param.name; });

struct Tumble {
    const char* name;
    Vec axis;  // body axes
};

void PrintTo(const Tumble& t, std::ostream* out) { *out << t.name; }

class FreeSpin : public testing::TestWithParam<Tumble> {};

TEST_P(FreeSpin, KeepsMomentaAndEnergy) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Quat turn = Quat::turn({1, 2, 3}, 0.7);
    const Vec v0(1, -2, 0.5), x0(3, 1, -2);
    const taut_body body = world.add({.shape = world.box({0.5, 0.3, 0.1}),
                                      .position = x0,
                                      .rotation = turn,
                                      .velocity = v0,
                                      .spin = turn.rotate(GetParam().axis),
                                      .mass = 7});
    const Totals start = totals({body});
    auto energy = [](const Totals& t) {
        return t.kinetic - dot(t.momentum, t.momentum) / (2 * t.mass);
    };  // of the spin
    double worst_l = 0, worst_e = 0;
    for (int frame = 1; frame <= 600; ++frame) {
        world.step();
        const Totals now = totals({body});
        worst_l = std::max(worst_l, norm(now.spin - start.spin) / norm(start.spin));
        worst_e = std::max(worst_e, std::abs(energy(now) / energy(start) - 1));
        ASSERT_LT(norm(now.momentum - start.momentum), 1e-6 * norm(start.momentum));
        ASSERT_LT(norm(now.centre - x0 - world.stepped(frame) * v0), 1e-9);
    }
    const Totals end = totals({body});
    EXPECT_NEAR(norm(end.spin) / norm(start.spin), 1, 0.005);
    EXPECT_NEAR(energy(end) / energy(start), 1, 0.02);
    RecordProperty("momentum_vector_error", std::to_string(worst_l));
    RecordProperty("energy_error", std::to_string(worst_e));
}

INSTANTIATE_TEST_SUITE_P(About, FreeSpin,
                         testing::Values(Tumble{"least_axis", {5, 0, 0}}, Tumble{"intermediate_axis", {1e-3, 5, 1e-3}},
                                         Tumble{"largest_axis", {0, 0, 5}}, Tumble{"no_axis", {3, 2, 4}}),
                         [](const auto& tested) { return tested.param.name; });

// At a thousand radians a second and more, where a substep turns it by several.
TEST(FreeSpin, NeverGainsEnergyOrMomentum) {
    std::mt19937 random(1);
    for (int start = 0; start < 60; ++start) {
        World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const double speed = std::pow(10, between(random, 2.7, 4));
        const taut_body body = world.add({.shape = world.box({0.1, start % 2 ? 0.015 : 0.07, 0.07}),
                                          .rotation = Quat::turn(random_direction(random), between(random, 0, kPi)),
                                          .spin = speed * random_direction(random)});
        const Totals before = totals({body});
        world.step(240);
        const Totals after = totals({body});
        EXPECT_LT(after.kinetic / before.kinetic, 1.001) << "start " << start << ", " << speed << " rad/s";
        EXPECT_GT(after.kinetic / before.kinetic, 0.3) << "start " << start << ", " << speed << " rad/s";
        EXPECT_LT(norm(after.spin) / norm(before.spin), 1.001) << "start " << start << ", " << speed << " rad/s";
    }
}

// A symmetric top precesses about its angular momentum at |L| / I_transverse (Landau, Lifshitz, section 33).
TEST(FreeSpin, SymmetricTopPrecessesAtItsRate) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const double transverse = 0.5, axial = 0.9;  // [kg m^2]
    const Vec spin(1.0, 0, 4.0);
    const taut_body body = world.add({.spin = spin, .mass = 1, .inertia = {transverse, transverse, axial}});
    const Vec momentum(transverse * spin.x, 0, axial * spin.z), up = unit(momentum);
    const double exact = 2 * kPi * transverse / norm(momentum);
    const Vec side = unit(cross(up, {1, 0, 0}));
    Crossings crossings;
    for (int frame = 1; frame <= 600; ++frame) {
        world.step();
        crossings.sample(frame * world.frame(), dot(state(body).rotation.rotate({0, 0, 1}), side));
    }
    EXPECT_NEAR(crossings.period() / exact, 1, 0.005);
}

struct FreeChain {
    const char* name;
    bool sphere, tumbles;
    double last_mass;
};

void PrintTo(const FreeChain& c, std::ostream* out) { *out << c.name; }

class ChainInSpace : public testing::TestWithParam<FreeChain> {};

TEST_P(ChainInSpace, KeepsMomentaAndEnergyForTenSeconds) {
    const FreeChain& plan = GetParam();
    constexpr int kLinks = 10;
    constexpr double kLink = 0.5;
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const double along = (0.2 * 0.2 + 0.2 * 0.2) / 12, across = (kLink * kLink + 0.2 * 0.2) / 12;
    auto mass = [&](int i) { return i + 1 == kLinks ? plan.last_mass : 1.0; };
    double middle = 0, total = 0;
    for (int i = 0; i < kLinks; ++i) middle += mass(i) * i * kLink, total += mass(i);
    middle /= total;
    // Joint-compatible velocities: each link's own spin, positions strung together, then the drift taken out.
    auto spin = [&](int i) {
        return plan.tumbles ? Vec(2 * std::sin(1.3 * i), 5 + 3 * std::cos(2.0 * i), 2 * std::cos(0.7 * i))
                            : Vec(0, 5, 0);
    };
    std::vector<Vec> velocities;
    Vec at_joint, drift;
    for (int i = 0; i < kLinks; ++i) {
        const Vec lever = cross(spin(i), {kLink / 2, 0, 0});
        velocities.push_back(at_joint + lever);
        drift += mass(i) / total * velocities.back();
        at_joint = at_joint + 2 * lever;
    }
    std::vector<taut_body> links;
    for (int i = 0; i < kLinks; ++i) {
        const Vec inertia = mass(i) * (plan.sphere ? Vec(across, across, across) : Vec(along, across, across));
        links.push_back(world.add({.position = {i * kLink - middle, 0, 0},
                                   .velocity = velocities[static_cast<size_t>(i)] - drift,
                                   .spin = spin(i),
                                   .mass = mass(i),
                                   .inertia = inertia}));
        if (i > 0) world.ball(links[static_cast<size_t>(i - 1)], {kLink / 2, 0, 0}, links.back(), {-kLink / 2, 0, 0});
    }
    const Totals start = totals(links);
    const Vec speed = 1 / start.mass * start.momentum;  // of rounding the velocities to float
    world.step(600);
    const Totals end = totals(links);
    EXPECT_NEAR(norm(end.spin) / norm(start.spin), 1, 0.005);
    EXPECT_NEAR(end.kinetic / start.kinetic, 1, 0.02);
    EXPECT_LT(norm(end.centre - start.centre - 600 * world.frame() * speed), 1e-9) << "linear momentum";
    RecordProperty("spin_ratio", std::to_string(norm(end.spin) / norm(start.spin)));
    RecordProperty("energy_ratio", std::to_string(end.kinetic / start.kinetic));
    RecordProperty("centre_moved",
                   std::to_string(1e12 * norm(end.centre - start.centre - 600 * world.frame() * speed)));
}

// Particles on rods: what geometric stiffness spares is the turning of each rod, which a rigid spin does not change.
TEST(ParticlesInSpace, KeepTheirMomenta) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    std::vector<taut_body> points;
    for (int i = 0; i < 10; ++i) {
        const double x = 0.5 * (i - 4.5);
        points.push_back(world.particle(1, {x, 0, 0}, {0, 0, -5 * x}));
        if (i > 0) world.rod(points[static_cast<size_t>(i - 1)], {}, points.back(), {}, 0.5);
    }
    const Totals start = totals(points);
    world.step(600);
    const Totals end = totals(points);
    EXPECT_NEAR(norm(end.spin) / norm(start.spin), 1, 0.0005);
    EXPECT_NEAR(end.kinetic / start.kinetic, 1, 0.001);
    EXPECT_LT(norm(end.centre - start.centre), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Of, ChainInSpace,
                         testing::Values(FreeChain{"spheres", true, false, 1}, FreeChain{"rods", false, false, 1},
                                         FreeChain{"tumbling_spheres", true, true, 1},
                                         FreeChain{"tumbling_rods", false, true, 1},
                                         FreeChain{"spheres_and_1000kg", true, false, 1000},
                                         FreeChain{"rods_and_1000kg", false, false, 1000}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
