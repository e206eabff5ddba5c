// Soft solids that are solved directly, in motions that one step of Newton's method does not hold.
#include <random>

#include "physics/deformable_lab.h"
#include "physics/joint_lab.h"

namespace {

using namespace lab;

double kinetic(const std::vector<taut_body>& bodies) {
    double sum = 0;
    for (const taut_body body : bodies) sum += 0.5 * mass_of(body).mass * dot(velocity(body), velocity(body));
    return sum;
}

uint32_t inverted_in(taut_solid solid) {
    uint32_t count = 0;
    taut_solid_get_volumes(solid, nullptr, 0, &count);
    std::vector<float> ratios(count);
    ok(taut_solid_get_volumes(solid, ratios.data(), count, &count));
    return static_cast<uint32_t>(std::ranges::count_if(ratios, [](float ratio) { return ratio <= 0; }));
}

// A cube of 10 cm whose vertices are thrown about in space: at 30 m/s they go by up to ten of its edges in a substep.
class ThrownAbout : public testing::TestWithParam<std::tuple<double, double, double>> {};
INSTANTIATE_TEST_SUITE_P(AtHertz, ThrownAbout,
                         testing::Combine(testing::Values(30, 60, 120, 240), testing::Values(1e4, 1e5),
                                          testing::Values(3, 10, 30)));

// Implicit Euler takes energy away, whatever it begins with, and jelly comes back to its shape.
TEST_P(ThrownAbout, GainsNoEnergyAndUntangles) {
    const auto [hz, young, speed] = GetParam();
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        const World world([&, hz = hz](taut_world_def& def) {
            def.gravity = {0, 0, 0};
            def.time_step = static_cast<float>(1 / hz);
        });
        const Beam cube({0.1, 0.1, 0.1}, 3, 3, 3, false);
        taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, young, 0.45);
        def.solve = TAUT_DEFORMABLE_DIRECT;
        const taut_solid solid = add(world, def);
        const std::vector<taut_body> bodies = bodies_of(solid);
        std::mt19937_64 engine(seed);
        std::normal_distribution<double> number;
        Vec momentum;
        for (const taut_body body : bodies) {
            const Vec v = speed * Vec(number(engine), number(engine), number(engine));
            ok(taut_body_set_velocity(body, v.narrow(), {}));
        }
        momentum = momentum_of(bodies);
        const double begin = kinetic(bodies);
        for (int i = 0; i < static_cast<int>(hz); ++i) {
            world.step();
            ASSERT_LE(kinetic(bodies), begin) << seed;
        }
        EXPECT_EQ(inverted_in(solid), 0u) << seed;
        EXPECT_LE(norm(momentum_of(bodies) - momentum), 1e-5 * speed) << seed;
    }
}

// What hangs on it by a rod comes along, and the rod holds.
TEST(ThrownAbout, KeepsItsTies) {
    const World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const Beam cube({0.1, 0.1, 0.1}, 3, 3, 3, false);
    taut_solid_def def = cube.def(TAUT_SOLID_NEO_HOOKEAN, 1e4, 0.45);
    def.solve = TAUT_DEFORMABLE_DIRECT;
    const taut_solid solid = add(world, def);
    const std::vector<taut_body> bodies = bodies_of(solid);
    const taut_body weight = world.particle(0.1, {0.2, 0.05, 0.05});
    const taut_joint rod = world.rod(bodies[cube.at(2, 1, 1)], {}, weight, {}, 0.1);
    std::mt19937_64 engine(1);
    std::normal_distribution<double> number;
    for (const taut_body body : bodies)
        ok(taut_body_set_velocity(body, (20 * Vec(number(engine), number(engine), number(engine))).narrow(), {}));
    const double begin = kinetic(bodies);
    for (int i = 0; i < 60; ++i) {
        world.step();
        ASSERT_LE(kinetic(bodies) + kinetic({weight}), begin) << i;
    }
    EXPECT_LE(error(rod), 1e-3);
    EXPECT_EQ(inverted_in(solid), 0u);
}

}  // namespace
