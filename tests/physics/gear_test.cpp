// Gears and racks against the mechanics of rigid wheels, at every rate and solved in either way.
#include "physics/joint_setting.h"

namespace {

using namespace lab;

const Vec kAxis(0, 0, 1);

// By both frames of each body: on itself and on the housing.
template <class Def>
void guide(const World& world, Def& def, const Vec& at_a, const Vec& along_a, const Vec& at_b, const Vec& along_b) {
    ok(taut_joint_frames_from_world(world.handle, def.base.body_a, def.housing, at_a.pos(), along_a.narrow(),
                                    &def.base.frame_a, &def.housing_frame_a));
    ok(taut_joint_frames_from_world(world.handle, def.base.body_b, def.housing, at_b.pos(), along_b.narrow(),
                                    &def.base.frame_b, &def.housing_frame_b));
}

double turn_of(taut_body body) { return dot(state(body).spin, kAxis); }
double angle_of(taut_body body) {
    const Vec x = state(body).rotation.rotate({1, 0, 0});
    return std::atan2(x.y, x.x);
}

class GearWorld : public SettingWorld {
protected:
    explicit GearWorld(const Vec& gravity = {}) : SettingWorld(gravity) {}

    taut_body wheel(const Vec& place, double inertia, double mass = 1) const {
        return world.add({.position = place, .mass = mass, .inertia = {inertia, inertia, inertia}});
    }
    taut_joint gear(taut_body a, taut_body b, taut_body housing, double ratio) const {
        taut_gear_joint_def def;
        taut_gear_joint_def_init(&def);
        def.base.body_a = a, def.base.body_b = b, def.housing = housing;
        guide(world, def, position(a), kAxis, position(b), kAxis);
        def.ratio = static_cast<float>(ratio);
        def.base.solve = GetParam().solve;
        taut_joint out{};
        ok(taut_world_add_gear_joint(world.handle, &def, &out));
        return out;
    }
    void torque(taut_body body, double about) const {
        ok(taut_body_apply_force(body, {0, 0, 0}, (about * kAxis).narrow()));
    }
};

class Gears : public GearWorld {};
INSTANTIATE_TEST_SUITE_P(Rates, Gears, testing::ValuesIn(joint_settings()), name_of);

// A torque on a turns I_a + ratio^2 I_b.
TEST_P(Gears, ReflectInertia) {
    for (const double ratio : {-1.0, -0.4, 2.5, 7.0}) {
        const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
        const taut_joint hold[2] = {hinged({}, a, {0, 0, 0}, kAxis), hinged({}, b, {1, 0, 0}, kAxis)};
        const taut_joint mesh = gear(a, b, {}, ratio);
        constexpr double kTorque = 3, kTime = 1;
        for (int i = 0; i < frames(kTime); ++i) torque(a, kTorque), world.step();
        const double spin = kTorque * kTime / (0.2 + ratio * ratio * 0.05);
        EXPECT_NEAR(turn_of(a), spin, 0.01 * spin) << ratio;
        EXPECT_NEAR(turn_of(b), ratio * turn_of(a), 1e-4 * std::abs(ratio * spin)) << ratio;
        taut_vec3 on_b{};
        ok(taut_joint_get_torque(mesh, &on_b));
        EXPECT_NEAR(Vec(on_b).z, 0.05 * ratio * spin / kTime, 0.01 * std::abs(0.05 * ratio * spin)) << ratio;
        for (const taut_joint joint : hold) EXPECT_LE(error(joint), 1e-4);
        ok(taut_body_remove(a));
        ok(taut_body_remove(b));
    }
}

// 1000 turns under load: the phase of b is what that of a says.
TEST_P(Gears, KeepTheirPhaseOverAThousandTurns) {
    constexpr double kSpin = 60, kRatio = -0.7310585;  // no ratio of small numbers
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    const taut_joint crank = hinged({}, a, {0, 0, 0}, kAxis);
    const taut_axis_def drive = motor(kSpin, 1000);
    ok(taut_joint_set_axis(crank, 0, &drive));
    const taut_axis_def brake = with_friction(0.5);
    const taut_joint held = hinged({}, b, {1, 0, 0}, kAxis);
    ok(taut_joint_set_axis(held, 0, &brake));
    const taut_joint mesh = gear(a, b, {}, kRatio);
    double turned = 0, last = 0;
    while (turned < 1000 * 2 * kPi) {
        world.step();
        const double now = angle_of(a);
        turned += std::remainder(now - last, 2 * kPi);
        last = now;
    }
    const double ratio = static_cast<double>(static_cast<float>(kRatio));
    EXPECT_NEAR(std::remainder(angle_of(b) - ratio * turned, 2 * kPi), 0, 2e-3);
    EXPECT_NEAR(turn_of(b), ratio * turn_of(a), 1e-4 * kSpin);
    EXPECT_LE(angular_error(mesh), 2e-3);
}

// Turns of more than half a turn a substep, which poses do not tell: none is miscounted, which would be a blow. Swept
// hinges do not hold their axis beyond half a turn a substep, gears or not.
TEST_P(Gears, CountTurnsHoweverFastTheySpin) {
    constexpr double kRatio = -0.7310585;
    const double most = 2.5 * pace().substeps * GetParam().hz;
    const double spin = GetParam().solve == TAUT_JOINT_SOLVE_DIRECT ? 900 : std::min(900.0, most);
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    ok(taut_body_set_velocity(a, {0, 0, 0}, (spin * kAxis).narrow()));
    ok(taut_body_set_velocity(b, {0, 0, 0}, (kRatio * spin * kAxis).narrow()));
    hinged({}, a, {0, 0, 0}, kAxis);
    hinged({}, b, {1, 0, 0}, kAxis);
    const taut_joint mesh = gear(a, b, {}, kRatio);
    for (int i = 0; i < frames(2); ++i) {
        world.step();
        ASSERT_LE(angular_error(mesh), 0.02) << "frame " << i;
        ASSERT_NEAR(turn_of(a), spin, 0.01 * spin) << "frame " << i;
        ASSERT_NEAR(turn_of(b), kRatio * turn_of(a), 1e-3 * spin) << "frame " << i;
    }
}

// A differential: two side gears turn against each other in a carrier that turns itself. With w_a, w_b = w_c -+ d:
// (I_c + 2 I) dw_c/dt = T - t, 2 I dd/dt = t of a torque T on the carrier and a brake t on a.
TEST_P(Gears, OfADifferentialShareTheTorqueInATurningHousing) {
    constexpr double kCarrier = 0.3, kSide = 0.1, kTorque = 4, kBrake = 0.6, kTime = 1.5;
    const taut_body carrier = wheel({0, 0, 0}, kCarrier), a = wheel({0, 0, -0.5}, kSide), b = wheel({0, 0, 0.5}, kSide);
    hinged({}, carrier, {0, 0, 0}, kAxis);
    hinged(carrier, a, {0, 0, -0.5}, kAxis);
    hinged(carrier, b, {0, 0, 0.5}, kAxis);
    const taut_joint mesh = gear(a, b, carrier, -1);
    for (int i = 0; i < frames(kTime); ++i) {
        torque(carrier, kTorque);
        torque(a, -kBrake);
        world.step();
    }
    const double mean = (kTorque - kBrake) * kTime / (kCarrier + 2 * kSide), apart = kBrake * kTime / (2 * kSide);
    EXPECT_NEAR(turn_of(carrier), mean, 0.01 * mean);
    EXPECT_NEAR(turn_of(a), mean - apart, 0.01 * mean);
    EXPECT_NEAR(turn_of(b), mean + apart, 0.01 * mean);
    EXPECT_NEAR(turn_of(a) + turn_of(b), 2 * turn_of(carrier), 1e-4 * mean);
    const double momentum = kCarrier * turn_of(carrier) + kSide * (turn_of(a) + turn_of(b));
    EXPECT_NEAR(momentum, (kTorque - kBrake) * kTime, 0.01 * kTorque * kTime);
    EXPECT_LE(angular_error(mesh), 1e-3);
}

// A planetary gear with nothing fixed in space: from within, momenta do not change.
TEST_P(Gears, OnAFreeHousingKeepItsMomenta) {
    const taut_body housing = wheel({0.5, 0, 0}, 2, 10), a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05, 3);
    const taut_joint crank = hinged(housing, a, {0, 0, 0}, kAxis);
    hinged(housing, b, {1, 0, 0}, kAxis);
    gear(a, b, housing, -3);
    const taut_axis_def drive = motor(20, 50);
    ok(taut_joint_set_axis(crank, 0, &drive));
    run(1);
    const Totals now = totals({housing, a, b});
    EXPECT_LE(norm(now.momentum), 2e-3);
    EXPECT_LE(norm(now.spin), 2e-3);
    EXPECT_NEAR(motion(crank).rate, 20, 0.05);
    EXPECT_NEAR(turn_of(b) - turn_of(housing), -3 * (turn_of(a) - turn_of(housing)), 1e-3 * 60);
}

