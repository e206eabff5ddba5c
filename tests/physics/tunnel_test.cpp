// Nothing tunnels: bodies that pass many times their own thickness in a step, against walls thinner than that.
#include "physics/tunnel_lab.h"

using namespace lab;

namespace {

enum class Bullet { ball, box, rod, hull };

taut_shape shape_of(const World& world, Bullet bullet) {
    if (bullet == Bullet::ball) return world.sphere(0.02);
    if (bullet == Bullet::box) return world.box({0.05, 0.03, 0.04});
    if (bullet == Bullet::rod) return world.capsule(0.01, 0.3);
    const taut_vec3 points[] = {
        {0.06f, 0, 0}, {-0.04f, 0.04f, 0.01f}, {-0.03f, -0.04f, 0}, {0, 0.01f, 0.05f}, {0, 0, -0.05f}};
    taut_hull_def d;
    taut_hull_def_init(&d);
    d.points = points;
    d.point_count = 5;
    taut_shape out{};
    ok(taut_world_add_hull(world.handle, &d, &out));
    return out;
}

struct Row {
    const char* name;
    Bullet bullet;
    Wall wall;
};

struct Tunnel : testing::TestWithParam<Row> {};

// Of 40 shots at a speed, those that came through, in any step before they are due to have slid off the wall.
int through(const Row& row, double speed, double restitution, uint32_t seed) {
    std::mt19937 random(seed);
    // The ground has no other side: what sinks in comes back. A hull's origin is off its middle.
    const double beyond = row.wall == Wall::plane ? 0.3 : row.bullet == Bullet::hull ? 0.05 : 0;
    int lost = 0;
    for (int shot = 0; shot < 40; ++shot) {
        World world(weightless);
        world.add({.kind = TAUT_BODY_STATIC, .shape = shape_of(world, row.wall), .restitution = restitution});
        const double angle = between(random, 0, 0.7), round = between(random, 0, 2 * kPi);
        const Vec way(std::cos(angle), std::sin(angle) * std::cos(round), std::sin(angle) * std::sin(round));
        const Vec start = -between(random, 0.6, 3) * way;
        const taut_body bullet = world.add({.shape = shape_of(world, row.bullet),
                                            .position = start,
                                            .rotation = Quat::turn(random_direction(random), between(random, 0, kPi)),
                                            .velocity = speed * way,
                                            .spin = between(random, 0, 60) * random_direction(random),
                                            .mass = 0.1,
                                            .restitution = restitution});
        bool passed = false;
        for (int frame = 0; frame * world.frame() * speed < 4; ++frame) {
            world.step();
            const Vec p = position(bullet);
            passed = passed || !finite(bullet) || (p.x > beyond && std::abs(p.y) < 5.5 && std::abs(p.z) < 5.5);
        }
        lost += passed;
    }
    return lost;
}

TEST_P(Tunnel, NothingComesThroughAtAnySpeed) {
    for (double speed : {20.0, 50.0, 100.0, 300.0, 1000.0, 5000.0})
        for (double restitution : {0.0, 0.7})
            EXPECT_EQ(through(GetParam(), speed, restitution, 7), 0) << speed << " m/s, restitution " << restitution;
}

const Row kRows[] = {
    {"ball_thick", Bullet::ball, Wall::thick}, {"ball_plate", Bullet::ball, Wall::plate},
    {"ball_sheet", Bullet::ball, Wall::sheet}, {"ball_mesh", Bullet::ball, Wall::mesh},
    {"ball_plane", Bullet::ball, Wall::plane}, {"box_plate", Bullet::box, Wall::plate},
    {"box_sheet", Bullet::box, Wall::sheet},   {"box_mesh", Bullet::box, Wall::mesh},
    {"box_plane", Bullet::box, Wall::plane},   {"rod_plate", Bullet::rod, Wall::plate},
    {"rod_sheet", Bullet::rod, Wall::sheet},   {"rod_mesh", Bullet::rod, Wall::mesh},
    {"rod_plane", Bullet::rod, Wall::plane},   {"hull_plate", Bullet::hull, Wall::plate},
    {"hull_mesh", Bullet::hull, Wall::mesh},   {"hull_plane", Bullet::hull, Wall::plane},
};

std::string name_of(const testing::TestParamInfo<Row>& row) { return row.param.name; }

INSTANTIATE_TEST_SUITE_P(Bullets, Tunnel, testing::ValuesIn(kRows), name_of);

// Both are thrown at each other; what they do to each other conserves momentum.
TEST(Continuous, TwoBulletsMeetHeadOn) {
    for (double speed : {50.0, 500.0, 3000.0}) {
        World world(weightless);
        const taut_shape ball = world.sphere(0.02);
        const taut_body left =
            world.add({.shape = ball, .position = {-1.3, 0, 0}, .velocity = {speed, 0, 0}, .mass = 0.1});
        const taut_body right =
            world.add({.shape = ball, .position = {0.9, 0, 0}, .velocity = {-0.7 * speed, 0, 0}, .mass = 0.3});
        const double momentum = totals({left, right}).momentum.x;
        world.step(20);
        EXPECT_LT(position(left).x, position(right).x) << speed;
        EXPECT_NEAR(totals({left, right}).momentum.x, momentum, 1e-4 * 0.1 * speed);
        for (taut_body ball_of : {left, right}) EXPECT_NEAR(velocity(ball_of).x, momentum / 0.4, 1e-3 * speed);
    }
}

TEST(Continuous, ABulletTakesAThinPlateAlong) {
    for (double speed : {50.0, 500.0, 3000.0}) {
        World world(weightless);
        const taut_body plate = world.add({.shape = world.box({0.005, 1, 1}), .mass = 2});
        const taut_body ball =
            world.add({.shape = world.sphere(0.02), .position = {-3.1, 0, 0}, .velocity = {speed, 0, 0}, .mass = 0.1});
        world.step(30);
        EXPECT_LT(position(ball).x, position(plate).x) << speed;
        EXPECT_NEAR(velocity(plate).x, 0.1 * speed / 2.1, 1e-3 * speed);
        EXPECT_NEAR(velocity(ball).x, 0.1 * speed / 2.1, 1e-3 * speed);
    }
}

TEST(Continuous, AOneWayPlatformLetsABulletThroughFromBehindOnly) {
    for (double side : {-1.0, 1.0}) {
        World world(weightless);
        const taut_body platform = world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({1, 0.01, 1})});
        taut_collider collider{};
        uint32_t count = 0;
        ok(taut_body_get_colliders(platform, &collider, 1, &count));
        ok(taut_collider_set_one_way(collider, {0, 1, 0}));
        const taut_body ball = world.add({.shape = world.sphere(0.02),
                                          .position = {0, side * 4.1, 0},
                                          .velocity = {0, -side * 200, 0},
                                          .mass = 0.1});
        world.step(10);
        if (side < 0)
            EXPECT_NEAR(velocity(ball).y, 200, 0.01);
        else
            EXPECT_NEAR(position(ball).y, 0.03, 0.01);
        EXPECT_NEAR(position(ball).y, side < 0 ? -4.1 + 200 * 10 * world.frame() : 0.03, 0.01);
    }
}

