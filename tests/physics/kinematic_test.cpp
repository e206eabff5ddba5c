// Kinematic bodies carry and push, and are not pushed.
#include <random>

#include "physics/tunnel_lab.h"

namespace {

using namespace lab;

class Platform : public testing::Test {
protected:
    Platform() {
        platform = world.add({.kind = TAUT_BODY_KINEMATIC,
                              .shape = world.box({3, 0.25, 3}),
                              .position = {0, -0.25, 0},
                              .friction = 0.5});
        box =
            world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {0, 0.25, 0}, .mass = 20, .friction = 0.5});
        world.step(30);
    }
    void drive(const Vec& velocity, const Vec& spin = {}) const {
        ok(taut_body_set_velocity(platform, velocity.narrow(), spin.narrow()));
        world.step();
    }
    Vec relative() const { return position(box) - position(platform); }

    World world;
    taut_body platform{}, box{};
};

// Below mu g = 4.9 m/s^2 the box keeps its place, both when the platform starts and when it stops.
TEST_F(Platform, CarriesABoxByFriction) {
    const Vec start = relative();
    double slip = 0;
    const auto frame = static_cast<double>(world.def.time_step);
    for (int i = 1; i <= std::lround(3 / frame); ++i) {
        const double t = i * frame, speed = t < 1 ? 3 * t : t < 2 ? 3 : 3 * (3 - t);
        ok(taut_body_set_velocity(platform, Vec(speed, 0, 0.5 * speed).narrow(), {0, 0, 0}));
        ok(taut_world_step(world.handle));
        slip = std::max(slip, norm(relative() - start));
    }
    EXPECT_GT(position(platform).x, 5) << "the platform went nowhere";
    EXPECT_LT(slip, 0.01);
}

// Beyond mu g the box slides: it gains mu g and no more.
TEST_F(Platform, CannotDragABoxFasterThanFrictionAllows) {
    for (int i = 1; i <= 18; ++i) drive({10 * i * world.frame(), 0, 0});
    const double time = 18 * world.frame();
    EXPECT_NEAR(velocity(box).x / (0.5 * kG * time), 1, 0.05);
}

TEST_F(Platform, LiftsABox) {
    for (int i = 0; i < 120; ++i) drive({0, 1.5, 0});
    EXPECT_NEAR(relative().y, 0.5, 0.005);
    EXPECT_NEAR(velocity(box).y, 1.5, 0.01);
    EXPECT_NEAR(position(platform).y, -0.25 + 3, 1e-5);
}

// On a turntable friction supplies the centripetal force while w^2 r < mu g.
TEST_F(Platform, TurnsABoxRound) {
    taut_pose pose{};
    ok(taut_body_get_pose(box, &pose));
    pose.position.x = 1;
    ok(taut_body_set_pose(box, &pose));
    world.step(30);
    for (int i = 0; i < 240; ++i) drive({}, {0, std::min(1.0, i / 60.0), 0});
    // Contacts are found once a frame F, and until the next one the box goes straight on: it may drift outwards by
    // up to (w r F)^2 / 2 r a frame.
    const Vec at = relative();
    const double drift = 240 * world.frame() * world.frame() / 2;
    EXPECT_NEAR(std::hypot(at.x, at.z), 1, drift);
    EXPECT_NEAR(norm(velocity(box)), 1, drift);
    const BodyState s = state(box), p = state(platform);
    EXPECT_GT(dot(s.rotation.rotate({1, 0, 0}), p.rotation.rotate({1, 0, 0})), 0.999) << "turned against the table";
}

TEST(KinematicPusher, PushesAHeavyBoxAndKeepsItsSpeed) {
    World world;
    world.add_ground(0.5);
    const taut_body pusher = world.add({.kind = TAUT_BODY_KINEMATIC,
                                        .shape = world.box({0.25, 0.5, 1}),
                                        .position = {-1, 0.6, 0},
                                        .velocity = {1, 0, 0}});
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .mass = 5000});
    world.step(240);
    const double time = 240 * world.frame();
    EXPECT_NEAR(position(pusher).x, -1 + time, 1e-5);
    EXPECT_NEAR(position(box).x - position(pusher).x, 0.75, 0.01);
    EXPECT_NEAR(velocity(box).x, 1, 0.02);
    EXPECT_NEAR(velocity(pusher).x, 1, 1e-7);
}

TEST(KinematicPusher, ReachesTheTargetOfMoveKinematic) {
    World world;
    const taut_body mover =
        world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.box({0.5, 0.5, 0.5}), .position = {4, 2, 1}});
    const Quat turn = Quat::turn({1, 1, 0}, 0.3);
    taut_pose target{};
    target.position = {4.1, 2.05, 0.9};
    target.rotation = turn.narrow();
    ok(taut_body_move_kinematic(mover, &target));
    world.step();
    EXPECT_LT(norm(position(mover) - Vec(target.position)), 1e-6);
    const Quat q = state(mover).rotation;
    EXPECT_NEAR(std::abs(q.x * turn.x + q.y * turn.y + q.z * turn.z + q.w * turn.w), 1, 1e-6);
}

// A plate of 10 cm is put 7 to 20 cm higher in each of 20 frames, through a chain of limbs that lies on it: above and
// below it, they are pushed apart. They may hang on it, but not be flung away.
TEST(TeleportedPlate, DoesNotFlingLimbs) {
    constexpr double kStep[] = {0.07, 0.1, 0.15, 0.2};  // [m]
    int flung = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
        std::mt19937 random(seed);
        const World world;
        const taut_body plate =
            world.add({.kind = TAUT_BODY_KINEMATIC, .shape = world.box({2, 0.05, 2}), .position = {0, -0.05, 0}});
        std::vector<taut_body> limbs;
        for (int i = 0; i < 6; ++i) {
            limbs.push_back(world.add({.shape = i == 0 ? world.sphere(0.15) : world.capsule(0.06, 0.14),
                                       .position = {0, 0.4 + 0.4 * i, 0},
                                       .mass = i == 0 ? 5.0 : 1.0}));
            if (i > 0) world.ball(limbs[static_cast<size_t>(i) - 1], {0, 0.2, 0}, limbs.back(), {0, -0.2, 0});
        }
        const Vec push(between(random, -2, 2), 0, between(random, -2, 2));
        ok(taut_body_set_velocity(limbs.back(), push.narrow(), {0, 0, 0}));
        world.step(120);
        double fastest = 0;
        for (int frame = 0; frame < 60; ++frame) {
            taut_pose pose{};
            pose.position = {0, -0.05 + kStep[seed % 4] * std::min(frame, 20), 0};
            pose.rotation = {0, 0, 0, 1};
            ok(taut_body_set_pose(plate, &pose));
            world.step();
            for (const taut_body limb : limbs) fastest = std::max(fastest, norm(velocity(limb)));
        }
        flung += fastest > 16;
    }
    EXPECT_LE(flung, 1);
}

}  // namespace
