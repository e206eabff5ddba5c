// How soft bodies that are left to choose are solved.
#include "physics/deformable_lab.h"

namespace {

using namespace lab;

taut_deformable_solve solve_of(taut_cloth cloth) {
    taut_deformable_solve out{};
    ok(taut_cloth_get_solve(cloth, &out));
    return out;
}
taut_deformable_solve solve_of(taut_solid solid) {
    taut_deformable_solve out{};
    ok(taut_solid_get_solve(solid, &out));
    return out;
}

// A cube of 40 cm of 6 x 6 x 6 vertices.
taut_deformable_solve choice_of_cube(const std::function<void(taut_solid_def&)>& change, bool hexahedra = false,
                                     const std::function<void(taut_world_def&)>& world_of = {}) {
    const World world(world_of);
    const Beam cube({0.4, 0.4, 0.4}, 6, 6, 6, hexahedra);
    taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.4);
    def.solve = TAUT_DEFORMABLE_AUTO;
    if (change) change(def);
    return solve_of(add(world, def));
}

// Links along the threads of a square of 1.5 m and 0.2 kg/m^2.
taut_deformable_solve choice_of_sheet(int side, const std::function<void(taut_cloth_def&)>& change = {},
                                      const std::function<void(taut_world_def&)>& world_of = {}) {
    const World world(world_of);
    const Sheet sheet(side, side, 1.5, 1.5, 2);
    taut_cloth_def def = sheet.def(TAUT_CLOTH_LINKS);
    def.shear_compliance = std::numeric_limits<float>::infinity();
    def.solve = TAUT_DEFORMABLE_AUTO;
    if (change) change(def);
    return solve_of(add(world, def));
}

TEST(DeformableChoice, IsWhatADefSays) {
    for (const auto solve : {TAUT_DEFORMABLE_DIRECT, TAUT_DEFORMABLE_SWEPT}) {
        EXPECT_EQ(choice_of_cube([&](taut_solid_def& def) { def.solve = solve; }), solve);
        EXPECT_EQ(choice_of_sheet(10, [&](taut_cloth_def& def) { def.solve = solve; }), solve);
    }
}

// Sweeps hold jelly at any load, in far less time; what is stiffer than their shortest substeps, or long damped, or of
// other elements they do not.
TEST(DeformableChoice, SweepsSolidsThatSubstepsResolve) {
    EXPECT_EQ(choice_of_cube({}), TAUT_DEFORMABLE_SWEPT);
    EXPECT_EQ(choice_of_cube([](taut_solid_def& def) { def.young_modulus = 2e4f; }), TAUT_DEFORMABLE_SWEPT);
    EXPECT_EQ(choice_of_cube([](taut_solid_def& def) { def.young_modulus = 1e8f; }), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_cube([](taut_solid_def& def) { def.damping = 0.5f; }), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_cube([](taut_solid_def& def) { def.material = TAUT_SOLID_COROTATED; }), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_cube({}, true), TAUT_DEFORMABLE_DIRECT);
}

// What is stiff in steps of 1/60 s may be soft in those of 1/240 s.
TEST(DeformableChoice, KnowsTheStep) {
    const auto stiff = [](taut_solid_def& def) { def.young_modulus = 3e8f; };
    const auto fine = [](taut_world_def& def) { def.time_step = 1.0f / 240; };
    EXPECT_EQ(choice_of_cube(stiff), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_cube(stiff, false, fine), TAUT_DEFORMABLE_SWEPT);
    const auto fixed = [](taut_world_def& def) { def.fixed_substeps = 1; };
    EXPECT_EQ(choice_of_cube([](taut_solid_def& def) { def.young_modulus = 2e6f; }, false, fixed),
              TAUT_DEFORMABLE_DIRECT);
}

// Stiff cloth, which any load would stretch in sweeps, is swept where a direct solve has no time for it.
TEST(DeformableChoice, SweepsClothThatIsTooLargeForADirectSolve) {
    EXPECT_EQ(choice_of_sheet(20), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_sheet(100), TAUT_DEFORMABLE_SWEPT);
    EXPECT_EQ(choice_of_sheet(100, [](taut_cloth_def& def) { def.stretch_tolerance = 1e-3f; }), TAUT_DEFORMABLE_DIRECT);
    const Ball ball(0.5, 5);  // 10242 vertices
    taut_cloth_def def = ball.def();
    def.gas = 1;
    def.solve = TAUT_DEFORMABLE_AUTO;
    const World world;
    EXPECT_EQ(solve_of(add(world, def)), TAUT_DEFORMABLE_DIRECT);
}

TEST(DeformableChoice, IsDirectWhereTheWorldsSolverTakesAllAlike) {
    const auto other = [](taut_world_def& def) { def.solver = TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL; };
    EXPECT_EQ(choice_of_cube({}, false, other), TAUT_DEFORMABLE_DIRECT);
    EXPECT_EQ(choice_of_sheet(100, {}, other), TAUT_DEFORMABLE_DIRECT);
}

// One that chose is as one that was told.
TEST(DeformableChoice, MakesWhatItChose) {
    uint32_t triangles[2], worlds = 0;
    for (const auto solve : {TAUT_DEFORMABLE_AUTO, TAUT_DEFORMABLE_SWEPT}) {
        const World world;
        const Beam cube({0.4, 0.4, 0.4}, 6, 6, 6, false);
        taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, 1e5, 0.4);
        def.solve = solve;
        const taut_solid solid = add(world, def);
        EXPECT_EQ(solve_of(solid), TAUT_DEFORMABLE_SWEPT);
        uint32_t& count = triangles[worlds++];
        EXPECT_EQ(taut_solid_get_triangles(solid, nullptr, 0, &count), TAUT_TOO_SMALL);
    }
    EXPECT_EQ(triangles[0], triangles[1]);
}

}  // namespace
