// What wakes an island, whom it wakes, and how it goes on.
#include "sleep/sleep_lab.h"

namespace {

using namespace lab;

// Two stacks side by side, asleep, the first on a slab of its own.
struct Sleepers {
    World world{let_sleep};
    taut_body ground, slab;
    std::vector<taut_body> stack, neighbour;

    explicit Sleepers(taut_body_kind slab_kind = TAUT_BODY_STATIC, double apart = 0.65) {
        ground = world.add_ground();
        slab = world.add({.kind = slab_kind, .shape = world.box({0.3, 0.25, 0.3}), .position = {0, 0.25, 0}});
        stack = add_stack(world, 4);
        for (taut_body body : stack) {
            taut_pose pose{};
            ok(taut_body_get_pose(body, &pose));
            pose.position.y += 0.5;
            ok(taut_body_set_pose(body, &pose));
        }
        neighbour = add_stack(world, 4, apart);
        if (steps_to_sleep(world, both()) < 0) throw std::runtime_error("nobody fell asleep");
    }
    std::vector<taut_body> both() const {
        std::vector<taut_body> all = stack;
        all.insert(all.end(), neighbour.begin(), neighbour.end());
        return all;
    }
};

// ---------------------------------------------------------------- contacts

TEST(Wakes, TheIslandThatABulletHitsAndNoOther) {
    for (double apart : {0.52, 0.65, 2.0}) {
        Sleepers s(TAUT_BODY_STATIC, apart);
        const taut_body bullet = s.world.add(
            {.shape = s.world.sphere(0.05), .position = {-3, 1.7, 0}, .velocity = {20, 0.5, 0}, .mass = 0.05});
        while (all_asleep(s.stack)) {
            s.world.step();
            ASSERT_LT(position(bullet).x, -0.1) << "it went in without waking anybody";
        }
        EXPECT_TRUE(all_awake(s.stack)) << "whole islands wake";
        EXPECT_TRUE(all_asleep(s.neighbour)) << apart;
        EXPECT_EQ(events_of(s.world.handle).woke_count, 4u);
        EXPECT_LT(velocity(bullet).x, 10) << "met in the same step, not a step later";
        s.world.step(5);
        EXPECT_GT(norm(velocity(s.stack[2])), 1e-4) << "it takes the push";
    }
}

// Passing close by is no touch.
TEST(Wakes, NobodyByABulletThatPasses) {
    Sleepers s;
    s.world.add({.shape = s.world.sphere(0.05), .position = {-3, 1.5, 0.4}, .velocity = {5, 0, 0}, .gravity_scale = 0});
    s.world.step(120);
    EXPECT_TRUE(all_asleep(s.both()));
}

TEST(Wakes, WhatAKinematicPlatformCarriesAsSoonAsItMoves) {
    Sleepers s(TAUT_BODY_KINEMATIC);
    taut_pose here{};
    ok(taut_body_get_pose(s.slab, &here));
    for (int i = 0; i < 60; ++i) {  // hosts say it every frame
        ok(taut_body_move_kinematic(s.slab, &here));
        s.world.step();
    }
    ASSERT_TRUE(all_asleep(s.both()));
    const double top = position(s.stack[3]).y;
    for (int i = 0; i < 60; ++i) {
        here.position.y += 0.5 / 60;
        ok(taut_body_move_kinematic(s.slab, &here));
        s.world.step();
        ASSERT_TRUE(all_awake(s.stack));
    }
    EXPECT_TRUE(all_asleep(s.neighbour));
    EXPECT_NEAR(position(s.stack[3]).y, top + 0.5, 0.01);
}

TEST(Wakes, WhatHangsOnAKinematicHook) {
    const World world(let_sleep);
    const taut_body hook = world.add({.kind = TAUT_BODY_KINEMATIC});
    const taut_body bob = world.particle(1, {0, -1, 0});
    world.rod(hook, {}, bob, {}, 1);
    ASSERT_GT(steps_to_sleep(world, {bob}), 0);
    ok(taut_body_set_velocity(hook, {0, 0.01f, 0}, {}));
    world.step(300);
    EXPECT_TRUE(awake(bob)) << "slow, but on the move";
    EXPECT_NEAR(position(bob).y, -1 + 0.05, 1e-3);
}

// ---------------------------------------------------------------- calls

struct Call {
    const char* name;
    void (*act)(Sleepers&);
    bool wakes = true;
};
void PrintTo(const Call& call, std::ostream* out) { *out << call.name; }

taut_collider first_collider(taut_body body) {
    taut_collider colliders[4];
    uint32_t count = 0;
    ok(taut_body_get_colliders(body, colliders, 4, &count));
    return colliders[0];
}

taut_pose moved(taut_body body, const Vec& by) {
    taut_pose pose{};
    ok(taut_body_get_pose(body, &pose));
    pose.position = (Vec(pose.position) + by).pos();
    return pose;
}

const Call kCalls[] = {
    {"set_velocity", [](Sleepers& s) { ok(taut_body_set_velocity(s.stack[1], {}, {})); }},
    {"apply_force",
     [](Sleepers& s) {
         ok(taut_body_apply_force(s.stack[1], {1, 0, 0}, {}));
     }},
    {"apply_no_force", [](Sleepers& s) { ok(taut_body_apply_force(s.stack[1], {}, {})); }, false},
    {"apply_force_at",
     [](Sleepers& s) {
         ok(taut_body_apply_force_at(s.stack[1], {1, 0, 0}, {}));
     }},
    {"apply_impulse",
     [](Sleepers& s) {
         ok(taut_body_apply_impulse(s.stack[1], {0, 0, 1}, {}));
     }},
    {"apply_impulse_at",
     [](Sleepers& s) {
         ok(taut_body_apply_impulse_at(s.stack[1], {0, 0, 1}, {}));
     }},
    {"set_pose",
     [](Sleepers& s) {
         const taut_pose pose = moved(s.stack[3], {0, 0.1, 0});
         ok(taut_body_set_pose(s.stack[3], &pose));
     }},
    {"set_material",
     [](Sleepers& s) {
         const taut_material ice{};
         ok(taut_body_set_material(s.stack[2], &ice));
     }},
    {"set_material_of_support",
     [](Sleepers& s) {
         const taut_material ice{};
         ok(taut_collider_set_material(first_collider(s.slab), &ice));
     }},
    {"set_filter",
     [](Sleepers& s) {
         const taut_filter nothing{};
         ok(taut_collider_set_filter(first_collider(s.stack[0]), &nothing));
     }},
    {"set_filter_of_support",
     [](Sleepers& s) {
         const taut_filter nothing{};
         ok(taut_collider_set_filter(first_collider(s.slab), &nothing));
     }},
    {"set_sensor", [](Sleepers& s) { ok(taut_collider_set_sensor(first_collider(s.stack[2]), 1)); }},
    {"set_sensor_of_support", [](Sleepers& s) { ok(taut_collider_set_sensor(first_collider(s.slab), 1)); }},
    {"set_sensor_as_it_is", [](Sleepers& s) { ok(taut_collider_set_sensor(first_collider(s.slab), 0)); }, false},
    {"set_one_way",
     [](Sleepers& s) {
         ok(taut_collider_set_one_way(first_collider(s.stack[1]), {0, -1, 0}));
     }},
    {"set_one_way_of_support",
     [](Sleepers& s) {
         ok(taut_collider_set_one_way(first_collider(s.slab), {0, -1, 0}));
     }},
    {"set_pre_solve", [](Sleepers& s) { ok(taut_collider_set_pre_solve(first_collider(s.stack[3]), 1)); }},
    {"set_pre_solve_of_support", [](Sleepers& s) { ok(taut_collider_set_pre_solve(first_collider(s.slab), 1)); }},
    {"set_shape",
     [](Sleepers& s) {
         ok(taut_collider_set_shape(first_collider(s.stack[0]), s.world.sphere(0.2), {}, {0, 0, 0, 1}));
     }},
    {"add_collider",
     [](Sleepers& s) {
         taut_collider_def def;
         taut_collider_def_init(&def);
         def.shape = s.world.sphere(0.1);
         def.position = {0, 0, 1};
         taut_collider out{};
         ok(taut_body_add_collider(s.stack[0], &def, &out));
         ok(taut_body_set_mass_from_colliders(s.stack[0]));
     }},
    {"remove_collider", [](Sleepers& s) { ok(taut_collider_remove(first_collider(s.stack[1]))); }},
    {"remove_collider_of_support", [](Sleepers& s) { ok(taut_collider_remove(first_collider(s.slab))); }},
    {"remove_body", [](Sleepers& s) { ok(taut_body_remove(s.stack[0])), s.stack.erase(s.stack.begin()); }},
    {"remove_support", [](Sleepers& s) { ok(taut_body_remove(s.slab)); }},
    {"move_support",
     [](Sleepers& s) {
         const taut_pose pose = moved(s.slab, {-5, 0, 0});
         ok(taut_body_set_pose(s.slab, &pose));
     }},
    {"move_a_wall_in",
     [](Sleepers& s) {
         const taut_body wall =
             s.world.add({.kind = TAUT_BODY_STATIC, .shape = s.world.box({0.1, 1, 1}), .position = {-9, 1, 0}});
         s.world.step();
         if (!all_asleep(s.stack)) throw std::runtime_error("a wall far off woke them");
         const taut_pose pose = moved(wall, {9 - 0.33, 0, 0});
         ok(taut_body_set_pose(wall, &pose));
     }},
    {"add_a_wall",
     [](Sleepers& s) {
         s.world.add({.kind = TAUT_BODY_STATIC, .shape = s.world.box({0.1, 1, 1}), .position = {-0.33, 1, 0}});
     }},
    {"add_joint",
     [](Sleepers& s) {
         s.world.ball({}, {0, 3, 0}, s.stack[3], {0, 0.25, 0});
     }},
    {"set_awake", [](Sleepers& s) { ok(taut_body_set_awake(s.stack[2], 1)); }},
    {"set_can_sleep", [](Sleepers& s) { ok(taut_body_set_can_sleep(s.stack[2], 0)); }},
    {"wake_box",
     [](Sleepers& s) {
         ok(taut_world_wake_box(s.world.handle, {-0.3, 2, -0.1}, {-0.2, 2.2, 0.1}));
     }},
    {"wake_box_elsewhere",
     [](Sleepers& s) {
         ok(taut_world_wake_box(s.world.handle, {-3, 0, -1}, {-1, 9, 1}));
     },
     false},
    {"set_user_data", [](Sleepers& s) { ok(taut_body_set_user_data(s.stack[1], 7)); }, false},
    {"set_density", [](Sleepers& s) { ok(taut_collider_set_density(first_collider(s.stack[1]), 5)); }, false},
};

class CallsWake : public testing::TestWithParam<Call> {};

TEST_P(CallsWake, TheIslandAndNotTheNeighbour) {
    Sleepers s;
    GetParam().act(s);
    EXPECT_TRUE(all_asleep(s.neighbour));
    EXPECT_EQ(all_awake(s.stack), GetParam().wakes);
    EXPECT_EQ(all_asleep(s.stack), !GetParam().wakes);
    s.world.step();
    const taut_events events = events_of(s.world.handle);
    EXPECT_EQ(events.woke_count, GetParam().wakes ? s.stack.size() : 0);
    EXPECT_EQ(s.world.profile().awake, GetParam().wakes ? s.stack.size() : 0);
    EXPECT_TRUE(all_asleep(s.neighbour));
    s.world.step();
    EXPECT_EQ(events_of(s.world.handle).woke_count, 0u) << "told once";
    for (taut_body body : s.stack) EXPECT_TRUE(finite(body));
}

INSTANTIATE_TEST_SUITE_P(Each, CallsWake, testing::ValuesIn(kCalls),
                         [](const auto& tested) -> std::string { return tested.param.name; });

// What lies inside of a static body that was a sensor, or let it through, is pushed out as soon as it no longer does.
TEST(Wakes, WhatLiesInAColliderThatBeginsToStopIt) {
    for (const bool one_way : {false, true}) {
        World world(let_sleep);
        world.add_ground();
        const taut_body block = world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({1, 0.2, 1})});
        const taut_collider collider = first_collider(block);
        if (one_way)
            ok(taut_collider_set_one_way(collider, {0, -1, 0}));
        else
            ok(taut_collider_set_sensor(collider, 1));
        const std::vector<taut_body> stack = add_stack(world, 2);
        ASSERT_GT(steps_to_sleep(world, stack), 0);
        const double before = position(stack[0]).y;
        if (one_way)
            ok(taut_collider_set_one_way(collider, {}));
        else
            ok(taut_collider_set_sensor(collider, 0));
        EXPECT_TRUE(all_awake(stack));
        world.step(120);
        EXPECT_GT(position(stack[0]).y, before + 0.15) << one_way;
    }
}

