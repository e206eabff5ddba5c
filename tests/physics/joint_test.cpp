// Joints with stops, drives and friction, against what mechanics says of them.
#include "physics/joint_experiments.h"

namespace {

using namespace lab;

// ---------------------------------------------------------------- stops

TEST(HingeStop, CatchesABarAndCarriesIt) {
    const World world;
    const taut_joint joint = catch_a_bar(world, {.blow = 0.3 * kDegree, .rest = 0.02 * kDegree, .moment = 0.002});
    EXPECT_LT(error(joint), 1e-5);
    EXPECT_LT(angular_error(joint), 1e-4);
}

TEST(HingeStop, YieldsByItsCompliance) { yield_at_a_stop(World(), 2e-4); }

// Fifty bodies with stops at 20 degrees, 1000 kg at the end: each angle stays within its stops.
TEST(HingeStop, HoldsUnderAThousandTimesTheWeight) {
    World world;
    std::vector<taut_joint> joints;
    taut_body last{};
    for (int i = 0; i < 20; ++i) {
        const taut_body link =
            world.add({.position = {0.25 + 0.5 * i, 0, 0}, .mass = 1, .inertia = {0.01, 0.02, 0.02}});
        joints.push_back(hinge(world, last, link, {0.5 * i, 0, 0}, {0, 0, 1}, limited(-20 * kDegree, 20 * kDegree)));
        last = link;
    }
    const taut_body weight = world.add({.position = {10.2, 0, 0}, .mass = 1000, .inertia = {40, 40, 40}});
    joints.push_back(hinge(world, last, weight, {10, 0, 0}, {0, 0, 1}));
    double overrun = 0, gap = 0;
    for (int frame = 0; frame < 600; ++frame) {
        world.step();
        for (size_t j = 0; j + 1 < joints.size(); ++j)
            overrun = std::max(overrun, std::abs(motion(joints[j]).value) - 20 * kDegree);
        for (taut_joint joint : joints) gap = std::max(gap, error(joint));
    }
    EXPECT_LE(overrun, 2 * kDegree);
    EXPECT_LE(gap, 5e-3);
    RecordProperty("overrun_deg", std::to_string(overrun / kDegree));
    RecordProperty("gap_mm", std::to_string(1e3 * gap));
}

TEST(Rope, IsSlackUntilItIsTaut) {
    World world;
    const taut_body body = world.particle(3, {0, -0.5, 0});
    taut_distance_joint_def def;
    taut_distance_joint_def_init(&def);
    def.base.body_b = body;
    def.max_length = 2;
    taut_joint rope{};
    ok(taut_world_add_distance_joint(world.handle, &def, &rope));
    const int falling = static_cast<int>(std::sqrt(2 * 1.4 / kG) / world.frame());
    world.step(falling);
    EXPECT_NEAR(position(body).y, -0.5 - 0.5 * kG * std::pow(falling * world.frame(), 2), 0.02) << "free fall";
    EXPECT_EQ(forces(rope).stop, 0);
    double lowest = 0;
    for (int frame = 0; frame < 300; ++frame) {
        world.step();
        lowest = std::min(lowest, position(body).y);
    }
    EXPECT_GT(lowest, -2.003);
    EXPECT_NEAR(position(body).y, -2, 1e-4);
    EXPECT_NEAR(forces(rope).stop, -3 * kG, 0.01);
}

TEST(ConeTwist, KeepsItsCone) {
    World world;
    const taut_body body =
        world.add({.position = {0, -0.5, 0}, .spin = {9, 3, 5}, .mass = 2, .inertia = {0.2, 0.05, 0.2}});
    auto def = at(world, taut_cone_twist_joint_def_init, {}, body, {0, 0, 0}, {0, -1, 0});
    def.swing = limited(0, 40 * kDegree);
    def.twist = limited(-15 * kDegree, 15 * kDegree);
    taut_joint joint{};
    ok(taut_world_add_cone_twist_joint(world.handle, &def, &joint));
    double swing = 0, twist = 0;
    for (int frame = 0; frame < 600; ++frame) {
        world.step();
        swing = std::max(swing, motion(joint, 0).value);
        twist = std::max(twist, std::abs(motion(joint, 1).value));
    }
    EXPECT_GE(swing, 39 * kDegree) << "the stop was reached";
    EXPECT_LE(swing, 42 * kDegree);
    EXPECT_LE(twist, 17 * kDegree);
    EXPECT_LE(error(joint), 1e-4);
}

// ---------------------------------------------------------------- drives

TEST(Motor, AcceleratesByItsTorqueThenHoldsItsSpeed) {
    const World world = weightless();
    reach_a_speed(world, bar(world), kAboutEnd);
}

TEST(Motor, GivesWayBeyondItsTorque) { give_way_and_hold(World(), 1e-3); }

TEST(Drive, HoldsATargetLikeASpring) { hold_like_a_spring(World(), 0.002); }

// Given as 2 Hz undamped: what it swings with, but for the damping of implicit Euler.
TEST(Drive, SwingsAtTheFrequencyGiven) {
    World world([](taut_world_def& def) { def.gravity = {0, 0, 0}, def.substeps = 32; });
    taut_axis_def axis = free_axis();
    axis.drive.frequency = 2;
    axis.drive.damping_ratio = 0;
    axis.drive.target = 0.2f;
    const taut_joint joint =
        slider(world, {}, world.add({.mass = 3, .inertia = {1, 1, 1}}), {0, 0, 0}, {1, 0, 0}, axis);
    std::vector<double> crossings;
    double last = -0.2;
    for (int frame = 1; frame <= 180; ++frame) {
        world.step();
        const double now = motion(joint).value - 0.2;
        if (last < 0 && now >= 0) crossings.push_back((frame - now / (now - last)) * world.frame());
        last = now;
    }
    ASSERT_GE(crossings.size(), 4u);
    const double period = (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
    EXPECT_NEAR(period, 0.5, 0.005);
}

// ---------------------------------------------------------------- friction

TEST(JointFriction, StopsARotorAfterItsTime) { stop_a_rotor(weightless(), 1e-3); }

TEST(JointFriction, HoldsBelowItsForceAndSlipsAbove) {
    for (const double factor : {0.9, 1.1}) hold_or_slip(World(), factor, 1e-3, 0.01);
}

// ---------------------------------------------------------------- what is locked

TEST(Slider, FallsAlongItsAxisAlone) {
    World world;
    const Vec axis = unit({1, -2, 0.5});
    const taut_body body = world.add({.spin = {}, .mass = 2, .inertia = {0.3, 0.4, 0.5}});
    const taut_joint joint = slider(world, {}, body, {0.3, 0.2, 0}, axis);
    world.step(60);
    const double acceleration = dot(axis, {0, -kG, 0});
    EXPECT_NEAR(motion(joint).value, 0.5 * acceleration, 0.01 * acceleration);
    EXPECT_LT(norm(cross(position(body), axis)), 1e-5);
    EXPECT_LT(norm(state(body).spin), 1e-6);
}

// Five bars welded to a wall carry their weight as one: the torque at the wall.
TEST(Fixed, CarriesACantilever) {
    World world;
    std::vector<taut_joint> joints;
    taut_body last{};
    for (int i = 0; i < 5; ++i) {
        const taut_body link = world.add({.position = {0.5 + i, 0, 0}, .mass = 4, .inertia = {0.1, 0.4, 0.4}});
        auto def = at(world, taut_fixed_joint_def_init, last, link, {1.0 * i, 0, 0}, {1, 0, 0});
        joints.emplace_back();
        ok(taut_world_add_fixed_joint(world.handle, &def, &joints.back()));
        last = link;
    }
    world.step(300);
    EXPECT_NEAR(position(last).y, 0, 1e-5);
    taut_vec3 force, torque;
    ok(taut_joint_get_force(joints[0], &force));
    ok(taut_joint_get_torque(joints[0], &torque));
    EXPECT_NEAR(force.y, 20 * kG, 0.01);
    EXPECT_NEAR(torque.z, 20 * kG * 2.5, 0.1);
}

// Two shafts at an angle beta through a cardan joint: tan(out) = tan(in) / cos(beta) or tan(in) cos(beta), by which
// shaft bears the cross; both shafts in bearings, so the loop is closed.
TEST(Universal, TurnsLikeACardanJoint) {
    const World world = weightless();
    const double beta = 30 * kDegree;
    const Vec out_axis = {std::cos(beta), std::sin(beta), 0};
    const taut_body in = world.add({.position = {-0.5, 0, 0}, .mass = 1, .inertia = {0.1, 0.1, 0.1}});
    const taut_body out = world.add({.position = 0.5 * out_axis, .mass = 1, .inertia = {0.1, 0.1, 0.1}});
    const taut_joint input = hinge(world, {}, in, {-0.5, 0, 0}, {1, 0, 0}, motor(2, 1e3));
    const taut_joint output = hinge(world, {}, out, 0.5 * out_axis, out_axis);
    taut_universal_joint_def def;
    taut_universal_joint_def_init(&def);
    def.base.body_a = in;
    def.base.body_b = out;
    def.base.frame_a.position = {0.5, 0, 0};
    def.base.frame_b.position = (-0.5 * out_axis).pos();
    // The cross: x of a is z of the world, y of b is square to it and to the output shaft.
    const Quat a = Quat::turn({0, 1, 0}, -kPi / 2);  // x to z
    const Quat b = Quat::turn({0, 0, 1}, beta) * a;
    def.base.frame_a.rotation = a.narrow();
    def.base.frame_b.rotation = b.narrow();
    taut_joint cardan{};
    ok(taut_world_add_universal_joint(world.handle, &def, &cardan));
    double worst = 0, ratio_low = 10, ratio_high = 0;
    for (int frame = 0; frame < 300; ++frame) {
        world.step();
        const double from = motion(input).value, to = motion(output).value;
        const double expected = std::atan2(std::sin(from) * std::cos(beta), std::cos(from));
        const double other = std::atan2(std::sin(from), std::cos(from) * std::cos(beta));
        const auto off = [&](double angle) { return std::abs(std::remainder(to - angle, 2 * kPi)); };
        worst = std::max(worst, std::min(off(expected), off(other)));
        if (frame < 5) continue;
        ratio_low = std::min(ratio_low, motion(output).rate / motion(input).rate);
        ratio_high = std::max(ratio_high, motion(output).rate / motion(input).rate);
    }
    EXPECT_LT(worst, 0.01);
    EXPECT_NEAR(ratio_low, std::cos(beta), 0.02);
    EXPECT_NEAR(ratio_high, 1 / std::cos(beta), 0.02);
    EXPECT_LT(error(cardan), 1e-3);
}

// A parallelogram with one more parallel link is over-constrained and still moves.
TEST(FourBar, MovesWithAParallelLinkTooMany) {
    World world;
    const taut_body coupler = world.add({.position = {1, -1, 0}, .mass = 2, .inertia = {0.2, 0.4, 0.4}});
    std::vector<taut_joint> joints;
    for (const double x : {0.0, 1.0, 2.0}) {
        const taut_body link = world.add({.position = {x, -0.5, 0}, .mass = 1, .inertia = {0.1, 0.02, 0.1}});
        joints.push_back(hinge(world, {}, link, {x, 0, 0}, {0, 0, 1}));
        joints.push_back(hinge(world, link, coupler, {x, -1, 0}, {0, 0, 1}));
    }
    ok(taut_body_set_velocity(coupler, {2, 0, 0}, {0, 0, 0}));
    double gap = 0, tilt = 0, reach = 0;
    for (int frame = 0; frame < 600; ++frame) {
        world.step();
        for (taut_joint joint : joints) gap = std::max(gap, error(joint));
        const BodyState now = state(coupler);
        tilt = std::max(tilt, std::abs(now.rotation.z));
        reach = std::max(reach, std::abs(now.position.x - 1));
    }
    EXPECT_GT(reach, 0.3);
    EXPECT_LT(gap, 1e-3);
    EXPECT_LT(tilt, 1e-3) << "the coupler stays level";
}

// ---------------------------------------------------------------- changes in motion

// A joint made between bodies that move as it wants, or taken away, changes no velocity.
TEST(JointInMotion, ComesAndGoesWithoutAKick) {
    const World world = weightless();
    const taut_body a = world.add({.velocity = {1, 2, 0}, .spin = {0, 0, 3}, .mass = 1, .inertia = {0.1, 0.1, 0.1}});
    const Vec arm = {1, 0, 0};
    const taut_body b = world.add({.position = arm,
                                   .velocity = Vec(1, 2, 0) + cross({0, 0, 3}, arm),
                                   .spin = {0, 0, 3},
                                   .mass = 5,
                                   .inertia = {0.4, 0.4, 0.4}});
    const Totals before = totals({a, b});
    auto def = at(world, taut_fixed_joint_def_init, a, b, {0.5, 0, 0}, {1, 0, 0});
    taut_joint joint{};
    ok(taut_world_add_fixed_joint(world.handle, &def, &joint));
    world.step(60);
    ok(taut_joint_remove(joint));
    world.step(1);
    const Totals after = totals({a, b});
    EXPECT_NEAR(after.kinetic / before.kinetic, 1, 0.002);
    EXPECT_NEAR(norm(after.spin - before.spin) / norm(before.spin), 0, 0.002);
}

}  // namespace
