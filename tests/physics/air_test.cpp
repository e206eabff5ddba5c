// Drag and lift of cloths and solids against the laws that they state.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr double kAir = 1.2;  // [kg/m^3]

struct AirCase {
    double hz;
    taut_cloth_kind kind = TAUT_CLOTH_TRIANGLES;
    taut_deformable_solve solve = TAUT_DEFORMABLE_DIRECT;
    taut_solver solver = TAUT_SOLVER_BLOCK_LDLT;
};

std::string name_of(const AirCase& of) {
    return std::to_string(static_cast<int>(of.hz)) + "_" + (of.kind == TAUT_CLOTH_LINKS ? "links" : "triangles") +
           (of.solve == TAUT_DEFORMABLE_SWEPT ? "_swept_" : "_direct_") + taut_solver_name(of.solver);
}
auto named = [](const auto& each) { return name_of(each.param); };

std::vector<AirCase> air_cases() {
    std::vector<AirCase> out;
    for (const double hz : {30.0, 60.0, 120.0, 240.0})
        for (const taut_cloth_kind kind : {TAUT_CLOTH_TRIANGLES, TAUT_CLOTH_LINKS})
            for (const taut_deformable_solve solve : {TAUT_DEFORMABLE_DIRECT, TAUT_DEFORMABLE_SWEPT})
                out.push_back({hz, kind, solve});
    for (int solver = 1; taut_solver_name(static_cast<taut_solver>(solver)); ++solver)  // each in its own way
        out.push_back({60, TAUT_CLOTH_TRIANGLES, TAUT_DEFORMABLE_DIRECT, static_cast<taut_solver>(solver)});
    return out;
}

struct Blown {
    explicit Blown(const AirCase& of, const Vec& gravity = {}, const Vec& wind = {})
        : world([&](taut_world_def& def) {
              def.time_step = static_cast<float>(1 / of.hz);
              def.gravity = gravity.narrow();
              def.wind = wind.narrow();
              def.solver = of.solver;
          }) {}
    void run(double seconds) const { world.step(static_cast<int>(std::lround(seconds / world.frame()))); }

    World world;
};

taut_cloth_def light_sheet(const Sheet& sheet, const AirCase& of) {
    taut_cloth_def def = sheet.def(of.kind);
    def.solve = of.solve;
    def.area_density = 0.05f;
    def.air_drag = 1.2f;
    def.filter.mask = 0;
    return def;
}

class Air : public testing::TestWithParam<AirCase> {};
INSTANTIATE_TEST_SUITE_P(Of, Air, testing::ValuesIn(air_cases()), named);

// dv/dt = -k v^2: v = v_0/(1 + k v_0 t), k = rho C_d/(2 m), whatever the step.
TEST_P(Air, SlowsAFreeSheetAsTheLawSays) {
    const Blown of(GetParam());
    const Sheet sheet(4, 4, 1, 1, 0);
    const taut_cloth cloth = add(of.world, light_sheet(sheet, GetParam()));
    const std::vector<taut_body> bodies = bodies_of(cloth);
    set_velocities(bodies, {0, 20, 0});
    of.run(0.2);
    const double k = 0.5 * kAir * 1.2 / 0.05;
    for (const taut_body body : bodies) EXPECT_NEAR(velocity(body).y, 20 / (1 + k * 20 * 0.2), 2e-4);
}

// A sheet that falls level comes to sqrt(2 m g/(rho C_d)), m of a square metre.
TEST_P(Air, LetsASheetFallAtItsTerminalVelocity) {
    const Blown of(GetParam(), {0, -kG, 0});
    const Sheet sheet(4, 4, 1, 1, 0);
    const taut_cloth cloth = add(of.world, light_sheet(sheet, GetParam()));
    of.run(2);
    for (const taut_body body : bodies_of(cloth))
        EXPECT_NEAR(velocity(body).y, -std::sqrt(2 * 0.05 * kG / (kAir * 1.2)), 1e-3);
}

