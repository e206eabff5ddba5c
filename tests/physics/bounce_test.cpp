// Restitution: heights and speeds after impacts, against those of ballistic flights and of elastic impacts.
#include "physics/bounce_lab.h"
#include "physics/surface_lab.h"

namespace {

using namespace lab;

enum class Floor { plane, box, mesh };

taut_body add_floor(const World& world, Floor floor, double restitution) {
    BodyPlan plan{.kind = TAUT_BODY_STATIC, .friction = 0, .restitution = restitution};
    plan.shape = world.plane();
    if (floor == Floor::box) plan.shape = world.box({8, 0.75, 8}), plan.position = {0, -0.75, 0};
    if (floor == Floor::mesh) plan.shape = mesh(world, grid(12, 12, 1.5)), plan.position = {-6, 0, -6};
    return world.add(plan);
}

struct Rate {
    int hz;
    uint32_t substeps;
};
void PrintTo(const Rate& rate, std::ostream* out) { *out << rate.hz << " Hz, " << rate.substeps << " substeps"; }

auto at_rate(const Rate& rate, double gravity = kG) {
    return [=](taut_world_def& def) {
        def.time_step = 1.0f / static_cast<float>(rate.hz);
        def.substeps = rate.substeps;
        def.gravity = {0, static_cast<float>(-gravity), 0};
    };
}

class Bounces : public testing::TestWithParam<Rate> {};

// To e^2 of the height, whatever that is, as long as it hits faster than gravity makes it within a substep. Dropped
// from rest it hits as from g h^2 / 8 higher up: the first substep falls by the whole of its speed. Contacts are looked
// for as far as a body comes without falling any faster: at 30 Hz it may go in by half a millimetre before it is seen.
TEST_P(Bounces, ToTheSquareOfRestitution) {
    const Rate rate = GetParam();
    for (const double gravity : {kG, 1.62})
        for (const double e : {0.3, 0.5, 0.8})
            for (const double drop : {0.005, 0.03, 0.4, 5.0}) {
                World world(at_rate(rate, gravity));
                add_floor(world, Floor::plane, 0);
                const double radius = std::min(0.2, 2 * drop), h = world.frame() / rate.substeps;
                const double fall = drop + gravity * h * h / 8, least = std::pow(gravity * h, 2) / (2 * gravity);
                const taut_body ball = world.add({.shape = world.sphere(radius),
                                                  .position = {0, radius + drop, 0},
                                                  .friction = 0,
                                                  .restitution = e});
                const auto tops = peaks(world, ball, radius, 2, 12);
                for (size_t i = 0; i < 2; ++i) {
                    const double from = fall * std::pow(e, 2.0 * static_cast<double>(i));
                    const double flight = e * std::sqrt(8 * from / gravity);
                    if (from < 1.5 * least || flight < 2.5 * world.frame()) break;
                    ASSERT_GT(tops.size(), i) << "from " << drop << " m, e = " << e << ", g = " << gravity;
                    EXPECT_NEAR(tops[i] / (e * e * from), 1, 0.015)
                        << "bounce " << i << " from " << drop << " m, e = " << e << ", g = " << gravity;
                }
            }
}

TEST_P(Bounces, WithoutLossForEver) {
    for (const Floor floor : {Floor::plane, Floor::box, Floor::mesh})
        for (const double drop : {0.07, 1.3}) {
            World world(at_rate(GetParam()));
            add_floor(world, floor, 1);
            const taut_body ball = world.add(
                {.shape = world.sphere(0.23), .position = {0.17, 0.23 + drop, 0.29}, .friction = 0, .restitution = 1});
            const auto tops = peaks(world, ball, 0.23, 15, 40);
            ASSERT_EQ(tops.size(), 15u);
            for (const double top : tops) EXPECT_NEAR(top / tops[0], 1, 2e-3) << "floor " << static_cast<int>(floor);
        }
}

// A ball's speed in a closed room without gravity, slow components too.
TEST_P(Bounces, KeepTheirSpeedInARoom) {
    for (const double speed : {0.02, 3.0, 60.0}) {
        World world(at_rate(GetParam(), 0));
        for (int side = 0; side < 6; ++side) {
            const double way = side % 2 ? 1 : -1;
            const Vec out = side < 2 ? Vec(way, 0, 0) : side < 4 ? Vec(0, way, 0) : Vec(0, 0, way);
            const Vec half = side < 2 ? Vec(1, 6, 6) : side < 4 ? Vec(6, 1, 6) : Vec(6, 6, 1);
            world.add({.kind = TAUT_BODY_STATIC, .shape = world.box(half), .position = 5 * out, .restitution = 1});
        }
        const taut_body ball = world.add(
            {.shape = world.sphere(0.4), .velocity = speed * unit({0.7, 0.2, -0.5}), .friction = 0, .restitution = 1});
        world.step(10 * GetParam().hz);
        EXPECT_NEAR(norm(velocity(ball)) / speed, 1, 1e-3) << speed << " m/s";
        EXPECT_LT(norm(position(ball)), std::sqrt(3) * 4);
    }
}

// A ball on a heavier one, touching it or not, after the heavier one has hit the ground: v and then u, elastic impacts.
TEST_P(Bounces, LeaveAHeavierBallAsElasticImpactsSay) {
    for (const double gap : {0.0, 0.004, 0.1})
        for (const double ratio : {0.05, 0.4}) {
            World world(at_rate(GetParam()));
            world.add_ground(0, 1);
            const double drop = 2.5;
            const taut_shape lower = world.sphere(0.4), upper = world.sphere(0.15);
            const taut_body heavy =
                world.add({.shape = lower, .position = {0, 0.4 + drop, 0}, .mass = 4, .friction = 0, .restitution = 1});
            const taut_body light = world.add({.shape = upper,
                                               .position = {0, 0.95 + drop + gap, 0},
                                               .mass = 4 * ratio,
                                               .friction = 0,
                                               .restitution = 1});
            // They meet a time t after the heavy one has hit at v: it rises, and the light one falls.
            const double v = std::sqrt(2 * kG * drop), t = gap / (2 * v);
            const double up = v - kG * t, down = v + kG * t, height = 0.95 + v * t - kG * t * t / 2;
            const double u = (2 * up + down * (1 - ratio)) / (1 + ratio);
            double top = 0;
            for (double time = 0; time < 4; time += world.frame()) {
                world.step();
                const double speed = flight_velocity(world, light).y;
                if (speed > 0) top = std::max(top, position(light).y + speed * speed / (2 * kG));
            }
            EXPECT_NEAR(top / (height + u * u / (2 * kG)), 1, 0.02) << "gap " << gap << " m, ratio " << ratio;
            // What flew past a contact that nobody foresaw is held back, and so does not fall.
            EXPECT_LE(energy(world, {heavy, light}), 1.005 * kG * (4 * (0.4 + drop) + 4 * ratio * (0.95 + drop + gap)));
        }
}

INSTANTIATE_TEST_SUITE_P(
    Rates, Bounces, testing::Values(Rate{30, 4}, Rate{60, 1}, Rate{60, 4}, Rate{60, 16}, Rate{120, 2}, Rate{240, 4}),
    [](const auto& tested) {
        return std::to_string(tested.param.hz) + "_Hz_" + std::to_string(tested.param.substeps) + "_substeps";
    });

class EverySolverBounces : public testing::TestWithParam<taut_solver> {};

TEST_P(EverySolverBounces, ToTheSquareOfRestitution) {
    for (const double e : {0.4, 1.0}) {
        World world([](taut_world_def& def) { def.solver = GetParam(); });
        world.add_ground(0.3, e);
        const taut_body ball = world.add({.shape = world.sphere(0.1), .position = {0, 0.6, 0}});
        const auto tops = peaks(world, ball, 0.1, 2, 5);
        ASSERT_EQ(tops.size(), 2u);
        for (size_t i = 0; i < 2; ++i)
            EXPECT_NEAR(tops[i] / (0.5 * std::pow(e, 2.0 * static_cast<double>(i + 1))), 1, 5e-3) << e;
    }
}

// A box that lands flat gets no spin, and rises as a ball does, on a floor of triangles too.
TEST_P(EverySolverBounces, FlatWithoutSpin) {
    for (const Floor floor : {Floor::plane, Floor::box, Floor::mesh})
        for (const double e : {0.5, 1.0}) {
            World world([](taut_world_def& def) { def.solver = GetParam(); });
            add_floor(world, floor, e);
            const taut_body box = world.add(
                {.shape = world.box({0.6, 0.2, 0.4}), .position = {0.31, 1.0, 0.13}, .friction = 0, .restitution = e});
            const auto tops = peaks(world, box, 0.2, 1, 3);
            ASSERT_EQ(tops.size(), 1u);
            EXPECT_NEAR(tops[0] / (0.8 * e * e), 1, 0.02) << "floor " << static_cast<int>(floor) << ", e = " << e;
            EXPECT_LT(norm(state(box).spin), 0.02) << "floor " << static_cast<int>(floor) << ", e = " << e;
        }
}

// A crate that stands on the floor is as hard as the floor, however light it is.
TEST_P(EverySolverBounces, OffACrateOnTheFloor) {
    for (const double mass : {0.5, 20.0}) {
        World world([](taut_world_def& def) { def.solver = GetParam(); });
        world.add_ground();
        for (int k = 0; k < 2; ++k)
            world.add({.shape = world.box({0.3, 0.3, 0.3}), .position = {0, 0.3 + 0.6 * k, 0}, .mass = mass});
        const taut_body ball =
            world.add({.shape = world.sphere(0.1), .position = {0, 2.3, 0}, .mass = 1, .restitution = 0.7});
        const auto tops = peaks(world, ball, 1.3, 1, 3);
        ASSERT_EQ(tops.size(), 1u);
        EXPECT_NEAR(tops[0] / 0.49, 1, 0.05) << mass << " kg";
    }
}

INSTANTIATE_TEST_SUITE_P(Solvers, EverySolverBounces,
                         testing::Values(TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                         TAUT_SOLVER_ACCELERATED_JACOBI),
                         [](const auto& tested) { return "solver_" + std::to_string(tested.param); });

// Two equal balls head on, e = 1, exchange their velocities; momentum is kept whatever e.
TEST(BallsCollide, ExchangeVelocitiesWhenElastic) {
    for (double e : {0.0, 0.5, 1.0}) {
        World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const taut_shape shape = world.sphere(0.25);
        const taut_body a =
            world.add({.shape = shape, .position = {-1, 0, 0}, .velocity = {3, 0, 0}, .mass = 2, .restitution = e});
        const taut_body b =
            world.add({.shape = shape, .position = {1, 0, 0}, .velocity = {-1, 0, 0}, .mass = 2, .restitution = e});
        world.step(60);
        EXPECT_NEAR(velocity(a).x, 1 - 2 * e, 0.02) << "e = " << e;
        EXPECT_NEAR(velocity(b).x, 1 + 2 * e, 0.02) << "e = " << e;
        EXPECT_NEAR(velocity(a).x + velocity(b).x, 2, 1e-5) << "e = " << e;
    }
}

class TopspinHits : public testing::TestWithParam<Rate> {};

// A ball that rolls on ground meets one at rest: its front goes down, and friction throws it up and the other one down.
// The blow is J = (1 + e) m v / 2, friction at most mu J, and where that ends the slip v / 7 of a mass: spheres resist
// it with 2 / 7 of their reduced mass (Garwin, 1969). Both gain 5 / 2 of that over r in spin.
TEST_P(TopspinHits, ThrowUpwardsByFriction) {
    for (const double e : {0.3, 0.6, 0.95})
        for (const double friction : {0.04, 0.12, 0.5}) {
            World world(at_rate(GetParam(), 0));
            constexpr double kRadius = 0.06, kSpeed = 2.4;
            const BodyPlan plan{.shape = world.sphere(kRadius), .mass = 0.3, .friction = friction, .restitution = e};
            BodyPlan rolls = plan;
            rolls.position = {-0.21, 0, 0};
            rolls.velocity = {kSpeed, 0, 0};
            rolls.spin = {0, 0, -kSpeed / kRadius};
            const taut_body ball = world.add(rolls), other = world.add(plan);
            const double before = energy(world, {ball, other});
            world.step(GetParam().hz / 10);
            const double up = kSpeed * std::min(friction * (1 + e) / 2, 1.0 / 7), near = 0.05 * up;
            const BodyState a = state(ball), b = state(other);
            EXPECT_NEAR(a.velocity.y, up, near) << "e = " << e << ", friction " << friction;
            EXPECT_NEAR(b.velocity.y, -up, near) << "e = " << e << ", friction " << friction;
            EXPECT_NEAR(a.velocity.x, kSpeed * (1 - e) / 2, 0.01 * kSpeed) << "e = " << e << ", friction " << friction;
            EXPECT_NEAR(b.velocity.x, kSpeed * (1 + e) / 2, 0.01 * kSpeed) << "e = " << e << ", friction " << friction;
            EXPECT_NEAR(a.spin.z + kSpeed / kRadius, 2.5 * up / kRadius, 2.5 * near / kRadius);
            EXPECT_NEAR(b.spin.z, 2.5 * up / kRadius, 2.5 * near / kRadius);
            EXPECT_LE(energy(world, {ball, other}), 1.0001 * before) << "e = " << e << ", friction " << friction;
        }
}

// On a table, at the height to which that takes it.
TEST_P(TopspinHits, ClimbOverATable) {
    if (GetParam().hz * GetParam().substeps < 240) GTEST_SKIP() << "a third as high in substeps of 1/60 s";
    World world(at_rate(GetParam()));
    constexpr double kRadius = 0.03, kSpeed = 6, kFriction = 0.1;
    world.add_ground(kFriction);
    const BodyPlan plan{.shape = world.sphere(kRadius), .mass = 0.2, .friction = kFriction, .restitution = 0.9};
    BodyPlan rolls = plan, rests = plan;
    rolls.position = {-0.3, kRadius, 0};
    rolls.velocity = {kSpeed, 0, 0};
    rolls.spin = {0, 0, -kSpeed / kRadius};
    rests.position = {0, kRadius, 0};
    const taut_body ball = world.add(rolls), other = world.add(rests);
    double top = 0, lowest = kRadius;
    for (int k = 0; k < GetParam().hz / 2; ++k) {
        world.step();
        top = std::max(top, position(ball).y - kRadius);
        lowest = std::min(lowest, position(other).y);
    }
    const double up = kSpeed * kFriction * 0.95, height = up * up / (2 * kG);
    EXPECT_NEAR(top, height, 0.1 * height + 0.5 * up * world.frame());
    EXPECT_GT(lowest, kRadius - 0.001) << "the other one is pressed into the table";
}

INSTANTIATE_TEST_SUITE_P(Rates, TopspinHits,
                         testing::Values(Rate{60, 1}, Rate{60, 4}, Rate{60, 16}, Rate{240, 1}, Rate{240, 4},
                                         Rate{240, 16}));

// Of a row of touching balls that another one hits the last leaves with all of its speed.
TEST(BallsCollide, PassOnABlowAlongARow) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
    const taut_shape shape = world.sphere(0.05);
    std::vector<taut_body> row;
    for (int k = 0; k < 6; ++k)
        row.push_back(world.add({.shape = shape,
                                 .position = {k == 0 ? -0.3 : 0.1 * k, 0, 0},
                                 .velocity = {k == 0 ? 1.7 : 0, 0, 0},
                                 .friction = 0,
                                 .restitution = 1}));
    world.step(60);
    for (size_t k = 0; k < 6; ++k) EXPECT_NEAR(velocity(row[k]).x, k == 5 ? 1.7 : 0, 0.02) << k;
}

