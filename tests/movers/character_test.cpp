// Characters on slopes and stairs, in corners, on what moves, and against what they push, at 30 to 240 Hz.
#include "movers/character_lab.h"

namespace lab {
namespace {

class Character : public testing::TestWithParam<double> {
protected:
    double hz() const { return GetParam(); }
};

std::string rate_name(const testing::TestParamInfo<double>& info) {
    return std::to_string(static_cast<int>(info.param)) + "Hz";
}
INSTANTIATE_TEST_SUITE_P(At, Character, testing::Values(30.0, 60.0, 120.0, 240.0), rate_name);

// count steps of a height and a depth that go up along x from 0, and a landing behind them.
void add_stairs(const World& world, int count, double rise, double depth) {
    for (int i = 0; i < count; ++i) {
        const double height = (i + 1) * rise;
        const double length = i + 1 < count ? depth : 10.0;
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = world.box({length / 2, height / 2, 2}),
                   .position = {i * depth + length / 2, height / 2, 0}});
    }
}

taut_body add_slope(const World& world, double angle) {
    const Quat turn = Quat::turn({0, 0, 1}, angle);
    return world.add({.kind = TAUT_BODY_STATIC,
                      .shape = world.box({20, 0.5, 5}),
                      .position = Vec(0, 0, 0) - turn.rotate({0, 0.5, 0}),
                      .rotation = turn});
}

// ---------------------------------------------------------------- the ground

TEST_P(Character, StandsStill) {
    const World world(at_rate(hz()));
    world.add_ground();
    Walker walker(world, hz(), {0, 0, 0});
    walker.walk({}, 0.2);
    const Vec start = walker.position();
    walker.walk({}, 5);
    EXPECT_TRUE(walker.on_ground());
    EXPECT_LT(norm(walker.position() - start), 1e-6);
    EXPECT_NEAR(walker.feet().y, 0, 1e-4);
    EXPECT_EQ(walker.deepest, 0);
}

TEST_P(Character, WalksAtTheSpeedAskedForOnEverySlope) {
    for (const double degrees : {-40.0, -20.0, 0.0, 20.0, 40.0, 48.0}) {
        SCOPED_TRACE(degrees);
        const World world(at_rate(hz()));
        const double angle = degrees * kPi / 180;
        add_slope(world, angle);
        Walker walker(world, hz(), {0, 0.1, 0});
        walker.walk({}, 1);
        ASSERT_TRUE(walker.on_ground());
        const Vec start = walker.position();
        walker.walk({3, 0, 0}, 2);
        EXPECT_TRUE(walker.on_ground());
        const double ramp = 0.5 * 3 * 3 / 50;  // of its acceleration [m]
        EXPECT_NEAR(walker.position().x - start.x, 6 - ramp, 2e-3);
        EXPECT_NEAR(walker.position().y - start.y, std::tan(angle) * (walker.position().x - start.x), 2e-3);
        EXPECT_EQ(walker.deepest, 0);
        // And stands there.
        walker.walk({}, 0.2);
        const Vec end = walker.position();
        walker.walk({}, 2);
        EXPECT_LT(norm(walker.position() - end), 1e-5);
    }
}

TEST_P(Character, SlidesDownWhatIsTooSteepAndDoesNotClimbIt) {
    const World world(at_rate(hz()));
    const double angle = 60 * kPi / 180;
    add_slope(world, angle);
    Walker walker(world, hz(), {0, 1.0, 0});
    walker.walk({}, 0.7);
    ASSERT_EQ(walker.body.state, TAUT_CHARACTER_SLIDING);
    const double speed = norm(walker.velocity());
    const Vec start = walker.position();
    walker.walk({2, 0, 0}, 0.5);
    EXPECT_EQ(walker.body.state, TAUT_CHARACTER_SLIDING);
    EXPECT_LT(walker.position().y, start.y);
    // g sin a, but what it would walk against does not count.
    EXPECT_NEAR(norm(walker.velocity()) - speed, 0.5 * kG * std::sin(angle), 0.15);
    EXPECT_EQ(walker.deepest, 0);
}

