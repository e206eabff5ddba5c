// Joints that break: when, what is told of it, and what is possible afterwards.
#include "joint_support.h"

using namespace taut_test;

namespace {

taut_events step_for_events(taut_world world) {
    EXPECT_OK(taut_world_step(world));
    return events_of(world);
}

// A weight of 1 kg hangs from a thread that holds more or less than that.
TEST(Break, AboveTheForceAndNotBelow) {
    for (bool holds : {true, false}) {
        const taut_world world = make_world();
        taut_ball_joint_def def;
        taut_ball_joint_def_init(&def);
        def.base.body_b = add_particle(world, 0, 0, 0);
        def.base.break_force = holds ? 9.9f : 9.7f;
        def.base.user_data = 77;
        taut_joint joint;
        ASSERT_OK(taut_world_add_ball_joint(world, &def, &joint));
        uint32_t broken = 0;
        for (int i = 0; i < 60; ++i) {
            const taut_events events = step_for_events(world);
            broken += events.broken_count;
            if (events.broken_count == 0) continue;
            EXPECT_EQ(events.broken[0].joint.bits, joint.bits);
            EXPECT_EQ(events.broken[0].user_data, 77u);
            EXPECT_NEAR(events.broken[0].force.y, 9.81, 0.01);
            EXPECT_NEAR(events.broken[0].torque.z, 0, 1e-6);
            EXPECT_FALSE(taut_joint_is_valid(joint));
        }
        EXPECT_EQ(broken, holds ? 0u : 1u);
        EXPECT_EQ(counts_of(world).joints, holds ? 1u : 0u);
        taut_pose pose;
        ASSERT_OK(taut_body_get_pose(def.base.body_b, &pose));
        EXPECT_EQ(pose.position.y < -4, !holds);
        EXPECT_OK(taut_world_destroy(world));
    }
}

// A beam bends off at the wall by its torque alone.
TEST(Break, AboveTheTorque) {
    for (float most : {0.0f, 2.1e4f, 1.9e4f}) {  // the weight's is 1.962e4
        const taut_world world = make_world();
        const taut_joint joint = add_beam(world);
        for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(world));
        ASSERT_OK(taut_joint_set_break(joint, 0, most));
        const taut_events events = step_for_events(world);
        ASSERT_EQ(events.broken_count, most == 1.9e4f ? 1u : 0u);
        for (uint32_t i = 0; i < events.broken_count; ++i) EXPECT_NEAR(events.broken[i].torque.z, 1.962e4, 10);
        EXPECT_OK(taut_world_destroy(world));
    }
}

// In the order of slots, with one event each; they are gone with the next step.
TEST(Break, ManyAtOnce) {
    const taut_world world = make_world();
    std::vector<taut_joint> joints;
    for (int i = 0; i < 20; ++i) {
        const taut_body bob = add_particle(world, i, 0, 0);
        taut_distance_joint_def def;
        taut_distance_joint_def_init(&def);
        def.base.body_b = bob;
        def.base.frame_a.position = {static_cast<double>(i), 1, 0};
        def.base.break_force = i % 2 == 0 ? 1.0f : 100.0f;
        def.base.user_data = static_cast<uint64_t>(i);
        taut_joint joint;
        ASSERT_OK(taut_world_add_distance_joint(world, &def, &joint));
        joints.push_back(joint);
    }
    taut_events events = step_for_events(world);
    ASSERT_EQ(events.broken_count, 10u);
    for (uint32_t i = 0; i < 10; ++i) {
        EXPECT_EQ(events.broken[i].user_data, 2 * i);
        EXPECT_EQ(events.broken[i].joint.bits, joints[2 * i].bits);
    }
    events = step_for_events(world);
    EXPECT_EQ(events.broken_count, 0u);
    EXPECT_EQ(counts_of(world).joints, 10u);
    EXPECT_OK(taut_world_destroy(world));
}

// Links of 1 kg on threads that bear less than the weight at their end; with each the joint to the link before.
struct Chain {
    std::vector<taut_joint> joints;

    Chain(taut_world world, double x, int links, float strength) {
        taut_body last = {0};
        for (int i = 0; i < links; ++i) {
            taut_particle_def link;
            taut_particle_def_init(&link);
            link.position = {x, -0.5 * i, 0};
            link.mass = i + 1 < links ? 1.0f : 10.0f;
            taut_distance_joint_def def;
            taut_distance_joint_def_init(&def);
            def.base.body_a = last;
            if (i == 0) def.base.frame_a.position = {x, 0.5, 0};
            EXPECT_OK(taut_world_add_particle(world, &link, &def.base.body_b));
            def.base.break_force = strength;
            def.base.user_data = static_cast<uint64_t>(i);
            taut_joint joint;
            EXPECT_OK(taut_world_add_distance_joint(world, &def, &joint));
            joints.push_back(joint);
            last = def.base.body_b;
        }
    }
};