// Two components of the force on a sheet that stands at an angle to the wind, from the first short step of a heavy one.
TEST(AirForce, IsDragAlongTheWindAndLiftAcrossIt) {
    constexpr double kDrag = 1.5, kLift = 0.9, kWind = 10, kMass = 100;
    for (const double angle : {0.1, 0.5, 1.0, 1.5}) {
        const Blown of({1000}, {}, {kWind, 0, 0});
        Sheet sheet(3, 3, 1, 1, 0);
        for (taut_pos& p : sheet.points) p = {p.x * std::cos(angle), -p.x * std::sin(angle), p.z};
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        def.area_density = kMass;
        def.air_drag = static_cast<float>(kDrag);
        def.air_lift = static_cast<float>(kLift);
        def.filter.mask = 0;
        const taut_cloth cloth = add(of.world, def);
        of.world.step();
        const Vec force = 1 / of.world.frame() * momentum_of(bodies_of(cloth));
        const double q = 0.5 * kAir * kWind * kWind, s = std::sin(angle), c = std::cos(angle);
        EXPECT_NEAR(force.x, q * kDrag * s, 1e-3 * q) << angle;
        EXPECT_NEAR(force.y, q * kLift * s * c, 1e-3 * q) << angle;
        EXPECT_NEAR(force.z, 0, 1e-4 * q) << angle;
    }
}

// Of what is closed the outer side alone: a ball is as wide as its shadow, of whatever it is made.
TEST(AirForce, OnABallIsThatOfItsShadow) {
    constexpr double kRadius = 0.5, kWind = 12;
    for (const bool inward : {false, true}) {
        const Blown of({1000}, {}, {0, 0, kWind});
        Ball ball(kRadius, 3);
        if (inward)
            for (size_t t = 0; t < ball.triangles.size(); t += 3) std::swap(ball.triangles[t], ball.triangles[t + 1]);
        taut_cloth_def def = ball.def();
        def.area_density = 100;
        def.air_drag = 0.5f;
        def.filter.mask = 0;
        const taut_cloth cloth = add(of.world, def);
        of.world.step();
        const double force = momentum_of(bodies_of(cloth)).z / of.world.frame();
        EXPECT_NEAR(force, 0.5 * kAir * 0.5 * kPi * kRadius * kRadius * kWind * kWind, 0.02 * force);
    }
}
TEST(AirForce, OnASolidIsThatOfTheFaceTowardsTheWind) {
    const Blown of({1000}, {}, {10, 0, 0});
    const Beam beam({1, 0.4, 0.5}, 4, 3, 3, false);
    taut_solid_def def = beam.def(TAUT_SOLID_NEO_HOOKEAN, 1e6, 0.3);
    def.air_drag = 1;
    def.filter.mask = 0;
    const taut_solid solid = add(of.world, def);
    of.world.step();
    const Vec force = 1 / of.world.frame() * momentum_of(bodies_of(solid));
    EXPECT_NEAR(force.x, 0.5 * kAir * 0.2 * 100, 0.02);
    EXPECT_NEAR(force.y, 0, 0.02);
}

// What is held bears all of the force at any rate of steps: a bar under water in a stream gets shorter by F L/(E A).
TEST(AirForce, OnWhatIsHeldDoesNotKnowTheStep) {
    constexpr double kYoung = 1e6, kSpeed = 6, kWater = 1000;
    for (const double hz : {30.0, 120.0}) {
        World world([&](taut_world_def& def) {
            def.time_step = static_cast<float>(1 / hz);
            def.gravity = {0, 0, 0};
            def.air_density = static_cast<float>(kWater);
            def.wind = {static_cast<float>(-kSpeed), 0, 0};
        });
        const Beam bar({1, 0.2, 0.2}, 11, 3, 3, true);
        taut_solid_def def = bar.def(TAUT_SOLID_ST_VENANT_KIRCHHOFF, kYoung, 0);
        def.density = 100;
        def.air_drag = 1;
        def.damping = 0.02f;
        def.filter.mask = 0;
        const taut_solid solid = add(world, def);
        bar.hold(solid);
        world.step(static_cast<int>(hz));
        const std::vector<Vec> x = points_of(solid);
        const double end = x[bar.at(10, 1, 1)].x;
        const double stress = 0.5 * kWater * kSpeed * kSpeed / kYoung;  // over E; Green strain e + e^2/2 softens
        double strain = -stress;
        for (int i = 0; i < 20; ++i) strain = -stress / ((1 + strain) * (1 + strain / 2));
        EXPECT_NEAR(end - 1, strain, 0.01 * stress) << hz;
    }
}

