// Pressure within closed cloths: volumes, thin shells, gas laws, any step.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr double kAtmosphere = 101325;  // [Pa], the default of worlds

double volume_of(taut_cloth cloth) {
    double out = 0;
    ok(taut_cloth_get_volume(cloth, &out));
    return out;
}
double pressure_of(taut_cloth cloth) {
    float out = 0;
    ok(taut_cloth_get_pressure(cloth, &out));
    return static_cast<double>(out);
}

struct Shell {
    double radius = 0.2, stiffness = 5000, poisson = 0.3, density = 0.2;

    taut_cloth_def def(const Ball& ball) const {
        taut_cloth_def out = ball.def();
        out.area_density = static_cast<float>(density);
        out.stretch_stiffness[0] = out.stretch_stiffness[1] = static_cast<float>(stiffness);
        out.poisson_ratio = static_cast<float>(poisson);
        out.shear_stiffness = static_cast<float>(stiffness / (2 * (1 + poisson)));
        out.damping = 0.01f;
        out.filter.mask = 0;
        return out;
    }
    // Laplace's p = 2 T/r, where Green strain E = (l^2 - 1)/2 both ways gives T = k E/(1 - nu) for each metre of the
    // stretched sheet: that of the first Piola stress, l k E/(1 - nu), is for each metre at rest.
    double pressure(double stretch) const {
        return stiffness * (stretch * stretch - 1) / (1 - poisson) / (stretch * radius);
    }
    // Stretch at which excess(stretch) is what the sheet holds.
    template <class Excess>
    double balance(Excess excess) const {
        double low = 0.5, high = 4;
        for (int i = 0; i < 100; ++i) {
            const double mid = 0.5 * (low + high);
            (pressure(mid) < excess(mid) ? low : high) = mid;
        }
        return low;
    }
};

double mean_radius(taut_cloth cloth) {
    double sum = 0;
    const std::vector<Vec> x = points_of(cloth);
    Vec middle;
    for (const Vec& p : x) middle += 1.0 / static_cast<double>(x.size()) * p;
    for (const Vec& p : x) sum += norm(p - middle);
    return sum / static_cast<double>(x.size());
}
double fastest_of(taut_cloth cloth) {
    double most = 0;
    for (const taut_body body : bodies_of(cloth)) most = std::max(most, norm(velocity(body)));
    return most;
}

struct GasCase {
    double hz = 60, density = 0.2, radius = 0.2;
};
auto named = [](const testing::TestParamInfo<GasCase>& each) {
    const GasCase& of = each.param;
    return std::to_string(static_cast<int>(of.hz)) + "Hz_" + std::to_string(static_cast<int>(1000 * of.density)) +
           "g_" + std::to_string(static_cast<int>(1000 * of.radius)) + "mm";
};

struct Still : World {
    explicit Still(const GasCase& of, double gravity = 0)
        : World([&](taut_world_def& w) {
              w.time_step = static_cast<float>(1 / of.hz);
              w.gravity = {0, static_cast<float>(-gravity), 0};
          }) {}
    void run(double seconds) const { step(static_cast<int>(std::lround(seconds * 1 / frame()))); }
};

