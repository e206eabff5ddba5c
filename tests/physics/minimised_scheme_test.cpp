// Deformables by minimisation in each scheme: orders of convergence, energy, contacts, tangles, threads, statics.
#include <complex>
#include <random>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr const char* kNames[] = {"implicit_euler", "newmark", "bdf2"};
std::string name_of(const testing::TestParamInfo<taut_scheme>& of) { return kNames[of.param]; }

World minimising(taut_scheme scheme, double step, const std::function<void(taut_world_def&)>& change = {}) {
    return World([&](taut_world_def& def) {
        def.solver = TAUT_SOLVER_MINIMISATION;
        def.scheme = scheme;
        def.time_step = static_cast<float>(step);
        def.substeps = 1;
        def.minimise_tolerance = 1e-9f;
        if (change) change(def);
    });
}

class MinimisedScheme : public testing::TestWithParam<taut_scheme> {};
INSTANTIATE_TEST_SUITE_P(Every, MinimisedScheme,
                         testing::Values(TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2), name_of);

// ---------------------------------------------------------------- an oscillation

constexpr double kYoung = 1e3, kPoisson = 0.3, kDensity = 1000, kEdge = 0.2;  // [Pa, 1, kg/m^3, m]
constexpr double kLame = kYoung * kPoisson / (1 + kPoisson) / (1 - 2 * kPoisson), kShear = kYoung / 2 / (1 + kPoisson);

// One tetrahedron of a fixed corotated material on three vertices that are held; the fourth swings along its edge. With
// the stretch s along that W/V = mu (s - 1)^2 + lambda/2 (J - 1)^2, J = s: its force is linear, whatever the amplitude,
// and its mass a quarter of the cell's: omega^2 = 4 (lambda + 2 mu) / (rho L^2).
class Swing {
public:
    Swing(const World& world, double stretch) {
        const std::vector<taut_pos> rest = {{0, 0, 0}, {0, 0, kEdge}, {kEdge, 0, 0}, {0, kEdge, 0}};
        std::vector<taut_pos> points = rest;
        points[3].y *= stretch;
        const uint32_t cell[4] = {0, 1, 2, 3};
        taut_solid_def def;
        taut_solid_def_init(&def);
        def.material = TAUT_SOLID_FIXED_COROTATED;
        def.points = points.data();
        def.rest = rest.data();
        def.point_count = 4;
        def.cells = cell;
        def.corners = 4;
        def.cell_count = 1;
        def.young_modulus = static_cast<float>(kYoung);
        def.poisson_ratio = static_cast<float>(kPoisson);
        def.density = static_cast<float>(kDensity);
        def.filter.mask = 0;
        const taut_solid solid = add(world, def);
        for (uint32_t v = 0; v < 3; ++v) ok(taut_solid_pin(solid, v, 1));
        body_ = bodies_of(solid)[3];
    }
    double off() const { return position(body_).y - kEdge; }
    // Over what it is at an amplitude of 1 m.
    double energy() const {
        const double v = norm(velocity(body_)) / kOmega;
        return off() * off() + v * v;
    }
    static inline const double kOmega = std::sqrt(4 * (kLame + 2 * kShear) / kDensity) / kEdge;  // [rad/s]

private:
    taut_body body_{};
};
constexpr double kStretch = 1.3, kAmplitude = (kStretch - 1) * kEdge;

void float_free(taut_world_def& def) { def.gravity = {0, 0, 0}; }

// The most that it is off the exact motion in a second.
double error_of(taut_scheme scheme, int rate) {
    const World world = minimising(scheme, 1.0 / rate, float_free);
    const Swing swing(world, kStretch);
    double worst = 0;
    for (int i = 1; i <= rate; ++i) {
        world.step();
        worst = std::max(worst, std::abs(swing.off() - kAmplitude * std::cos(Swing::kOmega * i / rate)));
    }
    return worst;
}

TEST_P(MinimisedScheme, ConvergesWithItsOrder) {
    const double expected = GetParam() == TAUT_SCHEME_IMPLICIT_EULER ? 1 : 2;
    double before = 0;
    for (const int rate : {256, 512, 1024}) {
        const double now = error_of(GetParam(), rate);
        if (before > 0) {
            EXPECT_NEAR(std::log2(before / now), expected, 0.25) << before << " and " << now << " m";
        }
        before = now;
    }
    EXPECT_LT(before, expected == 1 ? 0.1 * kAmplitude : 1e-3 * kAmplitude);
}

