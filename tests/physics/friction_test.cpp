// Coulomb's law on slopes, and balls that roll.
#include "physics/lab.h"

namespace {

using namespace lab;

// A slope through the origin, down along `down`, turned by yaw about the vertical.
struct Slope {
    double angle;
    Vec normal, down, side;
    Quat turn;

    Slope(double angle_, double yaw) : angle(angle_) {
        turn = Quat::turn({0, 1, 0}, yaw) * Quat::turn({0, 0, 1}, -angle);
        normal = turn.rotate({0, 1, 0});
        down = turn.rotate({1, 0, 0});
        side = turn.rotate({0, 0, 1});
    }
};

enum class Ground { static_box, kinematic_box, plane };

void PrintTo(Ground ground, std::ostream* out) {
    *out << (ground == Ground::static_box ? "static_box" : ground == Ground::kinematic_box ? "kinematic_box" : "plane");
}

void add_slope(const World& world, const Slope& slope, Ground ground, double friction) {
    if (ground == Ground::plane) {
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(slope.normal), .friction = friction});
        return;
    }
    const Vec half(40, 1, 40);
    world.add({.kind = ground == Ground::static_box ? TAUT_BODY_STATIC : TAUT_BODY_KINEMATIC,
               .shape = world.box(half),
               .position = -half.y * slope.normal,
               .rotation = slope.turn,
               .friction = friction});
}

struct OnSlope {
    double slope_yaw, box_yaw;  // [degrees]
    Ground ground;
};

void PrintTo(const OnSlope& s, std::ostream* out) {
    *out << "slope_" << s.slope_yaw << "_box_" << s.box_yaw << "_on_" << testing::PrintToString(s.ground);
}

class BoxOnSlope : public testing::TestWithParam<OnSlope> {
protected:
    static constexpr double kFriction = 0.5, kHalf = 0.25;

    Slope slope_of(double part_of_friction_angle) const {
        return {std::atan(kFriction * part_of_friction_angle), GetParam().slope_yaw * kPi / 180};
    }
    taut_body place(const World& world, const Slope& slope, const Vec& velocity = {}) const {
        add_slope(world, slope, GetParam().ground, kFriction);
        const Quat own = Quat::turn({0, 1, 0}, GetParam().box_yaw * kPi / 180);
        return world.add({.shape = world.box({kHalf, kHalf, kHalf}),
                          .position = kHalf * slope.normal,
                          .rotation = slope.turn * own,
                          .velocity = velocity,
                          .mass = 10,
                          .friction = kFriction});
    }
};

TEST_P(BoxOnSlope, StaysBelowTheFrictionAngle) {
    const Slope slope = slope_of(0.98);
    World world;
    const taut_body box = place(world, slope);
    const Vec start = position(box);
    double most = 0;
    for (int i = 0; i < 300; ++i) {
        world.step();
        most = std::max(most, norm(position(box) - start));
    }
    EXPECT_LT(most, 1e-3);
}

TEST_P(BoxOnSlope, SlidesAboveTheFrictionAngle) {
    const Slope slope = slope_of(1.02);
    World world;
    const taut_body box = place(world, slope);
    const Vec start = position(box);
    world.step(300);
    const Vec moved = position(box) - start;
    const double time = 300 * world.frame();
    const double exact = kG * (std::sin(slope.angle) - kFriction * std::cos(slope.angle)) * time * time / 2;
    EXPECT_NEAR(dot(moved, slope.down) / exact, 1, 0.05) << "moved " << dot(moved, slope.down) << ", exact " << exact;
    EXPECT_LT(std::abs(dot(moved, slope.side)), 0.01 * exact);
}

// v' = g sin(a) down - mu g cos(a) v / |v|, by small steps, until friction has stopped it.
Vec thrown_until_rest(const Slope& slope, double friction, Vec velocity) {
    constexpr double kStep = 1e-5;
    Vec at;
    while (norm(velocity) > 2e-4) {
        const double v = norm(velocity);
        velocity += kStep * kG * (std::sin(slope.angle) * slope.down - friction * std::cos(slope.angle) / v * velocity);
        at += kStep * velocity;
    }
    return at;
}

