// Restitution: a dropped ball rises to e^2 of its height, and what lies still keeps still.
#include "physics/lab.h"

namespace {

using namespace lab;

class DroppedBall : public testing::TestWithParam<double> {};

// The approach speed is taken at the start of the frame that finds the contact, up to one frame F before the impact,
// so that u lies in [v - g F, v] with v = sqrt(2 g h); the substep s shortens the fall's v by up to g s / 2 and the
// rise by up to e v s / 2. The rebound starts at the end of that frame, from the surface.
TEST_P(DroppedBall, ReboundsToTheSquareOfRestitution) {
    const double e = GetParam();
    constexpr double kDrop = 1, kRadius = 0.25;
    World world;
    world.add_ground(0.5, 0);
    const taut_body ball =
        world.add({.shape = world.sphere(kRadius), .position = {0, kRadius + kDrop, 0}, .restitution = e});
    const double frame = world.frame(), substep = frame / world.def.substeps, v = std::sqrt(2 * kG * kDrop);
    const double slowest = v - kG * (frame + substep / 2);
    const double least = e * e * slowest * slowest / (2 * kG) - e * v * substep / 2 - 1e-3;
    const double most = e * e * kDrop + 1e-3;

    int frames = 0;
    while (velocity(ball).y <= 1e-4 && ++frames < 60) world.step();
    EXPECT_EQ(frames == 60, e == 0) << "rises at " << velocity(ball).y << " m/s after frame " << frames;
    double top = position(ball).y - kRadius;
    for (int i = 0; i < 60; ++i) {
        world.step();
        top = std::max(top, position(ball).y - kRadius);
    }
    EXPECT_LE(top, most);
    EXPECT_GE(top, least) << "expected about " << e * e * kDrop;
    RecordProperty("height", std::to_string(top));
}

INSTANTIATE_TEST_SUITE_P(Restitution, DroppedBall, testing::Values(0.0, 0.5, 1.0),
                         [](const auto& tested) { return std::to_string(static_cast<int>(100 * tested.param)); });

// Ten bounces without loss must not gain height.
TEST(DroppedBall, FullyElasticNeverRisesAboveItsStart) {
    World world;
    world.add_ground(0, 0);
    const taut_body ball = world.add({.shape = world.sphere(0.25), .position = {0, 1.25, 0}, .restitution = 1});
    double top = 0;
    for (int i = 0; i < 600; ++i) {
        world.step();
        if (i > 30) top = std::max(top, position(ball).y);
    }
    EXPECT_LE(top, 1.251);
}

// Two equal balls head on, e = 1, exchange their velocities; momentum is kept whatever e.
TEST(BallsCollide, ExchangeVelocitiesWhenElastic) {
    for (double e : {0.0, 0.5, 1.0}) {
        World world([](taut_world_def& def) { def.gravity = {0, 0, 0}; });
        const taut_shape shape = world.sphere(0.25);
        const taut_body a =
            world.add({.shape = shape, .position = {-1, 0, 0}, .velocity = {3, 0, 0}, .mass = 2, .restitution = e});
        const taut_body b =
            world.add({.shape = shape, .position = {1, 0, 0}, .velocity = {-1, 0, 0}, .mass = 2, .restitution = e});
        world.step(60);
        EXPECT_NEAR(velocity(a).x, 1 - 2 * e, 0.02) << "e = " << e;
        EXPECT_NEAR(velocity(b).x, 1 + 2 * e, 0.02) << "e = " << e;
        EXPECT_NEAR(velocity(a).x + velocity(b).x, 2, 1e-5) << "e = " << e;
    }
}

TEST(RestingBox, WithRestitutionDoesNotJitter) {
    World world;
    world.add_ground(0.5, 0.5);
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .restitution = 0.8});
    world.step(60);
    const Vec start = position(box);
    double fastest = 0, moved = 0;
    for (int i = 0; i < 300; ++i) {
        world.step();
        const BodyState s = state(box);
        fastest = std::max({fastest, norm(s.velocity), norm(s.spin)});
        moved = std::max(moved, norm(s.position - start));
    }
    EXPECT_LT(fastest, 1e-3);
    EXPECT_LT(moved, 1e-4);
}

}  // namespace
