// Solids that yield: what remains of a strain, how fast it creeps, that volumes stay.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

constexpr double kYoung = 1e6, kNu = 0.3;
const float kNever = std::numeric_limits<float>::infinity();

// Norm of the strain of diag(l, l^-1/2, l^-1/2).
double strain_of(double stretch) {
    const double side = 1 / std::sqrt(stretch) - 1;
    return std::sqrt((stretch - 1) * (stretch - 1) + 2 * side * side);
}
// The stretch above 1 that has it.
double stretch_of(double strain) {
    double low = 1, high = 10;
    for (int i = 0; i < 200; ++i) {
        const double mid = 0.5 * (low + high);
        (strain_of(mid) < strain ? low : high) = mid;
    }
    return low;
}
double yield_strain(double stress) { return stress * 2 * (1 + kNu) / (std::sqrt(6.0) * kYoung); }

// A cube all of whose vertices are led to diag(l, l^-1/2, l^-1/2) of the rest shape.
struct Led {
    Led(const World& of, bool hex, taut_solid_material material, double stress, double creep, double stretch = 1)
        : world(of), cube({0.2, 0.2, 0.2}, 3, 3, 3, hex) {
        taut_solid_def def = cube.def(material, kYoung, kNu);
        def.yield_stress = static_cast<float>(stress);
        def.creep = static_cast<float>(creep);
        def.filter.mask = 0;
        def.damping = 0.02f;
        const std::vector<taut_pos> at = stretched(stretch);
        def.rest = cube.points.data();
        def.points = at.data();
        solid = add(world, def);
        for (uint32_t v = 0; v < cube.points.size(); ++v) ok(taut_solid_pin(solid, v, 1));
    }
    std::vector<taut_pos> stretched(double stretch) const {
        std::vector<taut_pos> out = cube.points;
        const double side = 1 / std::sqrt(stretch);
        for (taut_pos& p : out) p = {p.x * stretch, p.y * side, p.z * side};
        return out;
    }
    void let_go() const {
        for (uint32_t v = 0; v < cube.points.size(); ++v) ok(taut_solid_pin(solid, v, 0));
    }
    std::vector<float> plastic() const {
        std::vector<float> out(cube.cells.size() / (cube.hex ? 8 : 4));
        uint32_t count = 0;
        ok(taut_solid_get_plastic_strains(solid, out.data(), static_cast<uint32_t>(out.size()), &count));
        EXPECT_EQ(count, out.size());
        return out;
    }
    double extent(int axis) const {
        const std::vector<Vec> x = points_of(solid);
        const Vec far =
            axis == 0 ? x[cube.at(2, 1, 1)] - x[cube.at(0, 1, 1)] : x[cube.at(1, 2, 1)] - x[cube.at(1, 0, 1)];
        return norm(far) / 0.2;
    }
    double volume() const {
        const std::vector<Vec> x = points_of(solid);
        const Beam tets({0.2, 0.2, 0.2}, 3, 3, 3, false);
        double sum = 0;
        for (size_t c = 0; c < tets.cells.size(); c += 4) {
            const Vec& o = x[tets.cells[c]];
            sum += dot(x[tets.cells[c + 1]] - o, cross(x[tets.cells[c + 2]] - o, x[tets.cells[c + 3]] - o)) / 6;
        }
        return std::abs(sum);
    }

    const World& world;
    Beam cube;
    taut_solid solid{};
};

struct Weightless : World {
    explicit Weightless(double hz = pace().hz)
        : World([&](taut_world_def& w) {
              w.time_step = static_cast<float>(1 / hz);
              w.gravity = {0, 0, 0};
          }) {}
    void run(double seconds) const { step(static_cast<int>(std::lround(seconds / frame()))); }
};

struct FlowCase {
    bool hex;
    taut_solid_material material;
};
class Flow : public testing::TestWithParam<FlowCase> {};
INSTANTIATE_TEST_SUITE_P(Of, Flow,
                         testing::Values(FlowCase{false, TAUT_SOLID_NEO_HOOKEAN},
                                         FlowCase{false, TAUT_SOLID_ST_VENANT_KIRCHHOFF},
                                         FlowCase{false, TAUT_SOLID_COROTATED}, FlowCase{true, TAUT_SOLID_NEO_HOOKEAN},
                                         FlowCase{true, TAUT_SOLID_FIXED_COROTATED}),
                         [](const auto& each) {
                             return std::string(each.param.hex ? "Hex" : "Tet") + std::to_string(each.param.material);
                         });