TEST_P(Character, DoesNotWalkUpAWallOrATooSteepRamp) {
    const World world(at_rate(hz()));
    world.add_ground();
    const Quat turn = Quat::turn({0, 0, 1}, 60 * kPi / 180);
    world.add({.kind = TAUT_BODY_STATIC,
               .shape = world.box({5, 0.5, 5}),
               .position = Vec(2, 0, 0) + turn.rotate({5, -0.5, 0}),
               .rotation = turn});
    Walker walker(world, hz(), {0, 0, 0});
    walker.walk({4, 0, 0}, 3);
    EXPECT_LT(walker.feet().y, 0.02);
    EXPECT_TRUE(walker.on_ground());
    EXPECT_EQ(walker.deepest, 0);
}

// ---------------------------------------------------------------- stairs

std::vector<std::pair<double, double>> path_on_stairs(double hz, double rise, double depth, bool down) {
    const World world(at_rate(hz));
    world.add_ground();
    add_stairs(world, 10, rise, depth);
    Walker walker(world, hz, down ? Vec(10 * depth + 1, 10 * rise, 0) : Vec(-1, 0, 0));
    walker.walk({}, 0.2);
    std::vector<std::pair<double, double>> path;
    const double sign = down ? -1 : 1;
    for (int i = 0; i < walker.frames(10 * depth / 2 + 1); ++i) {
        walker.frame({2 * sign, 0, 0});
        EXPECT_TRUE(walker.on_ground()) << "at x " << walker.feet().x << ", frame " << i;
        path.emplace_back(walker.feet().x, walker.feet().y);
    }
    EXPECT_EQ(walker.deepest, 0);
    if (down) std::reverse(path.begin(), path.end());
    return path;
}

double height_at(const std::vector<std::pair<double, double>>& path, double x) {
    for (size_t i = 1; i < path.size(); ++i)
        if (path[i].first >= x) {
            const auto& [x0, y0] = path[i - 1];
            const auto& [x1, y1] = path[i];
            return y0 + (y1 - y0) * (x - x0) / std::max(x1 - x0, 1e-9);
        }
    return path.back().second;
}

class OnStairs : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(Going, OnStairs, testing::Bool(),
                         [](const auto& going) { return std::string(going.param ? "Down" : "Up"); });

TEST_P(OnStairs, ThePathIsTheSameAtEveryRate) {
    for (const auto& [rise, depth] : {std::pair(0.17, 0.29), {0.3, 0.5}, {0.34, 0.8}}) {
        SCOPED_TRACE(rise);
        const auto finest = path_on_stairs(240, rise, depth, GetParam());
        ASSERT_FALSE(HasFailure());
        for (const double hz : {30.0, 60.0, 120.0}) {
            SCOPED_TRACE(hz);
            const auto path = path_on_stairs(hz, rise, depth, GetParam());
            EXPECT_NEAR(path.front().first, finest.front().first, 0.15);  // a frame more or less of two metres a second
            EXPECT_NEAR(path.back().first, finest.back().first, 0.15);
            double furthest = 0;
            for (const auto& [x, y] : path)
                if (x > finest.front().first && x < finest.back().first)
                    furthest = std::max(furthest, std::abs(y - height_at(finest, x)));
            EXPECT_LT(furthest, 0.02);
        }
    }
}

TEST_P(Character, StepsUpToItsStepHeightAndNoHigher) {
    for (const double height : {0.05, 0.2, 0.33, 0.4, 1.0}) {
        SCOPED_TRACE(height);
        const World world(at_rate(hz()));
        world.add_ground();
        add_stairs(world, 1, height, 1);
        Walker walker(world, hz(), {-1, 0, 0});
        walker.walk({2, 0, 0}, 2);
        EXPECT_TRUE(walker.on_ground());
        EXPECT_NEAR(walker.feet().y, height < 0.35 ? height : 0, 1e-3);
        EXPECT_EQ(walker.deepest, 0);
    }
}

