// Pulleys against Atwood's machine and pendulums, at every rate and solved in either way.
#include "physics/joint_setting.h"

namespace {

using namespace lab;

class Pulleys : public SettingWorld {
protected:
    Pulleys() : SettingWorld({0, -kG, 0}) {}

    taut_joint hang(taut_body a, taut_body b, double ratio, taut_body housing = {}, const Vec& in_housing = {}) const {
        taut_pulley_joint_def def;
        taut_pulley_joint_def_init(&def);
        def.base.body_a = a, def.base.body_b = b, def.housing = housing;
        const Vec up(0, 2, 0);
        def.housing_frame_a.position = (position(a) + up - in_housing).pos();
        def.housing_frame_b.position = (position(b) + up - in_housing).pos();
        def.ratio = static_cast<float>(ratio);
        def.base.solve = GetParam().solve;
        taut_joint out{};
        ok(taut_world_add_pulley_joint(world.handle, &def, &out));
        return out;
    }
};
INSTANTIATE_TEST_SUITE_P(Rates, Pulleys, testing::ValuesIn(joint_settings()), name_of);

struct Atwood {
    double tension, down_b;  // [N], [m/s^2]
};
// Tension T at a, ratio T at b: a_a = T/m_a - g = -ratio a_b, a_b = ratio T/m_b - g.
Atwood atwood(double a, double b, double ratio) {
    const double tension = kG * (1 + ratio) / (1 / a + ratio * ratio / b);
    return {tension, kG - ratio * tension / b};
}

// Masses of 1 to 1000 both ways; ratio 1 is Atwood's (m_b - m_a) g / (m_a + m_b).
TEST_P(Pulleys, AreAtwoodsMachine) {
    EXPECT_NEAR(atwood(2, 3, 1).down_b, kG / 5, 1e-12);
    for (const double ratio : {1.0, 2.0, 0.5})
        for (const auto& [a, b] : {std::pair{2.0, 3.0}, {3.0, 2.0}, {1.0, 1000.0}, {1000.0, 1.0}}) {
            const bool is_even = std::max(a, b) < 10;
            if (GetParam().solve != TAUT_JOINT_SOLVE_DIRECT && !is_even) continue;
            const taut_body left = world.particle(a, {-1, 0, 0}), right = world.particle(b, {1, 0, 0});
            const taut_joint rope = hang(left, right, ratio);
            constexpr double kTime = 0.4;
            run(kTime);
            const Atwood expected = atwood(a, b, ratio);
            const std::string text = std::to_string(a) + " kg, " + std::to_string(b) + " kg, " + std::to_string(ratio);
            EXPECT_NEAR(-velocity(right).y / kTime, expected.down_b, 0.01 * kG) << text;
            EXPECT_NEAR(velocity(left).y, -ratio * velocity(right).y, 1e-3 * kG) << text;
            EXPECT_LE(error(rope), 1e-3) << text;
            taut_vec3 on_b{};
            ok(taut_joint_get_force(rope, &on_b));
            EXPECT_NEAR(Vec(on_b).y, ratio * expected.tension, 0.01 * ratio * expected.tension) << text;
            EXPECT_NEAR(-static_cast<double>(forces(rope).total), expected.tension, 0.01 * expected.tension) << text;
            ok(taut_body_remove(left));
            ok(taut_body_remove(right));
        }
}

// A rope does not push: a is thrown up, and falls until it is taut again.
TEST_P(Pulleys, GoSlack) {
    const taut_body left = world.particle(2, {-1, 0, 0}, {0, 3, 0}), right = world.particle(2, {1, 0, 0}, {0, 3, 0});
    const taut_joint rope = hang(left, right, 1);
    run(0.3);
    EXPECT_NEAR(velocity(left).y, 3 - 0.3 * kG, 0.02);
    EXPECT_LT(motion(rope).value, -0.8);
    EXPECT_EQ(forces(rope).total, 0);
    EXPECT_EQ(error(rope), 0);
    run(1.2);
    EXPECT_NEAR(motion(rope).value, 0, 2e-2);
    EXPECT_NEAR(velocity(left).y + velocity(right).y, 0, 0.02);
}

// A rod of hydraulics: what goes in on one side comes out on the other.
TEST_P(Pulleys, PushWhereTheyAreRigid) {
    taut_pulley_joint_def def;
    taut_pulley_joint_def_init(&def);
    def.base.body_a = world.add({.position = {-1, 2, 0}, .mass = 2, .inertia = {1, 1, 1}});
    def.base.body_b = world.add({.position = {1, 2, 0}, .mass = 3, .inertia = {1, 1, 1}});
    def.housing_frame_a.position = {-1, 0, 0}, def.housing_frame_b.position = {1, 0, 0};
    def.rigid = 1;
    def.base.solve = GetParam().solve;
    for (const taut_body body : {def.base.body_a, def.base.body_b}) sliding({}, body, {0, 1, 0});
    taut_joint rope{};
    ok(taut_world_add_pulley_joint(world.handle, &def, &rope));
    run(0.4);
    EXPECT_NEAR(-velocity(def.base.body_b).y / 0.4, kG / 5, 0.01 * kG);
}

// A drive along the axis is a winch.
TEST_P(Pulleys, WinchByADrive) {
    const taut_body left = world.particle(2, {-1, 0, 0}), right = world.particle(2, {1, 0, 0});
    const taut_joint rope = hang(left, right, 1);
    const taut_axis_def winch = motor(-0.5, 1e4);
    ok(taut_joint_set_axis(rope, 0, &winch));
    run(1);
    EXPECT_NEAR(velocity(left).y + velocity(right).y, 0.5, 5e-3);
    EXPECT_NEAR(motion(rope).value, -0.5, 1e-2);
    float length = 0;
    ok(taut_joint_get_length(rope, &length));
    EXPECT_EQ(length, 4);
    ok(taut_joint_set_length(rope, 3.5f));
    ok(taut_joint_get_length(rope, &length));
    EXPECT_EQ(length, 3.5f);
}

// A load swings below its sheave as a pendulum of that length, while a far heavier one holds the other end: period by
// K(k), and it loses no more than a rod of the same length does.
TEST_P(Pulleys, SwingAsPendulums) {
    constexpr double kLength = 2, kAmplitude = 0.5;
    const double period = 4 * std::sqrt(kLength / kG) * elliptic_k(std::sin(kAmplitude / 2));
    const taut_body heavy = world.add({.kind = TAUT_BODY_STATIC, .position = {5, 0, 0}});
    const Vec out(kLength * std::sin(kAmplitude), -kLength * std::cos(kAmplitude), 0);
    const taut_body load = world.particle(1, out), rival = world.particle(1, out + Vec(0, 0, 3));
    taut_pulley_joint_def def;
    taut_pulley_joint_def_init(&def);
    def.base.body_a = load, def.base.body_b = heavy;
    def.housing_frame_a.position = {0, 0, 0}, def.housing_frame_b.position = {5, 1, 0};
    def.base.solve = GetParam().solve;
    taut_joint rope{};
    ok(taut_world_add_pulley_joint(world.handle, &def, &rope));
    taut_distance_joint_def rod;
    taut_distance_joint_def_init(&rod);
    rod.base.body_b = rival, rod.base.frame_a.position = {0, 0, 3};
    rod.base.solve = GetParam().solve;
    taut_joint rod_out{};
    ok(taut_world_add_distance_joint(world.handle, &rod, &rod_out));
    Crossings of_load;
    double widest = 0, rivals = 0;
    const int frames = static_cast<int>(std::lround(5 * period * GetParam().hz));
    for (int i = 0; i < frames; ++i) {
        world.step();
        of_load.sample((i + 1) / GetParam().hz, position(load).x);
        if (i < frames * 4 / 5) continue;
        widest = std::max(widest, position(load).x);
        rivals = std::max(rivals, position(rival).x);
    }
    EXPECT_NEAR(of_load.period(), period, 0.02 * period);
    EXPECT_GE(widest, rivals - 0.05 * out.x) << "of " << out.x << ", a rod " << rivals;
    EXPECT_LE(widest, out.x * 1.01);
}

// On a trolley that nothing holds: no momentum comes from within.
TEST_P(Pulleys, BearOnTheirHousing) {
    ok(taut_world_set_gravity(world.handle, {0, 0, 0}));
    const taut_body trolley = world.add({.position = {0, 2, 0}, .mass = 20, .inertia = {5, 5, 5}});
    const taut_body left =
        world.add({.position = {-1, 0, 0}, .velocity = {0.3, -1, 0}, .mass = 2, .inertia = {1, 1, 1}});
    const taut_body right =
        world.add({.position = {1, 0, 0}, .velocity = {0, -1, 0.2}, .mass = 3, .inertia = {1, 1, 1}});
    const Totals before = totals({trolley, left, right});
    const taut_joint rope = hang(left, right, 1.5, trolley, {0, 2, 0});
    run(1);
    const Totals now = totals({trolley, left, right});
    EXPECT_LE(norm(now.momentum - before.momentum), 1e-3);
    EXPECT_LE(norm(now.spin - before.spin), 3e-2);
    EXPECT_LE(now.kinetic, before.kinetic * 1.001);
    EXPECT_LE(error(rope), 2e-3);
}

}  // namespace
