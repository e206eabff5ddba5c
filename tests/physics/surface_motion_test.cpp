// Surfaces that resist rolling and spinning, surfaces that run, and how two surfaces make one contact: against the
// mechanics of a ball and a box.
#include <random>

#include "physics/lab.h"

namespace {

using namespace lab;

// How the contacts are solved: in lanes, as rows, or as part of a block that a joint makes.
enum class Way { lanes, rows, block };

void PrintTo(Way way, std::ostream* out) {
    *out << (way == Way::lanes ? "lanes" : way == Way::rows ? "rows" : "block");
}

class Surface : public testing::TestWithParam<Way> {
protected:
    Surface()
        : world([](taut_world_def& def) {
              if (GetParam() == Way::rows) def.solver = TAUT_SOLVER_ACCELERATED_JACOBI;
          }) {}

    // A body; for a block with a light rider fixed to its centre, which makes masses unequal enough.
    taut_body add(BodyPlan plan) const {
        plan.group = -1;
        const taut_body body = world.add(plan);
        if (GetParam() != Way::block) return body;
        plan.shape = world.sphere(0.01);
        plan.mass = mass_of(body).mass / 500;
        const taut_body rider = world.add(plan);
        taut_fixed_joint_def d;
        taut_fixed_joint_def_init(&d);
        d.base.body_a = body;
        d.base.body_b = rider;
        taut_joint out{};
        ok(taut_world_add_fixed_joint(world.handle, &d, &out));
        return body;
    }
    taut_body ball_on(const Vec& normal, const Vec& velocity = {}, const Vec& spin = {}) const {
        return add({.shape = world.sphere(kRadius),
                    .position = kRadius * normal,
                    .velocity = velocity,
                    .spin = spin,
                    .mass = 2,
                    .friction = 1,
                    .rolling = kArm,
                    .spinning = kSpinArm});
    }
    taut_body slope(double angle) const {
        return world.add({.kind = TAUT_BODY_STATIC,
                          .shape = world.plane({std::sin(angle), std::cos(angle), 0}),
                          .friction = 1,
                          .group = 0});
    }

