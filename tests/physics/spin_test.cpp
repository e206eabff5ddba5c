// What spins keeps what it spins with: free bodies momentum and energy, gyroscopes their height, wheels their axle.
#include "physics/lab.h"

namespace {

using namespace lab;

struct Rate {
    double hertz;
    uint32_t substeps;
};

struct Spinning {
    Vec inertia, axis;  // principal [kg m^2]; of the spin, in the body's axes
    double hertz;
    uint32_t substeps;
};

void PrintTo(const Spinning& s, std::ostream* out) {
    *out << s.inertia.x << " " << s.inertia.y << " " << s.inertia.z << " kg m^2 about " << s.axis.x << " " << s.axis.y
         << " " << s.axis.z << ", " << s.hertz << " Hz, " << s.substeps << " substeps";
}

class FreeSpins : public testing::TestWithParam<Spinning> {};

TEST_P(FreeSpins, KeepsMomentumAndEnergyForTenSeconds) {
    const Spinning& plan = GetParam();
    World world([&](taut_world_def& def) {
        def.time_step = static_cast<float>(1 / plan.hertz);
        def.substeps = plan.substeps;
        def.gravity = {0, 0, 0};
    });
    const Quat start = Quat::turn({1, 2, -1}, 0.8);
    const taut_body body = world.add(
        {.rotation = start, .spin = 47 * start.rotate(unit(plan.axis)), .mass = 1.5, .inertia = plan.inertia});
    const Totals before = totals({body});
    const double turn = norm(state(body).spin) / (plan.hertz * plan.substeps);
    for (int second = 0; second < 10; ++second) {
        world.step(static_cast<int>(plan.hertz));
        const Totals now = totals({body});
        EXPECT_LT(norm(now.spin - before.spin) / norm(before.spin), 0.005) << "of " << turn << " rad a substep";
        EXPECT_NEAR(now.kinetic / before.kinetic, 1, 1e-4);
    }
}

std::vector<Spinning> all_spinning() {
    std::vector<Spinning> out;
    for (const Vec& inertia : {Vec(0.8, 0.8, 1.6), Vec(0.05, 0.7, 0.7), Vec(0.2, 0.7, 0.85), Vec(1, 1.3, 1.5)})
        for (const Vec& axis : {Vec(0.03, 0.02, 1), Vec(0.02, 1, 0.03), Vec(1, 0.03, 0.02), Vec(0.6, 1, 0.8)})
            for (const Rate& rate : {Rate{60, 4}, Rate{60, 16}, Rate{120, 4}, Rate{240, 1}, Rate{240, 4}})
                out.push_back({inertia, axis, rate.hertz, rate.substeps});
    return out;
}
INSTANTIATE_TEST_SUITE_P(Of, FreeSpins, testing::ValuesIn(all_spinning()));

struct Held {
    taut_joint_solve how;
    double hertz;
    uint32_t substeps;
};

void PrintTo(const Held& held, std::ostream* out) {
    *out << "joint " << held.how << ", " << held.hertz << " Hz, " << held.substeps << " substeps";
}

class SpinsOnAJoint : public testing::TestWithParam<Held> {
protected:
    static constexpr double kRadius = 0.25, kMass = 3, kLever = 0.3;                            // [m], [kg], [m]
    static constexpr double kAxial = 0.5 * kMass * kRadius * kRadius, kAcross = 0.52 * kAxial;  // [kg m^2]

    World world{[](taut_world_def& def) {
        def.time_step = static_cast<float>(1 / GetParam().hertz);
        def.substeps = GetParam().substeps;
        def.sleeping = 0;
    }};

