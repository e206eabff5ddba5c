// Deformables by minimisation (TAUT_SOLVER_MINIMISATION): recovery from tangles (Gast and Schroeder 2014, figures 8 and
// 9), agreement with the direct solver, and what such worlds refuse.
#include <random>

#include "physics/deformable_lab.h"

namespace {

using namespace lab;

World minimising(const std::function<void(taut_world_def&)>& change = {}) {
    return World([&](taut_world_def& def) {
        def.solver = TAUT_SOLVER_MINIMISATION;
        if (change) change(def);
    });
}

// ---------------------------------------------------------------- tangles

enum class Tangle { random, point };

struct TangleCase {
    Tangle tangle;
    int nodes;     // along an edge
    double young;  // [Pa]
    int frames;    // within which it recovers
};
void PrintTo(const TangleCase& of, std::ostream* out) {
    *out << (of.tangle == Tangle::random ? "random" : "point") << of.nodes << "_" << static_cast<long long>(of.young)
         << "_Pa";
}

// A cube of 1 m in steps of a film's frames, whose vertices are anywhere within it, or all in its middle.
class TangledCube {
public:
    explicit TangledCube(const TangleCase& of, const std::function<void(taut_world_def&)>& change = {})
        : world(minimising([&](taut_world_def& def) {
              def.time_step = 1.0f / 24;
              def.substeps = 1;
              def.gravity = {0, 0, 0};
              if (change) change(def);
          })) {
        const Beam cube({1, 1, 1}, of.nodes, of.nodes, of.nodes, false);
        taut_solid_def def = cube.def(TAUT_SOLID_FIXED_COROTATED, of.young, 0.3);
        std::vector<taut_pos> points(cube.points.size(), {0.5, 0.5, 0.5});
        std::mt19937_64 random(1);
        const auto unit = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
        for (taut_pos& p : points)
            if (of.tangle == Tangle::random) p.x = unit(), p.y = unit(), p.z = unit();
        def.rest = def.points;
        def.points = points.data();
        def.filter.mask = 0;
        solid = add(world, def);
    }
    // Frames until no cell is inverted and each has its volume within a twentieth, but no more than so many.
    int recover(int most) {
        for (int frame = 1; frame <= most; ++frame) {
            world.step();
            solves += static_cast<int>(world.profile().solves);
            if (largest_change() < 0.05) return frame;
        }
        return most + 1;
    }
    double largest_change() const {
        uint32_t count = 0;
        taut_solid_get_volumes(solid, nullptr, 0, &count);
        std::vector<float> volume(count);
        ok(taut_solid_get_volumes(solid, volume.data(), count, &count));
        double most = 0;
        for (const float each : volume) most = std::max(most, std::abs(static_cast<double>(each) - 1));
        return most;
    }
    uint64_t hash() const {
        uint64_t out = 0;
        ok(taut_world_get_state_hash(world.handle, &out));
        return out;
    }

