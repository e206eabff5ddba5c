// What the calls on joints, events and contacts do.
#include <cmath>
#include <vector>

#include "joint_support.h"

using namespace taut_test;

namespace {

struct Joints : testing::Test {
    Populated p;
};

TEST_F(Joints, TellKindEndsAndAnchors) {
    taut_joint_kind kind;
    ASSERT_OK(taut_joint_get_kind(p.ball, &kind));
    EXPECT_EQ(kind, TAUT_JOINT_BALL);
    ASSERT_OK(taut_joint_get_kind(p.rod, &kind));
    EXPECT_EQ(kind, TAUT_JOINT_DISTANCE);
    taut_body a, b;
    ASSERT_OK(taut_joint_get_bodies(p.rod, &a, &b));
    EXPECT_EQ(a.bits, p.bob.bits);
    EXPECT_EQ(b.bits, 0u);

    // Anchors are given in the body's frame, whose origin is not the wedge's centre of mass.
    taut_pos anchor_a, anchor_b;
    ASSERT_OK(set_pose(p.wedge, at(-5, 4, 0)));
    ASSERT_OK(taut_joint_get_anchors(p.ball, &anchor_a, &anchor_b));
    EXPECT_NEAR(anchor_a.x, -5, 1e-9);
    EXPECT_NEAR(anchor_a.y, 4, 1e-9);
    EXPECT_EQ(anchor_b.x, -5);
    float error;
    ASSERT_OK(taut_joint_get_error(p.ball, &error));
    EXPECT_NEAR(error, 0, 1e-9);
    ASSERT_OK(set_pose(p.wedge, at(-5, 4.3, 0.4, {0, 1, 0, 0})));
    ASSERT_OK(taut_joint_get_error(p.ball, &error));
    EXPECT_NEAR(error, 0.5, 1e-6);
}

TEST_F(Joints, ChangeLengthAndCompliance) {
    float error;
    ASSERT_OK(set_pose(p.bob, at(10, 5, 0)));
    ASSERT_OK(taut_joint_get_error(p.rod, &error));
    EXPECT_NEAR(error, 0, 1e-6);
    ASSERT_OK(taut_joint_set_length(p.rod, 2.5f));
    ASSERT_OK(taut_joint_get_error(p.rod, &error));
    EXPECT_NEAR(error, 0.5, 1e-6);
    EXPECT_OK(taut_joint_set_compliance(p.rod, 1e-3f, 5));

    const Watch watch(p.world);
    for (float bad : {NAN, INFINITY, -INFINITY, -1.0f, 0.0f, 9e-5f, 1.1e6f}) {
        EXPECT_EQ(taut_joint_set_length(p.rod, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_joint_set_length: length")) << taut_last_error();
    }
    for (float bad : {NAN, INFINITY, -INFINITY, -1.0f, 1.1e12f}) {
        EXPECT_EQ(taut_joint_set_compliance(p.rod, bad, 0), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_joint_set_compliance: compliance")) << taut_last_error();
        EXPECT_EQ(taut_joint_set_compliance(p.rod, 0, bad), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "taut_joint_set_compliance: damping")) << taut_last_error();
    }
    EXPECT_EQ(taut_joint_set_length(p.ball, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_get_kind(p.ball, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_user_data(p.ball, nullptr), TAUT_NULL_POINTER);
    taut_body body;
    taut_pos anchor;
    EXPECT_EQ(taut_joint_get_bodies(p.ball, &body, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_bodies(p.ball, nullptr, &body), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_anchors(p.ball, &anchor, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_anchors(p.ball, nullptr, &anchor), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_force(p.ball, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_joint_get_error(p.ball, nullptr), TAUT_NULL_POINTER);
    EXPECT_TRUE(watch.unchanged());
}

// A weight that hangs still: the force on end b is its weight, upwards, whichever joint holds it.
TEST(JointForce, IsTheWeightThatHangs) {
    for (bool rod : {false, true}) {
        const taut_world world = make_world();
        const taut_body bob = add_particle(world, 0, 0, 0);
        const taut_joint joint = rod ? add_rod(world, {0}, bob, {0, 1, 0}, {}) : add_ball(world, {0}, bob);
        taut_vec3 force;
        ASSERT_OK(taut_joint_get_force(joint, &force));
        EXPECT_EQ(force.y, 0);  // not solved yet
        for (int i = 0; i < 30; ++i) ASSERT_OK(taut_world_step(world));
        ASSERT_OK(taut_joint_get_force(joint, &force));
        EXPECT_NEAR(force.y, 9.81, 1e-3) << rod;
        EXPECT_NEAR(force.x, 0, 1e-6);
        EXPECT_OK(taut_world_destroy(world));
    }
}

std::vector<taut_contact> contacts_of(taut_world world) {
    std::vector<taut_contact> out(256);
    uint32_t count = 0;
    EXPECT_OK(taut_world_get_contacts(world, out.data(), 256, &count));
    out.resize(count);
    return out;
}

TEST(Contacts, OfABoxAtRest) {
    const taut_world world = make_world();
    const taut_body ground = add_body(world, body_def(TAUT_BODY_STATIC, add_plane(world)));
    const taut_body crate = add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world), 3, 0.5, 0));
    EXPECT_TRUE(contacts_of(world).empty());
    ASSERT_OK(taut_world_step(world));
    taut_events events = events_of(world);
    ASSERT_EQ(events.begin_count, 1u);
    EXPECT_EQ(events.begin[0].body_a.bits, ground.bits);
    EXPECT_EQ(events.begin[0].body_b.bits, crate.bits);
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(world));
    events = events_of(world);
    EXPECT_EQ(events.begin_count + events.end_count + events.quarantined_count, 0u);

    const std::vector<taut_contact> contacts = contacts_of(world);
    ASSERT_EQ(contacts.size(), 4u);
    double carried = 0;
    for (const taut_contact& contact : contacts) {
        EXPECT_EQ(contact.body_a.bits, ground.bits);
        EXPECT_EQ(contact.body_b.bits, crate.bits);
        EXPECT_NEAR(contact.normal.y, 1, 1e-5);
        EXPECT_NEAR(std::abs(contact.position.x - 3), 0.5, 0.01);
        EXPECT_NEAR(contact.position.y, 0, 0.01);
        EXPECT_LT(std::abs(contact.separation), 0.01f);
        EXPECT_GE(contact.friction_impulse, 0);
        carried += contact.normal_impulse;
    }
    EXPECT_NEAR(carried, 1000 * 9.81 / 60 / 4, 0.02 * 1000 * 9.81 / 60 / 4);  // the weight, over one substep

    uint32_t count = 0;
    EXPECT_EQ(taut_world_get_contacts(world, nullptr, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 4u);
    std::vector<taut_contact> room(4);
    EXPECT_EQ(taut_world_get_contacts(world, room.data(), 3, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(taut_world_get_contacts(world, nullptr, 4, &count), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_world_get_contacts(world, room.data(), 4, nullptr), TAUT_NULL_POINTER);
    EXPECT_OK(taut_world_get_contacts(world, room.data(), 4, &count));

    // The contact of a removed body ends with the next step, under the handle that it had.
    ASSERT_OK(taut_body_remove(crate));
    EXPECT_TRUE(contacts_of(world).empty());
    add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world), 3, 40, 0));  // takes the slot
    ASSERT_OK(taut_world_step(world));
    events = events_of(world);
    EXPECT_EQ(events.begin_count, 0u);
    ASSERT_EQ(events.end_count, 1u);
    EXPECT_EQ(events.end[0].body_a.bits, ground.bits);
    EXPECT_EQ(events.end[0].body_b.bits, crate.bits);
    ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(events_of(world).end_count, 0u);
    EXPECT_OK(taut_world_destroy(world));
}

// Two boxes that overlap stop colliding when a joint connects them, and collide again when it is gone.
TEST(Contacts, AreFilteredByJoints) {
    const TwoBoxes boxes(0.999);
    const taut_world world = boxes.world;
    ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(contacts_of(world).size(), 4u);
    taut_ball_joint_def def;
    taut_ball_joint_def_init(&def);
    def.base.body_a = boxes.b;
    def.base.body_b = boxes.a;
    def.base.frame_a.position = {-0.4995, 0, 0};
    def.base.frame_b.position = {0.4995, 0, 0};
    taut_joint joint;
    ASSERT_OK(taut_world_add_ball_joint(world, &def, &joint));
    ASSERT_OK(taut_world_step(world));
    EXPECT_TRUE(contacts_of(world).empty());
    EXPECT_EQ(events_of(world).end_count, 1u);
    ASSERT_OK(taut_joint_remove(joint));
    ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(contacts_of(world).size(), 4u);
    EXPECT_EQ(events_of(world).begin_count, 1u);
    // A joint that lets them collide changes nothing, and no event.
    def.base.collide_connected = 1;
    ASSERT_OK(taut_world_add_ball_joint(world, &def, &joint));
    ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(contacts_of(world).size(), 4u);
    EXPECT_EQ(events_of(world).begin_count + events_of(world).end_count, 0u);
}

TEST(Events, TellWhatMoved) {
    const taut_world world = make_world();
    const taut_body bob = add_particle(world, 0, 10, 0);
    ASSERT_OK(taut_body_set_user_data(bob, 42));
    add_body(world, body_def(TAUT_BODY_STATIC, add_box(world)));
    ASSERT_OK(taut_world_step(world));
    const taut_events events = events_of(world);
    ASSERT_EQ(events.moved_count, 1u);
    EXPECT_EQ(events.moved[0].body.bits, bob.bits);
    EXPECT_EQ(events.moved[0].user_data, 42u);
    taut_pose pose;
    ASSERT_OK(taut_body_get_pose(bob, &pose));
    EXPECT_EQ(events.moved[0].pose.position.y, pose.position.y);
    EXPECT_OK(taut_world_destroy(world));
}

}  // namespace