TEST_P(Character, FallsOffACliff) {
    const World world(at_rate(hz()));
    world.add_ground();
    add_stairs(world, 1, 3, 1);
    Walker walker(world, hz(), {0.6, 3, 0});
    walker.walk({}, 0.2);
    int frames = 0;
    while (walker.on_ground() && ++frames < 1000) walker.frame({-1, 0, 0});
    EXPECT_NEAR(walker.feet().x, 0, kRadius + 0.05);  // about when its middle is beyond the edge
    walker.walk({-1, 0, 0}, 1.5);
    EXPECT_TRUE(walker.on_ground());
    EXPECT_NEAR(walker.feet().y, 0, 1e-3);
    EXPECT_EQ(walker.deepest, 0);
}

// ---------------------------------------------------------------- walls

TEST_P(Character, StandsStillInCornersAndPassesNone) {
    for (const double degrees : {20.0, 60.0, 90.0, 150.0}) {
        SCOPED_TRACE(degrees);
        const World world(at_rate(hz()));
        world.add_ground();
        for (const double side : {-1.0, 1.0}) {
            const Quat turn = Quat::turn({0, 1, 0}, side * degrees / 2 * kPi / 180);
            world.add({.kind = TAUT_BODY_STATIC,
                       .shape = world.box({10, 3, 0.1}),
                       .position = Vec(8, 0, 0) + turn.rotate({-8, 0, -0.1 * side}),
                       .rotation = turn});
        }
        Walker walker(world, hz(), {2, 0, 0.2});
        walker.walk({6, 0, 1}, 3);
        const Vec start = walker.position();
        double furthest = 0;
        for (int i = 0; i < walker.frames(2); ++i) {
            walker.frame({6, 0, 1});
            furthest = std::max(furthest, norm(walker.position() - start));
        }
        // In a wide one it slides to and fro by what it gathers of speed within a frame or two.
        EXPECT_LT(furthest, degrees > 120 ? 0.015 : 1e-4);
        EXPECT_LT(norm(walker.velocity()), degrees > 120 ? 1 : 0.05);
        EXPECT_LT(walker.position().x, 8);
        EXPECT_EQ(walker.deepest, 0);
    }
}

TEST_P(Character, SlidesAlongAWallWithWhatLeadsAlong) {
    const World world(at_rate(hz()));
    world.add_ground();
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.5, 3, 50}), .position = {2, 0, 0}});
    Walker walker(world, hz(), {0, 0, 0});
    walker.walk({3, 0, 4}, 3);
    const double start = walker.position().z;
    walker.walk({3, 0, 4}, 2);
    EXPECT_NEAR(walker.position().z - start, 8, 1e-3);
    EXPECT_NEAR(walker.position().x, 1.5 - kRadius - walker.gap(), walker.gap());
    EXPECT_EQ(walker.deepest, 0);
}

TEST_P(Character, JumpsAsAStoneUnderAnyCeiling) {
    for (const double ceiling : {10.0, 2.2}) {
        SCOPED_TRACE(ceiling);
        const World world(at_rate(hz()));
        world.add_ground();
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({5, 0.5, 5}), .position = {0, ceiling + 0.5, 0}});
        Walker walker(world, hz(), {0, 0, 0});
        walker.walk({}, 0.5);
        walker.frame({}, 5);
        double highest = walker.feet().y, time = 1 / hz();
        while (!walker.on_ground() && time < 5) {
            walker.frame({});
            highest = std::max(highest, walker.feet().y);
            time += 1 / hz();
        }
        const double apex = 5 * 5 / (2 * kG);
        if (ceiling > 5) {
            EXPECT_NEAR(highest, apex, kG / 8 / hz() / hz() + 1e-3);  // between two frames
            EXPECT_NEAR(time, 2 * 5 / kG, 1.5 / hz());
        } else {
            EXPECT_NEAR(highest, ceiling - 1.8 - 2 * walker.gap(), 1e-2);
            EXPECT_LT(time, 2 * 5 / kG - 0.1);
        }
        EXPECT_EQ(walker.deepest, 0);
    }
}