// Led to a stretch l of its rest shape, what is beyond the yield flows: F_e of the yield's strain is left, and once let
// go it stands at F_p = F F_e^-1, as large as it was.
TEST_P(Flow, LeavesTheSetBeyondTheYield) {
    constexpr double kStress = 5e4;
    const Weightless world;
    const Led cube(world, GetParam().hex, GetParam().material, kStress, static_cast<double>(kNever), 1.3);
    const double volume = cube.volume(), set = 1.3 / stretch_of(yield_strain(kStress));
    world.run(0.1);
    for (const float strain : cube.plastic()) EXPECT_NEAR(strain, strain_of(set), 1e-5);
    EXPECT_NEAR(cube.extent(0), 1.3, 1e-9);
    cube.let_go();
    world.run(2);
    EXPECT_NEAR(cube.extent(0), set, 1e-3);
    EXPECT_NEAR(cube.extent(1), 1 / std::sqrt(set), 1e-3);
    EXPECT_NEAR(cube.volume(), volume, 1e-3 * volume);
}

TEST_P(Flow, DoesNotHappenBelowTheYield) {
    constexpr double kStress = 5e4;
    const Weightless world;
    const Led cube(world, GetParam().hex, GetParam().material, kStress, static_cast<double>(kNever),
                   0.99 * stretch_of(yield_strain(kStress)) + 0.01);
    world.run(0.1);
    for (const float strain : cube.plastic()) EXPECT_EQ(strain, 0);
    cube.let_go();
    world.run(2);
    EXPECT_NEAR(cube.extent(0), 1, 1e-4);
}

// At a shape that is held the excess falls as exp(-creep t), at any rate of steps.
TEST(Creep, GoesByTimeNotBySteps) {
    constexpr double kStress = 2e4, kCreep = 8, kTime = 0.2;
    const double first = strain_of(1.25), yield = yield_strain(kStress);
    const double left = yield + (first - yield) * std::exp(-kCreep * kTime);
    const double expected = strain_of(1.25 / stretch_of(left));
    for (const double hz : {30.0, 60.0, 120.0, 240.0}) {
        const Weightless world(hz);
        const Led cube(world, false, TAUT_SOLID_NEO_HOOKEAN, kStress, kCreep, 1.25);
        world.run(kTime);
        for (const float strain : cube.plastic()) EXPECT_NEAR(strain, expected, 0.01 * expected) << hz;
    }
}

// A bar that is pulled apart by its ends beyond the yield and let go is shorter by the elastic strain, stress/E, in its
// middle, and as large as before.
TEST(PlasticBar, KeepsWhatIsBeyondItsElasticStrain) {
    constexpr double kStress = 1e4;
    const Weightless world;
    const Beam bar({1, 0.1, 0.1}, 21, 3, 3, true);
    taut_solid_def def = bar.def(TAUT_SOLID_COROTATED, kYoung, kNu);
    def.yield_stress = static_cast<float>(kStress);
    def.damping = 0.02f;
    def.filter.mask = 0;
    const taut_solid solid = add(world, def);
    const std::vector<taut_body> bodies = bodies_of(solid);
    std::vector<taut_body> far;
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            ok(taut_solid_pin(solid, bar.at(0, j, k), 1));
            ok(taut_solid_pin(solid, bar.at(20, j, k), 1));
            far.push_back(bodies[bar.at(20, j, k)]);
        }
    for (const taut_body body : far) ok(taut_body_set_velocity(body, {0.05f, 0, 0}, {}));
    world.run(1);
    for (const taut_body body : far) ok(taut_body_set_velocity(body, {}, {}));
    world.run(1);
    const auto gauge = [&] {
        const std::vector<Vec> x = points_of(solid);
        return norm(x[bar.at(13, 1, 1)] - x[bar.at(7, 1, 1)]) / 0.3;
    };
    const double pulled = gauge();
    EXPECT_GE(pulled, 1.03);
    for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
            ok(taut_solid_pin(solid, bar.at(0, j, k), 0));
            ok(taut_solid_pin(solid, bar.at(20, j, k), 0));
        }
    world.run(3);
    EXPECT_NEAR((pulled - gauge()) / pulled, kStress / kYoung, 0.05 * kStress / kYoung);
    std::vector<float> ratio(bar.cells.size() / 8);
    uint32_t count = 0;
    ok(taut_solid_get_volumes(solid, ratio.data(), static_cast<uint32_t>(ratio.size()), &count));
    for (const float each : ratio) EXPECT_NEAR(each, 1, 0.01);
}

struct YieldCase {
    double hz, hardening;  // [Pa]
};
class OnePull : public testing::TestWithParam<YieldCase> {};
INSTANTIATE_TEST_SUITE_P(At, OnePull,
                         testing::Values(YieldCase{60, 5e4}, YieldCase{60, 2e5}, YieldCase{240, 2e5},
                                         YieldCase{30, 1e6}));

