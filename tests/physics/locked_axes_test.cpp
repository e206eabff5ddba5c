// Locked axes of bodies: what is free moves as analysis says, what is locked keeps its bits, in all solvers.
#include <cstring>

#include "physics/attachment_lab.h"
#include "physics/cable_lab.h"
#include "physics/joint_lab.h"

namespace {

using namespace lab;

struct Run {
    int hz;
    taut_solver solver;
};

void PrintTo(const Run& r, std::ostream* out) { *out << r.hz << "_hz_solver_" << r.solver; }

std::function<void(taut_world_def&)> stepped(const Run& r, const Vec& gravity = {0, -kG, 0}) {
    return [r, gravity](taut_world_def& def) {
        def.time_step = 1.0f / static_cast<float>(r.hz);
        def.solver = r.solver;
        def.sleeping = 0;
        def.gravity = gravity.narrow();
    };
}

taut_body lock(taut_body body, uint32_t axes) {
    ok(taut_body_set_locked_axes(body, axes));
    return body;
}

taut_pose pose_of(taut_body body) {
    taut_pose pose{};
    ok(taut_body_get_pose(body, &pose));
    return pose;
}

Vec local(taut_body body, const Vec& point) {
    const BodyState s = state(body);
    return s.rotation.rotate_back(point - s.position);
}

// Poses whose locked coordinates are to keep their bits.
class Watch {
public:
    void add(taut_body body, uint32_t axes) { held_.push_back({lock(body, axes), axes, pose_of(body)}); }
    void look() const {
        for (const Held& held : held_) {
            const taut_pose now = pose_of(held.body);
            const BodyState s = state(held.body);
            ASSERT_TRUE(finite(held.body));
            const double before[] = {held.pose.position.x, held.pose.position.y, held.pose.position.z};
            const double after[] = {now.position.x, now.position.y, now.position.z};
            const double v[] = {s.velocity.x, s.velocity.y, s.velocity.z}, w[] = {s.spin.x, s.spin.y, s.spin.z};
            for (uint32_t i = 0; i < 3; ++i) {
                if ((held.axes & TAUT_LOCK_X << i) != 0) {
                    ASSERT_EQ(after[i], before[i]) << "axis " << i;
                    ASSERT_EQ(v[i], 0) << "axis " << i;
                }
                if ((held.axes & TAUT_LOCK_ANGULAR_X << i) != 0) {
                    ASSERT_EQ(w[i], 0) << "axis " << i;
                }
            }
            if ((held.axes & TAUT_LOCK_ROTATION) == TAUT_LOCK_ROTATION) {
                ASSERT_EQ(std::memcmp(&now.rotation, &held.pose.rotation, sizeof now.rotation), 0);
            }
        }
    }

private:
    struct Held {
        taut_body body;
        uint32_t axes;
        taut_pose pose;
    };
    std::vector<Held> held_;
};

class LockedAxes : public testing::TestWithParam<Run> {};
class LockedBesideSofts : public LockedAxes {};

// w = T t / I_yy of the inertia as it lies in the world, whatever of the body's own axes lies there.
TEST_P(LockedAxes, TorqueAboutOneAxisMeetsTheMomentAboutIt) {
    World world(stepped(GetParam(), {0, 0, 0}));
    const Quat turned = Quat::turn({1, 0.4, -0.7}, 1.1);
    const taut_body body = world.add({.rotation = turned, .mass = 3, .inertia = {0.5, 2, 4}});
    lock(body, TAUT_LOCK_ANGULAR_X | TAUT_LOCK_ANGULAR_Z);
    const Vec axis = Quat(pose_of(body).rotation).rotate_back({0, 1, 0});
    const double moment = 0.5 * axis.x * axis.x + 2 * axis.y * axis.y + 4 * axis.z * axis.z, torque = 6;
    const int frames = GetParam().hz;
    for (int i = 0; i < frames; ++i) {
        ok(taut_body_apply_force(body, {0, 0, 0}, {5, static_cast<float>(torque), -9}));
        ok(taut_world_step(world.handle));
    }
    const BodyState s = state(body);
    const double time = frames * static_cast<double>(world.def.time_step);
    EXPECT_NEAR(s.spin.y, torque * time / moment, 2e-6 * torque / moment);
    EXPECT_EQ(s.spin.x, 0);
    EXPECT_EQ(s.spin.z, 0);
    ok(taut_body_set_velocity(body, {0, 0, 0}, {0, 0, 0}));
    ok(taut_body_apply_impulse(body, {0, 0, 0}, {-3, 1, 2}));
    EXPECT_NEAR(state(body).spin.y, 1 / moment, 1e-6);
}

// Spin about two axes p of the world, free of torque: P I w is kept, and with it w . I w; against a solution in small
// steps of the same law, by the classical rule of Runge and Kutta.
TEST_P(LockedAxes, SpinAboutTwoAxesKeepsItsMomentumAndEnergy) {
    World world(stepped(GetParam(), {0, 0, 0}));
    const double i1 = 1, i2 = 2, i3 = 3;
    const taut_body body =
        world.add({.rotation = Quat::turn({1, 1, 0}, 0.6), .spin = {0, 1.5, 2}, .mass = 1, .inertia = {i1, i2, i3}});
    lock(body, TAUT_LOCK_ANGULAR_X);
    struct Block {  // of P I P
        double yy, zz, yz;
    };
    const auto block_of = [&](const Quat& q) {
        const Vec y = q.rotate_back({0, 1, 0}), z = q.rotate_back({0, 0, 1});
        const auto product = [&](const Vec& a, const Vec& b) {
            return i1 * a.x * b.x + i2 * a.y * b.y + i3 * a.z * b.z;
        };
        return Block{product(y, y), product(z, z), product(y, z)};
    };
    const auto spin_of = [&](const Quat& q, double ly, double lz) {
        const Block b = block_of(q);
        const double det = b.yy * b.zz - b.yz * b.yz;
        return Vec(0, (b.zz * ly - b.yz * lz) / det, (b.yy * lz - b.yz * ly) / det);
    };
    const auto momentum = [&] {
        const BodyState s = state(body);
        const Block b = block_of(s.rotation);
        return Vec(dot(s.spin, {0, b.yy * s.spin.y + b.yz * s.spin.z, b.yz * s.spin.y + b.zz * s.spin.z}),
                   b.yy * s.spin.y + b.yz * s.spin.z, b.yz * s.spin.y + b.zz * s.spin.z);
    };
    const Vec before = momentum();
    Quat q = pose_of(body).rotation;
    constexpr int kFine = 20000;
    for (int i = 0; i < kFine; ++i) {
        const double h = 1.0 / kFine;
        const auto turned = [&](const Vec& w, double time) {
            return norm(w) > 0 ? Quat::turn(w, norm(w) * time) * q : q;
        };
        const Vec w1 = spin_of(q, before.y, before.z), w2 = spin_of(turned(w1, h / 2), before.y, before.z);
        q = turned(w2, h);
    }
    for (int i = 0; i < GetParam().hz; ++i) ok(taut_world_step(world.handle));
    const Vec after = momentum();
    const double substep = world.substep();
    EXPECT_NEAR(after.x, before.x, 4e-3 * before.x);
    EXPECT_NEAR(norm(after - before), 0, 4e-3 * norm(before));
    const BodyState s = state(body);
    const Vec wanted = spin_of(q, before.y, before.z);
    EXPECT_LT(norm(s.spin - wanted), 30 * substep * substep * norm(wanted) + 1e-5) << s.spin.y << " " << wanted.y;
    EXPECT_EQ(s.spin.x, 0);
}

// A pendulum that a ball joint and locks hold in a plane swings as one that a hinge does: T = 4 K(sin(a/2)) sqrt(I / (m
// g l)).
TEST_P(LockedAxes, PlanePendulumHasThePeriodOfAnalysis) {
    World world(stepped(GetParam()));
    const double angle = 1.2, length = 1;
    const Vec at(length * std::sin(angle), -length * std::cos(angle), 0);
    const taut_body bob =
        world.add({.position = at, .rotation = Quat::turn({0, 0, 1}, angle), .mass = 2, .inertia = {0.3, 5, 0.2}});
    lock(bob, TAUT_LOCK_TO_PLANE_XY);
    world.ball({}, {0, 0, 0}, bob, {0, length, 0});
    Crossings crossings;
    const auto h = static_cast<double>(world.def.time_step);
    for (int i = 0; i < 8 * GetParam().hz; ++i) {
        ok(taut_world_step(world.handle));
        crossings.sample(i * h, position(bob).x);
    }
    const double moment = 0.2 + 2 * length * length;
    const double period = 4 * elliptic_k(std::sin(angle / 2)) * std::sqrt(moment / (2 * kG * length));
    EXPECT_EQ(position(bob).z, 0);
    const bool energy_form = GetParam().solver == TAUT_SOLVER_CONJUGATE_GRADIENTS;
    EXPECT_NEAR(crossings.period(), period, (energy_form ? 0.05 : 0.02) * period);
}

// On an incline of 30 degrees that drops along x, with z free and x locked, a box stays; with y locked too. With x and
// y free it slides at g (sin a - mu cos a), whatever is locked beside.
TEST_P(LockedAxes, BoxOnAnIncline) {
    World world(stepped(GetParam()));
    const double slope = kPi / 6, mu = 0.2;
    const Vec normal(std::sin(slope), std::cos(slope), 0), down(std::cos(slope), -std::sin(slope), 0);
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.plane(normal), .friction = mu});
    const auto box = [&](double z) {
        return world.add({.shape = world.box({0.5, 0.25, 0.5}),
                          .position = 0.25 * normal + Vec(0, 0, z),
                          .rotation = Quat::turn({0, 0, 1}, -slope),
                          .friction = mu,
                          .group = -1});
    };
    Watch watch;
    const taut_body slides = box(0), stays = box(3), falls = box(6);
    watch.add(slides, TAUT_LOCK_Z | TAUT_LOCK_ROTATION);
    watch.add(stays, TAUT_LOCK_X | TAUT_LOCK_ROTATION);
    watch.add(falls, TAUT_LOCK_Y | TAUT_LOCK_ROTATION);
    for (int i = 0; i < GetParam().hz; ++i) {
        ok(taut_world_step(world.handle));
        watch.look();
    }
    const double acceleration = kG * (std::sin(slope) - mu * std::cos(slope));
    EXPECT_NEAR(dot(velocity(slides), down), acceleration, 0.03 * acceleration);
    EXPECT_NEAR(norm(velocity(stays)), 0, 0.02);
    EXPECT_NEAR(position(stays).y, 0.25 * normal.y, 0.02);
    EXPECT_NEAR(norm(velocity(falls)), 0, 0.02);
}