TEST(Wakes, WhatAnotherPreSolveFunctionMayLetThrough) {
    World world(let_sleep);
    world.add_ground();
    const taut_body shelf =
        world.add({.kind = TAUT_BODY_STATIC, .shape = world.box({1, 0.2, 1}), .position = {0, 2, 0}});
    ok(taut_collider_set_pre_solve(first_collider(shelf), 1));
    const taut_body on_shelf = world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {0, 2.45, 0}});
    const taut_body on_ground = world.add({.shape = world.box({0.25, 0.25, 0.25}), .position = {5, 0.25, 0}});
    ASSERT_GT(steps_to_sleep(world, {on_shelf, on_ground}), 0);
    const taut_pre_solve_fn lets_through = [](const taut_pre_solve*, taut_pre_solve_answer*, void*) { return 0; };
    ok(taut_world_set_pre_solve(world.handle, lets_through, nullptr));
    EXPECT_TRUE(awake(on_shelf));
    EXPECT_FALSE(awake(on_ground));
    world.step(60);
    EXPECT_LT(position(on_shelf).y, 1.5);
}

TEST(Wakes, EveryoneWhenGravityChanges) {
    Sleepers s;
    ok(taut_world_set_gravity(s.world.handle, s.world.def.gravity));
    EXPECT_TRUE(all_asleep(s.both()));
    ok(taut_world_set_gravity(s.world.handle, {0, 1, 0}));
    EXPECT_TRUE(all_awake(s.both()));
    s.world.step(60);
    EXPECT_GT(velocity(s.stack[0]).y, 0.9);
}