// A bar pulled slowly: each cell of its middle tells once that it yields, at the def's stress. In the end it bears
// y + H p under the plastic strain p = (e - y/E) E/(E + H) of simple tension, and keeps p once it is let go.
TEST_P(OnePull, YieldsOnceAndKeepsWhatTheoryHas) {
    constexpr double kStress = 1e4, kPulled = 0.04;
    const double hardening = GetParam().hardening;
    const Weightless world(GetParam().hz);
    const Beam bar({1, 0.1, 0.1}, 11, 2, 2, true);
    taut_solid_def def = bar.def(TAUT_SOLID_COROTATED, kYoung, kNu);
    def.yield_stress = static_cast<float>(kStress);
    def.hardening = static_cast<float>(hardening);
    def.damping = 0.02f;
    def.mass_damping = 20;
    def.filter.mask = 0;
    def.user_data = 77;
    const taut_solid solid = add(world, def);
    const std::vector<taut_body> bodies = bodies_of(solid);
    const auto ends = [&](auto&& act) {
        for (const int i : {0, 10})
            for (int j = 0; j < 2; ++j)
                for (int k = 0; k < 2; ++k) act(bar.at(i, j, k), i == 10);
    };
    ends([&](uint32_t v, bool) { ok(taut_solid_pin(solid, v, 1)); });
    ends([&](uint32_t v, bool far) {
        if (far) ok(taut_body_set_velocity(bodies[v], {static_cast<float>(kPulled / 2), 0, 0}, {}));
    });
    const size_t cells = bar.cells.size() / 8;
    std::vector<std::vector<taut_yield_event>> told(cells);
    const auto run = [&](double seconds) {
        for (int i = 0; i < static_cast<int>(std::lround(seconds * GetParam().hz)); ++i) {
            world.step();
            taut_events events{};
            ok(taut_world_get_events(world.handle, &events));
            for (uint32_t e = 0; e < events.yielded_count; ++e) {
                const taut_yield_event& event = events.yielded[e];
                EXPECT_EQ(event.solid.bits, solid.bits);
                EXPECT_EQ(event.user_data, 77u);
                ASSERT_LT(event.cell, cells);
                told[event.cell].push_back(event);
            }
        }
    };
    run(2);
    ends([&](uint32_t v, bool far) {
        if (far) ok(taut_body_set_velocity(bodies[v], {}, {}));
    });
    run(1);
    const auto gauge = [&] {
        const std::vector<Vec> x = points_of(solid);
        return norm(x[bar.at(7, 1, 1)] - x[bar.at(3, 1, 1)]) / 0.4 - 1;
    };
    const double strain = gauge(), gone = (strain - kStress / kYoung) * kYoung / (kYoung + hardening);
    uint32_t count = 0;
    std::vector<float> stress(cells), plastic(cells);
    ok(taut_solid_get_stresses(solid, stress.data(), static_cast<uint32_t>(cells), &count));
    ok(taut_solid_get_plastic_strains(solid, plastic.data(), static_cast<uint32_t>(cells), &count));
    // Plastic strain by its tensor's norm is that of simple tension times sqrt(3/2).
    for (size_t c = 3; c < 7; ++c) {
        ASSERT_EQ(told[c].size(), 1u) << c;
        EXPECT_NEAR(static_cast<double>(told[c][0].stress), kStress, 0.03 * kStress) << c;
        EXPECT_GT(told[c][0].strain, 0);
        EXPECT_LE(static_cast<double>(told[c][0].strain), 0.1 * gone);
        EXPECT_NEAR(static_cast<double>(stress[c]), kStress + hardening * gone, 0.04 * (kStress + hardening * gone))
            << c;
        EXPECT_NEAR(static_cast<double>(plastic[c]), std::sqrt(1.5) * gone, 0.05 * std::sqrt(1.5) * gone) << c;
    }
    ends([&](uint32_t v, bool) { ok(taut_solid_pin(solid, v, 0)); });
    run(2);
    EXPECT_NEAR(gauge(), gone, 0.04 * gone);
    for (size_t c = 3; c < 7; ++c) EXPECT_EQ(told[c].size(), 1u) << c;
}

// Cells that are crushed or turned inside out do not flow into something that bursts.
TEST(Plastic, WhatIsTangledDoesNotBlowUp) {
    for (const double hz : {30.0, 60.0, 240.0})
        for (const taut_solid_material material : {TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_FIXED_COROTATED}) {
            const Weightless world(hz);
            const Beam cube({0.4, 0.4, 0.4}, 4, 4, 4, false);
            taut_solid_def def = cube.def(material, 1e5, kNu);
            def.yield_stress = 5e3f;
            def.damping = 0.02f;
            def.filter.mask = 0;
            std::vector<taut_pos> at = cube.points;
            for (size_t i = 0; i < at.size(); ++i) {  // mirrored, and wrung
                const double turn = 7.0 * at[i].x;
                const double y = at[i].y - 0.2, z = at[i].z - 0.2;
                at[i] = {-at[i].x, std::cos(turn) * y - std::sin(turn) * z, std::sin(turn) * y + std::cos(turn) * z};
            }
            def.rest = cube.points.data();
            def.points = at.data();
            const taut_solid solid = add(world, def);
            const std::vector<taut_body> bodies = bodies_of(solid);
            for (int i = 0; i < static_cast<int>(3 * hz); ++i) {
                world.step();
                for (const taut_body body : bodies) ASSERT_LE(norm(position(body)), 2) << hz;
            }
            double fastest = 0;
            for (const taut_body body : bodies) fastest = std::max(fastest, norm(velocity(body)));
            EXPECT_LE(fastest, 0.5) << hz;
            EXPECT_EQ(world.profile().bodies, bodies.size());
        }
}

