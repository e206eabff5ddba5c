// Wheels on struts: springs, steering and spin each for itself, and cars of four of them.
#include "physics/joint_setting.h"

namespace {

using namespace lab;

const Vec kUp(0, 1, 0), kAxle(0, 0, 1);  // strut and axle; cars drive along x

class Wheels : public SettingWorld {
protected:
    Wheels() : SettingWorld({0, -kG, 0}) {}

    taut_wheel_joint_def wheel_at(taut_body chassis, taut_body wheel, const Vec& place, const Vec& strut = kUp) const {
        taut_wheel_joint_def def;
        taut_wheel_joint_def_init(&def);
        def.base.body_a = chassis, def.base.body_b = wheel;
        ok(taut_joint_frames_from_two_axes(world.handle, chassis, wheel, place.pos(), strut.narrow(), kAxle.narrow(),
                                           &def.base.frame_a, &def.base.frame_b));
        def.base.solve = GetParam().solve;
        return def;
    }
    taut_joint add(const taut_wheel_joint_def& def) const {
        taut_joint out{};
        ok(taut_world_add_wheel_joint(world.handle, &def, &out));
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Rates, Wheels, testing::ValuesIn(joint_settings()), name_of);

taut_axis_def spring(double stiffness, double damping, double target = 0) {
    taut_axis_def axis = free_axis();
    axis.drive.stiffness = static_cast<float>(stiffness);
    axis.drive.damping = static_cast<float>(damping);
    axis.drive.target = static_cast<float>(target);
    return axis;
}

Vec axle_of(taut_body wheel) { return state(wheel).rotation.rotate(kAxle); }

// A chassis sinks by m g / k on a wheel that stands, and swings meanwhile as k / m says.
TEST_P(Wheels, SpringsSagByTheWeight) {
    constexpr double kMass = 400, kStiffness = 4e4;
    const taut_body ground = world.add({.kind = TAUT_BODY_STATIC, .position = {0, 0, 0}});
    const taut_body chassis = world.add({.position = {0, 0.5, 0}, .mass = kMass, .inertia = {100, 100, 100}});
    auto def = wheel_at(chassis, ground, {0, 0, 0});
    def.spin.mode = TAUT_AXIS_LOCKED;
    def.suspension = spring(kStiffness, 0);
    const taut_joint strut = add(def);
    Crossings swing;
    const double sag = kMass * kG / kStiffness;
    for (int i = 0; i < frames(3); ++i) {
        world.step();
        swing.sample((i + 1) / GetParam().hz, motion(strut).value - sag);
    }
    const double period = 2 * kPi * std::sqrt(kMass / kStiffness);
    EXPECT_NEAR(swing.period(), period, 0.02 * period);
    const taut_axis_def damped = spring(kStiffness, 2 * std::sqrt(kMass * kStiffness));
    ok(taut_joint_set_axis(strut, 0, &damped));
    run(2);
    EXPECT_NEAR(motion(strut).value, sag, 0.01 * sag);  // the wheel is up the strut
    EXPECT_NEAR(static_cast<double>(forces(strut).drive), -kMass * kG, 0.01 * kMass * kG);
    EXPECT_LE(error(strut), 1e-3);
}

// The axle stays where steering turned it, whatever the spin: with six_dof it went round with the wheel.
TEST_P(Wheels, AxlesDoNotTurnWithTheSpin) {
    const taut_body wheel = world.add({.mass = 20, .inertia = {0.6, 0.6, 1.1}, .gravity_scale = 0});
    auto def = wheel_at({}, wheel, {0, 0, 0});
    def.spin = motor(30, 1e3);
    def.steering = spring(2e4, 400, 0.4);
    const taut_joint joint = add(def);
    run(1);
    for (int i = 0; i < frames(1); ++i) {
        world.step();
        ASSERT_NEAR(motion(joint, 1).value, 0.4, 0.01) << i;
        const Vec wanted(std::sin(0.4), 0, std::cos(0.4));
        ASSERT_LE(norm(axle_of(wheel) - wanted), 0.02) << i;
    }
    EXPECT_NEAR(motion(joint, 2).rate, 30, 0.3);
    // Steered as it spins: gyroscopic torques do not tip it out of the joint.
    for (int i = 0; i < frames(2); ++i) {
        ok(taut_joint_set_target(joint, 1, static_cast<float>(0.4 * std::cos(3 * i / GetParam().hz)), 0));
        world.step();
        ASSERT_LE(angular_error(joint), 1e-2) << i;
    }
}

TEST_P(Wheels, SpinFreelyForever) {
    const taut_body wheel = world.add({.mass = 20, .inertia = {0.6, 0.6, 1.1}, .gravity_scale = 0});
    ok(taut_body_set_velocity(wheel, {0, 0, 0}, (70 * kAxle).narrow()));
    const taut_joint joint = add(wheel_at({}, wheel, {0, 0, 0}, unit(Vec(0.2, 1, 0))));
    run(10);
    EXPECT_NEAR(motion(joint, 2).rate, 70, 0.07);
    EXPECT_LE(angular_error(joint), 1e-4);
    EXPECT_LE(error(joint), 1e-4);
}

TEST_P(Wheels, StopsHoldSteeringAndSuspension) {
    const taut_body wheel = world.add({.mass = 20, .inertia = {0.6, 0.6, 1.1}});
    auto def = wheel_at({}, wheel, {0, 0, 0});
    def.suspension = limited(-0.1, 0.1);
    def.steering = limited(-0.5, 0.5);
    const taut_joint joint = add(def);
    for (int i = 0; i < frames(1.5); ++i) {
        ok(taut_body_apply_force(wheel, {0, 0, 0}, {0, 20, 0}));
        world.step();
        ASSERT_LE(motion(joint, 1).value, 0.51) << i;
    }
    EXPECT_NEAR(motion(joint).value, -0.1, 2e-3);
    EXPECT_NEAR(motion(joint, 1).value, 0.5, 5e-3);
    EXPECT_EQ(forces(joint).active_stop, -1);
    EXPECT_NEAR(static_cast<double>(forces(joint, 1).stop), -20, 0.4);
}

// Four sprung wheels under a chassis, driven at the rear, steered at the front after Ackermann.
class Car {
public:
    static constexpr double kBase = 2.4, kTrack = 1.5, kRadius = 0.35, kMass = 800;  // [m], [kg]