TEST(Wakes, WhatAChangedOrRemovedJointHolds) {
    const World world(let_sleep);
    const taut_shape arm = world.box({0.5, 0.05, 0.05});
    const taut_body door = world.add({.shape = arm, .position = {0.5, 0, 0}});
    taut_hinge_joint_def def;
    taut_hinge_joint_def_init(&def);
    def.base.body_b = door;
    def.base.frame_b.position = {-0.5, 0, 0};
    def.angle.drive.frequency = 2;
    def.angle.drive.damping_ratio = 1;
    taut_joint joint{};
    ok(taut_world_add_hinge_joint(world.handle, &def, &joint));
    ASSERT_GT(steps_to_sleep(world, {door}), 0);
    ok(taut_joint_set_target(joint, 0, 0, 0));
    EXPECT_FALSE(awake(door)) << "no news";
    ok(taut_joint_set_user_data(joint, 5));
    EXPECT_FALSE(awake(door));
    ok(taut_joint_set_target(joint, 0, 0.5f, 0));
    EXPECT_TRUE(awake(door));
    ASSERT_GT(steps_to_sleep(world, {door}), 0);
    ok(taut_joint_set_break(joint, 1e6f, 0));
    EXPECT_TRUE(awake(door));
    ASSERT_GT(steps_to_sleep(world, {door}), 0);
    ok(taut_joint_remove(joint));
    EXPECT_TRUE(awake(door));
    world.step(30);
    EXPECT_LT(velocity(door).y, -4.5);
}