// Per step implicit Euler's energy shrinks by 1 / (1 + (omega h)^2), Newmark's not at all, BDF2's by |z|^2 of
// (3/2 - i omega h) z^2 - 2 z + 1/2 = 0 after a first step by implicit Euler.
TEST_P(MinimisedScheme, KeepsEnergyAsItsEquationsSay) {
    const double step = 1.0 / 24, wh = Swing::kOmega * step;
    const World world = minimising(GetParam(), step, float_free);
    const Swing swing(world, kStretch);
    const double begin = swing.energy();
    world.step(48);
    const double left = swing.energy() / begin;
    const double damped = 1 / (1 + wh * wh);
    const std::complex<double> rate(1.5, -wh), root = (1.0 + std::sqrt(1.0 - 0.5 * rate)) / rate;
    const double expected[] = {std::pow(damped, 48), 1, damped * std::pow(std::norm(root), 47)};
    const double within[] = {1e-3, 1e-4, 0.1};
    EXPECT_NEAR(left, expected[GetParam()], within[GetParam()]);
}

// ---------------------------------------------------------------- solids

// A cube of St. Venant and Kirchhoff's material, whose energy is known.
class Cube {
public:
    Cube(const World& world, const Vec& corner, double young, double damping, double stretch = 1, double friction = 0.5)
        : young_(young), beam_({0.4, 0.4, 0.4}, 4, 4, 4, false) {
        for (taut_pos& p : beam_.points) p = (Vec(p) + corner).pos();
        taut_solid_def def = beam_.def(TAUT_SOLID_ST_VENANT_KIRCHHOFF, young, kPoisson);
        std::vector<taut_pos> points = beam_.points;
        for (taut_pos& p : points) p.x *= stretch;
        def.rest = beam_.points.data();
        def.points = points.data();
        def.density = static_cast<float>(kDensity);
        def.damping = static_cast<float>(damping);
        def.surface.friction = static_cast<float>(friction);
        solid = add(world, def);
        bodies_ = bodies_of(solid);
    }
    // Of motion, strain and height [J].
    double energy(double gravity) const {
        double sum = strain_energy();
        for (const taut_body body : bodies_) {
            const double mass = mass_of(body).mass;
            sum += mass * (0.5 * dot(velocity(body), velocity(body)) + gravity * position(body).y);
        }
        return sum;
    }
    double least_height() const {
        double least = 1e9;
        for (const Vec& p : points_of(solid)) least = std::min(least, p.y);
        return least;
    }
    double mass() const {
        double sum = 0;
        for (const taut_body body : bodies_) sum += mass_of(body).mass;
        return sum;
    }
    const std::vector<taut_body>& bodies() const { return bodies_; }

    taut_solid solid{};

private:
    // W = V (mu E : E + lambda/2 tr(E)^2), E = (F^T F - 1)/2.
    double strain_energy() const {
        const double shear = young_ / 2 / (1 + kPoisson), lame = 2 * shear * kPoisson / (1 - 2 * kPoisson);
        const std::vector<Vec> at = points_of(solid);
        double sum = 0;
        for (size_t c = 0; c < beam_.cells.size(); c += 4) {
            const uint32_t* const node = &beam_.cells[c];
            Vec rest[3], now[3];
            for (int k = 0; k < 3; ++k) {
                rest[k] = Vec(beam_.points[node[k + 1]]) - Vec(beam_.points[node[0]]);
                now[k] = at[node[k + 1]] - at[node[0]];
            }
            const double six = dot(rest[0], cross(rest[1], rest[2]));
            // Dual edges: F = sum now_k dual_k^T.
            const Vec dual[3] = {1 / six * cross(rest[1], rest[2]), 1 / six * cross(rest[2], rest[0]),
                                 1 / six * cross(rest[0], rest[1])};
            const auto row = [](const Vec& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; };
            double squares = 0, trace = 0;
            for (int i = 0; i < 3; ++i)
                for (int k = 0; k < 3; ++k) {
                    double e = i == k ? -0.5 : 0;
                    for (int a = 0; a < 3; ++a)
                        for (int b = 0; b < 3; ++b) e += 0.5 * row(dual[a], i) * row(dual[b], k) * dot(now[a], now[b]);
                    squares += e * e;
                    trace += i == k ? e : 0;
                }
            sum += std::abs(six) / 6 * (shear * squares + 0.5 * lame * trace * trace);
        }
        return sum;
    }

