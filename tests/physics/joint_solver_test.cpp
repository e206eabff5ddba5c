// Axes of joints by every solver: stops, drives and friction, against what mechanics says of them. Sweeps and Jacobi
// are given the iterations that they need.
#include "physics/joint_lab.h"

namespace {

using namespace lab;

// The same stop and motor when the joint is swept instead of solved in a block.
TEST(SoftJoint, KnowsStopsAndMotors) {
    World world;
    const taut_body body = bar(world);
    auto def = at(world, taut_hinge_joint_def_init, {}, body, {0, 0, 0}, {0, 0, 1});
    def.angle = limited(-30 * kDegree, 60 * kDegree);
    def.solve = TAUT_JOINT_SOLVE_SOFT;
    taut_joint joint{};
    ok(taut_world_add_hinge_joint(world.handle, &def, &joint));
    world.step(300);
    EXPECT_NEAR(motion(joint).value, -30 * kDegree, 0.5 * kDegree);
    const taut_axis_def up = motor(1, 100);
    ok(taut_joint_set_axis(joint, 0, &up));
    world.step(60);
    EXPECT_NEAR(motion(joint).rate, 1, 0.02);
    EXPECT_LT(error(joint), 2e-3);
}

class AxisUnder : public testing::TestWithParam<taut_solver> {
protected:
    World with_solver(double gravity = 1) const {
        return World([&](taut_world_def& def) {
            def.solver = GetParam();
            def.sweeps = 60;
            def.gravity.y *= static_cast<float>(gravity);
        });
    }
};

// A bar swings on its hinge from horizontal to horizontal; a quarter swing takes
// sqrt(2 I / (m g L/2)) * 1.31103 (the elliptic integral of a drop from 90 degrees over sqrt 2).
TEST_P(AxisUnder, SwingsFreely) {
    const World world = with_solver();
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1});
    const double quarter = std::sqrt(2 * kAboutEnd / (kBarMass * kG * 0.5)) * 1.31103;
    int frames = 0;
    while (motion(joint).value > -kPi / 2 && frames < 200) {
        world.step();
        ++frames;
    }
    EXPECT_NEAR(frames * world.frame(), quarter, 1.5 * world.frame());
    EXPECT_LT(error(joint), 0.01);
}

TEST_P(AxisUnder, StopCatchesABarAndCarriesIt) {
    const World world = with_solver();
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, limited(-30 * kDegree, 60 * kDegree));
    double overrun = 0;
    for (int frame = 0; frame < 300; ++frame) {
        world.step();
        overrun = std::max(overrun, -30 * kDegree - motion(joint).value);
    }
    EXPECT_LE(overrun, 1 * kDegree) << "at the blow";
    EXPECT_NEAR(motion(joint).value, -30 * kDegree, 0.1 * kDegree);
    EXPECT_NEAR(motion(joint).rate, 0, 1e-3);
    const double moment = kBarMass * kG * 0.5 * std::cos(30 * kDegree);
    EXPECT_NEAR(forces(joint).stop, moment, 0.01 * moment);
    EXPECT_EQ(forces(joint).active_stop, -1);
}

TEST_P(AxisUnder, CompliantStopYields) {
    const World world = with_solver();
    taut_axis_def axis = limited(0, 1);
    axis.stop_compliance = 0.01f;
    axis.stop_damping = 5;
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, axis);
    world.step(600);
    const double yielded = motion(joint).value;
    EXPECT_NEAR(yielded, -0.01 * kBarMass * kG * 0.5 * std::cos(yielded), 5e-4);
}

TEST_P(AxisUnder, MotorAcceleratesByItsTorqueThenHoldsItsSpeed) {
    constexpr double kInertia = 0.5;
    const World world = with_solver(0);
    const taut_body rotor = world.add({.mass = 1, .inertia = {0.3, 0.3, kInertia}});
    const taut_joint joint = hinge(world, {}, rotor, {0, 0, 0}, {0, 0, 1}, motor(6, 3));
    const double reached = 6 * kInertia / 3;  // [s]
    const int before = static_cast<int>(0.5 * reached / world.frame());
    world.step(before);
    EXPECT_NEAR(motion(joint).rate, 3 / kInertia * before * world.frame(), 1e-3);
    EXPECT_NEAR(forces(joint).drive, 3, 1e-5);
    world.step(static_cast<int>(reached / world.frame()));
    EXPECT_NEAR(motion(joint).rate, 6, 1e-3);
    EXPECT_NEAR(forces(joint).drive, 0, 0.02);
    // Switched off it leaves nothing behind.
    const taut_axis_def off = free_axis();
    ok(taut_joint_set_axis(joint, 0, &off));
    world.step(30);
    EXPECT_NEAR(motion(joint).rate, 6, 2e-3);
}