    static constexpr double kRadius = 0.25, kArm = 0.02, kSpinArm = 0.01;  // [m]
    World world;
};

INSTANTIATE_TEST_SUITE_P(In, Surface, testing::Values(Way::lanes, Way::rows, Way::block));

void run_surface(taut_body body, const Vec& velocity, const Vec& spin = {}) {
    taut_collider collider{};
    uint32_t count = 0;
    ok(taut_body_get_colliders(body, &collider, 1, &count));
    ok(taut_collider_set_surface_velocity(collider, velocity.narrow(), spin.narrow()));
}

// Rolling without slip, friction F at the contact: m v' = -F and 2/5 m r v' = F r - arm m g, so v' = -5/7 arm g / r.
TEST_P(Surface, RollingFrictionSlowsABallAsItsArmSays) {
    slope(0);
    constexpr double kSpeed = 1;
    const taut_body ball = ball_on({0, 1, 0}, {kSpeed, 0, 0}, {0, 0, -kSpeed / kRadius});
    const double slows = 5.0 / 7 * kArm * kG / kRadius, stops = kSpeed / slows;
    world.step(static_cast<int>(0.5 * stops / world.frame()));
    EXPECT_NEAR(velocity(ball).x, 0.5 * kSpeed, 0.02 * kSpeed);
    world.step(static_cast<int>((0.5 * stops + 1) / world.frame()));
    EXPECT_NEAR(position(ball).x, kSpeed * kSpeed / (2 * slows), 0.03 * kSpeed * kSpeed / (2 * slows));
    EXPECT_LT(norm(velocity(ball)), 1e-3) << "still at rest";
    EXPECT_LT(norm(state(ball).spin), 1e-3);
}

// A slope moves the normal force by r tan(angle) from under the centre: held while that is within the arm.
TEST_P(Surface, RollingFrictionHoldsABallOnAGentleSlope) {
    const double angle = std::atan(0.95 * kArm / kRadius);
    slope(angle);
    const taut_body ball = ball_on({std::sin(angle), std::cos(angle), 0});
    world.step(60);
    const Vec start = position(ball);
    double fastest = 0;
    for (int i = 0; i < 300; ++i) {
        world.step();
        fastest = std::max(fastest, norm(velocity(ball)));
    }
    EXPECT_LT(norm(position(ball) - start), 1e-3);
    EXPECT_LT(fastest, 1e-3);
}

// v' = 5/7 (g sin(angle) - arm/r g cos(angle))
TEST_P(Surface, RollingFrictionSlowsABallOnASteepSlope) {
    const double angle = std::atan(2.5 * kArm / kRadius);
    slope(angle);
    const taut_body ball = ball_on({std::sin(angle), std::cos(angle), 0});
    world.step(180);
    const double exact = 5.0 / 7 * kG * (std::sin(angle) - kArm / kRadius * std::cos(angle));
    const Vec down(std::cos(angle), -std::sin(angle), 0);
    EXPECT_NEAR(dot(velocity(ball), down) / (exact * 180 * world.frame()), 1, 0.03);
}

// 2/5 m r^2 w' = -arm m g
TEST_P(Surface, SpinningFrictionStopsABallAsItsArmSays) {
    slope(0);
    const double slows = kSpinArm * kG / (0.4 * kRadius * kRadius), spin = 2 * slows;  // stops after 2 s
    const taut_body ball = ball_on({0, 1, 0}, {}, {0, spin, 0});
    world.step(60);
    EXPECT_NEAR(state(ball).spin.y / spin, 0.5, 0.02);
    world.step(75);
    EXPECT_LT(norm(state(ball).spin), 1e-3);
    world.step(60);
    EXPECT_LT(norm(state(ball).spin), 1e-3) << "stays so";
    EXPECT_LT(norm(velocity(ball)), 1e-3);
}

// Thrown and spun at random, balls lose energy only.
TEST_P(Surface, FrictionTorquesNeverAddEnergy) {
    slope(0);
    std::mt19937_64 engine(41);
    std::uniform_real_distribution<double> number(-1, 1);
    const auto any = [&] { return Vec(number(engine), number(engine), number(engine)); };
    for (int trial = 0; trial < 20; ++trial) {
        const Vec throws = any();
        const taut_body ball = ball_on({0, 1, 0}, {3 * throws.x, 0, 3 * throws.z}, 20 * any());
        double energy = totals({ball}).kinetic;
        for (int i = 0; i < 240; ++i) {
            world.step();
            const double now = totals({ball}).kinetic;
            ASSERT_LE(now, energy * 1.001 + 1e-5) << "trial " << trial << ", frame " << i;
            energy = now;
        }
        ok(taut_body_remove(ball));
    }
}

// ---------------------------------------------------------------- surfaces that run

constexpr double kBelt = 1.5, kFriction = 0.4;  // [m/s], [1]

// mu g up to the speed of the belt, and exactly that from there on.
TEST_P(Surface, ABeltTakesABoxAlong) {
    const taut_body belt = world.add({.kind = TAUT_BODY_KINEMATIC,
                                      .shape = world.box({30, 0.5, 2}),
                                      .position = {0, -0.5, 0},
                                      .rotation = Quat::turn({0, 1, 0}, 0.3),
                                      .friction = kFriction});
    run_surface(belt, {kBelt, 0.7, 0});  // what points out of the surface does nothing
    const Vec along = Quat::turn({0, 1, 0}, 0.3).rotate({1, 0, 0});
    const taut_body box = add({.shape = world.box({0.3, 0.2, 0.3}), .position = {0, 0.2, 0}, .friction = kFriction});
    const double reaches = kBelt / (kFriction * kG);
    const int half = static_cast<int>(0.5 * reaches / world.frame());
    world.step(half);
    EXPECT_NEAR(dot(velocity(box), along), kFriction * kG * world.stepped(half), 0.05 * kBelt);
    world.step(60);
    EXPECT_LT(norm(velocity(box) - kBelt * along), 2e-3);
    const Vec from = position(box);
    world.step(120);
    EXPECT_LT(norm(position(box) - from - 120 * world.frame() * kBelt * along), 2e-3);
    EXPECT_LT(norm(state(box).spin), 1e-3);
}

// The belt on the left runs towards +z, the one on the right towards -z: a box across the gap turns about +y in place.
TEST_P(Surface, TwoBeltsTurnABoxBetweenThem) {
    for (double side : {-1.0, 1.0}) {
        const taut_body belt = world.add({.kind = TAUT_BODY_STATIC,
                                          .shape = world.box({1, 0.5, 4}),
                                          .position = {1.3 * side, -0.5, 0},
                                          .friction = kFriction});
        run_surface(belt, {0, 0, -side * 0.5});
    }
    const taut_body box = add({.shape = world.box({0.5, 0.1, 0.1}), .position = {0, 0.1, 0}, .friction = kFriction});
    world.step(20);
    EXPECT_GT(state(box).spin.y, 0.2);
    EXPECT_LT(norm(position(box) - Vec(0, 0.1, 0)), 0.01);
}

// What lies on a table that turns at w turns with it, on its circle.
TEST_P(Surface, ATurntableCarriesABoxRound) {
    constexpr double kTurn = 0.8, kFrom = 1;  // [rad/s], [m]; w^2 r is well below mu g
    const taut_body table = world.add(
        {.kind = TAUT_BODY_STATIC, .shape = world.box({3, 0.5, 3}), .position = {4, -0.5, 0}, .friction = kFriction});
    run_surface(table, {}, {0, kTurn, 0});
    const taut_body box = add({.shape = world.box({0.1, 0.1, 0.1}),
                               .position = {4 + kFrom, 0.1, 0},
                               .velocity = {0, 0, -kTurn * kFrom},
                               .spin = {0, kTurn, 0},
                               .friction = kFriction});
    world.step(180);
    const double angle = kTurn * 180 * world.frame();
    const Vec exact(4 + kFrom * std::cos(angle), 0.1, -kFrom * std::sin(angle));
    EXPECT_LT(norm(position(box) - exact), 0.03);
    EXPECT_NEAR(state(box).spin.y, kTurn, 0.02);
}

// A vehicle on ice with a belt on it moves the other way: momentum stays zero, speeds differ by the belt's.
TEST_P(Surface, ABeltPushesItsOwnBodyBack) {
    world.add_ground(0);
    const taut_body vehicle =
        world.add({.shape = world.box({2, 0.25, 1}), .position = {0, 0.25, 0}, .mass = 30, .friction = kFriction});
    run_surface(vehicle, {kBelt, 0, 0});
    const taut_body box =
        add({.shape = world.box({0.2, 0.2, 0.2}), .position = {-1, 0.7, 0}, .mass = 10, .friction = kFriction});
    world.step(60);
    EXPECT_NEAR(velocity(box).x, kBelt * 30 / 40, 0.01 * kBelt);
    EXPECT_NEAR(velocity(vehicle).x, -kBelt * 10 / 40, 0.01 * kBelt);
}

// The same on any number of threads.
TEST(SurfaceDeterminism, ThreadsDoNotMatter) {
    uint64_t hashes[2];
    for (uint32_t threads : {1u, 4u}) {
        World world([&](taut_world_def& def) { def.threads = threads; });
        const taut_body ground = world.add_ground();
        run_surface(ground, {0.5, 0, 0.2}, {0, 0.3, 0});
        for (int i = 0; i < 200; ++i)
            world.add({.shape = i % 2 ? world.sphere(0.2) : world.box({0.2, 0.15, 0.2}),
                       .position = {0.5 * (i % 8), 0.3 + 0.45 * (i / 64), 0.5 * (i / 8 % 8)},
                       .rolling = 0.01,
                       .spinning = 0.02});
        world.step(90);
        ok(taut_world_get_state_hash(world.handle, &hashes[threads > 1]));
    }
    EXPECT_EQ(hashes[0], hashes[1]);
}

// ---------------------------------------------------------------- two surfaces, one contact

struct Rule {
    taut_combine a, b;
    double of_a, of_b, friction;
};

void PrintTo(const Rule& rule, std::ostream* out) { *out << "rules_" << rule.a << "_" << rule.b; }

class FrictionRule : public testing::TestWithParam<Rule> {};

// What a box thrown over the ground loses of its speed is the pair's friction.
TEST_P(FrictionRule, IsWhatSlowsABox) {
    const Rule rule = GetParam();
    World world;
    const taut_body ground = world.add_ground();
    const taut_body box =
        world.add({.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}, .velocity = {8, 0, 0}});
    taut_material material{};
    material.friction = static_cast<float>(rule.of_a);
    material.friction_rule = rule.a;
    ok(taut_body_set_material(ground, &material));
    material.friction = static_cast<float>(rule.of_b);
    material.friction_rule = rule.b;
    ok(taut_body_set_material(box, &material));
    world.step(30);
    const double lost = 8 - velocity(box).x;
    EXPECT_NEAR(lost, rule.friction * kG * 30 * world.frame(), 0.03 * lost + 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Rules, FrictionRule,
                         testing::Values(Rule{TAUT_COMBINE_DEFAULT, TAUT_COMBINE_DEFAULT, 0.2, 0.8, 0.4},
                                         Rule{TAUT_COMBINE_GEOMETRIC_MEAN, TAUT_COMBINE_GEOMETRIC_MEAN, 0.2, 0.8, 0.4},
                                         Rule{TAUT_COMBINE_AVERAGE, TAUT_COMBINE_AVERAGE, 0.2, 0.8, 0.5},
                                         Rule{TAUT_COMBINE_MINIMUM, TAUT_COMBINE_MINIMUM, 0.2, 0.8, 0.2},
                                         Rule{TAUT_COMBINE_PRODUCT, TAUT_COMBINE_PRODUCT, 0.5, 0.8, 0.4},
                                         Rule{TAUT_COMBINE_MAXIMUM, TAUT_COMBINE_MAXIMUM, 0.2, 0.8, 0.8},
                                         // ice stays slippery, unless the other surface says otherwise
                                         Rule{TAUT_COMBINE_DEFAULT, TAUT_COMBINE_DEFAULT, 0, 0.8, 0},
                                         Rule{TAUT_COMBINE_DEFAULT, TAUT_COMBINE_MAXIMUM, 0, 0.8, 0.8},
                                         // the later rule of the list
                                         Rule{TAUT_COMBINE_AVERAGE, TAUT_COMBINE_DEFAULT, 0.2, 0.8, 0.5},
                                         Rule{TAUT_COMBINE_AVERAGE, TAUT_COMBINE_MINIMUM, 0.2, 0.8, 0.2},
                                         Rule{TAUT_COMBINE_PRODUCT, TAUT_COMBINE_MINIMUM, 0.5, 0.8, 0.4},
                                         Rule{TAUT_COMBINE_MAXIMUM, TAUT_COMBINE_PRODUCT, 0.2, 0.8, 0.8}));

// A lively ball on a dead floor bounces by default, and not where the floor asks for the minimum.
TEST(RestitutionRule, IsWhatABallBouncesBy) {
    for (taut_combine rule : {TAUT_COMBINE_DEFAULT, TAUT_COMBINE_MINIMUM, TAUT_COMBINE_AVERAGE}) {
        World world;
        taut_material material{};
        material.restitution_rule = rule;
        ok(taut_body_set_material(world.add_ground(), &material));
        const taut_body ball = world.add({.shape = world.sphere(0.2), .position = {0, 1.2, 0}, .restitution = 0.8});
        double down = 0, up = 0;
        for (int i = 0; i < 60; ++i) {
            world.step();
            down = std::min(down, velocity(ball).y);
            up = std::max(up, velocity(ball).y);
        }
        const double share = rule == TAUT_COMBINE_DEFAULT ? 0.8 : rule == TAUT_COMBINE_AVERAGE ? 0.4 : 0;
        EXPECT_NEAR(up / -down, share, 0.06) << "rule " << rule;
    }
}

// A particle takes no torque and gives none: it slides as it would without.
TEST(SurfaceOfParticles, HasNoRollingFriction) {
    double reached[2];
    for (double arm : {0.0, 0.1}) {
        World world;
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(), .friction = 0.1, .rolling = arm, .spinning = arm});
        taut_particle_def d;
        taut_particle_def_init(&d);
        d.position = {0, 0.1, 0};
        d.velocity = {2, 0, 0};
        d.shape = world.sphere(0.1);
        taut_body grain{};
        ok(taut_world_add_particle(world.handle, &d, &grain));
        world.step(30);
        reached[arm > 0] = position(grain).x;
    }
    EXPECT_EQ(reached[0], reached[1]);
}

}  // namespace