    double young_;
    Beam beam_;
    std::vector<taut_body> bodies_;
};

// A cube let go a fiftieth longer than it is, at a film's rate for two seconds.
TEST(MinimisedSchemes, NewmarkKeepsTheEnergyOfASolid) {
    double left[3];
    for (const taut_scheme scheme : {TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK, TAUT_SCHEME_BDF2}) {
        const World world = minimising(scheme, 1.0 / 24, float_free);
        const Cube cube(world, {0, 0, 0}, 1e4, 0, 1.02);
        const double begin = cube.energy(0);
        double most = 0;
        for (int i = 0; i < 48; ++i) {
            world.step();
            most = std::max(most, cube.energy(0) / begin);
        }
        left[scheme] = cube.energy(0) / begin;
        std::printf("%s keeps %.4f, at most %.4f\n", kNames[scheme], left[scheme], most);
        EXPECT_LT(most, scheme == TAUT_SCHEME_NEWMARK ? 1.05 : 1 + 1e-6) << kNames[scheme];
    }
    EXPECT_NEAR(left[TAUT_SCHEME_NEWMARK], 1, 0.05);
    EXPECT_LT(left[TAUT_SCHEME_IMPLICIT_EULER], 0.2);
    EXPECT_GT(left[TAUT_SCHEME_BDF2], left[TAUT_SCHEME_IMPLICIT_EULER]);
}

// ---------------------------------------------------------------- contacts

class SchemeAtRate : public testing::TestWithParam<std::tuple<taut_scheme, double>> {};
INSTANTIATE_TEST_SUITE_P(Hertz, SchemeAtRate,
                         testing::Combine(testing::Values(TAUT_SCHEME_IMPLICIT_EULER, TAUT_SCHEME_NEWMARK,
                                                          TAUT_SCHEME_BDF2),
                                          testing::Values(24.0, 60.0, 240.0)),
                         [](const auto& of) {
                             return std::string(kNames[std::get<0>(of.param)]) + "_" +
                                    std::to_string(static_cast<int>(std::get<1>(of.param)));
                         });

// A cube that falls on the ground gains no energy, and no vertex of it sinks in.
TEST_P(SchemeAtRate, CubeBouncesWithoutGain) {
    const auto& [scheme, rate] = GetParam();
    const World world = minimising(scheme, 1 / rate);
    world.add_ground();
    const Cube cube(world, {0, 0.3, 0}, 1e5, 0);
    const double begin = cube.energy(kG), fallen = cube.mass() * kG * 0.3;
    double most = 0;
    for (int i = 0; i < 3 * rate; ++i) {
        world.step();
        most = std::max(most, (cube.energy(kG) - begin) / fallen);
        ASSERT_GE(cube.least_height(), -1e-9);
    }
    EXPECT_LT(most, 1e-3);
}

// Damped it rests, without a speed, and the ground bears its weight.
TEST_P(SchemeAtRate, CubeRestsOnTheGround) {
    const auto& [scheme, rate] = GetParam();
    const World world = minimising(scheme, 1 / rate);
    world.add_ground();
    const Cube cube(world, {0, 0.05, 0}, 1e5, 0.05);
    world.step(static_cast<int>(3 * rate));
    double impulse = 0;
    for (const taut_contact& contact : world.contacts()) impulse += contact.normal_impulse;
    EXPECT_NEAR(impulse * rate, cube.mass() * kG, 0.01 * cube.mass() * kG);
    EXPECT_LT(norm(momentum_of(cube.bodies())), 1e-3 * cube.mass());
    EXPECT_LT(cube.least_height(), 0.02);
}

// On a slope of 0.4 rad it slides with g (sin - mu cos): friction knows what the ground bears.
TEST_P(MinimisedScheme, CubeSlides) {
    constexpr double kSlope = 0.4, kFriction = 0.2;
    const World world = minimising(GetParam(), 1.0 / 60, [](taut_world_def& def) {
        def.gravity = {static_cast<float>(kG * std::sin(kSlope)), static_cast<float>(-kG * std::cos(kSlope)), 0};
    });
    world.add_ground(kFriction);
    const Cube cube(world, {0, 0.003, 0}, 1e6, 0.02, 1, kFriction);
    world.step(60);
    const double before = momentum_of(cube.bodies()).x / cube.mass();
    world.step(60);
    const double grew = momentum_of(cube.bodies()).x / cube.mass() - before;
    EXPECT_NEAR(grew, kG * (std::sin(kSlope) - kFriction * std::cos(kSlope)), 0.02 * kG);
}