TEST_P(BoxOnSlope, ThrownAcrossComesToRestWhereFrictionSays) {
    const Slope slope = slope_of(0.5);
    World world;
    const Vec velocity = 2 * slope.down + 2 * slope.side;
    const taut_body box = place(world, slope, velocity);
    const Vec start = position(box);
    world.step(300);
    const Vec moved = position(box) - start, exact = thrown_until_rest(slope, kFriction, velocity);
    EXPECT_NEAR(dot(exact, slope.down), 1.213, 0.001);  // study/contact3d.md, section 5
    EXPECT_NEAR(dot(exact, slope.side), 0.746, 0.001);
    EXPECT_NEAR(dot(moved, slope.down) / dot(exact, slope.down), 1, 0.03);
    EXPECT_NEAR(dot(moved, slope.side) / dot(exact, slope.side), 1, 0.03);
    EXPECT_LT(norm(lab::velocity(box)), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Turned, BoxOnSlope,
                         testing::Values(OnSlope{0, 0, Ground::static_box}, OnSlope{0, 17, Ground::static_box},
                                         OnSlope{33, 0, Ground::static_box}, OnSlope{45, 45, Ground::static_box},
                                         OnSlope{90, 30, Ground::kinematic_box},
                                         OnSlope{123, 70, Ground::kinematic_box}, OnSlope{200, 10, Ground::plane},
                                         OnSlope{301, 45, Ground::plane}));

class BallRolls : public testing::TestWithParam<Ground> {};

// Without slip a solid sphere accelerates at g sin(a) / (1 + 2/5).
TEST_P(BallRolls, DownASlopeAtFiveSevenths) {
    const Slope slope(20 * kPi / 180, 0.6);
    constexpr double kRadius = 0.3;
    World world;
    add_slope(world, slope, GetParam(), 1);
    const taut_body ball =
        world.add({.shape = world.sphere(kRadius), .position = kRadius * slope.normal, .friction = 1});
    const Vec start = position(ball);
    world.step(180);
    const double time = 180 * world.frame(), exact = 5.0 / 7 * kG * std::sin(slope.angle);
    const Vec moved = position(ball) - start, v = velocity(ball), w = state(ball).spin;
    EXPECT_NEAR(dot(v, slope.down) / (exact * time), 1, 0.02);
    EXPECT_NEAR(dot(moved, slope.down) / (exact * time * time / 2), 1, 0.02);
    EXPECT_LT(norm(v + cross(w, -kRadius * slope.normal)), 0.02 * norm(v)) << "slips";
    EXPECT_LT(std::abs(dot(moved, slope.side)), 0.01);
}

// Sliding friction turns a ball until it rolls; about the line of contact momentum is kept: v = 5/7 v0.
TEST_P(BallRolls, FromSlidingToFiveSeventhsOfItsSpeed) {
    const Slope level(0, 0.4);
    constexpr double kRadius = 0.25, kSpeed = 5, kFriction = 0.3;
    World world;
    add_slope(world, level, GetParam(), kFriction);
    const taut_body ball = world.add({.shape = world.sphere(kRadius),
                                      .position = {0, kRadius, 0},
                                      .velocity = kSpeed * level.down,
                                      .friction = kFriction});
    const double slides = 2 * kSpeed / (7 * kFriction * kG);  // [s]
    world.step(static_cast<int>(0.5 * slides / world.frame()));
    EXPECT_GT(dot(velocity(ball), level.down), 5.0 / 7 * kSpeed * 1.1) << "still sliding half-way";
    world.step(120);
    EXPECT_NEAR(dot(velocity(ball), level.down) / (5.0 / 7 * kSpeed), 1, 0.02);
    EXPECT_NEAR(norm(state(ball).spin) * kRadius / (5.0 / 7 * kSpeed), 1, 0.02);
}

INSTANTIATE_TEST_SUITE_P(On, BallRolls, testing::Values(Ground::static_box, Ground::plane));

// A light box that carries a heavy load by a joint is solved in a block; set in motion from rest it slides all the
// same.
TEST(Friction, SlowsALoadedBoxByMuG) {
    World world;
    world.add_ground(0.1);
    const taut_body box =
        world.add({.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}, .mass = 1, .friction = 0.1});
    const taut_body load = world.add({.position = {0, 0.1, 0}, .mass = 100, .inertia = {10, 10, 10}});
    taut_fixed_joint_def joint;
    taut_fixed_joint_def_init(&joint);
    joint.base.body_a = box;
    joint.base.body_b = load;
    taut_joint out{};
    ok(taut_world_add_fixed_joint(world.handle, &joint, &out));
    world.step(30);
    for (const taut_body body : {box, load}) ok(taut_body_set_velocity(body, {3, 0, 0}, {0, 0, 0}));
    world.step(60);
    EXPECT_NEAR(velocity(load).x, 3 - 0.1 * kG, 0.03 * 0.1 * kG);
}

}  // namespace