    World world;
    taut_solid solid{};
    int solves = 0;
};

class Tangled : public testing::TestWithParam<TangleCase> {};

TEST_P(Tangled, Recovers) {
    TangledCube cube(GetParam());
    const int frames = cube.recover(GetParam().frames);
    RecordProperty("frames", frames);
    RecordProperty("solves", cube.solves);
    std::printf("%d frames, %.1f solves each\n", frames, static_cast<double>(cube.solves) / frames);
    EXPECT_LE(frames, GetParam().frames) << "cells are off by " << cube.largest_change();
}
// Of three stiffnesses the highest recovers in one step, the lowest within 120.
std::vector<TangleCase> tangles(int nodes) {
    std::vector<TangleCase> out;
    for (const Tangle tangle : {Tangle::random, Tangle::point})
        for (const auto& [young, frames] : {std::pair(1e7, 1), {1e5, 40}, {1e4, 120}})
            out.push_back({tangle, nodes, young, frames});
    return out;
}
INSTANTIATE_TEST_SUITE_P(Cubes, Tangled, testing::ValuesIn(tangles(7)), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Soak17, Tangled, testing::ValuesIn(tangles(17)), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Soak33, Tangled, testing::ValuesIn(tangles(33)), testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Soak65, Tangled, testing::ValuesIn(tangles(65)), testing::PrintToStringParamName());

// The same program by a setting: each step of Newton's method as it comes.
TEST(TangledCube, WithoutTheSearchNewtonsMethodDoesNotRecover) {
    for (const bool search : {true, false}) {
        TangledCube cube({Tangle::random, 5, 1e7, 1}, [&](taut_world_def& def) {
            def.line_search = search;
            def.sweeps = 500;
        });
        EXPECT_EQ(cube.recover(3) <= 3, search);
        for (const Vec& p : points_of(cube.solid)) EXPECT_TRUE(finite(p));
    }
}

TEST(TangledCube, HasTheSameBitsOnAnyTeam) {
    std::vector<uint64_t> hashes;
    for (const uint32_t threads : {1u, 2u, 5u}) {
        TangledCube cube({Tangle::random, 9, 1e3, 3}, [&](taut_world_def& def) { def.threads = threads; });
        cube.world.step(3);
        hashes.push_back(cube.hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

// What is inside moves by forces between its own points alone.
TEST(TangledCube, KeepsItsCentreOfMass) {
    TangledCube cube({Tangle::random, 7, 1e5, 3});
    const std::vector<taut_body> vertices = bodies_of(cube.solid);
    const Vec before = totals(vertices).centre;
    cube.world.step(3);
    EXPECT_LT(norm(totals(vertices).centre - before), 1e-5);
}

// Many in one world recover each as it does alone: islands do not know of each other.
TEST(TangledCube, RecoversBesideOthersAsAlone) {
    const auto add_cube = [](const World& world, double x) {
        const Beam cube({1, 1, 1}, 4, 4, 4, false);
        taut_solid_def def = cube.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3);
        std::vector<taut_pos> points(cube.points.size(), {x, 0, 0});
        for (size_t i = 0; i < points.size(); ++i) points[i].y = 0.001 * static_cast<double>(i * i % 7);
        def.rest = def.points;
        def.points = points.data();
        def.filter.mask = 0;
        return add(world, def);
    };
    const World one = minimising(), both = minimising();
    const taut_solid alone = add_cube(one, 0), first = add_cube(both, 0);
    add_cube(both, 3);
    one.step(5);
    both.step(5);
    const std::vector<Vec> a = points_of(alone), b = points_of(first);
    for (size_t i = 0; i < a.size(); ++i) EXPECT_EQ(norm(a[i] - b[i]), 0) << i;
}

// ---------------------------------------------------------------- beside the direct solver

struct Hung {
    std::vector<Vec> points;
    double tip;  // how far the tip sank [m]
};

Hung hang_beam(taut_solver solver, taut_solid_material material, bool hexahedra, int steps, double damping,
               double rayleigh, uint32_t substeps, taut_scheme scheme = TAUT_SCHEME_IMPLICIT_EULER) {
    const World world([&](taut_world_def& def) {
        def.solver = solver;
        def.scheme = scheme;
        def.time_step = 1.0f / 60;
        def.substeps = substeps;
    });
    const Beam beam({0.5, 0.1, 0.1}, 6, 2, 2, hexahedra);
    taut_solid_def def = beam.def(material, 1e5, 0.3);
    def.filter.mask = 0;
    def.damping = static_cast<float>(damping);
    def.stiffness_damping = static_cast<float>(rayleigh);
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    world.step(steps);
    const std::vector<Vec> points = points_of(solid);
    return {points, points[beam.at(5, 1, 1)].y - beam.points[beam.at(5, 1, 1)].y};
}

class MinimisedBeam : public testing::TestWithParam<std::tuple<taut_solid_material, bool>> {};

// At rest both solve the same equations.
TEST_P(MinimisedBeam, HangsAsSolvedDirectly) {
    const auto [material, hex] = GetParam();
    const Hung mine = hang_beam(TAUT_SOLVER_MINIMISATION, material, hex, 600, 0.4, 0, 1);
    const Hung direct = hang_beam(TAUT_SOLVER_BLOCK_LDLT, material, hex, 600, 0.4, 0, 1);
    EXPECT_LT(direct.tip, -0.02);
    for (size_t i = 0; i < mine.points.size(); ++i)
        EXPECT_LT(norm(mine.points[i] - direct.points[i]), 1e-3 * -direct.tip) << i;
}
INSTANTIATE_TEST_SUITE_P(Of, MinimisedBeam,
                         testing::Combine(testing::Values(TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_ST_VENANT_KIRCHHOFF,
                                                          TAUT_SOLID_COROTATED, TAUT_SOLID_FIXED_COROTATED),
                                          testing::Bool()));

// On its way down, in steps so short that one step of Newton's method, which the direct solver takes, is as good.
// Rayleigh's damping of what stress resists has no rows, as which elements come in other schemes.
TEST(MinimisedBeam, SwingsAsSolvedDirectly) {
    struct Way {
        taut_scheme scheme;
        double damping, rayleigh;
    };
    for (const Way& way : std::initializer_list<Way>{{TAUT_SCHEME_IMPLICIT_EULER, 0, 0},
                                                     {TAUT_SCHEME_IMPLICIT_EULER, 0.05, 0},
                                                     {TAUT_SCHEME_IMPLICIT_EULER, 0, 0.05},
                                                     {TAUT_SCHEME_NEWMARK, 0, 0},
                                                     {TAUT_SCHEME_NEWMARK, 0.05, 0},
                                                     {TAUT_SCHEME_BDF2, 0, 0},
                                                     {TAUT_SCHEME_BDF2, 0.05, 0}}) {
        const auto hang = [&](taut_solver solver) {
            return hang_beam(solver, TAUT_SOLID_FIXED_COROTATED, false, 15, way.damping, way.rayleigh, 16, way.scheme);
        };
        const Hung mine = hang(TAUT_SOLVER_MINIMISATION), direct = hang(TAUT_SOLVER_BLOCK_LDLT);
        EXPECT_LT(direct.tip, -0.01);
        EXPECT_NEAR(mine.tip, direct.tip, 0.02 * -direct.tip)
            << way.scheme << " " << way.damping << " " << way.rayleigh;
    }
}

// A sheet of each kind, held by a row, comes to rest where the direct solver has it.
TEST(MinimisedSheet, HangsAsSolvedDirectly) {
    for (const taut_cloth_kind kind : {TAUT_CLOTH_TRIANGLES, TAUT_CLOTH_LINKS}) {
        std::vector<Vec> at[2];
        for (int which = 0; which < 2; ++which) {
            const World world([&](taut_world_def& def) {
                def.solver = which ? TAUT_SOLVER_BLOCK_LDLT : TAUT_SOLVER_MINIMISATION;
                def.time_step = 1.0f / 60;
                def.substeps = 1;
            });
            const Sheet sheet(9, 7, 1, 0.7, 0);
            taut_cloth_def def = sheet.def(kind);
            if (kind == TAUT_CLOTH_LINKS) def.uv = nullptr;
            def.stretch_compliance[0] = def.stretch_compliance[1] = 1e-3f;
            def.shear_compliance = 1e-2f;
            def.stretch_stiffness[0] = def.stretch_stiffness[1] = 200;
            def.bending_stiffness = 1e-3f;
            def.shear_stiffness = 80;
            def.mass_damping = 5;
            def.filter.mask = 0;
            const taut_cloth cloth = add(world, def);
            for (int k = 0; k < 7; ++k) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
            world.step(900);
            at[which] = points_of(cloth);
        }
        for (size_t i = 0; i < at[0].size(); ++i) EXPECT_LT(norm(at[0][i] - at[1][i]), 1e-3) << kind << " " << i;
    }
}

// A held vertex that is led takes the rest with it, at its own speed.
TEST(MinimisedBeam, FollowsVerticesThatAreLed) {
    const World world = minimising([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Beam beam({0.5, 0.1, 0.1}, 6, 2, 2, false);
    taut_solid_def def = beam.def(TAUT_SOLID_FIXED_COROTATED, 1e6, 0.3);
    def.filter.mask = 0;
    def.damping = 0.01f;
    const taut_solid solid = add(world, def);
    beam.hold(solid);
    const std::vector<taut_body> vertices = bodies_of(solid);
    for (uint32_t v = 0; v < 4; ++v) ok(taut_body_set_velocity(vertices[v], {1, 0, 0}, {}));
    const double frames = 120;
    world.step(static_cast<int>(frames));
    const std::vector<Vec> after = points_of(solid);
    for (size_t v = 0; v < after.size(); ++v)
        EXPECT_NEAR(after[v].x, beam.points[v].x + frames * world.frame(), v < 4 ? 1e-5 : 2e-3) << v;
}

// ---------------------------------------------------------------- statics

// Random starts within a box, by seed.
std::vector<taut_pos> scattered(size_t count, uint64_t seed, const Vec& low, const Vec& high) {
    std::mt19937_64 random(seed);
    const auto between = [&](double a, double b) {
        return a + (b - a) * std::ldexp(static_cast<double>(random() >> 11), -53);
    };
    std::vector<taut_pos> out(count);
    for (taut_pos& p : out) p.x = between(low.x, high.x), p.y = between(low.y, high.y), p.z = between(low.z, high.z);
    return out;
}

constexpr float kRestWithin = 1e-5f;  // [m/s^2]

void relax(const World& world, uint32_t most = 5000) {
    taut_relaxation done{};
    ok(taut_world_relax(world.handle, kRestWithin, most, &done));
    EXPECT_EQ(done.converged, 1u) << done.steps << " steps leave " << done.residual;
    EXPECT_LT(done.residual, kRestWithin);
}

// A cantilever, from ten starts in which each vertex is off by up to half a beam's height, is where damped motion comes
// to rest, and stays there.
TEST(Relaxed, CantileverIsWhereMotionEnds) {
    const Beam beam({0.5, 0.1, 0.1}, 6, 2, 2, false);
    const Hung moved = hang_beam(TAUT_SOLVER_MINIMISATION, TAUT_SOLID_FIXED_COROTATED, false, 600, 0.4, 0, 1);
    for (uint64_t seed = 0; seed <= 10; ++seed) {
        const World world = minimising();
        taut_solid_def def = beam.def(TAUT_SOLID_FIXED_COROTATED, 1e5, 0.3);
        std::vector<taut_pos> points = beam.points;
        const std::vector<taut_pos> off = scattered(points.size(), seed, {-0.05, -0.05, -0.05}, {0.05, 0.05, 0.05});
        for (size_t v = 4; seed > 0 && v < points.size(); ++v)
            points[v] = {points[v].x + off[v].x, points[v].y + off[v].y, points[v].z + off[v].z};
        def.rest = def.points;
        def.points = points.data();
        def.filter.mask = 0;
        const taut_solid solid = add(world, def);
        beam.hold(solid);
        relax(world);
        const std::vector<Vec> at = points_of(solid);
        double most = 0, after = 0;
        for (size_t v = 0; v < at.size(); ++v) most = std::max(most, norm(at[v] - moved.points[v]));
        EXPECT_LT(most, 1e-3 * -moved.tip) << "start " << seed;
        world.step(10);
        const std::vector<Vec> then = points_of(solid);
        for (size_t v = 0; v < at.size(); ++v) after = std::max(after, norm(at[v] - then[v]));
        EXPECT_LT(after, 1e-5) << "start " << seed;
    }
}

// A limp strip that hardly stretches, hung by its ends: y = a cosh(x/a) - a cosh(d/2a), with the length 2 a sinh(d/2a).
TEST(Relaxed, StripHangsAsACatenary) {
    constexpr int kPoints = 61;
    constexpr double kLength = 1.2, kApart = 1;
    const Sheet strip(kPoints, 2, kLength, 0.02, 0);
    const World world = minimising();
    taut_cloth_def def = strip.def(TAUT_CLOTH_TRIANGLES);
    std::vector<taut_pos> points = strip.points;
    for (taut_pos& p : points) {  // along a parabola of about that length
        p.x *= kApart / kLength;
        p.y = 1.1 * (p.x - kApart) * p.x;
    }
    def.rest = def.points;
    def.points = points.data();
    def.stretch_stiffness[0] = def.stretch_stiffness[1] = 5e4f;
    def.shear_stiffness = 2e4f;
    def.filter.mask = 0;
    const taut_cloth cloth = add(world, def);
    for (const int i : {0, kPoints - 1})
        for (int k = 0; k < 2; ++k) ok(taut_cloth_pin(cloth, strip.at(i, k), 1));
    relax(world);
    double low = 0.01, high = 10;  // a
    for (int i = 0; i < 100; ++i) {
        const double a = 0.5 * (low + high);
        (2 * a * std::sinh(kApart / (2 * a)) > kLength ? low : high) = a;
    }
    const std::vector<Vec> at = points_of(cloth);
    const double sag = low * (std::cosh(kApart / (2 * low)) - 1);
    for (const Vec& p : at)
        EXPECT_NEAR(p.y, low * (std::cosh((p.x - kApart / 2) / low) - std::cosh(kApart / (2 * low))), 1e-3 * sag);
}

// A sheet hung by two corners, from ten starts in which each vertex is off by up to two edges: one rest.
TEST(Relaxed, SheetHasOneRest) {
    const Sheet sheet(11, 11, 1, 1, 0);
    std::vector<std::vector<Vec>> found;
    double sag = 0;
    for (uint64_t seed = 0; seed <= 10; ++seed) {
        const World world = minimising();
        taut_cloth_def def = sheet.def(TAUT_CLOTH_TRIANGLES);
        std::vector<taut_pos> points = sheet.points;
        const std::vector<taut_pos> off = scattered(points.size(), seed, {-0.2, -0.2, -0.2}, {0.2, 0.2, 0.2});
        for (size_t v = 0; seed > 0 && v < points.size(); ++v)
            if (v != sheet.at(0, 0) && v != sheet.at(0, 10))
                points[v] = {points[v].x + off[v].x, points[v].y + off[v].y, points[v].z + off[v].z};
        def.rest = def.points;
        def.points = points.data();
        def.bending_stiffness = 0.1f;
        def.filter.mask = 0;
        const taut_cloth cloth = add(world, def);
        for (const int k : {0, 10}) ok(taut_cloth_pin(cloth, sheet.at(0, k), 1));
        relax(world);
        found.push_back(points_of(cloth));
    }
    for (const Vec& p : found[0]) sag = std::max(sag, -p.y);
    for (size_t seed = 1; seed < found.size(); ++seed)
        for (size_t v = 0; v < found[0].size(); ++v)
            EXPECT_LT(norm(found[seed][v] - found[0][v]), 1e-3 * sag) << seed << ", vertex " << v;
}

TEST(Relaxed, RefusesWhatHasNoRest) {
    taut_relaxation done{};
    const World other;
    EXPECT_EQ(taut_world_relax(other.handle, 1e-3f, 100, &done), TAUT_UNSUPPORTED);
    TangledCube cube({Tangle::point, 3, 1e5, 10});
    const taut_world world = cube.world.handle;
    EXPECT_EQ(taut_world_relax(world, 0, 100, &done), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_relax(world, NAN, 100, &done), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_relax(world, 1e-3f, 0, &done), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_world_relax({0}, 1e-3f, 100, &done), TAUT_STALE_HANDLE);
    ok(taut_world_set_gravity(world, {0, -1, 0}));
    const uint64_t before = cube.hash();
    EXPECT_EQ(taut_world_relax(world, 1e-3f, 100, &done), TAUT_UNSUPPORTED);
    EXPECT_NE(std::string(taut_last_error()).find("nothing holds"), std::string::npos) << taut_last_error();
    EXPECT_EQ(cube.hash(), before);
    ok(taut_world_set_gravity(world, {0, 0, 0}));
    EXPECT_EQ(taut_world_relax(world, 1e-3f, 1000, &done), TAUT_OK);
    EXPECT_EQ(done.converged, 1u);
    EXPECT_LT(cube.largest_change(), 1e-3);
    EXPECT_EQ(taut_world_relax(world, 1e-3f, 1, nullptr), TAUT_OK);
}

// ---------------------------------------------------------------- as a world

TEST(MinimisedWorld, TakesNoMemoryOnceWarm) {
    TangledCube cube({Tangle::random, 5, 1e5, 10});
    cube.world.step(5);
    for (int i = 0; i < 5; ++i) {
        cube.world.step();
        EXPECT_EQ(cube.world.profile().allocations, 0u);
    }
}

TEST(MinimisedWorld, GoesOnAfterARestorationAsBefore) {
    TangledCube cube({Tangle::random, 5, 1e4, 10});
    cube.world.step(2);
    uint64_t bytes = 0;
    ok(taut_world_snapshot_size(cube.world.handle, &bytes));
    std::vector<uint8_t> saved(bytes);
    ok(taut_world_save(cube.world.handle, saved.data(), bytes, &bytes));
    cube.world.step(3);
    const uint64_t first = cube.hash();
    cube.world.step(2);
    ok(taut_world_restore(cube.world.handle, saved.data(), bytes));
    cube.world.step(3);
    EXPECT_EQ(cube.hash(), first);
}

// The step refuses what it does not take, by name, and changes nothing; without that it goes on.
TEST(MinimisedWorld, RefusesWhatItDoesNotTake) {
    TangledCube cube({Tangle::point, 3, 1e5, 10});
    const World& world = cube.world;
    const auto refused = [&](const char* text) {
        const uint64_t before = cube.hash();
        EXPECT_EQ(taut_world_step(world.handle), TAUT_UNSUPPORTED);
        EXPECT_NE(std::string(taut_last_error()).find(text), std::string::npos) << taut_last_error();
        EXPECT_EQ(taut_world_advance(world.handle, 0.1, nullptr), TAUT_UNSUPPORTED);
        EXPECT_EQ(cube.hash(), before);
    };
    world.step();
    const taut_body box = world.add({.shape = world.box({1, 1, 1}), .position = {9, 0, 0}, .mass = 1});
    refused("rigid dynamic body");
    ok(taut_body_remove(box));
    world.step();
    const taut_body a = world.particle(1, {5, 0, 0}), b = world.particle(1, {6, 0, 0});
    const taut_joint rod = world.rod(a, {}, b, {}, 1);
    refused("joints");
    ok(taut_joint_remove(rod));
    world.step();
    taut_attachment_def hold;
    taut_attachment_def_init(&hold);
    hold.compliance = 1e-3f;
    ok(taut_solid_find_anchor(cube.solid, {0.3, 0.4, 0.6}, &hold.a, nullptr));
    ok(taut_world_get_anchor(world.handle, {0}, {0.3, 0.4, 0.6}, &hold.b));
    taut_attachment held{};
    ok(taut_world_add_attachment(world.handle, &hold, &held));
    refused("attachments");
    ok(taut_attachment_remove(held));
    world.step();
    taut_particle_def touching;
    taut_particle_def_init(&touching);
    touching.shape = world.sphere(0.1);
    touching.position = {5, 5, 5};
    taut_body particle{};
    ok(taut_world_add_particle(world.handle, &touching, &particle));
    refused("filter.mask");
    ok(taut_body_remove(particle));
    const Sheet sheet(3, 3, 1, 1, 5);
    taut_cloth_def rigid = sheet.def(TAUT_CLOTH_LINKS);
    rigid.uv = nullptr;
    rigid.stretch_compliance[0] = 0;
    rigid.filter.mask = 0;
    const taut_cloth cloth = add(world, rigid);
    refused("compliance of 0");
    ok(taut_cloth_remove(cloth));
    world.step();
}

// A step of 1000 that only falls: what has no elements is moved as ever, and statics do not touch it.
TEST(MinimisedWorld, LetsParticlesFall) {
    const World world = minimising([](taut_world_def& def) {
        def.time_step = 1.0f / 60;
        def.substeps = 1;
    });
    const taut_body particle = world.particle(1, {0, 0, 0}, {1, 0, 0});
    world.step(60);
    EXPECT_NEAR(position(particle).x, 1, 1e-6);
    EXPECT_NEAR(position(particle).y, -kG * (1 + 1 / 60.0) / 2, 1e-4);  // implicit Euler's
}

}  // namespace