TEST(RestingBox, WithRestitutionDoesNotJitter) {
    for (const double e : {0.5, 0.8, 1.0}) {
        World world;
        world.add_ground(0.5, e);
        const taut_body box =
            world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .restitution = e});
        world.step(60);
        const Vec start = position(box);
        double fastest = 0, moved = 0;
        for (int i = 0; i < 300; ++i) {
            world.step();
            const BodyState s = state(box);
            fastest = std::max({fastest, norm(s.velocity), norm(s.spin)});
            moved = std::max(moved, norm(s.position - start));
        }
        EXPECT_LT(fastest, 1e-3) << e;
        EXPECT_LT(moved, 1e-4) << e;
    }
}

// A stack that is let down from a centimetre comes to rest, and falls asleep, where impacts take something.
TEST(BouncyStack, ComesToRest) {
    for (const double e : {0.3, 0.6}) {
        World world([](taut_world_def& def) { def.sleeping = 1; });
        world.add_ground(0.5, e);
        std::vector<taut_body> stack;
        for (int k = 0; k < 6; ++k)
            stack.push_back(world.add(
                {.shape = world.box({0.25, 0.15, 0.25}), .position = {0, 0.16 + 0.31 * k, 0}, .restitution = e}));
        world.step(400);
        for (size_t k = 0; k < stack.size(); ++k) {
            EXPECT_EQ(norm(velocity(stack[k])), 0) << e << ", box " << k;
            EXPECT_NEAR(position(stack[k]).y, 0.15 + 0.3 * static_cast<double>(k), 5e-3) << e << ", box " << k;
        }
    }
}