// A ball that meets another which locks hold along the normal bounces as off one that is static.
TEST_P(LockedAxes, ImpactOnALockedBodyIsAsOnAStaticOne) {
    for (const double restitution : {0.0, 0.8}) {
        World world(stepped(GetParam(), {0, 0, 0}));
        const taut_shape ball = world.sphere(0.5);
        const auto shot_at = [&](taut_body_kind kind, double z) {
            const taut_body target = world.add({.kind = kind,
                                                .shape = ball,
                                                .position = {0, 0, z},
                                                .mass = kind == TAUT_BODY_DYNAMIC ? 1.0 : 0.0,
                                                .friction = 0,
                                                .restitution = restitution});
            if (kind == TAUT_BODY_DYNAMIC) lock(target, TAUT_LOCK_X);
            return world.add({.shape = ball,
                              .position = {-1.6, 0, z},
                              .velocity = {4, 0, 0},
                              .mass = 2,
                              .friction = 0,
                              .restitution = restitution});
        };
        const taut_body on_locked = shot_at(TAUT_BODY_DYNAMIC, 0), on_static = shot_at(TAUT_BODY_STATIC, 9);
        for (int i = 0; i < GetParam().hz; ++i) ok(taut_world_step(world.handle));
        const double after = velocity(on_static).x;
        EXPECT_LT(after, 0.01);
        EXPECT_NEAR(velocity(on_locked).x, after, 1e-3 * 4) << restitution;
    }
}

