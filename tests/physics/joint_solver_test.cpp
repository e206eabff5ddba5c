// Axes of joints by every solver: stops, drives and friction, against what mechanics says of them. Sweeps and Jacobi
// are given the iterations that they need.
#include "physics/joint_experiments.h"

namespace {

using namespace lab;

// The same stop and motor when the joint is swept instead of solved in a block.
TEST(SoftJoint, KnowsStopsAndMotors) {
    World world;
    const taut_body body = bar(world);
    auto def = at(world, taut_hinge_joint_def_init, {}, body, {0, 0, 0}, {0, 0, 1});
    def.angle = limited(-30 * kDegree, 60 * kDegree);
    def.base.solve = TAUT_JOINT_SOLVE_SOFT;
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
    catch_a_bar(with_solver(), {.blow = 1 * kDegree, .rest = 0.1 * kDegree, .moment = 0.01});
}

TEST_P(AxisUnder, CompliantStopYields) { yield_at_a_stop(with_solver(), 5e-4); }

TEST_P(AxisUnder, MotorAcceleratesByItsTorqueThenHoldsItsSpeed) {
    constexpr double kInertia = 0.5;
    const World world = with_solver(0);
    const taut_joint joint = reach_a_speed(world, world.add({.mass = 1, .inertia = {0.3, 0.3, kInertia}}), kInertia);
    // Switched off it leaves nothing behind.
    const taut_axis_def off = free_axis();
    ok(taut_joint_set_axis(joint, 0, &off));
    world.step(30);
    EXPECT_NEAR(motion(joint).rate, 6, 2e-3);
}

TEST_P(AxisUnder, MotorGivesWayBeyondItsTorque) { give_way_and_hold(with_solver(), 5e-3); }

TEST_P(AxisUnder, DriveHoldsATargetLikeASpring) { hold_like_a_spring(with_solver(), 0.01); }

TEST_P(AxisUnder, FrictionStopsARotorAfterItsTime) { stop_a_rotor(with_solver(0), 1e-2); }

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
    def.base.body_b = body;
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
    for (const double factor : {0.9, 1.1}) hold_or_slip(with_solver(), factor, 0.02, 0.02);
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
