// Springs on the swing of a cone-twist joint, against the harmonic oscillator in a plane.
#include "physics/joint_lab.h"

namespace {

using namespace lab;

constexpr double kInertia = 0.25;  // [kg m^2], about any axis

// A top on a point, its x axis along the joint's, tilted by an angle towards a direction across it.
struct Top {
    Top(double tilt, double azimuth, const taut_axis_def& swing, uint32_t substeps = 16,
        taut_joint_solve solve = TAUT_JOINT_SOLVE_DIRECT, taut_solver solver = TAUT_SOLVER_BLOCK_LDLT)
        : world([&](taut_world_def& def) {
              def.gravity = {0, 0, 0};
              def.substeps = substeps;
              def.solver = solver;
          }),
          axis(0, -std::sin(azimuth), std::cos(azimuth)),
          towards(0, std::cos(azimuth), std::sin(azimuth)),
          body(world.add({.mass = 2, .inertia = {kInertia, kInertia, kInertia}})) {
        auto def = at(world, taut_cone_twist_joint_def_init, {}, body, {}, {1, 0, 0});
        def.swing = swing;
        def.base.solve = solve;
        ok(taut_world_add_cone_twist_joint(world.handle, &def, &joint));
        const taut_pose pose{{0, 0, 0}, Quat::turn(axis, tilt).narrow(), {}};
        ok(taut_body_set_pose(body, &pose));
    }
    void spin(const Vec& w) const { ok(taut_body_set_velocity(body, {0, 0, 0}, w.narrow())); }
    Vec nose() const { return state(body).rotation.rotate({1, 0, 0}); }
    double along() const { return std::asin(dot(nose(), towards)); }  // tilt, with its sign

    const World world;
    Vec axis, towards;  // of the tilt
    taut_body body;
    taut_joint joint{};
};

taut_axis_def spring(double frequency, double damping_ratio, double target = 0) {
    taut_axis_def swing = free_axis();
    swing.drive.frequency = static_cast<float>(frequency);
    swing.drive.damping_ratio = static_cast<float>(damping_ratio);
    swing.drive.target = static_cast<float>(target);
    return swing;
}

// x = a e^(-z w t) cos(w sqrt(1 - z^2) t) nearly, and through the middle as if it were not there; implicit Euler damps
// by w^2 h / 2 besides.
TEST(SwingSpring, SwingsAtItsFrequencyAndDampingToEitherSide) {
    constexpr double kFrequency = 1.5, kRatio = 0.08, kTilt = 0.4;
    constexpr double kOmega = 2 * kPi * kFrequency;
    for (const double azimuth : {0.0, 0.7, 2.5}) {
        const Top top(kTilt, azimuth, spring(kFrequency, kRatio));
        Crossings crossings;
        double lowest = 0, highest = 0, across = 0;
        for (int frame = 1; frame <= 180; ++frame) {
            top.world.step();
            const double now = top.along(), time = frame * top.world.frame();
            crossings.sample(time, now);
            if (time < 0.5) lowest = std::min(lowest, now);
            if (time > 1.8) highest = std::max(highest, now);
            across = std::max(across, std::abs(dot(top.nose(), top.axis)));
        }
        const double damped = kOmega * std::sqrt(1 - kRatio * kRatio);
        EXPECT_NEAR(crossings.period(), 2 * kPi / damped, 0.006) << azimuth;
        const double rate = kRatio * kOmega + kOmega * kOmega * top.world.substep() / 2;
        EXPECT_NEAR(lowest, -kTilt * std::exp(-rate * kPi / damped), 0.02 * kTilt) << azimuth;
        EXPECT_NEAR(highest, kTilt * std::exp(-rate * 6 * kPi / damped), 0.02 * kTilt) << azimuth;
        EXPECT_LE(across, 1e-3) << azimuth;
    }
}

// In two directions at once, a quarter of a period apart: it goes around, and damping takes of either as much.
TEST(SwingSpring, GoesAroundAsItSwings) {
    constexpr double kFrequency = 1, kTilt = 0.1;
    constexpr double kOmega = 2 * kPi * kFrequency;
    for (const double ratio : {0.0, 0.05}) {
        const Top top(kTilt, 0.4, spring(kFrequency, ratio));
        top.spin(kOmega * kTilt * top.towards);
        double turned = 0;
        Vec last = top.nose();
        for (int frame = 0; frame < 120; ++frame) {
            top.world.step();
            const Vec now = top.nose();
            turned += std::atan2(last.y * now.z - last.z * now.y, last.y * now.y + last.z * now.z);
            last = now;
        }
        const double rate = ratio * kOmega + kOmega * kOmega * top.world.substep() / 2, time = 2;
        EXPECT_NEAR(std::abs(turned), kOmega * time, 0.02 * kOmega * time) << ratio;
        EXPECT_NEAR(motion(top.joint).value, kTilt * std::exp(-rate * time), 0.05 * kTilt) << ratio;
    }
}

// By every way of solving: on the side where it leans, and a torque moves it on by as much as the spring yields.
TEST(SwingSpring, HoldsATargetAndYields) {
    constexpr double kTarget = 0.6, kStiffness = 40, kTorque = 3;
    for (const taut_solver solver :
         {TAUT_SOLVER_BLOCK_LDLT, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL, TAUT_SOLVER_ACCELERATED_JACOBI})
        for (const taut_joint_solve solve : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT}) {
            taut_axis_def swing = free_axis();
            swing.drive.stiffness = kStiffness;
            swing.drive.damping = 5;
            swing.drive.target = static_cast<float>(kTarget);
            const Top top(0.2, -1.1, swing, 4, solve, solver);
            top.world.step(120);
            EXPECT_NEAR(top.along(), kTarget, 1e-3) << solver << ", " << solve;
            const taut_vec3 torque = (kTorque * top.axis).narrow();
            for (int frame = 0; frame < 120; ++frame) {
                ok(taut_body_apply_force(top.body, {0, 0, 0}, torque));
                top.world.step();
            }
            EXPECT_NEAR(top.along(), kTarget + kTorque / kStiffness, 2e-3) << solver << ", " << solve;
            EXPECT_NEAR(static_cast<double>(forces(top.joint).drive), -kTorque, 0.02 * kTorque) << solver;
        }
}

TEST(SwingSpring, IsNoStrongerThanItsForce) {
    taut_axis_def swing = spring(2, 1);
    swing.drive.max_force = 1;
    const Top top(0.01, 0.3, swing);
    for (int frame = 0; frame < 30; ++frame) {
        ok(taut_body_apply_force(top.body, {0, 0, 0}, (2 * top.axis).narrow()));
        top.world.step();
    }
    EXPECT_NEAR(dot(state(top.body).spin, top.axis), 0.5 * 1 / kInertia,
                0.02);  // what is left of 2 N m in half a second
}

// A stop that gives way by its compliance, and rocks on it as on a spring.
TEST(SoftSwingStop, YieldsByItsCompliance) {
    constexpr double kLimit = 0.35, kCompliance = 0.02;
    for (const double torque : {2.0, 6.0}) {
        taut_axis_def swing = limited(-INFINITY, kLimit);
        swing.stop_compliance = static_cast<float>(kCompliance);
        swing.stop_damping = 3;
        const Top top(0.1, 2, swing, 4);
        for (int frame = 0; frame < 180; ++frame) {
            ok(taut_body_apply_force(top.body, {0, 0, 0}, (torque * top.axis).narrow()));
            top.world.step();
        }
        EXPECT_NEAR(motion(top.joint).value, kLimit + kCompliance * torque, 1e-3) << torque;
    }
}

}  // namespace