// Two cubes that meet: penalties give both what they take from each other, and no energy.
TEST_P(SchemeAtRate, CubesMeetAndPart) {
    const auto& [scheme, rate] = GetParam();
    const World world = minimising(scheme, 1 / rate, float_free);
    const Cube one(world, {0, 0, 0}, 1e5, 0), other(world, {0.5, 0.05, 0.03}, 1e5, 0);
    set_velocities(one.bodies(), {1.5, 0, 0});
    const double begin = one.energy(0) + other.energy(0), mass = one.mass();
    double most = 0;
    for (int i = 0; i < rate; ++i) {
        world.step();
        most = std::max(most, (one.energy(0) + other.energy(0)) / begin - 1);
    }
    EXPECT_LT(most, 1e-3);
    const Vec all = momentum_of(one.bodies()) + momentum_of(other.bodies());
    EXPECT_LT(norm(all - Vec{1.5 * mass, 0, 0}), 1e-3 * mass);
    EXPECT_GT(momentum_of(other.bodies()).x, momentum_of(one.bodies()).x);
}

// ---------------------------------------------------------------- the rest

// A cube of 7^3 vertices anywhere within it, in steps of a film's frames. Newmark's keeps what energy a tangle has, and
// with it the tangle.
TEST(MinimisedSchemes, Bdf2UntanglesACube) {
    for (const auto& [young, frames] : {std::pair(1e7, 1), {1e5, 40}}) {
        const World world = minimising(TAUT_SCHEME_BDF2, 1.0 / 24, [](taut_world_def& def) {
            float_free(def);
            def.minimise_tolerance = 1e-6f;
        });
        const Beam cube({1, 1, 1}, 7, 7, 7, false);
        taut_solid_def def = cube.def(TAUT_SOLID_FIXED_COROTATED, young, kPoisson);
        std::vector<taut_pos> points(cube.points.size());
        std::mt19937_64 random(1);
        const auto unit = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
        for (taut_pos& p : points) p.x = unit(), p.y = unit(), p.z = unit();
        def.rest = def.points;
        def.points = points.data();
        def.filter.mask = 0;
        const taut_solid solid = add(world, def);
        int frame = 0, inverted = 1;
        for (; frame < frames && inverted > 0; ++frame) {
            world.step();
            uint32_t count = 0;
            taut_solid_get_volumes(solid, nullptr, 0, &count);
            std::vector<float> volume(count);
            ok(taut_solid_get_volumes(solid, volume.data(), count, &count));
            inverted = static_cast<int>(std::ranges::count_if(volume, [](float each) { return !(each > 0); }));
        }
        EXPECT_EQ(inverted, 0) << young;
    }
}

TEST_P(MinimisedScheme, HasTheSameBitsOnAnyTeam) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        const World world = minimising(GetParam(), 1.0 / 24, [&](taut_world_def& def) { def.threads = threads; });
        world.add_ground();
        const Cube low(world, {0, 0.1, 0}, 1e5, 0.01), high(world, {0.05, 0.6, 0}, 1e5, 0.01);
        world.step(12);
        uint64_t hash = 0;
        ok(taut_world_get_state_hash(world.handle, &hash));
        hashes.push_back(hash);
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

// Where statics leave a beam, it stays.
TEST_P(MinimisedScheme, StaysWhereItRests) {
    const World world = minimising(GetParam(), 1.0 / 60);
    const Beam beam({0.5, 0.1, 0.1}, 6, 2, 2, false);
    taut_solid_def def = beam.def(TAUT_SOLID_FIXED_COROTATED, 1e5, kPoisson);
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    world.step(3);
    taut_relaxation done{};
    ok(taut_world_relax(world.handle, 1e-6f, 5000, &done));
    ASSERT_EQ(done.converged, 1u);
    const std::vector<Vec> before = points_of(solid);
    world.step(30);
    const std::vector<Vec> after = points_of(solid);
    for (size_t v = 0; v < before.size(); ++v) EXPECT_LT(norm(after[v] - before[v]), 1e-6) << v;
}

}  // namespace