// A thousand times heavier, on either side.
TEST_P(Gears, CarryAThousandTimesTheInertia) {
    if (GetParam().solve != TAUT_JOINT_SOLVE_DIRECT) GTEST_SKIP() << "sweeps give way under what is far heavier";
    for (const bool heavy_a : {false, true}) {
        const double inertia_a = heavy_a ? 100 : 0.1, inertia_b = heavy_a ? 0.1 : 100;
        const taut_body a = wheel({0, 0, 0}, inertia_a), b = wheel({1, 0, 0}, inertia_b);
        hinged({}, a, {0, 0, 0}, kAxis);
        hinged({}, b, {1, 0, 0}, kAxis);
        gear(a, b, {}, 1.5);
        for (int i = 0; i < frames(1); ++i) torque(a, 50), world.step();
        const double spin = 50 / (inertia_a + 2.25 * inertia_b);
        EXPECT_NEAR(turn_of(a), spin, 0.01 * spin);
        EXPECT_NEAR(turn_of(b), 1.5 * turn_of(a), 1e-4 * spin);
        ok(taut_body_remove(a));
        ok(taut_body_remove(b));
    }
}

class Racks : public GearWorld {
protected:
    Racks() : GearWorld({0, -kG, 0}) {}

    taut_joint rack(taut_body pinion, taut_body bar, taut_body housing, double radius) const {
        taut_rack_pinion_joint_def def;
        taut_rack_pinion_joint_def_init(&def);
        def.base.body_a = pinion, def.base.body_b = bar, def.housing = housing;
        guide(world, def, position(pinion), kAxis, position(bar), {0, -1, 0});
        def.ratio = static_cast<float>(radius);
        def.base.solve = GetParam().solve;
        taut_joint out{};
        ok(taut_world_add_rack_pinion_joint(world.handle, &def, &out));
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Rates, Racks, testing::ValuesIn(joint_settings()), name_of);

// A rack falls and turns its pinion: v = r w, (m + I / r^2) dv/dt = m g.
TEST_P(Racks, TurnTheirPinions) {
    constexpr double kRadius = 0.25, kInertia = 0.4, kMass = 3, kTime = 1;
    const taut_body pinion = wheel({0, 0, 0}, kInertia), bar = wheel({kRadius, 0, 0}, 1, kMass);
    hinged({}, pinion, {0, 0, 0}, kAxis);
    sliding({}, bar, {0, -1, 0});
    const taut_joint mesh = rack(pinion, bar, {}, kRadius);
    run(kTime);
    const double speed = kMass * kG / (kMass + kInertia / (kRadius * kRadius)) * kTime;
    EXPECT_NEAR(-velocity(bar).y, speed, 0.01 * speed);
    EXPECT_NEAR(-velocity(bar).y, kRadius * turn_of(pinion), 1e-4 * speed);
    EXPECT_LE(error(mesh), 1e-4);
    taut_vec3 on_rack{};
    ok(taut_joint_get_force(mesh, &on_rack));
    const double force = kMass * (kG - speed / kTime);
    EXPECT_NEAR(Vec(on_rack).y, force, 0.01 * force);
}

// A climber: the rack is fixed in the world, the housing carries the pinion along it.
TEST_P(Racks, LiftTheirHousingWhereTheRackIsFixed) {
    constexpr double kRadius = 0.1;
    const taut_body carriage = wheel({0, 0, 0}, 1, 10), pinion = wheel({0, 0, 0}, 0.05);
    sliding({}, carriage, {0, -1, 0});
    const taut_joint crank = hinged(carriage, pinion, {0, 0, 0}, kAxis);
    taut_rack_pinion_joint_def def;
    taut_rack_pinion_joint_def_init(&def);
    def.base.body_a = pinion, def.housing = carriage;
    guide(world, def, {0, 0, 0}, kAxis, {kRadius, 0, 0}, {0, -1, 0});
    def.ratio = static_cast<float>(kRadius);
    def.base.solve = GetParam().solve;
    taut_joint mesh{};
    ok(taut_world_add_rack_pinion_joint(world.handle, &def, &mesh));
    const taut_axis_def drive = motor(20, 1000);  // 2 m/s
    ok(taut_joint_set_axis(crank, 0, &drive));
    run(2);
    EXPECT_NEAR(velocity(carriage).y, 2, 0.01);
    EXPECT_NEAR(position(carriage).y, 4, 0.1);
    EXPECT_NEAR(static_cast<double>(forces(crank).drive), 11 * kG * kRadius, 0.02 * 11 * kG * kRadius);
}

// ---------------------------------------------------------------- what a host does with them

class GearHost : public GearWorld {};
INSTANTIATE_TEST_SUITE_P(Modes, GearHost,
                         testing::Values(JointSetting{60, TAUT_JOINT_SOLVE_DIRECT},
                                         JointSetting{60, TAUT_JOINT_SOLVE_SOFT}),
                         name_of);

// Off they turn freely; on again, or with another ratio, they mesh as they stand and nothing jumps.
TEST_P(GearHost, MeshAsTheyStand) {
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    hinged({}, a, {0, 0, 0}, kAxis);
    hinged({}, b, {1, 0, 0}, kAxis);
    const taut_joint mesh = gear(a, b, {}, -2);
    ok(taut_joint_set_enabled(mesh, 0));
    ok(taut_body_set_velocity(a, {0, 0, 0}, (10 * kAxis).narrow()));
    for (int i = 0; i < 77; ++i) world.step();
    EXPECT_NEAR(turn_of(b), 0, 1e-6);
    ok(taut_body_set_velocity(b, {0, 0, 0}, (-20 * kAxis).narrow()));
    ok(taut_joint_set_enabled(mesh, 1));
    EXPECT_LE(angular_error(mesh), 1e-6);
    for (int i = 0; i < 30; ++i) world.step();
    EXPECT_NEAR(turn_of(a), 10, 1e-3);
    EXPECT_NEAR(turn_of(b), -20, 1e-3);
    // Another gear: speeds come together, momentum reflected to a stays.
    ok(taut_joint_set_ratio(mesh, 3));
    float ratio = 0;
    ok(taut_joint_get_ratio(mesh, &ratio));
    EXPECT_EQ(ratio, 3);
    const double before = 0.2 * turn_of(a) + 3 * 0.05 * turn_of(b);
    for (int i = 0; i < 30; ++i) world.step();
    EXPECT_NEAR(turn_of(b), 3 * turn_of(a), 1e-3);
    EXPECT_NEAR(turn_of(a), before / (0.2 + 9 * 0.05), 0.02);
    // Where the host puts one.
    taut_pose pose;
    ok(taut_body_get_pose(b, &pose));
    pose.rotation = Quat::turn(kAxis, 2).narrow();
    ok(taut_body_set_pose(b, &pose));
    EXPECT_LE(angular_error(mesh), 1e-6);
    const double spin = turn_of(a);
    for (int i = 0; i < 30; ++i) world.step();
    EXPECT_NEAR(turn_of(a), spin, 1e-3);
}

TEST_P(GearHost, BreakAboveTheirTorque) {
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    hinged({}, a, {0, 0, 0}, kAxis);
    const taut_joint held = hinged({}, b, {1, 0, 0}, kAxis);
    const taut_axis_def brake = with_friction(1e4);
    ok(taut_joint_set_axis(held, 0, &brake));
    const taut_joint mesh = gear(a, b, {}, -2);
    ok(taut_joint_set_break(mesh, 0, 10));
    for (int i = 0; i < 30; ++i) torque(a, 18), world.step();  // 9 N m on b
    EXPECT_TRUE(taut_joint_is_valid(mesh));
    for (int i = 0; i < 2; ++i) torque(a, 22), world.step();
    EXPECT_FALSE(taut_joint_is_valid(mesh));
}

// Turns are state: what was saved goes on bit by bit, and in another world too.
TEST_P(GearHost, GoOnFromASnapshot) {
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    const taut_joint crank = hinged({}, a, {0, 0, 0}, kAxis);
    hinged({}, b, {1, 0, 0}, kAxis);
    const taut_joint mesh = gear(a, b, {}, -0.7310585);
    const taut_axis_def drive = motor(50, 3);
    ok(taut_joint_set_axis(crank, 0, &drive));
    for (int i = 0; i < 200; ++i) world.step();
    uint64_t size = 0;
    taut_world_save(world.handle, nullptr, 0, &size);
    std::vector<unsigned char> saved(size);
    ok(taut_world_save(world.handle, saved.data(), saved.size(), &size));
    for (int i = 0; i < 100; ++i) world.step();
    uint64_t expected = 0, hash = 0;
    ok(taut_world_get_state_hash(world.handle, &expected));
    ok(taut_world_restore(world.handle, saved.data(), saved.size()));
    for (int i = 0; i < 100; ++i) world.step();
    ok(taut_world_get_state_hash(world.handle, &hash));
    EXPECT_EQ(hash, expected);
    EXPECT_LE(angular_error(mesh), 1e-3);
}

// A shaft that leans in the housing is driven evenly, as by a joint of constant velocity.
TEST_P(GearHost, DriveALeaningShaftEvenly) {
    const Vec lean = unit(Vec(0, std::sin(0.4), std::cos(0.4)));
    const taut_body a = wheel({0, 0, 0}, 0.2), b = wheel({1, 0, 0}, 0.05);
    hinged({}, a, {0, 0, 0}, kAxis);
    taut_gear_joint_def def;
    taut_gear_joint_def_init(&def);
    def.base.body_a = a, def.base.body_b = b;
    guide(world, def, {0, 0, 0}, kAxis, {1, 0, 0}, kAxis);
    def.ratio = 1;
    def.base.solve = GetParam().solve;
    // The shaft is upright in the housing's frame, and held in a hinge that leans.
    taut_pose pose;
    ok(taut_body_get_pose(b, &pose));
    pose.rotation = Quat::turn({1, 0, 0}, -0.4).narrow();
    ok(taut_body_set_pose(b, &pose));
    EXPECT_NEAR(norm(state(b).rotation.rotate(kAxis) - lean), 0, 1e-6);
    hinged({}, b, {1, 0, 0}, lean);
    taut_joint mesh{};
    ok(taut_world_add_gear_joint(world.handle, &def, &mesh));
    ok(taut_body_set_velocity(a, {0, 0, 0}, (5 * kAxis).narrow()));
    ok(taut_body_set_velocity(b, {0, 0, 0}, (5 * lean).narrow()));
    for (int i = 0; i < 120; ++i) {
        world.step();
        ASSERT_NEAR(dot(state(b).spin, lean), turn_of(a), 5e-3) << i;
        ASSERT_NEAR(turn_of(a), 5, 5e-2) << i;
    }
}

// What diverges is frozen; the other gear goes on, and they mesh again once it is let go.
TEST_P(GearHost, OutliveAQuarantine) {
    const taut_body a = wheel({0, 0, 0}, 1e-6, 1e-6), b = wheel({1, 0, 0}, 0.05);
    hinged({}, b, {1, 0, 0}, kAxis);
    const taut_joint mesh = gear(a, b, {}, -2);
    world.step();
    ok(taut_body_apply_force(a, {0, 0, 0}, {0, 1e22f, 1e22f}));
    for (int i = 0; i < 5; ++i) world.step();
    ASSERT_TRUE(finite(a));
    ASSERT_TRUE(finite(b));
    EXPECT_TRUE(std::isfinite(angular_error(mesh)));
    ok(taut_body_release(a));
    EXPECT_LE(angular_error(mesh), 1e-6);
}

}  // namespace