// What is fast stops at a thin wall that lies askew, and a kinematic body that drives against a lock goes through what
// holds: bits stay, nothing flies off.
TEST_P(LockedAxes, FastOnesStopAndDrivenOnesStay) {
    World world(stepped(GetParam()));
    const taut_shape thin = world.box({0.02, 3, 3}), ball = world.sphere(0.1), box = world.box({0.3, 0.3, 0.3});
    world.add(
        {.kind = TAUT_BODY_STATIC, .shape = thin, .position = {5, 0, 0}, .rotation = Quat::turn({0, 0, 1}, 0.35)});
    const taut_body shot = world.add({.shape = ball, .velocity = {200, 0, 0}, .mass = 1});
    const taut_body pressed = world.add({.shape = box, .position = {0, 20, 0}, .mass = 1});
    world.add({.kind = TAUT_BODY_KINEMATIC, .shape = box, .position = {0.01, 19, 0.02}, .velocity = {0, 1, 0}});
    Watch watch;
    watch.add(shot, TAUT_LOCK_Y | TAUT_LOCK_Z | TAUT_LOCK_ROTATION);
    watch.add(pressed, TAUT_LOCK_Y | TAUT_LOCK_ROTATION);
    for (int i = 0; i < GetParam().hz; ++i) {
        ok(taut_world_step(world.handle));
        watch.look();
        if (HasFatalFailure()) return;
        EXPECT_LT(position(shot).x, 5.1);
        EXPECT_LT(norm(velocity(pressed)), 20);
    }
}