TEST_P(AxisUnder, MotorGivesWayBeyondItsTorque) {
    const World world = with_solver();
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, motor(0, 4));
    world.step(20);
    EXPECT_LT(motion(joint).value, -0.2);
    EXPECT_NEAR(forces(joint).drive, 4, 1e-4);
    const taut_axis_def enough = motor(0, kBarMass * kG);
    ok(taut_joint_set_axis(joint, 0, &enough));
    world.step(60);
    const double held = motion(joint).value;
    world.step(60);
    EXPECT_NEAR(motion(joint).value, held, 5e-3);
}

TEST_P(AxisUnder, DriveHoldsATargetLikeASpring) {
    const World world = with_solver();
    taut_axis_def axis = free_axis();
    axis.drive.stiffness = 200;
    axis.drive.damping = 20;
    axis.drive.target = 0.4f;
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, axis);
    world.step(600);
    const double angle = motion(joint).value, moment = kBarMass * kG * 0.5 * std::cos(angle);
    EXPECT_NEAR(200 * (0.4 - angle), moment, 0.01 * moment);
    EXPECT_NEAR(forces(joint).drive, moment, 0.01 * moment);
}

TEST_P(AxisUnder, FrictionStopsARotorAfterItsTime) {
    const World world = with_solver(0);
    const taut_body body = world.add({.spin = {0, 0, 10}, .mass = 1, .inertia = {0.3, 0.3, 0.5}});
    const taut_joint joint = hinge(world, {}, body, {0, 0, 0}, {0, 0, 1}, with_friction(2));
    const double stops = 10 * 0.5 / 2;  // [s]
    const int half = static_cast<int>(0.5 * stops / world.frame());
    world.step(half);
    EXPECT_NEAR(motion(joint).rate, 10 - 2 / 0.5 * half * world.frame(), 1e-2);
    EXPECT_NEAR(forces(joint).friction, -2, 1e-5);
    world.step(half + 20);
    EXPECT_NEAR(motion(joint).rate, 0, 1e-3);
}

// What rubs on a swing rubs on its way around the cone too: a body that goes around the rim comes to rest after
// I u / torque.
TEST_P(AxisUnder, FrictionOfASwingActsAroundItsCone) {
    if (GetParam() == TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL) GTEST_SKIP() << "sweeps leave it out";
    constexpr double kInertia = 0.5, kTorque = 2, kRate = 2, kTilt = 60 * kDegree;
    const World world = with_solver(0);
    const Vec along(std::cos(kTilt), std::sin(kTilt), 0), up(-std::sin(kTilt), std::cos(kTilt), 0);
    const taut_body body = world.add({.rotation = Quat::turn({0, 0, 1}, kTilt),
                                      .spin = kRate * up,
                                      .mass = 1,
                                      .inertia = {kInertia, kInertia, kInertia}});
    taut_cone_twist_joint_def def;
    taut_cone_twist_joint_def_init(&def);
    def.body_b = body;
    def.swing = limited(0, kTilt);
    def.swing.lower = -INFINITY;
    def.swing.friction = kTorque;
    taut_joint joint{};
    ok(taut_world_add_cone_twist_joint(world.handle, &def, &joint));
    const auto rate = [&] {
        const BodyState now = state(body);
        return norm(cross(now.spin, now.rotation.rotate({1, 0, 0})));
    };
    EXPECT_NEAR(rate(), kRate, 1e-6);
    const int half = static_cast<int>(0.5 * kRate * kInertia / kTorque / world.frame());
    world.step(half);
    EXPECT_NEAR(rate(), kRate - half * world.frame() * kTorque / kInertia, 0.03 * kRate);
    EXPECT_NEAR(motion(joint).value, kTilt, 1 * kDegree);
    world.step(half + 20);
    EXPECT_NEAR(rate(), 0, 0.02);
}

TEST_P(AxisUnder, FrictionHoldsBelowItsForceAndSlipsAbove) {
    for (const double factor : {0.9, 1.1}) {
        const World world = with_solver();
        const taut_joint joint = slider(world, {}, world.add({.mass = 2, .inertia = {1, 1, 1}}), {0, 0, 0}, {0, 1, 0},
                                        with_friction(2 * kG / factor));
        world.step(120);
        const double slid = -motion(joint).value, net = kG * (1 - 1 / factor), t = 120 * world.frame();
        EXPECT_NEAR(slid, factor < 1 ? 0 : 0.5 * net * t * t, 0.02) << factor;
    }
}

std::string solver_name(const testing::TestParamInfo<taut_solver>& tested) {
    const char* names[] = {"block", "sweeps", "jacobi"};
    return names[tested.param];
}

INSTANTIATE_TEST_SUITE_P(Solver, AxisUnder,
                         testing::Values(TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL,
                                         TAUT_SOLVER_ACCELERATED_JACOBI),
                         solver_name);

}  // namespace