    Car(const World& world, taut_joint_solve solve) : world_(world) {
        chassis = world.add({.shape = world.box({1.4, 0.2, 0.6}),
                             .position = {0, 0.75, 0},
                             .mass = kMass,
                             .inertia = {200, 700, 600},
                             .group = -1});
        for (int i = 0; i < 4; ++i) {
            const Vec place(i < 2 ? 0.5 * kBase : -0.5 * kBase, kRadius, i % 2 == 0 ? -0.5 * kTrack : 0.5 * kTrack);
            wheel[i] = world.add({.shape = world.sphere(kRadius),
                                  .position = place,
                                  .mass = 20,
                                  .inertia = {0.8, 0.8, 1.2},
                                  .friction = 1,
                                  .group = -1});
            taut_wheel_joint_def def;
            taut_wheel_joint_def_init(&def);
            def.base.body_a = chassis, def.base.body_b = wheel[i];
            ok(taut_joint_frames_from_two_axes(world.handle, chassis, wheel[i], place.pos(), kUp.narrow(),
                                               kAxle.narrow(), &def.base.frame_a, &def.base.frame_b));
            def.suspension = spring(4e4, 4e3, -kMass * kG / 4 / 4e4);
            if (i < 2) def.steering = spring(2e4, 500);
            def.base.solve = solve;
            ok(taut_world_add_wheel_joint(world.handle, &def, &joint[i]));
        }
    }

    // Along a circle to the left of so much curvature [1/m], by the kinematic model of a bicycle, as fast as that.
    void drive(double speed, double curvature) const {
        for (int i = 0; i < 4; ++i) {
            const double side = i % 2 == 0 ? -0.5 * kTrack : 0.5 * kTrack;  // along z, which is right
            const double out = 1 + side * curvature;
            if (i < 2)
                ok(taut_joint_set_target(joint[i], 1, static_cast<float>(std::atan(kBase * curvature / out)), 0));
            else {
                const taut_axis_def turning = motor(-speed * out / kRadius, 400);
                ok(taut_joint_set_axis(joint[i], 2, &turning));
            }
        }
    }
    Vec heading() const { return state(chassis).rotation.rotate({1, 0, 0}); }
    Vec rear() const { return position(chassis) - 0.5 * kBase * heading(); }
    double worst_error() const {
        double worst = 0;
        for (const taut_joint each : joint) worst = std::max({worst, error(each), angular_error(each)});
        return worst;
    }