// Piles, joints, cables and cloth push and pull what is locked in all ways.
TEST_P(LockedAxes, KeepTheirBitsInAPile) {
    World world(stepped(GetParam()));
    world.add_ground(0.5);
    const taut_shape box = world.box({0.5, 0.3, 0.4}), ball = world.sphere(0.4), capsule = world.capsule(0.3, 0.5);
    Watch watch;
    const uint32_t locks[] = {TAUT_LOCK_Z,
                              TAUT_LOCK_TO_PLANE_XY,
                              TAUT_LOCK_ROTATION,
                              TAUT_LOCK_ANGULAR_Y,
                              TAUT_LOCK_ALL,
                              TAUT_LOCK_X | TAUT_LOCK_ANGULAR_Z,
                              TAUT_LOCK_Y,
                              0u,
                              TAUT_LOCK_X | TAUT_LOCK_Y | TAUT_LOCK_Z,
                              TAUT_LOCK_ANGULAR_X | TAUT_LOCK_ANGULAR_Z};
    taut_body last{};
    int k = 0;
    for (int level = 0; level < 4; ++level)
        for (int column = 0; column < 5; ++column, ++k) {
            const Vec at(0.9 * column - 2 + 0.13 * level, 0.5 + 0.75 * level, 0.07 * ((3 * k) % 5));
            const taut_body body = world.add({.shape = k % 3 == 0   ? box
                                                       : k % 3 == 1 ? ball
                                                                    : capsule,
                                              .position = at,
                                              .rotation = Quat::turn({1, 2, 3}, 0.4 * k),
                                              .spin = {0.5, 1, -2},
                                              .rolling = 0.01,
                                              .spinning = 0.01});
            watch.add(body, locks[k % 10]);
            if (k % 4 == 3)
                world.ball(last, local(last, 0.5 * (at + position(last))), body,
                           local(body, 0.5 * (at + position(last))));
            last = body;
        }
    const int frames = GetParam().solver == TAUT_SOLVER_BLOCK_LDLT ? 1000 : 200;
    for (int i = 0; i < frames; ++i) {
        ok(taut_world_step(world.handle));
        watch.look();
        if (HasFatalFailure()) return;
    }
}