TEST(Volume, IsThatOfTheMesh) {
    const Still world({});
    const taut_pos corner[] = {{5, 0, 0}, {7, 0, 0}, {5, 3, 0}, {7, 3, 0}, {5, 0, 4}, {7, 0, 4}, {5, 3, 4}, {7, 3, 4}};
    const uint32_t face[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                             2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    taut_cloth_def def;
    taut_cloth_def_init(&def);
    def.points = corner;
    def.point_count = 8;
    def.triangles = face;
    def.triangle_count = 12;
    EXPECT_NEAR(volume_of(add(world, def)), 24, 1e-12);
    uint32_t inward[36];
    for (int t = 0; t < 12; ++t) {
        inward[3 * t] = face[3 * t];
        inward[3 * t + 1] = face[3 * t + 2];
        inward[3 * t + 2] = face[3 * t + 1];
    }
    def.triangles = inward;
    EXPECT_NEAR(volume_of(add(world, def)), 24, 1e-12);
    double out = 0;
    const Sheet sheet(3, 3, 1, 1, 0);
    EXPECT_EQ(taut_cloth_get_volume(add(world, sheet.def(TAUT_CLOTH_LINKS)), &out), TAUT_INVALID_ARGUMENT);
}

TEST(Pressure, IsRefusedWhereItCannotBe) {
    const Still world({});
    taut_cloth out{};
    const Sheet sheet(3, 3, 1, 1, 0);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
    def.pressure = 10;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("open"), std::string::npos) << taut_last_error();
    Ball two(0.2, 0);
    const Ball other(0.2, 0);
    for (const taut_pos& p : other.points) two.points.push_back({p.x + 1, p.y, p.z});
    for (const uint32_t v : other.triangles) two.triangles.push_back(v + 12);
    def = two.def();
    def.gas = 1;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("several pieces"), std::string::npos) << taut_last_error();
    const Ball ball(0.2, 1);
    def = ball.def();
    def.gas = 1;
    def.pressure = -102000;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("pressure"), std::string::npos) << taut_last_error();
    std::vector<taut_pos> flat = ball.points;
    for (taut_pos& p : flat) p.y = 0;
    def.rest = ball.points.data();
    def.points = flat.data();
    def.pressure = 10;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("no volume"), std::string::npos) << taut_last_error();
    def.gas = 2;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    const taut_cloth open = add(world, sheet.def(TAUT_CLOTH_TRIANGLES));
    EXPECT_EQ(taut_cloth_set_pressure(open, 1), TAUT_INVALID_ARGUMENT);
    def = ball.def();
    def.solve = TAUT_DEFORMABLE_SWEPT;
    EXPECT_EQ(taut_cloth_set_pressure(add(world, def), 1), TAUT_INVALID_ARGUMENT);
    def.pressure = 1;
    EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_NE(std::string(taut_last_error()).find("solved directly"), std::string::npos) << taut_last_error();
}

// Of all solvers, those that take elements one by one have no row for what is within.
TEST(Pressure, IsRefusedBySolversWithoutIt) {
    int refused = 0;
    for (int solver = 0; taut_solver_name(static_cast<taut_solver>(solver)); ++solver) {
        const World world([&](taut_world_def& of) { of.solver = static_cast<taut_solver>(solver); });
        const Ball ball(0.2, 1);
        taut_cloth_def def = ball.def();
        const taut_cloth limp = add(world, def);
        def.pressure = 1000;
        taut_cloth out{};
        const taut_result wanted = solver == TAUT_SOLVER_BLOCK_LDLT ? TAUT_OK : TAUT_INVALID_ARGUMENT;
        EXPECT_EQ(taut_world_add_cloth(world.handle, &def, &out), wanted) << solver;
        EXPECT_EQ(taut_cloth_set_pressure(limp, 1000), wanted) << solver;
        if (wanted == TAUT_OK) continue;
        ++refused;
        EXPECT_NE(std::string(taut_last_error()).find("pressure"), std::string::npos) << taut_last_error();
    }
    EXPECT_EQ(refused, 8);
}

class Balloon : public testing::TestWithParam<GasCase> {};
std::vector<GasCase> gas_cases() {
    std::vector<GasCase> out;
    for (const double hz : {30.0, 60.0, 120.0, 240.0})
        for (const auto& [density, radius] : {std::pair(0.2, 0.2), std::pair(0.05, 0.05), std::pair(2.0, 1.0)})
            out.push_back({hz, density, radius});
    return out;
}
INSTANTIATE_TEST_SUITE_P(Of, Balloon, testing::ValuesIn(gas_cases()), named);

// Blown up evenly within half a second: at once, a vertex would get 100 m/s of each substep.
void blow_up(const Still& world, taut_cloth cloth, double pressure, double hz) {
    const int steps = static_cast<int>(0.5 * hz);
    for (int i = 1; i <= steps; ++i) {
        ok(taut_cloth_set_pressure(cloth, static_cast<float>(pressure * i / steps)));
        world.step();
    }
    world.run(0.5);
}

TEST_P(Balloon, StretchesAsThinShellsDo) {
    const Still world(GetParam());
    const Ball ball(GetParam().radius, 2);
    const Shell shell{.radius = GetParam().radius, .density = GetParam().density};
    const taut_cloth cloth = add(world, shell.def(ball));
    const double wanted = shell.pressure(1.2);
    blow_up(world, cloth, wanted, GetParam().hz);
    EXPECT_NEAR(mean_radius(cloth) / shell.radius, 1.2, 0.01);
    EXPECT_NEAR(pressure_of(cloth), wanted, 1e-6 * wanted);
    EXPECT_LE(fastest_of(cloth), 0.02);
}