    taut_body chassis{}, wheel[4]{};
    taut_joint joint[4]{};

private:
    const World& world_;
};

TEST_P(Wheels, CarryACarStraight) {
    world.add_ground(1);
    const Car car(world, GetParam().solve);
    run(1);
    EXPECT_NEAR(position(car.chassis).y, 0.75, 0.01);  // the springs are set for its weight
    car.drive(5, 0);
    run(4);
    const BodyState now = state(car.chassis);
    EXPECT_NEAR(now.velocity.x, 5, 0.05);
    EXPECT_NEAR(now.position.z, 0, 0.02);
    EXPECT_NEAR(car.heading().z, 0, 5e-3);
    EXPECT_LE(car.worst_error(), 2e-3);
}

TEST_P(Wheels, TurnACarAsItsSteeringSays) {
    world.add_ground(1);
    const Car car(world, GetParam().solve);
    run(0.5);
    for (const double radius : {8.0, -15.0}) {
        car.drive(2.5, 1 / radius);
        run(2);
        // Three points of the rear axle's way: their circle.
        Vec p[3];
        for (Vec& each : p) {
            each = car.rear();
            run(0.8);
        }
        const Vec a = p[1] - p[0], b = p[2] - p[1], c = p[2] - p[0];
        const double measured = norm(a) * norm(b) * norm(c) / (2 * cross(a, c).y);
        EXPECT_NEAR(measured, radius, 0.04 * std::abs(radius));
        EXPECT_NEAR(state(car.chassis).spin.y, 2.5 / radius, 0.04 * 2.5 / std::abs(radius));
        EXPECT_LE(car.worst_error(), 3e-3);
    }
}

// An engine drives both rear wheels through a differential: its housing turns with the engine, the wheels' shafts
// spring.
TEST_P(Wheels, AreDrivenThroughADifferential) {
    world.add_ground(1);
    const Car car(world, GetParam().solve);
    const Vec middle(-0.5 * Car::kBase, 0.6, 0);
    const taut_body carrier = world.add({.position = middle, .mass = 15, .inertia = {0.2, 0.2, 0.2}, .group = -1});
    auto hinge = at(world, taut_hinge_joint_def_init, car.chassis, carrier, middle, kAxle);
    hinge.base.solve = GetParam().solve;
    hinge.angle = motor(-10, 600);
    taut_joint engine{};
    ok(taut_world_add_hinge_joint(world.handle, &hinge, &engine));
    taut_gear_joint_def def;
    taut_gear_joint_def_init(&def);
    def.base.body_a = car.wheel[2], def.base.body_b = car.wheel[3], def.housing = carrier;
    for (const int i : {2, 3})
        ok(taut_joint_frames_from_world(world.handle, car.wheel[i], carrier, position(car.wheel[i]).pos(),
                                        kAxle.narrow(), i == 2 ? &def.base.frame_a : &def.base.frame_b,
                                        i == 2 ? &def.housing_frame_a : &def.housing_frame_b));
    def.base.solve = GetParam().solve;
    taut_joint gear{};
    ok(taut_world_add_gear_joint(world.handle, &def, &gear));
    for (const int i : {0, 1}) {
        const double side = i == 0 ? -0.5 : 0.5;
        ok(taut_joint_set_target(car.joint[i], 1, static_cast<float>(std::atan(Car::kBase / (8 + side * Car::kTrack))),
                                 0));
    }
    run(4);
    const double left = motion(car.joint[2], 2).rate, right = motion(car.joint[3], 2).rate;
    EXPECT_NEAR(left + right, 2 * motion(engine).rate, 0.05);
    // Sweeps of substeps of 1/120 s let it run ahead by 6 %: the car weighs 4000 times what the carrier does.
    EXPECT_NEAR(motion(engine).rate, -10, GetParam().solve == TAUT_JOINT_SOLVE_DIRECT ? 0.2 : 0.8);
    const double half = 0.5 * Car::kTrack / 8;
    EXPECT_NEAR(right / left, (1 + half) / (1 - half), 0.03);
    const double speed = -motion(engine).rate * Car::kRadius;
    EXPECT_NEAR(state(car.chassis).spin.y, speed / 8, 0.05 * speed / 8);
}

}  // namespace
