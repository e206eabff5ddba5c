#include "physics/lab.h"

namespace {

using namespace lab;

// The host's threshold, from one step to the next.
TEST(RestitutionThreshold, IsTheFastestImpactThatDoesNotBounce) {
    for (const double speed : {0.5, 2.0}) {
        World world([](taut_world_def& def) {
            def.gravity = {0, 0, 0};
            def.restitution_threshold = 1;
        });
        world.add_ground(0, 1);
        const taut_body ball = world.add(
            {.shape = world.sphere(0.1), .position = {0, 0.3, 0}, .velocity = {0, -speed, 0}, .restitution = 1});
        world.step(60);
        EXPECT_NEAR(velocity(ball).y, speed > 1 ? speed : 0, 1e-3 * speed);
        ok(taut_world_set_restitution_threshold(world.handle, 0.1f));
        const taut_pose above{{0, 1, 0}, {0, 0, 0, 1}, {}};
        ok(taut_body_set_pose(ball, &above));
        ok(taut_body_set_velocity(ball, {0, -0.5f, 0}, {0, 0, 0}));
        world.step(150);
        EXPECT_NEAR(velocity(ball).y, 0.5, 1e-3);
    }
}

TEST(RestitutionThreshold, RefusesWhatIsNoSpeed) {
    World world;
    taut_world_def def;
    for (const float bad : {NAN, INFINITY, -1.0f, 1.0001e4f}) {
        EXPECT_EQ(taut_world_set_restitution_threshold(world.handle, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_NE(std::string(taut_last_error()).find("restitution_threshold"), std::string::npos);
    }
    ok(taut_world_get_def(world.handle, &def));
    EXPECT_EQ(def.restitution_threshold, 0);
    ok(taut_world_set_restitution_threshold(world.handle, 3));
    ok(taut_world_get_def(world.handle, &def));
    EXPECT_EQ(def.restitution_threshold, 3);
}

}  // namespace