// How deep a ball gets into a plate that it hits at one of many moments of a frame [m], at most.
double deepest_hit(taut_solver solver, double speed, bool one_way, bool jointed) {
    constexpr int kMoments = 50;
    double deepest = 0;
    for (int k = 0; k < kMoments; ++k) {
        World world([&](taut_world_def& def) {
            weightless(def);
            def.solver = solver;
        });
        const taut_body plate = world.add({.kind = jointed ? TAUT_BODY_DYNAMIC : TAUT_BODY_STATIC,
                                           .shape = world.box({0.5, 0.05, 0.5}),
                                           .mass = 1000});
        if (jointed) {
            taut_fixed_joint_def def;
            taut_fixed_joint_def_init(&def);
            def.base.body_b = plate;
            taut_joint joint{};
            ok(taut_world_add_fixed_joint(world.handle, &def, &joint));
        }
        taut_collider collider{};
        uint32_t count = 0;
        ok(taut_body_get_colliders(plate, &collider, 1, &count));
        if (one_way) ok(taut_collider_set_one_way(collider, {0, 1, 0}));
        const taut_body ball = world.add({.shape = world.sphere(0.02),
                                          .position = {0, 2 + k * speed * world.frame() / kMoments, 0},
                                          .velocity = {0, -speed, 0},
                                          .mass = 0.1});
        for (double time = 0; time < 3 / speed + 0.2; time += world.frame()) {
            world.step(1);
            deepest = std::max(deepest, 0.07 - position(ball).y);
        }
    }
    return deepest;
}

// A soft contact would leave a fast one some of its speed for a substep: at 1000 m/s 120 mm of way.
TEST(Continuous, WhatHitsStopsAtTheSurface) {
    for (double speed : {20.0, 100.0, 300.0, 1000.0}) {
        SCOPED_TRACE(testing::Message() << speed << " m/s");
        for (taut_solver solver :
             {TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, TAUT_SOLVER_ACCELERATED_JACOBI}) {
            EXPECT_LT(deepest_hit(solver, speed, false, false), 3e-4) << "solver " << solver;
            EXPECT_LT(deepest_hit(solver, speed, true, false), 3e-4) << "one-way, solver " << solver;
        }
        EXPECT_LT(deepest_hit(TAUT_SOLVER_BLOCK_LDLT, speed, false, true), 5e-4) << "jointed";
    }
}