// One that stands keeps still even where impacts take nothing; at first it settles as one does that does not bounce.
TEST(BouncyStack, KeepsStill) {
    World world;
    world.add_ground(0.5, 1);
    std::vector<taut_body> stack;
    for (int k = 0; k < 6; ++k)
        stack.push_back(
            world.add({.shape = world.box({0.25, 0.15, 0.25}), .position = {0, 0.15 + 0.3 * k, 0}, .restitution = 1}));
    double fastest = 0, last = 0;
    for (int i = 0; i < 300; ++i) {
        world.step();
        last = 0;
        for (const taut_body box : stack) last = std::max(last, norm(velocity(box)));
        fastest = std::max(fastest, last);
    }
    EXPECT_LT(fastest, 0.15);
    EXPECT_LT(last, 2e-3);
    for (size_t k = 0; k < stack.size(); ++k)
        EXPECT_NEAR(position(stack[k]).y, 0.15 + 0.3 * static_cast<double>(k), 5e-3) << k;
}

TEST(BouncyBox, KeepsItsPlaceOnASlope) {
    World world([](taut_world_def& def) { def.gravity = {3.0f, -9.0f, 0}; });
    world.add_ground(0.8, 0.5);
    const taut_body box = world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {0, 0.2, 0}, .restitution = 1});
    world.step(300);
    EXPECT_LT(norm(velocity(box)), 1e-3);
    EXPECT_NEAR(position(box).x, 0, 5e-3);
}

}  // namespace
