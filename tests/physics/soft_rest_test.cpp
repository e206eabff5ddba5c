// Swept solids at rest stay at rest, whatever their shape, material and step: none is swept beyond what sweeps hold.
#include <algorithm>
#include <cmath>

#include "physics/deformable_lab.h"
#include "scenes/random.h"

namespace lab {
namespace {

constexpr int kBlocks = 40;

// Between two numbers, each decade alike.
double decades(scenes::Random& random, double low, double high) { return low * std::pow(high / low, random.uniform()); }

// Cells of random proportions, half of them uneven, turned about.
Beam random_block(scenes::Random& random) {
    const auto side = [&] { return 0.1 + 0.5 * random.uniform(); };
    const auto vertices = [&] { return 2 + static_cast<int>(random.bits() % 3); };
    Beam block({side(), side(), side()}, vertices(), vertices(), vertices(), false);
    const double uneven = random.bits() % 2 ? 0.2 : 0;
    const Quat turn = Quat::turn(Vec(random.direction()), 3 * random.uniform());
    for (taut_pos& p : block.points) {
        const Vec by(block.extent.x / (block.n[0] - 1) * random.around_zero(),
                     block.extent.y / (block.n[1] - 1) * random.around_zero(),
                     block.extent.z / (block.n[2] - 1) * random.around_zero());
        p = turn.rotate(Vec(p) + uneven * by).pos();
    }
    return block;
}

// Without gravity: the fastest vertex after a second [m/s]. Before substeps were bounded by what holds and stiffness by
// what the most of them hold, half of these shook, at up to 600 m/s.
TEST(SweptSolids, OfAnyShapeStayAtRest) {
    scenes::Random random(5);
    for (int i = 0; i < kBlocks; ++i) {
        const double hz = 30 << random.bits() % 3;
        const World world([&](taut_world_def& def) {
            def.time_step = static_cast<float>(1 / hz);
            def.gravity = {0, 0, 0};
        });
        const Beam block = random_block(random);
        taut_solid_def def = block.def(TAUT_SOLID_NEO_HOOKEAN, decades(random, 1e4, 1e8), 0.49 * random.uniform());
        def.density = static_cast<float>(decades(random, 30, 6000));
        def.solve = TAUT_DEFORMABLE_SWEPT;
        const taut_solid solid = add(world, def);
        world.step(static_cast<int>(hz));
        double fastest = 0;
        for (const taut_body body : bodies_of(solid)) fastest = std::max(fastest, norm(velocity(body)));
        EXPECT_LT(fastest, 0.01) << "block " << i << " at " << hz << " Hz, " << world.profile().substeps << " substeps";
    }
}

// Of other laws and cells: free fall gains nothing, and taut_solid_get_solve says how they are solved.
TEST(SweptSolids, WithoutASweepOfTheirOwnAreSolvedDirectly) {
    for (const bool hexahedra : {false, true})
        for (const taut_solid_material law : {TAUT_SOLID_NEO_HOOKEAN, TAUT_SOLID_ST_VENANT_KIRCHHOFF,
                                              TAUT_SOLID_COROTATED, TAUT_SOLID_FIXED_COROTATED}) {
            const World world;
            Beam block({0.22, 0.15, 0.22}, 4, 3, 3, hexahedra);
            taut_solid_def def = block.def(law, 2e6, 0.26);
            def.density = 4000;
            def.solve = TAUT_DEFORMABLE_SWEPT;
            const taut_solid solid = add(world, def);
            taut_deformable_solve solve{};
            ok(taut_solid_get_solve(solid, &solve));
            const bool sweeps = !hexahedra && law == TAUT_SOLID_NEO_HOOKEAN;
            EXPECT_EQ(solve, sweeps ? TAUT_DEFORMABLE_SWEPT : TAUT_DEFORMABLE_DIRECT);
            const std::vector<taut_body> bodies = bodies_of(solid);
            const double before = totals(bodies).height;
            world.step(60);
            const Totals after = totals(bodies);
            EXPECT_LE(after.kinetic + kG * after.height, kG * before);
            for (const taut_body body : bodies)
                EXPECT_LT(norm(velocity(body) - 1 / after.mass * after.momentum), 0.01) << hexahedra << law;
        }
}

}  // namespace
}  // namespace lab