class Storm : public testing::TestWithParam<AirCase> {};
INSTANTIATE_TEST_SUITE_P(Of, Storm, testing::ValuesIn(air_cases()), named);
class Flag : public Storm {};
INSTANTIATE_TEST_SUITE_P(Of, Flag,
                         testing::Values(AirCase{30}, AirCase{60}, AirCase{240}, AirCase{30, TAUT_CLOTH_LINKS},
                                         AirCase{240, TAUT_CLOTH_LINKS}),
                         named);

// Against the air a free cloth only loses energy, whichever way the wind turns, and never overtakes it.
TEST_P(Storm, GivesAFreeClothNoEnergyAgainstTheAir) {
    const Blown of(GetParam());
    Sheet sheet(7, 7, 1, 1, 0);
    for (size_t i = 0; i < sheet.points.size(); ++i)
        sheet.points[i].y = 0.1 * std::sin(3 * sheet.points[i].x + 1.7 * sheet.points[i].z * sheet.points[i].z);
    const taut_cloth cloth = add(of.world, light_sheet(sheet, GetParam()));
    const std::vector<taut_body> bodies = bodies_of(cloth);
    for (const Vec& wind : {Vec(50, 0, 0), Vec(0, 0, 50), Vec(-30, 40, 0), Vec(0, -50, 0)}) {
        ok(taut_world_set_wind(of.world.handle, wind.narrow()));
        const auto against = [&] {
            double sum = 0;
            for (const taut_body body : bodies) {
                const Vec w = velocity(body) - wind;
                sum += 0.5 * mass_of(body).mass * dot(w, w);
            }
            return sum;
        };
        const double first = against();
        // What the links and triangles hold from the last wind joins it.
        const double stored = 0.05 * first;
        for (int i = 0; i < static_cast<int>(0.25 * GetParam().hz); ++i) {
            of.world.step();
            ASSERT_LE(against(), first + stored);
        }
        double mass = 0;
        for (const taut_body body : bodies) mass += mass_of(body).mass;
        const Vec mean = 1 / mass * momentum_of(bodies);
        EXPECT_LE(dot(mean, unit(wind)), 50 * 1.001);
        EXPECT_GE(dot(mean, unit(wind)), 25);
    }
}

// One as light as silk, in a gale that turns four times a second.
TEST_P(Flag, StaysWithinTheSpeedsOfTheAir) {
    const Blown of(GetParam(), {0, -kG, 0});
    const Sheet sheet(9, 9, 1, 1, 0);
    taut_cloth_def def = light_sheet(sheet, GetParam());
    def.air_lift = 1;
    const taut_cloth cloth = add(of.world, def);
    for (int k = 0; k < 9; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
    const std::vector<taut_body> bodies = bodies_of(cloth);
    double fastest = 0;
    for (int i = 0; i < static_cast<int>(2 * GetParam().hz); ++i) {
        const double turn = std::floor(4 * i / GetParam().hz) * 1.1;
        ok(taut_world_set_wind(of.world.handle, Vec(50 * std::cos(turn), 10, 50 * std::sin(turn)).narrow()));
        of.world.step();
        for (const taut_body body : bodies) fastest = std::max(fastest, norm(velocity(body)));
    }
    EXPECT_LE(fastest, 2 * 51);
    EXPECT_GE(fastest, 5);
}

}  // namespace
