// Bodies that hardly move against what they lie on, whose contacts are not asked for in every step: what they do in
// the long run, and what the host changes under them.
#include "physics/contact_lab.h"

namespace {

using namespace lab;

// At 0.3 to 100 um a step, so that contacts live for one step up to hundreds.
TEST(ContactReuse, ABoxThatIsPushedSlowlyStaysAtWhatPushesIt) {
    for (const double speed : {2e-5, 3e-4, 1e-3, 3e-3, 6e-3}) {
        World world;
        world.add_ground();
        const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .mass = 100});
        const taut_body pusher = world.add({.kind = TAUT_BODY_KINEMATIC,
                                            .shape = world.box({0.1, 0.3, 0.3}),
                                            .position = {-0.6, 0.5, 0},
                                            .velocity = {speed, 0, 0},
                                            .friction = 0});
        world.step(60);
        const double apart = position(box).x - position(pusher).x;
        world.step(240);
        EXPECT_NEAR(position(box).x - position(pusher).x, apart, 2e-4) << speed;
        EXPECT_NEAR(position(box).x, 5 * speed, 1e-3) << speed;
        EXPECT_NEAR(position(box).y, 0.5, 1e-3) << speed;
        EXPECT_NEAR(state(box).rotation.w, 1, 1e-6) << speed;
    }
}

// Each body turns with it as if fixed, for half a turn.
TEST(ContactReuse, AStackTurnsWithItsPlatform) {
    World world;
    constexpr double kSpin = 0.3;
    const taut_body platform = world.add({.kind = TAUT_BODY_KINEMATIC,
                                          .shape = world.box({3, 0.1, 3}),
                                          .position = {0, -0.1, 0},
                                          .spin = {0, kSpin, 0}});
    std::vector<taut_body> stack;
    for (int i = 0; i < 4; ++i)
        stack.push_back(world.add({.shape = world.box({0.25, 0.25, 0.25}),
                                   .position = {1.2, 0.25 + 0.5 * i, 0.5},
                                   .velocity = {kSpin * 0.5, 0, -kSpin * 1.2},
                                   .spin = {0, kSpin, 0}}));
    const auto as_seen = [&](taut_body body) { return state(platform).rotation.rotate_back(position(body)); };
    world.step(60);
    std::vector<Vec> before;
    for (taut_body body : stack) before.push_back(as_seen(body));
    world.step(600);
    // Friction that turns creeps by some 3e-3 of the way, also where contacts are found in every step.
    const Vec crept = as_seen(stack[0]) - before[0];
    EXPECT_LT(norm(crept), 4e-3 * kSpin * 1.3 * 10);
    for (size_t i = 0; i < stack.size(); ++i) {
        const Quat own = state(stack[i]).rotation;
        EXPECT_LT(norm(as_seen(stack[i]) - before[i] - crept), 1e-3) << i;
        EXPECT_NEAR(state(stack[i]).spin.y, kSpin, 1e-3) << i;
        EXPECT_NEAR(own.rotate({0, 1, 0}).y, 1, 1e-6) << i;
    }
}

TEST(ContactReuse, AChangedMaterialTakesEffectAtRest) {
    World world;
    const double slope = 0.3;
    const taut_body ground = world.add(
        {.kind = TAUT_BODY_STATIC, .shape = world.plane({std::sin(slope), std::cos(slope), 0}), .friction = 1});
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}),
                                     .position = 0.5 * Vec(std::sin(slope), std::cos(slope), 0),
                                     .rotation = Quat::turn({0, 0, 1}, -slope),
                                     .friction = 1});
    world.step(120);
    const Vec rest = position(box);
    taut_material ice{};
    ok(taut_body_get_material(ground, &ice));
    ice.friction = 0;
    ok(taut_body_set_material(ground, &ice));
    world.step(60);
    EXPECT_NEAR(norm(position(box) - rest), 0.5 * kG * std::sin(slope), 0.05);
}

// v = v0 - mu g t, by the friction that is now.
TEST(ContactReuse, AChangedMaterialTakesEffectInMotion) {
    World world;
    const taut_body ground = world.add_ground(1);
    const taut_body box = world.add(
        {.shape = world.box({0.5, 0.1, 0.5}), .position = {0, 0.1, 0}, .velocity = {8, 0, 0}, .friction = 0.25});
    world.step(30);
    const double before = velocity(box).x;
    EXPECT_NEAR(before, 8 - 0.5 * kG * 30 * world.frame(), 0.05);
    taut_material ice{};
    ok(taut_body_get_material(ground, &ice));
    ice.friction = 0;
    ok(taut_body_set_material(ground, &ice));
    world.step(30);
    EXPECT_NEAR(velocity(box).x, before, 0.01);
}

TEST(ContactReuse, ASurfaceThatBeginsToRunTakesTheBoxAlong) {
    World world;
    const taut_body ground = world.add_ground(1);
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}, .friction = 1});
    world.step(120);
    ok(taut_collider_set_surface_velocity(collider_of(ground), Vec(0.5, 0, 0).narrow(), Vec().narrow()));
    world.step(60);
    EXPECT_NEAR(velocity(box).x, 0.5, 0.01);
    ok(taut_collider_set_surface_velocity(collider_of(ground), Vec().narrow(), Vec().narrow()));
    world.step(60);
    EXPECT_NEAR(velocity(box).x, 0, 0.01);
}

TEST(ContactReuse, ABodyAtRestThatGetsAnotherShapeLiesOnThat) {
    World world;
    world.add_ground();
    const taut_body box = world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}});
    world.step(120);
    const auto reshape = [&](const Vec& half) {
        ok(taut_collider_set_shape(collider_of(box), world.box(half), Vec().narrow(), Quat().narrow()));
        world.step(120);
    };
    reshape({0.5, 0.499, 0.5});
    EXPECT_NEAR(position(box).y, 0.499, 5e-4);
    reshape({0.5, 0.3, 0.5});
    EXPECT_NEAR(position(box).y, 0.3, 1e-3);
}

TEST(ContactReuse, EventsThatAreAskedForAtRestCome) {
    World world;
    const taut_body ground = world.add_ground();
    world.add({.shape = world.box({0.5, 0.5, 0.5}), .position = {0, 0.5, 0}});
    world.step(120);
    ok(taut_body_set_contact_events(ground, TAUT_CONTACT_EVENTS_PERSIST));
    world.step();
    taut_events events;
    ok(taut_world_get_events(world.handle, &events));
    EXPECT_GT(events.persist_count, 0u);
}

}  // namespace
