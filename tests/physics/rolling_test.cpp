// Round shapes on flat ground, whatever it is made of: what rolls keeps its height, speed and course, what is pressed
// in stays out, what stands stands, and long rods that fall turning stay above the floor.
#include <algorithm>

#include "physics/surface_lab.h"

namespace {

using namespace lab;

enum class Ground { plane, box, two_triangles, mesh, fine_mesh, field };
constexpr const char* kGrounds[] = {"plane", "box", "two_triangles", "mesh", "fine_mesh", "field"};

constexpr double kLength = 160, kWidth = 16;  // along x and z, about the origin [m]

// At y = 0.
void add_flat(const World& world, Ground ground, double friction) {
    BodyPlan plan{.kind = TAUT_BODY_STATIC, .position = {-kLength / 2, 0, -kWidth / 2}, .friction = friction};
    if (ground == Ground::plane) plan.shape = world.plane();
    if (ground == Ground::box) plan.shape = world.box({kLength / 2, 1, kWidth / 2}), plan.position = {0, -1, 0};
    if (ground == Ground::two_triangles) {
        Triangles out;
        out.add_quad({0, 0, 0}, {0, 0, kWidth}, {kLength, 0, kWidth}, {kLength, 0, 0});
        plan.shape = mesh(world, out);
    }
    if (ground == Ground::mesh) plan.shape = mesh(world, grid(kLength, kWidth, 0.8));
    if (ground == Ground::fine_mesh) plan.shape = mesh(world, grid(kLength, 2, 0.4)), plan.position.z = -1;
    if (ground == Ground::field) plan.shape = height_field(world, 33, 321, 0.5, [](double, double) { return 0.0; });
    world.add(plan);
}

enum class Kind { cylinder, roller, tapered, ball, capsule };
constexpr const char* kKinds[] = {"cylinder", "roller", "tapered_capsule", "ball", "capsule"};
constexpr double kRadius = 0.3;

taut_shape shape_of(const World& world, Kind kind) {
    if (kind == Kind::cylinder) return world.cylinder(kRadius, 0.12);
    if (kind == Kind::roller) return world.cylinder(kRadius, 0.5);
    if (kind == Kind::tapered) return world.tapered_capsule(kRadius, kRadius, 0.4);
    if (kind == Kind::ball) return world.sphere(kRadius);
    return world.capsule(kRadius, 0.3);
}

struct Rate {
    double frequency;  // [Hz]
    uint32_t substeps;
};
constexpr Rate kRates[] = {{60, 4}, {60, 1}, {30, 8}, {120, 2}, {240, 16}};

// How far a soft contact gives way under a weight, 0.405 g h^2 (constraints/soft_contact.h), with room.
double sag(const Rate& rate) {
    const double h = 1 / (rate.frequency * rate.substeps);
    return 0.5 * kG * h * h;
}

World world_at(const Rate& rate) {
    return World([&](taut_world_def& def) {
        def.time_step = static_cast<float>(1 / rate.frequency);
        def.substeps = rate.substeps;
        def.sleeping = 0;
    });
}

class Rolling : public testing::TestWithParam<std::tuple<Kind, Ground, double>> {};

TEST_P(Rolling, KeepsHeightSpeedAndCourse) {
    const auto& [kind, ground, speed] = GetParam();
    double worst_height = 0, worst_loss = 0, worst_lean = 0, worst_course = 0;
    for (const Rate& rate : kRates) {
        // Axes that turn by more than a radian in a substep swing about.
        if (speed / kRadius > rate.frequency * rate.substeps) continue;
        const World world = world_at(rate);
        add_flat(world, ground, 0.9);
        const taut_body body = world.add({.shape = shape_of(world, kind),
                                          .position = {-70.3, kRadius, 0.17},
                                          .rotation = Quat::turn({1, 0, 0}, kPi / 2),
                                          .velocity = {speed, 0, 0},
                                          .spin = {0, 0, -speed / kRadius},
                                          .mass = 12,
                                          .friction = 0.9});
        const double seconds = std::min(3.0, 130 / speed);
        for (int i = 0; i < seconds * rate.frequency; ++i) {
            world.step();
            if (i < 0.25 * rate.frequency) continue;
            const BodyState s = state(body);
            worst_height = std::max(worst_height, std::abs(s.position.y - kRadius) - sag(rate));
            worst_lean = std::max(worst_lean, std::abs(s.rotation.rotate({0, 1, 0}).y));
        }
        const Vec v = velocity(body);
        worst_loss = std::max(worst_loss, std::abs(1 - norm(v) / speed));
        worst_course = std::max(worst_course, std::abs(std::atan2(v.z, v.x)));
    }
    const bool is_ball = kind == Kind::ball || kind == Kind::capsule;
    EXPECT_LT(worst_height, is_ball ? 2e-4 : 1e-3);
    EXPECT_LT(worst_loss, 3e-3);  // a third of the time: of 1 % in 10 s
    EXPECT_LT(worst_course, 2e-3);
    if (kind != Kind::ball) {
        EXPECT_LT(worst_lean, 3e-3);
    }
    RecordProperty("height_mm", std::to_string(1000 * worst_height));
    RecordProperty("loss_pct", std::to_string(100 * worst_loss));
}

INSTANTIATE_TEST_SUITE_P(On, Rolling,
                         testing::Combine(testing::Values(Kind::cylinder, Kind::roller, Kind::tapered, Kind::ball,
                                                          Kind::capsule),
                                          testing::Values(Ground::plane, Ground::box, Ground::two_triangles,
                                                          Ground::mesh, Ground::fine_mesh, Ground::field),
                                          testing::Values(5.0, 17.0, 45.0)),
                         [](const auto& tested) {
                             return std::string(kKinds[static_cast<int>(std::get<0>(tested.param))]) + "_" +
                                    kGrounds[static_cast<int>(std::get<1>(tested.param))] + "_" +
                                    std::to_string(static_cast<int>(std::get<2>(tested.param)));
                         });

class OnFlat : public testing::TestWithParam<Ground> {};

// A cone on its side rolls about its apex: with a rate W its axis turns about the vertical, it turns about the line
// that touches at W / tan a, a: half of the angle at the apex. So does a tapered capsule about where its sides meet.
struct Circle {
    double half_angle;  // [rad]
    double centre;      // of the shape's origin, from the apex along the axis [m]
    double base;        // +1 or -1: on which side of the axis the wide end is
};

void rolls_in_a_circle(const World& world, const Circle& c, taut_shape shape, double rate, double turns) {
    // The axis, from apex to wide end, over the line that touches, x.
    const Vec axis(std::cos(c.half_angle), std::sin(c.half_angle), 0);
    const Quat turn = Quat::turn({0, 0, 1}, c.half_angle - kPi / 2);  // takes y to it
    const Quat rotation = c.base > 0 ? turn : turn * Quat::turn({0, 0, 1}, kPi);
    const Vec spin(-rate / std::tan(c.half_angle), 0, 0);
    const Vec start = c.centre * axis;
    const taut_body body = world.add({.shape = shape, .position = start, .rotation = rotation, .friction = 0.9});
    taut_vec3 local{};
    float mass = 0;
    taut_sym3 inertia{};
    ok(taut_body_get_mass(body, &mass, &local, &inertia));
    const Vec velocity_of_centre = cross(spin, start + rotation.rotate(Vec(local)));
    ok(taut_body_set_velocity(body, velocity_of_centre.narrow(), spin.narrow()));
    const double seconds = 2 * kPi * turns / rate;
    double height = 0, apex = 0, before = 0, angle = 0;
    for (int i = 0; i < seconds / world.frame(); ++i) {
        world.step();
        const BodyState s = state(body);
        const Vec along = c.base * s.rotation.rotate({0, 1, 0});
        height = std::max(height, std::abs(s.position.y - start.y));
        apex = std::max(apex, norm(s.position - c.centre * along));
        const double now = std::atan2(-along.z, along.x);
        angle += std::remainder(now - before, 2 * kPi);
        before = now;
    }
    EXPECT_LT(height, 3e-3);
    EXPECT_LT(apex, 0.02) << "wanders";
    EXPECT_NEAR(angle, 2 * kPi * turns, 0.08 * 2 * kPi * turns);
}

TEST_P(OnFlat, AConeRollsInACircle) {
    for (const Rate& rate : kRates) {
        const World world = world_at(rate);
        add_flat(world, GetParam(), 0.9);
        const double r = 0.25, half = 0.35;
        rolls_in_a_circle(world, {std::atan2(r, 2 * half), half, -1}, world.cone(r, half), 1.3, 1);
    }
}

TEST_P(OnFlat, ATaperedCapsuleRollsInACircle) {
    for (const Rate& rate : kRates) {
        const World world = world_at(rate);
        add_flat(world, GetParam(), 0.9);
        const double low = 0.3, high = 0.15, half = 0.4;
        const double angle = std::asin((low - high) / (2 * half));
        rolls_in_a_circle(world, {angle, high / std::sin(angle) + half, -1}, world.tapered_capsule(low, high, half), 1,
                          1);
    }
}

// Caps have several points on triangles too.
TEST_P(OnFlat, WhatStandsOnItsCapStandsStill) {
    const World world = world_at(kRates[0]);
    add_flat(world, GetParam(), 0.5);
    const std::vector<taut_body> bodies = {
        world.add({.shape = world.cylinder(0.15, 0.7), .position = {-2.03, 0.7, 0.11}}),
        world.add({.shape = world.cylinder(0.6, 0.02), .position = {0.4, 0.02, 0.4}}),
        world.add({.shape = world.cone(0.25, 0.5), .position = {2.1, 0.5, -0.3}}),
    };
    std::vector<BodyState> start;
    for (const taut_body body : bodies) start.push_back(state(body));
    world.step(600);
    for (size_t i = 0; i < bodies.size(); ++i) {
        const BodyState s = state(bodies[i]);
        EXPECT_LT(norm(s.velocity), 1e-3) << i;
        EXPECT_LT(norm(s.position - start[i].position), 2e-3) << i;
        EXPECT_GT(s.rotation.rotate({0, 1, 0}).y, 0.99999) << i;
    }
}

// Under fifty times their weight.
TEST_P(OnFlat, WhatIsPressedInStaysOut) {
    for (const Rate& rate : kRates) {
        const World world = world_at(rate);
        add_flat(world, GetParam(), 0.5);
        const taut_shape shapes[] = {world.cylinder(0.2, 0.3), world.cone(0.3, 0.3),
                                     world.tapered_capsule(0.3, 0.2, 0.3), world.box({0.3, 0.2, 0.25}), stone(world)};
        const double lowest[] = {0.3, 0.3, 0.6, 0.2, 0.2};
        // Sides of so large triangles still take points from polytopes that lie in.
        const int kinds = GetParam() == Ground::two_triangles ? 3 : 5;
        for (int i = 0; i < kinds; ++i) {
            const double x = 3.1 * i - 7.3;
            const taut_body body = world.add({.shape = shapes[i], .position = {x, lowest[i] + 0.001, 0.21}, .mass = 2});
            for (int frame = 0; frame < rate.frequency; ++frame) {
                ok(taut_body_apply_force(body, Vec(0, -50 * 2 * kG, 0).narrow(), {}));
                world.step();
                if (i != 2) {
                    ASSERT_GT(position(body).y, lowest[i] - 5e-3 - 50 * sag(rate)) << i;
                }
            }
        }
    }
}

// Long rods that turn about the vertical fall over, however fast they come to spin about their lengths: one of 18 puts
// its axis 7 mm below the floor for a moment, and at most 0.54 % of the energy is gained.
TEST_P(OnFlat, RodsThatFallTurningStayAboveTheFloor) {
    constexpr double kThin = 0.04, kHalf = 0.8;
    for (const bool round : {false, true}) {
        for (const double lean : {0.15, 0.6, 0.9}) {
            for (const double turning : {-12.0, 18.0, -24.0}) {
                const World world = world_at(kRates[0]);
                add_flat(world, GetParam(), 0.5);
                const double up = kHalf * std::cos(lean) + (round ? kThin : kThin * std::sin(lean));
                const taut_body rod =
                    world.add({.shape = round ? world.capsule(kThin, kHalf) : world.cylinder(kThin, kHalf),
                               .position = {0.3, up, 0.1},
                               .rotation = Quat::turn({0, 0, 1}, lean),
                               .spin = {0, turning, 0}});
                const auto energy = [&] {
                    const Totals t = totals({rod});
                    return t.kinetic + kG * t.height;
                };
                const double all = energy();
                double least = all, gain = 0, deepest = -1;
                for (int i = 0; i < 240; ++i) {
                    world.step();
                    const double now = energy();
                    gain = std::max(gain, now - least);
                    least = std::min(least, now);
                    const BodyState s = state(rod);
                    deepest = std::max(deepest, kHalf * std::abs(s.rotation.rotate({0, 1, 0}).y) - s.position.y);
                }
                EXPECT_LT(deepest, 0.01) << round << ' ' << lean << ' ' << turning;
                EXPECT_LT(gain, 0.01 * all) << round << ' ' << lean << ' ' << turning;
            }
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, OnFlat,
                         testing::Values(Ground::plane, Ground::box, Ground::two_triangles, Ground::mesh,
                                         Ground::field),
                         [](const auto& tested) { return kGrounds[static_cast<int>(tested.param)]; });

// A wheel of steel rolls on: it the ground resists with a ten-thousandth of its weight.
TEST(SlowCylinder, RollsFar) {
    for (const bool on_box : {false, true}) {
        World world;
        BodyPlan ground{.kind = TAUT_BODY_STATIC, .shape = world.plane(), .friction = 0.6};
        if (on_box) ground.shape = world.box({20, 0.5, 3}), ground.position = {0, -0.5, 0};
        world.add(ground);
        constexpr double kWheel = 0.25, kSpeed = 1.5, kWay = 12;
        const taut_body wheel = world.add({.shape = world.cylinder(kWheel, 0.15),
                                           .position = {-6, kWheel, 0},
                                           .rotation = Quat::turn({1, 0, 0}, kPi / 2),
                                           .velocity = {kSpeed, 0, 0},
                                           .spin = {0, 0, -kSpeed / kWheel},
                                           .friction = 0.6});
        world.step(static_cast<int>(60 * kWay / kSpeed));
        EXPECT_GT(velocity(wheel).x, 0.992 * kSpeed) << (on_box ? "box" : "plane");
        EXPECT_LE(velocity(wheel).x, 1.0001 * kSpeed) << (on_box ? "box" : "plane");
    }
}

}  // namespace