TEST_P(Character, LandsWhateverItsSpeed) {
    for (const double speed : {5.0, 50.0, 500.0, 5000.0}) {
        SCOPED_TRACE(speed);
        const World world(at_rate(hz()));
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({5, 0.01, 5})});
        Walker walker(world, hz(), {0, 100, 0});
        walker.body.velocity = {0, static_cast<float>(-speed), 0};
        walker.walk({}, 5);
        EXPECT_TRUE(walker.on_ground());
        EXPECT_NEAR(walker.feet().y, 0.01, 1e-3);
        EXPECT_EQ(walker.deepest, 0);
    }
}

// ---------------------------------------------------------------- what moves

taut_body add_platform(const World& world, const Vec& velocity, const Vec& spin) {
    return world.add({.kind = TAUT_BODY_KINEMATIC,
                      .shape = world.box({4, 0.25, 4}),
                      .position = {0, -0.25, 0},
                      .velocity = velocity,
                      .spin = spin});
}

TEST_P(Character, RidesWhatMovesTurnsAndLifts) {
    for (const Vec velocity : {Vec(3, 0, 0), Vec(0, 2, 0), Vec(0, -3, 0), Vec(5, 1, 2)}) {
        SCOPED_TRACE(velocity.x + 10 * velocity.y);
        const World world(at_rate(hz()));
        const taut_body platform = add_platform(world, velocity, {});
        Walker walker(world, hz(), {1, 0, 1});
        walker.body.velocity = Vec(velocity.x, 0, velocity.z).narrow();
        walker.walk({}, 1.5);
        const Vec start = walker.position() - lab::position(platform);
        walker.walk({}, 3);
        EXPECT_TRUE(walker.on_ground());
        EXPECT_LT(norm(walker.position() - lab::position(platform) - start), 1e-3);
        EXPECT_LT(norm(walker.velocity() - velocity), 1e-3);
        EXPECT_EQ(walker.deepest, 0);
    }
    const World world(at_rate(hz()));
    const taut_body platform = add_platform(world, {}, {0, 1, 0});
    Walker walker(world, hz(), {2, 0, 0});
    walker.body.velocity = {0, 0, -2};
    walker.move({});
    const Vec held = walker.feet();
    double turned = 0;
    for (int i = 0; i < walker.frames(10); ++i) {
        walker.frame({});
        turned += static_cast<double>(walker.body.ground_turn);
    }
    const Quat turn = state(platform).rotation;
    EXPECT_LT(norm(walker.feet() - turn.rotate(held)), 2e-3);
    EXPECT_NEAR(turned, 10, 1e-3);
    EXPECT_LT(norm(walker.velocity() - cross({0, 1, 0}, walker.feet())), 0.01);
}

TEST_P(Character, KeepsThePlatformsSpeedInAJump) {
    const World world(at_rate(hz()));
    const taut_body platform = add_platform(world, {6, 0, 0}, {});
    Walker walker(world, hz(), {0, 0, 0});
    walker.walk({}, 0.5);
    const double before = walker.position().x - lab::position(platform).x;
    walker.frame({}, 3);
    for (int i = 0; i < 1000 && !walker.on_ground(); ++i) walker.frame({});
    EXPECT_TRUE(walker.on_ground());
    EXPECT_NEAR(walker.position().x - lab::position(platform).x, before, 1e-3);
}

TEST_P(Character, IsPushedByAWallAndCrushedWithoutRoom) {
    const World world(at_rate(hz()));
    world.add_ground();
    const taut_body wall = world.add({.kind = TAUT_BODY_KINEMATIC,
                                      .shape = world.box({0.5, 2, 2}),
                                      .position = {-2, 2.2, 0},
                                      .velocity = {2, 0, 0}});
    world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.02, 2, 5}), .position = {3, 2, 0}});
    Walker walker(world, hz(), {0, 0, 0});
    for (int i = 0; i < walker.frames(1.5); ++i) {
        walker.frame({-1, 0, 0});
        const double free = walker.position().x - lab::position(wall).x - 0.5 - kRadius;
        EXPECT_GE(free, -1e-4);
        EXPECT_TRUE(walker.on_ground());
    }
    EXPECT_NEAR(walker.position().x - lab::position(wall).x, 0.5 + kRadius, 0.02);
    EXPECT_EQ(walker.body.overlap, 0);
    // Then against the other, which it does not leave.
    walker.walk({}, 0.6);
    EXPECT_GT(walker.body.overlap, 0.05f);
    EXPECT_LT(walker.position().x, 3 - 0.02 - kRadius + 1e-3);
}