// A cable's load that may only rise and fall hangs below its end, and a cloth and a solid that lie on locked bodies or
// hang from them move none of what is locked.
TEST_P(LockedBesideSofts, KeepTheirBits) {
    CableLab world(stepped(GetParam()));
    Watch watch;
    const taut_shape box = world.box({0.2, 0.2, 0.2}), ball = world.sphere(0.3);
    const taut_body load = world.add({.shape = box, .position = {0, -2, 9}, .mass = 2});
    watch.add(load, TAUT_LOCK_X | TAUT_LOCK_Z | TAUT_LOCK_ROTATION);
    taut_cable_def cable = CableLab::plan(TAUT_CABLE_LINKS);
    cable.end[0] = to_world({0.4, 0, 9});
    cable.end[1] = to_body(load, {0, 0.2, 0});
    cable.segment_count = 8;
    world.cable(cable);
    const taut_body under = world.add({.shape = ball, .position = {1, -0.4, 1}, .mass = 5, .gravity_scale = 0});
    const taut_body beside = world.add({.shape = box, .position = {0.3, -0.3, 1.6}, .mass = 5, .gravity_scale = 0});
    const taut_body held = world.add({.shape = box, .position = {0, 0, 0}, .mass = 1, .gravity_scale = 0});
    watch.add(under, TAUT_LOCK_Y | TAUT_LOCK_ROTATION);
    watch.add(beside, TAUT_LOCK_X | TAUT_LOCK_Y | TAUT_LOCK_ANGULAR_Z);
    watch.add(held, TAUT_LOCK_TO_PLANE_XY | TAUT_LOCK_Y);
    const Sheet sheet(9, 9, 2, 2, 0);
    const taut_cloth cloth = add(world, sheet.def(TAUT_CLOTH_TRIANGLES));
    attach(world, anchor_on(world, held, {0, 0, 0}), anchor_on(cloth, {0, 0, 0}));
    const Beam beam({1, 0.4, 0.4}, 4, 3, 3, false);
    const taut_solid solid = add(world, beam.def(TAUT_SOLID_ST_VENANT_KIRCHHOFF, 1e5, 0.3));
    for (const taut_body vertex : bodies_of(solid)) {
        const Vec at = position(vertex) + Vec(5, 0.5, 0);
        const taut_pose pose{at.pos(), {0, 0, 0, 1}, {0, 0}};
        ok(taut_body_set_pose(vertex, &pose));
    }
    const taut_body seat = world.add({.shape = ball, .position = {5.5, 0.1, 0.2}, .mass = 3, .gravity_scale = 0});
    watch.add(seat, TAUT_LOCK_Y | TAUT_LOCK_X);
    for (int i = 0; i < 2 * GetParam().hz; ++i) {
        ok(taut_world_step(world.handle));
        watch.look();
        if (HasFatalFailure()) return;
    }
    EXPECT_NEAR(position(load).y, -2.2, 0.25);
}