    taut_body add_disc(const Vec& at, const Vec& velocity, const Vec& spin) const {
        return world.add(
            {.position = at, .velocity = velocity, .spin = spin, .mass = kMass, .inertia = {kAxial, kAcross, kAcross}});
    }
};

// Steady and level, exactly: I w Omega = m g l.
TEST_P(SpinsOnAJoint, PrecessesLevel) {
    const double substep = 1 / (GetParam().hertz * GetParam().substeps);
    for (const double spin : {60.0, 140.0, 240.0, 400.0}) {
        if (spin * substep > 1) continue;
        const double rate = kMass * kG * kLever / (kAxial * spin);
        const taut_body disc = add_disc({kLever, 0, 0}, {0, 0, -rate * kLever}, {spin, rate, 0});
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_a = disc;
        def.base.frame_a.position = Vec(-kLever, 0, 0).pos();
        def.base.solve = GetParam().how;
        taut_joint joint{};
        ok(taut_world_add_ball_joint(world.handle, &def, &joint));
        double turned = 0, last = 0, tilt = 0;
        const int frames = static_cast<int>(5 * GetParam().hertz);
        for (int frame = 0; frame < frames; ++frame) {
            world.step();
            const Vec axle = state(disc).rotation.rotate({1, 0, 0});
            const double now = std::atan2(-axle.z, axle.x);
            turned += std::remainder(now - last, 2 * kPi);
            last = now;
            tilt = std::max(tilt, std::abs(std::asin(axle.y)));
        }
        const double left = dot(state(disc).spin, state(disc).rotation.rotate({1, 0, 0})) / spin;
        EXPECT_NEAR(turned / (5 * rate), 1, 0.03) << spin << " rad/s";
        EXPECT_LT(tilt, 0.015) << spin << " rad/s";
        EXPECT_NEAR(left, 1, 0.05) << spin << " rad/s";
        ok(taut_body_remove(disc));
    }
}

// Wheels at 400 rad/s on an axle that stands fast, and on both sides of a car's body that floats and is turned about.
TEST_P(SpinsOnAJoint, DoNotWobbleOnHinges) {
    ok(taut_world_set_gravity(world.handle, {0, 0, 0}));
    const Vec at(0, 3, 0), turning(0.1, 0.4, -0.2);
    const taut_body car = world.add({.position = at, .spin = turning, .mass = 30, .inertia = {2, 2.5, 1.1}}),
                    nothing = {};
    std::vector<taut_body> parts = {car};
    const auto add_wheel = [&](const Vec& lever, const Vec& where, const Vec& turns, taut_body on) {
        const taut_body wheel = add_disc(where + lever, cross(turns, lever), turns + Vec(400, 0, 0));
        taut_hinge_joint_def def;
        taut_hinge_joint_def_init(&def);
        def.base.body_a = wheel;
        def.base.body_b = on;
        def.base.frame_b.position = lever.pos();
        def.base.solve = GetParam().how;
        taut_joint joint{};
        ok(taut_world_add_hinge_joint(world.handle, &def, &joint));
        return wheel;
    };
    const taut_body fast = add_wheel({0, 0, 0}, {}, {}, nothing);
    for (const double side : {-0.6, 0.6})
        for (const double end : {-0.8, 0.8}) parts.push_back(add_wheel({side, 0, end}, at, turning, car));
    const Totals before = totals(parts);
    double wobble = 0, least = 1e9, most = 0;
    const auto look_at = [&](taut_body wheel, const Vec& axle, const Vec& turns) {
        const BodyState s = state(wheel);
        wobble = std::max(wobble, norm(s.rotation.rotate({1, 0, 0}) - axle));
        least = std::min(least, dot(s.spin - turns, axle)), most = std::max(most, dot(s.spin - turns, axle));
    };
    for (int frame = 0; frame < 4 * GetParam().hertz; ++frame) {
        world.step();
        look_at(fast, {1, 0, 0}, {});
        const BodyState s = state(car);
        for (const taut_body wheel : parts)
            if (wheel.bits != car.bits) look_at(wheel, s.rotation.rotate({1, 0, 0}), s.spin);
    }
    const Totals after = totals(parts);
    // Swept, where a substep turns a wheel by more than a radian, what spares slow motions spares it no more.
    const bool damps = GetParam().how == TAUT_JOINT_SOLVE_SOFT && 400 > GetParam().hertz * GetParam().substeps;
    EXPECT_LT(wobble, damps ? 0.025 : 0.003);
    EXPECT_GT(least, damps ? 290 : 392);
    EXPECT_LT(most, 400.1);
    EXPECT_LT(norm(after.spin - before.spin) / norm(before.spin), damps ? 0.1 : 0.02);
}

std::vector<Held> all_held() {
    std::vector<Held> out;
    for (const auto how : {TAUT_JOINT_SOLVE_DIRECT, TAUT_JOINT_SOLVE_SOFT})
        for (const Rate& rate : {Rate{60, 4}, Rate{60, 16}, Rate{120, 4}, Rate{240, 1}, Rate{240, 4}})
            out.push_back({how, rate.hertz, rate.substeps});
    return out;
}
INSTANTIATE_TEST_SUITE_P(With, SpinsOnAJoint, testing::ValuesIn(all_held()));

}  // namespace
