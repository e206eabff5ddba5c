// Rayleigh's damping of deformables: the decay of single modes, what hangs and what falls.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

struct RayleighCase {
    double hz, mass, stiffness;  // [1/s], alpha [1/s], beta [s]
};
void PrintTo(const RayleighCase& of, std::ostream* out) {
    *out << "at_" << of.hz << "_by_" << (of.mass > 0 ? "mass" : "") << (of.stiffness > 0 ? "stiffness" : "");
}

class Rayleigh : public testing::TestWithParam<RayleighCase> {
protected:
    // Rate of decay of one freedom that swings freely [1/s]: of a linear map of two states x_n x_n+2 - x_n+1^2 goes by
    // its determinant in each step, whatever the phase.
    template <class Read>
    static double rate_of(const World& world, Read&& read) {
        constexpr int kSteps = 8;
        std::vector<double> x;
        for (int i = 0; i < kSteps + 3; ++i) {
            x.push_back(read());
            world.step();
        }
        const auto d = [&](int i) {
            const auto n = static_cast<size_t>(i);
            return x[n] * x[n + 2] - x[n + 1] * x[n + 1];
        };
        return -0.5 * std::log(d(kSteps) / d(0)) / (kSteps * world.frame());
    }
    // That of implicit Euler in substeps of h, of frequency w.
    static double expected(const World& world, double squared, double alpha, double beta) {
        const double h = world.frame() / world.def.substeps;
        return 0.5 * std::log((1 + h * alpha) * (1 + h * h * squared + h * beta * squared)) / h;
    }
    static void expect(const World& world, double measured, double squared) {
        const RayleighCase& of = GetParam();
        const double euler = expected(world, squared, of.mass, of.stiffness), without = expected(world, squared, 0, 0);
        EXPECT_NEAR(measured, euler, 1e-3 * euler);
        // What the damping adds is Rayleigh's (alpha + beta w^2)/2, up to the step.
        const double analytic = 0.5 * (of.mass + of.stiffness * squared);
        EXPECT_NEAR(measured - without, analytic, 0.05 * analytic);
    }
    static World still(const RayleighCase& of) {
        return World([&](taut_world_def& def) {
            def.time_step = static_cast<float>(1 / of.hz);
            def.gravity = {0, 0, 0};
        });
    }
};
INSTANTIATE_TEST_SUITE_P(Of, Rayleigh,
                         testing::Values(RayleighCase{30, 1.5, 0}, RayleighCase{60, 1.5, 0}, RayleighCase{120, 1.5, 0},
                                         RayleighCase{240, 1.5, 0}, RayleighCase{30, 0, 0.004},
                                         RayleighCase{60, 0, 0.004}, RayleighCase{120, 0, 0.004},
                                         RayleighCase{240, 0, 0.004}, RayleighCase{60, 1, 0.004}),
                         testing::PrintToStringParamName());

// A corner of a cube of St. Venant's and Kirchhoff's material whose other three vertices are held: with h the edge it
// swings along its own edge at w^2 = 4 (lambda + 2 mu)/(rho h^2).
TEST_P(Rayleigh, StrainDecaysByItsFrequency) {
    const RayleighCase& of = GetParam();
    constexpr double kYoung = 2e4, kNu = 0.25, kFrom = 1e-4;
    const double mu = kYoung / (2 * (1 + kNu)), lame = kYoung * kNu / ((1 + kNu) * (1 - 2 * kNu));
    const double squared = 4 * (lame + 2 * mu) / 1000;
    const World world = still(of);
    const taut_pos rest[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    taut_pos at[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1 + kFrom}};
    const uint32_t cell[] = {0, 1, 2, 3};
    taut_solid_def def;
    taut_solid_def_init(&def);
    def.material = TAUT_SOLID_ST_VENANT_KIRCHHOFF;
    def.points = at;
    def.rest = rest;
    def.point_count = 4;
    def.cells = cell;
    def.cell_count = 1;
    def.young_modulus = static_cast<float>(kYoung);
    def.poisson_ratio = static_cast<float>(kNu);
    def.filter.mask = 0;
    def.mass_damping = static_cast<float>(of.mass);
    def.stiffness_damping = static_cast<float>(of.stiffness);
    const taut_solid solid = add(world, def);
    for (uint32_t v = 0; v < 3; ++v) ok(taut_solid_pin(solid, v, 1));
    expect(world, rate_of(world, [&] { return points_of(solid)[3].z - 1; }), squared);
}

// The middle of a taut cross of links swings across itself by tension alone, w^2 = sum T/(L m): this the damping of a
// strain leaves alone, and Rayleigh's does not.
TEST_P(Rayleigh, TensionDecaysByItsFrequencyToo) {
    const RayleighCase& of = GetParam();
    constexpr double kCompliance = 1e-3, kStretch = 1.1, kSide = 1, kAreal = 0.5, kFrom = 1e-4;
    const World world = still(of);
    const Sheet sheet(3, 3, 2 * kSide, 2 * kSide, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.rest = sheet.points.data();
    std::vector<taut_pos> at;
    for (const taut_pos& p : sheet.points) at.push_back({kStretch * p.x, 0, kStretch * p.z});
    at[4].y = kFrom;
    def.points = at.data();
    def.stretch_compliance[0] = def.stretch_compliance[1] = static_cast<float>(kCompliance);
    def.shear_compliance = std::numeric_limits<float>::infinity();
    def.area_density = static_cast<float>(kAreal);
    def.filter.mask = 0;
    def.mass_damping = static_cast<float>(of.mass);
    def.stiffness_damping = static_cast<float>(of.stiffness);
    const taut_cloth cloth = add(world, def);
    for (uint32_t v = 0; v < 9; ++v)
        if (v != 4) ok(taut_cloth_pin(cloth, v, 1));
    const double mass = mass_of(bodies_of(cloth)[4]).mass;
    const double tension = kSide * (kStretch - 1) / kCompliance;
    const double squared = 4 * tension / (kSide * kStretch * mass);
    world.step(2);  // links carry what they do from the first on
    expect(world, rate_of(world, [&] { return points_of(cloth)[4].y; }), squared);
}

// What hangs does so as far down as without damping, and what falls comes to g/alpha.
TEST(RayleighOfMasses, HoldsNothingUp) {
    for (const taut_deformable_solve solve : {TAUT_DEFORMABLE_DIRECT, TAUT_DEFORMABLE_SWEPT}) {
        double low[2];
        for (const bool damped : {false, true}) {
            const World world;
            const Sheet sheet(6, 6, 1, 1, 0);
            taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
            def.rest = sheet.points.data();
            std::vector<taut_pos> hung;
            for (const taut_pos& p : sheet.points) hung.push_back({0, -p.x, p.z});
            def.points = hung.data();
            def.solve = solve;
            def.damping = 0.05f;
            def.filter.mask = 0;
            def.mass_damping = damped ? 4.0f : 0.0f;
            const taut_cloth cloth = add(world, def);
            for (int k = 0; k < 6; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
            world.step(600);
            low[damped] = points_of(cloth)[sheet.at(5, 3)].y;
        }
        EXPECT_NEAR(low[0], low[1], solve == TAUT_DEFORMABLE_DIRECT ? 1e-4 : 5e-3);
        const World world;
        const Beam cube({0.2, 0.2, 0.2}, 2, 2, 2, false);
        taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.3);
        def.solve = solve;
        def.mass_damping = 5;
        const taut_solid falling = add(world, def);
        world.step(240);
        EXPECT_NEAR(velocity(bodies_of(falling)[0]).y, -kG / 5, 0.03 * kG / 5);
    }
}

}  // namespace