// ---------------------------------------------------------------- what it pushes

TEST_P(Character, PushesWithTheForceItHas) {
    for (const double mass : {20.0, 50.0, 200.0}) {
        SCOPED_TRACE(mass);
        const World world(at_rate(hz()));
        world.add_ground(0.4);
        const taut_body box =
            world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {1.2, 0.5, 0}, .mass = mass, .friction = 0.4});
        Walker walker(world, hz(), {0, 0, 0});
        walker.walk({}, 0.5);
        // Until it is against the box and for a while longer.
        int frames = 0;
        while (walker.body.pushed == 0 && ++frames < 1000) walker.frame({5, 0, 0});
        const double expected = std::max(400 / mass - 0.4 * kG, 0.0);
        const double time = expected > 0 ? std::min(0.4, 2.5 / expected) : 0.5;
        const int count = walker.frames(time);
        const double before = velocity(box).x;
        for (int i = 0; i < count; ++i) walker.frame({5, 0, 0});
        const double reached = (velocity(box).x - before) * hz() / count;
        EXPECT_NEAR(reached, expected, 0.03 * expected + 0.02);
        EXPECT_LT(walker.deepest, 2e-3);
        EXPECT_LT(std::abs(state(box).spin.z), 0.1);
        // And no faster than it walks.
        walker.walk({1, 0, 0}, 2);
        EXPECT_LT(velocity(box).x, 1.05);
    }
}

TEST_P(Character, WeighsOnWhatItStandsOn) {
    const World world(at_rate(hz()));
    world.add_ground();
    const taut_body box = world.add({.shape = world.box({1, 0.25, 1}), .position = {0, 0.25, 0}, .mass = 50});
    Walker walker(world, hz(), {0, 0.5, 0});
    walker.walk({}, 2);
    double force = 0;
    for (const taut_contact& contact : world.contacts())
        if (contact.body_a.bits == box.bits || contact.body_b.bits == box.bits)
            force += static_cast<double>(contact.normal_impulse) * hz() * 4;
    EXPECT_NEAR(force, (50 + 80) * kG, 0.01 * 130 * kG);
    EXPECT_TRUE(walker.on_ground());
}

TEST_P(Character, WhatItsBodyIsThrownAtComesBack) {
    const World world(at_rate(hz()));
    world.add_ground();
    Walker walker(world, hz(), {0, 0, 0});
    walker.def.body =
        world.add({.kind = TAUT_BODY_KINEMATIC, .shape = walker.def.shape, .position = walker.position()});
    const taut_body ball = world.add(
        {.shape = world.sphere(0.2), .position = {3, 1, 0}, .velocity = {-8, 0, 0}, .mass = 5, .gravity_scale = 0});
    walker.walk({}, 2);
    EXPECT_GT(lab::position(ball).x, 0.4);
    EXPECT_LT(norm(lab::position(walker.def.body) - walker.position()), 0.05);
    EXPECT_TRUE(walker.on_ground());
}

// ---------------------------------------------------------------- anywhere