// Gas of 12 kPa over the air in a hull at rest stretches it until both balance; let out, it is as before.
TEST_P(Balloon, HoldsItsGas) {
    const Still world(GetParam());
    const Ball ball(GetParam().radius, 2);
    const Shell shell{
        .radius = GetParam().radius, .stiffness = 25000 * GetParam().radius, .density = GetParam().density};
    taut_cloth_def def = shell.def(ball);
    def.gas = 1;
    const taut_cloth cloth = add(world, def);
    blow_up(world, cloth, 12000, GetParam().hz);
    const double amount = (kAtmosphere + pressure_of(cloth)) * volume_of(cloth);
    world.run(0.5);
    const double stretch = mean_radius(cloth) / shell.radius;
    EXPECT_GE(stretch, 1.05);
    EXPECT_NEAR(pressure_of(cloth), shell.pressure(stretch), 0.05 * shell.pressure(stretch));
    EXPECT_NEAR((pressure_of(cloth) + kAtmosphere) * volume_of(cloth), amount, 1e-5 * amount);
    EXPECT_LE(fastest_of(cloth), 0.02);
    const double balance =
        shell.balance([&](double l) { return amount / (volume_of(cloth) * std::pow(l / stretch, 3)) - kAtmosphere; });
    EXPECT_NEAR(stretch, balance, 0.005);
    // Let out to less.
    for (int i = 0; i < static_cast<int>(GetParam().hz); ++i) {
        ok(taut_cloth_set_pressure(cloth, 3000));
        world.step();
    }
    EXPECT_NEAR(mean_radius(cloth) / shell.radius, shell.balance([](double) { return 3000; }), 0.005);
}

// A ball full of gas that is thrown on the ground springs up by less than it fell, and lies on it as high as its
// pressure lets it.
TEST_P(Balloon, BouncesAndRests) {
    const GasCase& of = GetParam();
    const Still world(of, kG);
    world.add_ground();
    Ball ball(of.radius, 2);
    for (taut_pos& p : ball.points) p.y += 3 * of.radius;
    const Shell shell{.radius = of.radius, .stiffness = 20000, .density = of.density};
    taut_cloth_def def = shell.def(ball);
    def.filter.mask = 0xffffffffu;
    def.thickness = 0.002f;
    def.gas = 1;
    def.pressure = 3000;
    const taut_cloth cloth = add(world, def);
    const double volume = volume_of(cloth);
    double least = volume, most = volume;
    for (int i = 0; i < static_cast<int>(2 * of.hz); ++i) {
        world.step();
        least = std::min(least, volume_of(cloth));
        most = std::max(most, volume_of(cloth));
        const std::vector<Vec> x = points_of(cloth);
        Vec middle;
        for (const Vec& p : x) middle += 1.0 / static_cast<double>(x.size()) * p;
        ASSERT_LE(middle.y, 3 * of.radius * 1.01);
        ASSERT_GE(middle.y, 0.6 * of.radius);
    }
    EXPECT_GE(least, 0.8 * volume);
    EXPECT_LE(most, 1.2 * volume);
}

// Whatever becomes of a shape, the pressure in it stays finite.
TEST(Gas, StaysFiniteWhereItsHullIsTurnedInsideOut) {
    for (const double hz : {30.0, 240.0}) {
        const Still world({hz});
        const Ball ball(0.2, 1);
        taut_cloth_def def = Shell{}.def(ball);
        def.gas = 1;
        def.pressure = 1000;
        const taut_cloth cloth = add(world, def);
        const std::vector<taut_body> bodies = bodies_of(cloth);
        for (const taut_body body : bodies) {
            const Vec x = position(body);
            ok(taut_body_set_velocity(body, (-200 * x).narrow(), {}));
        }
        for (int i = 0; i < static_cast<int>(2 * hz); ++i) {
            world.step();
            for (const taut_body body : bodies) ASSERT_TRUE(finite(body)) << i;
        }
        EXPECT_TRUE(std::isfinite(pressure_of(cloth)));
        EXPECT_EQ(world.profile().bodies, bodies.size());
    }
}

}  // namespace