// The uppermost carries most. With it the others are relieved: they fall as they are.
TEST(Break, OnlyTheWorstOfThoseThatCarryOneForce) {
    for (uint32_t solver = 0; solver < TAUT_SOLVER_MINIMISATION; ++solver) {
        taut_world_def world_def;
        taut_world_def_init(&world_def);
        world_def.solver = static_cast<taut_solver>(solver);
        taut_world world = {0};
        ASSERT_OK(taut_world_create(&world_def, &world));
        const Chain chain(world, 0, 9, 0);
        for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(world));
        for (const taut_joint joint : chain.joints) ASSERT_OK(taut_joint_set_break(joint, 60, 0));
        const taut_events events = step_for_events(world);
        ASSERT_EQ(events.broken_count, 1u) << solver;
        EXPECT_EQ(events.broken[0].user_data, 0u) << solver;
        for (int i = 0; i < 30 && solver == TAUT_SOLVER_BLOCK_LDLT; ++i)
            EXPECT_EQ(step_for_events(world).broken_count, 0u);
        EXPECT_OK(taut_world_destroy(world));
    }
}

// Each mechanism has a worst of its own, also where they hang from one body that does not move.
TEST(Break, OneOfEachMechanism) {
    const taut_world world = make_world();
    std::vector<Chain> chains;
    for (int i = 0; i < 5; ++i) chains.emplace_back(world, i, 4 + i, 60.0f);
    const taut_events events = step_for_events(world);
    ASSERT_EQ(events.broken_count, 5u);
    for (uint32_t i = 0; i < 5; ++i) EXPECT_EQ(events.broken[i].joint.bits, chains[i].joints[0].bits);
    EXPECT_OK(taut_world_destroy(world));
}

// Two threads side by side carry half each: the older one goes, wherever its slot is, and the other then has it all.
TEST(Break, TheOldestOfLikeOnes) {
    const taut_world world = make_world();
    const taut_body weight = add_particle(world, 0, 0, 0);
    const auto thread = [&](double x, uint64_t name) {
        taut_distance_joint_def def;
        taut_distance_joint_def_init(&def);
        def.base.body_b = weight;
        def.base.frame_a.position = {x, 2, 0};
        def.base.break_force = 5;
        def.base.user_data = name;
        taut_joint joint;
        EXPECT_OK(taut_world_add_distance_joint(world, &def, &joint));
        return joint;
    };
    const taut_joint first = thread(5, 0);
    thread(1, 1);
    ASSERT_OK(taut_joint_remove(first));
    thread(-1, 2);
    taut_events events = step_for_events(world);
    ASSERT_EQ(events.broken_count, 1u);
    EXPECT_EQ(events.broken[0].user_data, 1u);
    events = step_for_events(world);
    ASSERT_EQ(events.broken_count, 1u);
    EXPECT_EQ(events.broken[0].user_data, 2u);
    EXPECT_OK(taut_world_destroy(world));
}

// Two boxes that a joint kept from colliding do so once it broke.
TEST(Break, LetsItsBodiesCollide) {
    const taut_world world = make_world();
    const taut_shape box = add_box(world);
    const taut_body a = add_body(world, body_def(TAUT_BODY_STATIC, box, 0, 0, 0));
    const taut_body b = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0, 0.999, 0));
    taut_joint joint = add_ball(world, a, b, {0, 0.5, 0}, {0, -0.499, 0});
    for (int i = 0; i < 10; ++i) ASSERT_OK(taut_world_step(world));
    uint32_t count = 0;
    ASSERT_OK(taut_world_get_contacts(world, nullptr, 0, &count));
    ASSERT_OK(taut_joint_set_break(joint, 1, 0));
    EXPECT_EQ(step_for_events(world).broken_count, 1u);
    EXPECT_EQ(step_for_events(world).begin_count, 1u);
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(world));
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(b, &pose));
    EXPECT_NEAR(pose.position.y, 1, 0.01);  // it stands on the other
    EXPECT_OK(taut_world_destroy(world));
}

TEST(CollideConnected, ChangesBothWays) {
    const TwoBoxes boxes(0.999);
    const taut_world world = boxes.world;
    const taut_joint joint = add_ball(world, boxes.a, boxes.b, {0.4995, 0, 0}, {-0.4995, 0, 0});
    taut_contact contacts[8];
    for (uint32_t collide : {0u, 1u, 0u, 1u}) {
        ASSERT_OK(taut_joint_set_collide_connected(joint, collide));
        const taut_events events = step_for_events(world);
        uint32_t count = 99;
        ASSERT_OK(taut_world_get_contacts(world, contacts, 8, &count));
        EXPECT_EQ(count, collide ? 4u : 0u);
        EXPECT_EQ(events.begin_count, collide);
    }
}

}  // namespace
