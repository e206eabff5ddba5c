// Experiments on a joint's axis in a world of any solver, against what mechanics says of them within given bounds.
#pragma once

#include "physics/joint_lab.h"

namespace lab {

// Of a bar that falls on a stop 30 degrees below: overrun at the blow and at rest [rad], share of the moment.
struct StopBounds {
    double blow, rest, moment;
};
inline taut_joint catch_a_bar(const World& world, const StopBounds& bounds) {
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, limited(-30 * kDegree, 60 * kDegree));
    double overrun = 0;
    for (int frame = 0; frame < 300; ++frame) {
        world.step();
        overrun = std::max(overrun, -30 * kDegree - motion(joint).value);
    }
    EXPECT_LE(overrun, bounds.blow) << "at the blow";
    EXPECT_NEAR(motion(joint).value, -30 * kDegree, bounds.rest);
    EXPECT_NEAR(motion(joint).rate, 0, 1e-3);
    const double moment = kBarMass * kG * 0.5 * std::cos(30 * kDegree);
    EXPECT_NEAR(forces(joint).stop, moment, bounds.moment * moment);
    EXPECT_EQ(forces(joint).active_stop, -1);
    return joint;
}

// A stop of compliance c yields by moment * c.
inline void yield_at_a_stop(const World& world, double bound) {
    taut_axis_def axis = limited(0, 1);
    axis.stop_compliance = 0.01f;
    axis.stop_damping = 5;
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, axis);
    world.step(600);
    const double yielded = motion(joint).value;
    EXPECT_NEAR(yielded, -0.01 * kBarMass * kG * 0.5 * std::cos(yielded), bound);
}

// Without gravity: 3 N m on this inertia up to 6 rad/s.
inline taut_joint reach_a_speed(const World& world, taut_body rotor, double inertia) {
    const taut_joint joint = hinge(world, {}, rotor, {0, 0, 0}, {0, 0, 1}, motor(6, 3));
    const double reached = 6 * inertia / 3;  // [s]
    const int before = static_cast<int>(0.5 * reached / world.frame());
    world.step(before);
    EXPECT_NEAR(motion(joint).rate, 3 / inertia * world.stepped(before), 1e-3);
    EXPECT_NEAR(forces(joint).drive, 3, 1e-5);
    world.step(static_cast<int>(reached / world.frame()));
    EXPECT_NEAR(motion(joint).rate, 6, 1e-3);
    EXPECT_NEAR(forces(joint).drive, 0, 0.02);
    return joint;
}

// A motor slips at its limit against a load beyond its strength; one that is strong enough holds the bar where it is.
inline void give_way_and_hold(const World& world, double bound) {
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, motor(0, 4));
    world.step(20);
    EXPECT_LT(motion(joint).value, -0.2);
    EXPECT_NEAR(forces(joint).drive, 4, 1e-4);
    const taut_axis_def enough = motor(0, kBarMass * kG);
    ok(taut_joint_set_axis(joint, 0, &enough));
    world.step(60);
    const double held = motion(joint).value;
    world.step(60);
    EXPECT_NEAR(motion(joint).value, held, bound);
}

// Bound: share of the moment that the spring holds.
inline void hold_like_a_spring(const World& world, double bound) {
    taut_axis_def axis = free_axis();
    axis.drive.stiffness = 200;
    axis.drive.damping = 20;
    axis.drive.target = 0.4f;
    const taut_joint joint = hinge(world, {}, bar(world), {0, 0, 0}, {0, 0, 1}, axis);
    world.step(600);
    const double angle = motion(joint).value, moment = kBarMass * kG * 0.5 * std::cos(angle);
    EXPECT_NEAR(200 * (0.4 - angle), moment, bound * moment);
    EXPECT_NEAR(forces(joint).drive, moment, bound * moment);
}

// Without gravity: 2 N m of friction stop 10 rad/s. Bound on the rate half-way [rad/s].
inline void stop_a_rotor(const World& world, double bound) {
    const taut_body body = world.add({.spin = {0, 0, 10}, .mass = 1, .inertia = {0.3, 0.3, 0.5}});
    const taut_joint joint = hinge(world, {}, body, {0, 0, 0}, {0, 0, 1}, with_friction(2));
    const double stops = 10 * 0.5 / 2;  // [s]
    const int half = static_cast<int>(0.5 * stops / world.frame());
    world.step(half);
    EXPECT_NEAR(motion(joint).rate, 10 - 2 / 0.5 * half * world.frame(), bound);
    EXPECT_NEAR(forces(joint).friction, -2, 1e-5);
    world.step(half + 20);
    EXPECT_NEAR(motion(joint).rate, 0, 1e-3);
}

// A weight on a slide whose friction is the weight over a factor. Bounds where it holds and where it slips [m].
inline void hold_or_slip(const World& world, double factor, double holds, double slips) {
    const taut_joint joint = slider(world, {}, world.add({.mass = 2, .inertia = {1, 1, 1}}), {0, 0, 0}, {0, 1, 0},
                                    with_friction(2 * kG / factor));
    world.step(120);
    const double slid = -motion(joint).value, net = kG * (1 - 1 / factor), t = 120 * world.frame();
    if (factor < 1)
        EXPECT_NEAR(slid, 0, holds);
    else
        EXPECT_NEAR(slid, 0.5 * net * t * t, slips);
}

}  // namespace lab