// ---------------------------------------------------------------- state of all loads

struct Loaded {
    explicit Loaded(uint32_t threads)
        : world([&](taut_world_def& def) {
              def.threads = threads;
              def.wind = {6, 2, 1};
          }) {
        world.add_ground();
        const Sheet sheet(12, 12, 1, 1, 2);
        taut_cloth_def flag = sheet.def(TAUT_CLOTH_TRIANGLES);
        flag.air_drag = 1.2f;
        flag.air_lift = 0.8f;
        cloth = add(world, flag);
        for (int k = 0; k < 12; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
        Ball ball(0.2, 2);
        for (taut_pos& p : ball.points) p.y += 0.4, p.z += 3;
        taut_cloth_def full = ball.def();
        full.gas = 1;
        full.pressure = 2000;
        full.air_drag = 0.5f;
        balloon = add(world, full);
        Beam cube({0.3, 0.3, 0.3}, 5, 5, 5, false);
        for (taut_pos& p : cube.points) p.y += 1, p.x += 3;
        taut_solid_def clay = cube.def(TAUT_SOLID_NEO_HOOKEAN, 5e4, 0.3);
        clay.yield_stress = 500;
        clay.creep = 30;
        clay.air_drag = 1;
        solid = add(world, clay);
    }
    uint64_t hash() const {
        uint64_t out = 0;
        ok(taut_world_get_state_hash(world.handle, &out));
        return out;
    }
    std::vector<uint64_t> run(int steps) const {
        std::vector<uint64_t> out;
        for (int i = 0; i < steps; ++i) {
            world.step();
            out.push_back(hash());
        }
        return out;
    }

    World world;
    taut_cloth cloth{}, balloon{};
    taut_solid solid{};
};

TEST(SurfaceLoads, GiveTheSameBitsOnAnyTeam) {
    const std::vector<uint64_t> alone = Loaded(1).run(60);
    for (const uint32_t threads : {2u, 5u}) EXPECT_EQ(Loaded(threads).run(60), alone) << threads;
}

TEST(SurfaceLoads, AreStateOfTheWorld) {
    const Loaded loaded(1);
    loaded.run(60);
    uint64_t bytes = 0;
    ok(taut_world_snapshot_size(loaded.world.handle, &bytes));
    std::vector<unsigned char> saved(bytes);
    ok(taut_world_save(loaded.world.handle, saved.data(), bytes, &bytes));
    const uint64_t then = loaded.hash();
    ok(taut_world_set_wind(loaded.world.handle, {-20, 0, 3}));
    EXPECT_NE(loaded.hash(), then);
    ok(taut_world_restore(loaded.world.handle, saved.data(), bytes));
    EXPECT_EQ(loaded.hash(), then);
    ok(taut_cloth_set_pressure(loaded.balloon, 500));
    EXPECT_NE(loaded.hash(), then);
    ok(taut_world_restore(loaded.world.handle, saved.data(), bytes));
    const std::vector<uint64_t> first = loaded.run(60);
    ok(taut_cloth_set_pressure(loaded.balloon, 3000));
    loaded.run(20);
    ok(taut_world_restore(loaded.world.handle, saved.data(), bytes));
    taut_vec3 wind{};
    ok(taut_world_get_wind(loaded.world.handle, &wind));
    EXPECT_EQ(wind.x, 6);
    EXPECT_EQ(loaded.run(60), first);
    std::vector<float> strain(2000);
    uint32_t count = 0;
    ok(taut_solid_get_plastic_strains(loaded.solid, strain.data(), 2000, &count));
    EXPECT_GT(*std::max_element(strain.begin(), strain.begin() + count), 1e-3f);
}

TEST(SurfaceLoads, TakeNoMemoryOnceTheyAreWarm) {
    const Loaded loaded(1);
    loaded.run(300);
    for (int i = 0; i < 60; ++i) {
        loaded.world.step();
        EXPECT_EQ(loaded.world.profile().allocations, 0u) << i;
    }
}

}  // namespace