// A rod about a pivot sweeps through more than a right angle in a step; the post stands in its way.
TEST(Continuous, ASpinningRodStopsAtAPost) {
    for (double spin : {20.0, 60.0, 150.0}) {
        World world(weightless);
        const taut_body rod = world.add({.shape = shape_of(world, Bullet::rod),
                                         .rotation = Quat::turn({0, 0, 1}, kPi / 2),
                                         .spin = {0, spin, 0},
                                         .mass = 1,
                                         .inertia = {0.03, 0.0001, 0.03}});
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.01, 0.5, 0.01}), .position = {0.25, 0, -0.12}});
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.01, 0.5, 0.01}), .position = {-0.25, 0, 0.12}});
        double turned = 0;
        for (int i = 0; i < 60; ++i) {
            world.step();
            turned += state(rod).spin.y * world.frame();
        }
        EXPECT_LT(turned, kPi / 2) << spin;
    }
}

enum class Slim { rod, cylinder, beam };

taut_shape shape_of(const World& world, Slim slim) {
    if (slim == Slim::rod) return shape_of(world, Bullet::rod);
    if (slim == Slim::beam) return world.box({0.01, 0.3, 0.01});
    return world.cylinder(0.01, 0.3);
}

struct Bounce {
    const char* name;
    Slim slim;
    double friction, restitution;
};

void PrintTo(const Bounce& bounce, std::ostream* out) { *out << bounce.name; }

struct ThinAndSpinning : testing::TestWithParam<Bounce> {};

// The largest kinetic energy of a thin body thrown at a plane, over that which it had at first.
double largest_energy(const Bounce& bounce, double speed, std::mt19937& random) {
    World world(weightless);
    const auto [name, slim, friction, restitution] = bounce;
    world.add(
        {.kind = TAUT_BODY_STATIC, .shape = world.plane({-1, 0, 0}), .friction = friction, .restitution = restitution});
    const taut_body body = world.add({.shape = shape_of(world, slim),
                                      .position = {-between(random, 0.6, 3), 0, 0},
                                      .rotation = Quat::turn(random_direction(random), between(random, 0, kPi)),
                                      .velocity = {speed, 0, 0},
                                      .spin = between(random, 0, 60) * random_direction(random),
                                      .mass = 0.1,
                                      .friction = friction,
                                      .restitution = restitution});
    const double before = totals({body}).kinetic;
    double most = 0;
    for (int frame = 0; frame < 20 || frame * world.frame() * speed < 4; ++frame) {
        world.step();
        most = std::max(most, totals({body}).kinetic);
    }
    return most / before;
}

// Without weight nothing gives a thin body energy, however fast it spins.
TEST_P(ThinAndSpinning, GainsNoEnergy) {
    constexpr int kShots = 40;
    std::mt19937 random(11);
    const bool bounces = GetParam().restitution > 0;
    int gained = 0, shots = 0;
    for (const double speed : {2.0, 5.0, 20.0, 50.0, 100.0, 300.0})
        for (int shot = 0; shot < kShots; ++shot, ++shots) {
            const double most = largest_energy(GetParam(), speed, random);
            gained += most > 1.05;
            EXPECT_LT(most, bounces ? 1.5 : 1.05) << speed << " m/s, shot " << shot;
        }
    EXPECT_LE(gained, bounces ? shots / 50 : 0) << "by more than 5 %";
}

INSTANTIATE_TEST_SUITE_P(
    Of, ThinAndSpinning,
    testing::Values(Bounce{"rod_smooth", Slim::rod, 0, 0}, Bounce{"rod_rough", Slim::rod, 0.5, 0},
                    Bounce{"rod_smooth_bounces", Slim::rod, 0, 0.7}, Bounce{"rod_rough_bounces", Slim::rod, 0.5, 0.7},
                    Bounce{"cylinder_smooth", Slim::cylinder, 0, 0}, Bounce{"cylinder_rough", Slim::cylinder, 0.5, 0},
                    Bounce{"cylinder_smooth_bounces", Slim::cylinder, 0, 0.7},
                    Bounce{"cylinder_rough_bounces", Slim::cylinder, 0.5, 0.7},
                    Bounce{"beam_rough", Slim::beam, 0.5, 0}, Bounce{"beam_smooth_bounces", Slim::beam, 0, 0.7},
                    Bounce{"beam_rough_bounces", Slim::beam, 0.5, 0.7}),
    [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
