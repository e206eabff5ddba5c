// Refusals and readings of contact events, sensors and the pre-solve function.
#include "support.h"

using namespace taut_test;

namespace {

struct EventCalls : testing::Test {
    // A collider made by a def with a change reads as that def.
    template <class Change>
    void expect_kept(Change change) {
        taut_collider_def def, read;
        taut_collider_def_init(&def);
        def.shape = p.box;
        change(def);
        taut_collider out{};
        ASSERT_OK(taut_body_add_collider(p.crate, &def, &out));
        ASSERT_OK(taut_collider_get_def(out, &read));
        EXPECT_EQ(read.flags, def.flags);
        EXPECT_EQ(read.contact_events, def.contact_events);
        EXPECT_EQ(read.one_way.z, def.one_way.z);
        EXPECT_EQ(read.friction.static_friction, def.friction.static_friction);
        EXPECT_EQ(read.friction.slide_factor, def.friction.slide_factor);
        EXPECT_EQ(read.friction.slide_direction.y, def.friction.slide_direction.y);
        ASSERT_OK(taut_collider_remove(out));
    }

    Populated p;
};

template <class Call>
void expect_refused(taut_world world, const char* text, Call&& call) {
    const Watch watch(world);
    EXPECT_EQ(call(), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
    EXPECT_TRUE(watch.unchanged());
}

TEST_F(EventCalls, RefuseWhatIsOutOfRange) {
    expect_refused(p.world, "taut_world_set_contact_events: contact_events is 16",
                   [&] { return taut_world_set_contact_events(p.world, 16); });
    expect_refused(p.world, "taut_body_set_contact_events: contact_events is 99",
                   [&] { return taut_body_set_contact_events(p.crate, 99); });
    expect_refused(p.world, "taut_collider_set_contact_events: contact_events is 4294967295",
                   [&] { return taut_collider_set_contact_events(p.collider, UINT32_MAX); });
    expect_refused(p.world, "taut_collider_set_sensor: sensor is 2",
                   [&] { return taut_collider_set_sensor(p.collider, 2); });
    expect_refused(p.world, "taut_collider_set_pre_solve: pre_solve is",
                   [&] { return taut_collider_set_pre_solve(p.collider, -1); });
    for (float bad : {NAN, INFINITY, -1.0f, 1.0001e4f})
        expect_refused(p.world, "hit_speed", [&] { return taut_world_set_hit_speed(p.world, bad); });
    for (float bad : {NAN, INFINITY, 1.0001e4f})
        expect_refused(p.world, "direction.z", [&] { return taut_collider_set_one_way(p.collider, {0, 0, bad}); });
    const auto refuse = [&](const char* text, const taut_friction& friction) {
        expect_refused(p.world, text, [&] { return taut_collider_set_friction(p.collider, &friction); });
    };
    for (float bad : {NAN, INFINITY, -0.1f, 100.1f})
        refuse("taut_collider_set_friction: static_friction is", {bad, 0, {}, 0});
    for (float bad : {NAN, INFINITY, -0.1f, 1.1f}) refuse("slide_factor is", {0, bad, {}, 0});
    for (float bad : {NAN, INFINITY, 1.0001e4f}) refuse("slide_direction.y", {0, 0, {0, bad, 0}, 0});
    refuse("reserved", {0, 0, {}, 1});
    EXPECT_EQ(taut_collider_set_friction(p.collider, nullptr), TAUT_NULL_POINTER);
}

TEST_F(EventCalls, DefsRefuseWhatIsOutOfRange) {
    taut_collider_def def;
    taut_collider_def_init(&def);
    def.shape = p.box;
    const auto refuse = [&](const char* text, auto change) {
        taut_collider_def bad = def;
        change(bad);
        taut_collider out{};
        expect_refused(p.world, text, [&] { return taut_body_add_collider(p.crate, &bad, &out); });
    };
    refuse("flags is 16", [](auto& d) { d.flags = 16; });
    refuse("which only a particle", [](auto& d) { d.flags = TAUT_COLLIDER_GRAIN; });
    refuse("contact_events is 16", [](auto& d) { d.contact_events = 16; });
    refuse("one_way.x", [](auto& d) { d.one_way.x = NAN; });
    refuse("reserved", [](auto& d) { d.reserved = 1; });
    refuse("friction.static_friction is -1", [](auto& d) { d.friction.static_friction = -1; });
    refuse("friction.slide_factor is 2", [](auto& d) { d.friction.slide_factor = 2; });
    refuse("friction.slide_direction.x", [](auto& d) { d.friction.slide_direction.x = NAN; });
    refuse("friction.reserved", [](auto& d) { d.friction.reserved = 1; });
    taut_body_def body = body_def(TAUT_BODY_DYNAMIC, p.box);
    taut_body out{};
    body.collider_flags = 16;
    expect_refused(p.world, "collider_flags is 16", [&] { return taut_world_add_body(p.world, &body, &out); });
    taut_particle_def grain;
    taut_particle_def_init(&grain);
    grain.contact_events = 16;
    expect_refused(p.world, "contact_events is 16", [&] { return taut_world_add_particle(p.world, &grain, &out); });
    for (float bad : {NAN, -1.0f, 2e4f}) {
        taut_world_def world;
        taut_world_def_init(&world);
        world.hit_speed = bad;
        taut_world made{};
        EXPECT_EQ(taut_world_create(&world, &made), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "hit_speed")) << taut_last_error();
    }
}

TEST_F(EventCalls, ReadAsTheyWereSet) {
    expect_kept([](taut_collider_def& d) { d.flags = TAUT_COLLIDER_PRE_SOLVE | TAUT_COLLIDER_SENSES_STATIC; });
    expect_kept([](taut_collider_def& d) { d.contact_events = TAUT_CONTACT_EVENTS_HIT; });
    expect_kept([](taut_collider_def& d) { d.one_way = {0, 0, -1}; });
    expect_kept([](taut_collider_def& d) { d.friction = {0.75f, 0.25f, {0, -1, 0}, 0}; });
    ASSERT_OK(taut_world_set_hit_speed(p.world, 3));
    ASSERT_OK(taut_world_set_contact_events(p.world, TAUT_CONTACT_EVENTS_ALL));
    taut_world_def def;
    ASSERT_OK(taut_world_get_def(p.world, &def));
    EXPECT_EQ(def.hit_speed, 3);
    EXPECT_EQ(def.contact_events, TAUT_CONTACT_EVENTS_ALL);
}

TEST_F(EventCalls, OverlapsNeedRoom) {
    ASSERT_OK(taut_collider_set_sensor(p.collider, 1));
    const taut_body visitor = add_body(p.world, body_def(TAUT_BODY_KINEMATIC, p.box, 0.1, 0.5, 0));
    ASSERT_OK(taut_world_step(p.world));
    uint32_t count = 7;
    EXPECT_EQ(taut_collider_get_overlaps(p.collider, nullptr, 0, &count), TAUT_TOO_SMALL);
    EXPECT_EQ(count, 1u);
    EXPECT_EQ(taut_collider_get_overlaps(p.collider, nullptr, 1, &count), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_collider_get_overlaps(p.collider, nullptr, 1, nullptr), TAUT_NULL_POINTER);
    taut_collider found{};
    ASSERT_OK(taut_collider_get_overlaps(p.collider, &found, 1, &count));
    taut_body owner{};
    ASSERT_OK(taut_collider_get_body(found, &owner));
    EXPECT_EQ(owner.bits, visitor.bits);
    ASSERT_OK(taut_body_remove(visitor));  // its handle is stale, its visit ends with the next step
    ASSERT_OK(taut_collider_get_overlaps(p.collider, &found, 1, &count));
    EXPECT_EQ(count, 0u);
    ASSERT_OK(taut_world_step(p.world));
    taut_events events;
    ASSERT_OK(taut_world_get_events(p.world, &events));
    ASSERT_EQ(events.sensor_leave_count, 1u);
    EXPECT_EQ(events.sensor_leave[0].visitor_body.bits, visitor.bits);
}

}  // namespace