// Hills of triangles with boxes on them at any angle.
void add_rubble(const World& world, uint32_t seed) {
    uint32_t state = seed * 747796405u + 2891336453u;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) / 16777216.0;
    };
    constexpr uint32_t kSide = 25;
    std::vector<float> heights(kSide * kSide);
    for (float& height : heights) height = static_cast<float>(1.2 * random());
    const taut_shape field = world.shape(taut_height_field_def_init, taut_world_add_height_field, [&](auto& def) {
        def.rows = def.columns = kSide;
        def.heights = heights.data();
    });
    world.add({.kind = TAUT_BODY_STATIC, .shape = field, .position = {-12, 0, -12}});
    for (int i = 0; i < 40; ++i) {
        const Vec half(0.1 + random(), 0.1 + 0.5 * random(), 0.1 + random());
        const Vec axis(random() - 0.5, random() - 0.5, random() - 0.5);
        world.add({.kind = TAUT_BODY_STATIC,
                   .shape = world.box(half),
                   .position = {20 * random() - 10, 1.5 * random(), 20 * random() - 10},
                   .rotation = Quat::turn(axis, 6 * random())});
    }
    for (const double side : {-1.0, 1.0}) {
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({0.5, 9, 12}), .position = {11.5 * side, 0, 0}});
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({12, 9, 0.5}), .position = {0, 0, 11.5 * side}});
    }
}

struct Journey {
    Vec end;
    double deepest = 0, furthest = 0;
    bool fell = false, stood = false;
};

Journey wander(double hz, uint32_t seed, double time) {
    const World world(at_rate(hz));
    add_rubble(world, seed);
    Walker walker(world, hz, {0, 4, 0});
    uint32_t state = seed;
    Vec walk;
    Journey journey;
    const int turn = walker.frames(1);
    for (int i = 0; i < walker.frames(time); ++i) {
        if (i % turn == 0) {
            state = state * 1664525u + 1013904223u;
            const double angle = (state >> 8) / 16777216.0 * 2 * kPi;
            walk = 5 * Vec(std::cos(angle), 0, std::sin(angle));
        }
        const Vec before = walker.position();
        walker.frame(walk, i % turn == turn / 2 ? 4 : 0);
        journey.furthest = std::max(journey.furthest, norm(walker.position() - before) * hz);
        journey.fell = journey.fell || walker.position().y < -0.5;
        journey.stood = journey.stood || walker.on_ground();
    }
    journey.end = walker.position();
    journey.deepest = walker.deepest;
    return journey;
}

TEST_P(Character, IsNeverWithinAnythingOnRubble) {
    int failures = 0;
    double deepest = 0, fastest = 0;
    for (uint32_t seed = 1; seed <= 40; ++seed) {
        const Journey journey = wander(hz(), seed, 10);
        deepest = std::max(deepest, journey.deepest);
        fastest = std::max(fastest, journey.furthest);
        const bool failed = journey.deepest > 1e-3 || journey.fell || !journey.stood;
        if (failed) ADD_FAILURE() << "start " << seed << ": " << journey.deepest << " m deep, fell " << journey.fell;
        failures += failed ? 1 : 0;
    }
    EXPECT_EQ(failures, 0);
    RecordProperty("deepest_mm", std::to_string(1000 * deepest));
    RecordProperty("fastest", std::to_string(fastest));
}

TEST_P(Character, HasTheSameBitsEachTimeAndAfterARestoration) {
    const Journey first = wander(hz(), 7, 5), second = wander(hz(), 7, 5);
    EXPECT_EQ(std::memcmp(&first.end, &second.end, sizeof first.end), 0);

    const World world(at_rate(hz()));
    const taut_body platform = add_platform(world, {1, 0, 0}, {0, 1, 0});
    Walker walker(world, hz(), {1, 0, 0});
    walker.walk({1, 0, 0}, 0.5);
    uint64_t size = 0;
    ok(taut_world_snapshot_size(world.handle, &size));
    std::vector<unsigned char> bytes(size);
    ok(taut_world_save(world.handle, bytes.data(), size, &size));
    const taut_character saved = walker.body;
    walker.walk({0, 0, 1}, 0.5);
    const taut_character once = walker.body;
    ok(taut_world_restore(world.handle, bytes.data(), size));
    walker.body = saved;
    walker.walk({0, 0, 1}, 0.5);
    EXPECT_EQ(std::memcmp(&walker.body, &once, sizeof once), 0);
    EXPECT_TRUE(taut_body_is_valid(platform));
}

}  // namespace
}  // namespace lab