// Hinges of bodies in a plane, of whose five rows locks leave two: a chain that hangs at rest bears its weight, below
// its anchor and beside it, where the joint stays open.
TEST_P(LockedAxes, HingesInAPlaneBearTheWeight) {
    const bool energy_form = GetParam().solver == TAUT_SOLVER_CONJUGATE_GRADIENTS;
    for (const double beside : {0.0, 0.05}) {
        World world(stepped(GetParam()));
        constexpr int kLinks = 4;
        Watch watch;
        taut_body last{};
        std::vector<taut_body> links;
        std::vector<taut_joint> joints;
        for (int i = 0; i < kLinks; ++i) {
            const Vec at(0, -0.5 - i, 0);
            links.push_back(world.add({.shape = world.box({0.1, 0.5, 0.1}), .position = at, .mass = 2, .group = -1}));
            joints.push_back(hinge(world, last, links.back(), {0, -1.0 * i, 0}, {0, 0, 1}));
            last = links.back();
        }
        for (const taut_body link : links) {
            taut_pose pose = pose_of(link);
            pose.position.z = beside;
            ok(taut_body_set_pose(link, &pose));
            watch.add(link, TAUT_LOCK_TO_PLANE_XY);
        }
        for (int i = 0; i < GetParam().hz; ++i) {
            ok(taut_world_step(world.handle));
            watch.look();
            if (HasFatalFailure()) return;
        }
        for (int i = 0; i < kLinks; ++i) {
            taut_vec3 force{};
            ok(taut_joint_get_force(joints[static_cast<size_t>(i)], &force));
            const double weight = 2 * kG * (kLinks - i);
            EXPECT_NEAR(static_cast<double>(force.y), weight, (energy_form ? 0.1 : 0.02) * weight)
                << i << " " << beside;
            EXPECT_NEAR(static_cast<double>(force.x), 0, 0.01 * weight) << i << " " << beside;
        }
        EXPECT_LT(norm(velocity(last)), energy_form ? 0.1 : 1e-2) << beside;
    }
}

// A tower of boxes in a plane settles as one without locks, and stands.
TEST_P(LockedAxes, TowerStandsAsWithoutLocks) {
    if (GetParam().solver == TAUT_SOLVER_CONJUGATE_GRADIENTS) GTEST_SKIP() << "its towers creep without locks too";
    World world(stepped(GetParam()));
    world.add_ground();
    const taut_shape box = world.box({0.5, 0.25, 0.5});
    std::vector<taut_body> towers[2];
    for (int level = 0; level < 5; ++level)
        for (int locked = 0; locked < 2; ++locked) {
            const Vec at(0.02 * (level % 2), 0.25 + 0.5 * level, 5.0 * locked);
            towers[locked].push_back(world.add({.shape = box, .position = at}));
            if (locked == 1) lock(towers[1].back(), TAUT_LOCK_TO_PLANE_XY);
        }
    for (int i = 0; i < 2 * GetParam().hz; ++i) ok(taut_world_step(world.handle));
    for (size_t level = 0; level < 5; ++level) {
        const Vec apart = position(towers[1][level]) - position(towers[0][level]) - Vec(0, 0, 5);
        EXPECT_LT(norm(apart), 0.01) << level;
        EXPECT_LT(norm(velocity(towers[1][level])), 0.02) << level;
    }
}

INSTANTIATE_TEST_SUITE_P(Rates, LockedAxes,
                         testing::Values(Run{30, TAUT_SOLVER_BLOCK_LDLT}, Run{60, TAUT_SOLVER_BLOCK_LDLT},
                                         Run{120, TAUT_SOLVER_BLOCK_LDLT}, Run{240, TAUT_SOLVER_BLOCK_LDLT}),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(
    Solvers, LockedAxes,
    testing::Values(Run{60, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL}, Run{240, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL},
                    Run{60, TAUT_SOLVER_ACCELERATED_JACOBI}, Run{120, TAUT_SOLVER_JACOBI},
                    Run{60, TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL}, Run{120, TAUT_SOLVER_MINIMUM_RESIDUAL},
                    Run{60, TAUT_SOLVER_CONJUGATE_RESIDUALS}, Run{120, TAUT_SOLVER_CONJUGATE_GRADIENTS}),
    testing::PrintToStringParamName());

INSTANTIATE_TEST_SUITE_P(Some, LockedBesideSofts,
                         testing::Values(Run{30, TAUT_SOLVER_BLOCK_LDLT}, Run{60, TAUT_SOLVER_BLOCK_LDLT},
                                         Run{60, TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL}),
                         testing::PrintToStringParamName());

}  // namespace