TEST(Wakes, ACableThatIsReeled) {
    const World world(let_sleep);
    const taut_body weight = world.add({.shape = world.box({0.2, 0.2, 0.2}), .position = {0, -4, 0}, .mass = 50});
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.end[0].attached = def.end[1].attached = 1;
    def.end[1].body = weight;
    taut_cable cable{};
    ok(taut_world_add_cable(world.handle, &def, &cable));
    ASSERT_GT(steps_to_sleep(world, {weight}, 1200), 0);
    const double before = position(weight).y;
    ok(taut_cable_set_reel_speed(cable, 0, -0.02f, 0));
    for (int i = 0; i < 300; ++i) {
        world.step();
        ASSERT_TRUE(awake(weight)) << "slow, but on the move";
    }
    EXPECT_NEAR(position(weight).y, before + 0.1, 0.01);
    ok(taut_cable_set_reel_speed(cable, 0, 0, 0));
    EXPECT_GT(steps_to_sleep(world, {weight}, 1200), 0);
    ok(taut_cable_remove(cable));
    EXPECT_TRUE(awake(weight));
}

// ---------------------------------------------------------------- how it goes on

// The carried impulses hold the stack in the first step.
TEST(Woken, GoesOnAsIfItHadNeverSlept) {
    const World world([](taut_world_def& def) {
        let_sleep(def);
        def.sleep_time = 10;  // by then nothing creeps any more
    });
    world.add_ground();
    const std::vector<taut_body> stack = add_stack(world, 10);
    ASSERT_GT(steps_to_sleep(world, stack, 700), 0);
    world.step(60);
    const Vec before = position(stack.back());
    ok(taut_body_set_awake(stack.back(), 1));
    double fastest = 0;
    for (int i = 0; i < 60; ++i) {
        world.step();
        for (taut_body body : stack) fastest = std::max(fastest, norm(velocity(body)));
    }
    EXPECT_LT(fastest, 1e-4);
    EXPECT_LT(norm(position(stack.back()) - before), 1e-5);
}

TEST(PutToSleep, TakesTheIslandAlongAndHoldsItInTheAir) {
    const World world(let_sleep);
    world.add_ground();
    const taut_body a = world.particle(1, {0, 5, 0}), b = world.particle(1, {0, 4, 0});
    world.rod(a, {}, b, {}, 1);
    const std::vector<taut_body> stack = add_stack(world, 2, 3);
    world.step(20);
    ok(taut_body_set_awake(a, 0));
    EXPECT_TRUE(all_asleep({a, b}));
    EXPECT_TRUE(all_awake(stack));
    const Vec at = position(b);
    world.step();
    EXPECT_EQ(events_of(world.handle).fell_asleep_count, 2u);
    world.step(60);
    EXPECT_EQ(position(b).y, at.y);
    ok(taut_body_set_awake(b, 1));
    world.step(30);
    EXPECT_LT(position(b).y, at.y - 1);
}

}  // namespace
