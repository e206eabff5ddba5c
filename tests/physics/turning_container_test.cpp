// What lies in a kinematic container that turns is taken along and gains no energy from its walls beyond that.
#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

// Four walls about the y axis.
taut_body add_container(const World& world, double spin) {
    const taut_body body = world.add({.kind = TAUT_BODY_KINEMATIC, .spin = {0, spin, 0}});
    for (int side = 0; side < 4; ++side) {
        const Quat turned = Quat::turn({0, 1, 0}, side * kPi / 2);
        taut_collider_def def;
        taut_collider_def_init(&def);
        def.shape = world.box({0.05, 3, 2});
        def.position = turned.rotate({1.95, 0, 0}).narrow();
        def.rotation = turned.narrow();
        def.material.friction = 0.5f;
        taut_collider collider{};
        ok(taut_body_add_collider(body, &def, &collider));
    }
    return body;
}

enum class Thing { ball, box, plate };

taut_body add_thing(const World& world, Thing thing, double size, double spin, std::mt19937& random) {
    const Vec at(between(random, 1, 1.5), 0, between(random, -0.3, 0.3));
    return world.add({.shape = thing == Thing::ball  ? world.sphere(size)
                               : thing == Thing::box ? world.box({size, 0.7 * size, 0.8 * size})
                                                     : world.box({size, 0.15 * size, 0.7 * size}),
                      .position = at,
                      .rotation = Quat::turn(random_direction(random), between(random, 0, kPi)),
                      .velocity = cross({0, spin, 0}, at),
                      .spin = {0, spin, 0}});
}

// As seen from the container [J/kg]: kinetic and centrifugal energy, E - w . L.
double energy(taut_body body, double spin) {
    const Totals t = totals({body});
    const Vec own = t.spin + cross(t.centre, t.momentum);
    return (t.kinetic - spin * own.y) / t.mass;
}

struct Turning {
    Thing thing;
    double size, spin;  // [m], [rad/s]
};

void PrintTo(const Turning& turning, std::ostream* out) {
    *out << (turning.thing == Thing::ball  ? "balls"
             : turning.thing == Thing::box ? "boxes"
                                           : "plates")
         << " of " << turning.size << " m at " << turning.spin << " rad/s";
}

class TurningContainer : public testing::TestWithParam<Turning> {};

TEST_P(TurningContainer, GivesNoEnergy) {
    const auto [thing, size, spin] = GetParam();
    for (unsigned seed = 1; seed <= 20; ++seed) {
        std::mt19937 random(seed);
        World world(weightless);
        add_container(world, spin);
        const taut_body body = add_thing(world, thing, size, spin, random);
        double least = energy(body, spin), gained = 0;
        for (int frame = 0; frame < 300; ++frame) {
            world.step();
            const double now = energy(body, spin);
            gained = std::max(gained, now - least);
            least = std::min(least, now);
        }
        EXPECT_LT(gained, 0.1 * spin * spin) << "J/kg, seed " << seed;
    }
}

INSTANTIATE_TEST_SUITE_P(Of, TurningContainer,
                         testing::Values(Turning{Thing::ball, 0.02, 2}, Turning{Thing::ball, 0.05, 6},
                                         Turning{Thing::box, 0.02, 2}, Turning{Thing::plate, 0.05, 6}));

// Islands that take fewer substeps are solved before: the table has turned no further for the others.
TEST(TurningTable, TurnsAnewForEachGroup) {
    const auto run = [](bool other) {
        World world([](taut_world_def& def) { def.solver = TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL; });
        world.add({.kind = TAUT_BODY_KINEMATIC,
                   .shape = world.box({3, 0.25, 3}),
                   .position = {0, -0.25, 0},
                   .spin = {0, 1, 0}});
        world.add({.shape = world.box({0.3, 0.1, 0.3}), .position = {1.5, 0.1, 0}, .mass = 1});
        const taut_body load = world.add({.shape = world.box({0.3, 0.1, 0.3}), .position = {1.5, 0.3, 0}, .mass = 20});
        if (other) world.add({.shape = world.sphere(0.1), .position = {-1, 0.1, 0}});
        world.step(60);
        EXPECT_GT(world.profile().substeps, world.def.substeps) << "one group";
        return position(load);
    };
    EXPECT_EQ(norm(run(true) - run(false)), 0);
}

}  // namespace
