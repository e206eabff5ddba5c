// Cables: arguments, read-back, handles, removal, memory.
#include <cmath>
#include <vector>

#include "calls.h"

using namespace taut_test;

namespace {

taut_cable_def cable_def(taut_cable_kind kind = TAUT_CABLE_LINKS) {
    taut_cable_def def;
    taut_cable_def_init(&def);
    def.kind = kind;
    def.end[0].attached = def.end[1].attached = 1;
    def.end[0].anchor = {0, 20, 0};
    def.end[1].anchor = {4, 20, 0};
    def.segment_count = 8;
    def.user_data = 77;
    return def;
}

taut_cable add_cable(taut_world world, const taut_cable_def& def) {
    taut_cable cable = {0};
    EXPECT_EQ(taut_world_add_cable(world, &def, &cable), TAUT_OK) << taut_last_error();
    return cable;
}

std::vector<taut_body> bodies_of(taut_cable cable) {
    std::vector<taut_body> out(300);
    uint32_t count = 0;
    EXPECT_EQ(taut_cable_get_bodies(cable, out.data(), 300, &count), TAUT_OK) << taut_last_error();
    out.resize(count);
    return out;
}

taut_joint end_joint(taut_cable cable, uint32_t end) {
    taut_joint joint = {1};
    EXPECT_EQ(taut_cable_get_end_joint(cable, end, &joint), TAUT_OK) << taut_last_error();
    return joint;
}

std::vector<Call<taut_cable>> cable_calls() {
    static taut_pos points[300];
    static float tensions[300];
    static taut_body bodies[300];
    static taut_joint joint;
    static uint32_t count;
    static uint64_t data;
    static float number;
    return {
        {"taut_cable_get_user_data", [](taut_cable c) { return taut_cable_get_user_data(c, &data); }},
        {"taut_cable_get_length", [](taut_cable c) { return taut_cable_get_length(c, &number); }},
        {"taut_cable_get_points", [](taut_cable c) { return taut_cable_get_points(c, points, 300, &count); }},
        {"taut_cable_get_tensions", [](taut_cable c) { return taut_cable_get_tensions(c, tensions, 300, &count); }},
        {"taut_cable_get_bodies", [](taut_cable c) { return taut_cable_get_bodies(c, bodies, 300, &count); }},
        {"taut_cable_get_end_joint", [](taut_cable c) { return taut_cable_get_end_joint(c, 0, &joint); }},
        {"taut_cable_get_reel_speed", [](taut_cable c) { return taut_cable_get_reel_speed(c, 0, &number); }},
        {"taut_cable_set_reel_speed", [](taut_cable c) { return taut_cable_set_reel_speed(c, 0, 0.1f, 1); }},
        {"taut_cable_reel", [](taut_cable c) { return taut_cable_reel(c, 0, 0.1f); }},
        {"taut_cable_cut", [](taut_cable c) { return taut_cable_cut(c, 0); }},
        {"taut_cable_remove", [](taut_cable c) { return taut_cable_remove(c); }},
    };
}

void expect_all(taut_cable cable, taut_result wanted) {
    for (const auto& call : cable_calls()) {
        EXPECT_EQ(call.run(cable), wanted) << call.name << ": " << taut_last_error();
        if (wanted != TAUT_OK) {
            EXPECT_TRUE(contains(taut_last_error(), call.name)) << taut_last_error();
        }
    }
}

TEST(Cable, Defaults) {
    taut_cable_def def;
    taut_cable_def_init(&def);
    EXPECT_EQ(def.struct_size, sizeof def);
    EXPECT_EQ(def.kind, TAUT_CABLE_LINKS);
    EXPECT_EQ(def.diameter, 0.02f);
    EXPECT_EQ(def.mass_per_metre, 1);
    EXPECT_EQ(def.material.friction, 0.5f);
    EXPECT_EQ(def.filter.category, 1u);
    EXPECT_EQ(def.filter.mask, UINT64_MAX);
    EXPECT_EQ(def.gravity_scale, 1);
    EXPECT_EQ(def.end[0].attached + def.end[1].attached, 0u);
    taut_cable_def_init(nullptr);
}

TEST(Cable, ReadsBack) {
    for (taut_cable_kind kind : {TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS}) {
        Populated p;
        const Counts before = counts_of(p.world);
        const taut_cable cable = add_cable(p.world, cable_def(kind));
        const bool links = kind == TAUT_CABLE_LINKS;
        const uint32_t n = links ? 8 : 9;
        const uint32_t joints = links ? 9 : 2;  // of particles those of the ends alone
        EXPECT_EQ(counts_of(p.world), (Counts{before.bodies + n, before.shapes + 8, before.joints + joints}));
        uint64_t data = 0;
        ASSERT_OK(taut_cable_get_user_data(cable, &data));
        EXPECT_EQ(data, 77u);
        float length = 0, mass = 0, total = 0;
        ASSERT_OK(taut_cable_get_length(cable, &length));
        EXPECT_NEAR(length, 4, 1e-6);
        taut_pos points[9];
        uint32_t count = 0;
        EXPECT_EQ(taut_cable_get_points(cable, points, 8, &count), TAUT_TOO_SMALL);
        EXPECT_EQ(count, 9u);
        EXPECT_EQ(taut_cable_get_points(cable, nullptr, 9, &count), TAUT_NULL_POINTER);
        EXPECT_EQ(taut_cable_get_points(cable, points, 9, nullptr), TAUT_NULL_POINTER);
        ASSERT_OK(taut_cable_get_points(cable, points, 9, &count));
        for (int i = 0; i < 9; ++i) EXPECT_NEAR(points[i].x, 0.5 * i, 1e-9);
        float tensions[8];
        EXPECT_EQ(taut_cable_get_tensions(cable, tensions, 7, &count), TAUT_TOO_SMALL);
        EXPECT_EQ(count, 8u);
        ASSERT_OK(taut_cable_get_tensions(cable, tensions, 8, &count));
        for (float tension : tensions) EXPECT_EQ(tension, 0);  // not solved yet
        const auto bodies = bodies_of(cable);
        ASSERT_EQ(bodies.size(), n);
        for (taut_body body : bodies) {
            taut_vec3 centre;
            taut_sym3 inertia;
            ASSERT_OK(taut_body_get_mass(body, &mass, &centre, &inertia));
            total += mass;
            taut_cable of = {0};
            ASSERT_OK(taut_body_get_cable(body, &of));
            EXPECT_EQ(of.bits, cable.bits);
            ASSERT_OK(taut_body_get_user_data(body, &data));
            EXPECT_EQ(data, 77u);
        }
        EXPECT_NEAR(total, 4, 1e-5);
        taut_cable of = cable;
        ASSERT_OK(taut_body_get_cable(p.crate, &of));
        EXPECT_EQ(of.bits, 0u);
        expect_all(cable, TAUT_OK);  // the last of them removes it
        EXPECT_EQ(counts_of(p.world), before);
        EXPECT_OK(taut_world_step(p.world));
    }
}

TEST(Cable, RefusesWhatItCannotBe) {
    Populated p;
    const taut_world other = make_world();
    const taut_body foreign = add_particle(other, 0, 0, 0);
    const Watch watch(p.world);
    const taut_pos path[3] = {{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}};
    const auto refuse = [&](const char* text, taut_result wanted, const std::function<void(taut_cable_def&)>& change) {
        taut_cable_def def = cable_def();
        change(def);
        taut_cable out = {5};
        EXPECT_EQ(taut_world_add_cable(p.world, &def, &out), wanted) << text << ": " << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), text)) << text << ": " << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_add_cable")) << taut_last_error();
        EXPECT_EQ(out.bits, 5u);
    };
    constexpr taut_result kBad = TAUT_INVALID_ARGUMENT;
    using Def = taut_cable_def;
    refuse("struct_size", TAUT_STRUCT_SIZE, [](Def& d) { d.struct_size -= 4; });
    refuse("kind", kBad, [](Def& d) { d.kind = static_cast<taut_cable_kind>(2); });
    for (float bad : {NAN, -1.0f, INFINITY}) {
        refuse("diameter", kBad, [&](Def& d) { d.diameter = bad; });
        refuse("mass_per_metre", kBad, [&](Def& d) { d.mass_per_metre = bad; });
        refuse("stretch_compliance", kBad, [&](Def& d) { d.stretch_compliance = bad; });
        refuse("stretch_damping", kBad, [&](Def& d) { d.stretch_damping = bad; });
        refuse("bending_stiffness", kBad, [&](Def& d) { d.bending_stiffness = bad; });
        refuse("bending_damping", kBad, [&](Def& d) { d.bending_damping = bad; });
        refuse("material.friction", kBad, [&](Def& d) { d.material.friction = bad; });
        refuse("material.restitution", kBad, [&](Def& d) { d.material.restitution = bad; });
        refuse("segment_length", kBad, [&](Def& d) { d.segment_count = 0, d.segment_length = bad; });
        refuse("length", kBad, [&](Def& d) { d.length = bad; });
        refuse("end[1].anchor", kBad, [&](Def& d) { d.end[1].anchor.z = bad < 0 ? -1e8 : static_cast<double>(bad); });
    }
    refuse("gravity_scale", kBad, [](Def& d) { d.gravity_scale = NAN; });
    refuse("filter.reserved", kBad, [](Def& d) { d.filter.reserved = 1; });
    refuse("self_collision", kBad, [](Def& d) { d.self_collision = 2; });
    refuse("filter.group", kBad, [](Def& d) { d.filter.group = 1; });
    refuse("filter.group", kBad, [](Def& d) { d.filter.group = -1, d.self_collision = 1; });
    refuse("end[0].attached", kBad, [](Def& d) { d.end[0].attached = 2; });
    refuse("clamped without", kBad, [](Def& d) { d.end[0].clamped = 1; });
    refuse("not attached", kBad, [](Def& d) { d.end[0].attached = 0; });  // and no points
    refuse("not attached has a body", kBad, [&](Def& d) { d.end[0].attached = 0, d.end[0].body = p.bob; });
    refuse("segment_count", kBad, [](Def& d) { d.segment_count = TAUT_CABLE_MAX_SEGMENTS + 1; });
    refuse("segment_count", kBad, [](Def& d) { d.segment_length = 1; });
    refuse("points", TAUT_NULL_POINTER, [](Def& d) { d.point_count = 2; });
    refuse("point_count", kBad, [&](Def& d) { d.point_count = 1, d.points = path; });
    refuse("length of segment", kBad, [&](Def& d) {
        d.point_count = 3, d.points = path, d.segment_count = 0, d.end[0].attached = d.end[1].attached = 0;
    });
    refuse("length", kBad, [&](Def& d) { d.point_count = 3, d.points = path, d.length = 9; });
    refuse("less than the ends are apart", kBad, [](Def& d) { d.length = 3; });
    refuse("cannot sag", kBad, [](Def& d) { d.length = 5, d.segment_count = 1; });
    refuse("distance of the ends", kBad, [](Def& d) { d.end[1].anchor = d.end[0].anchor; });
    refuse("length of segment", kBad, [](Def& d) { d.segment_count = 4096; });
    refuse("off its particle", kBad, [&](Def& d) { d.end[0].body = p.bob; });
    refuse("end[0].body", TAUT_STALE_HANDLE, [](Def& d) { d.end[0].body = {99}; });
    refuse("end[1].body", TAUT_FOREIGN_HANDLE, [&](Def& d) { d.end[1].body = foreign; });
    taut_cable out;
    EXPECT_EQ(taut_world_add_cable(p.world, nullptr, &out), TAUT_NULL_POINTER);
    const taut_cable_def good = cable_def();
    EXPECT_EQ(taut_world_add_cable(p.world, &good, nullptr), TAUT_NULL_POINTER);
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(taut_world_destroy(other));
}

TEST(Cable, ReelingIsChecked) {
    Populated p;
    taut_cable_def def = cable_def();
    const taut_pos path[2] = {{0, 20, 0}, {4, 20, 0}};
    def.points = path;
    def.point_count = 2;
    def.end[1] = {};
    const taut_cable cable = add_cable(p.world, def);
    const Watch watch(p.world);
    EXPECT_EQ(taut_cable_set_reel_speed(cable, 1, 1, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "free")) << taut_last_error();
    EXPECT_EQ(taut_cable_reel(cable, 1, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cable_set_reel_speed(cable, 2, 1, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cable_set_reel_speed(cable, 0, NAN, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cable_set_reel_speed(cable, 0, 1, -1), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cable_set_reel_speed(cable, 0, 15.1f, 0), TAUT_INVALID_ARGUMENT);  // 0.5 segments of 0.5 m at 60 Hz
    EXPECT_EQ(taut_cable_reel(cable, 0, INFINITY), TAUT_INVALID_ARGUMENT);
    float speed;
    taut_joint joint;
    EXPECT_EQ(taut_cable_get_reel_speed(cable, 2, &speed), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cable_get_end_joint(cable, 2, &joint), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(end_joint(cable, 1).bits, 0u);
    EXPECT_TRUE(watch.unchanged());
    // What is set is part of the state: it decides the future.
    ASSERT_OK(taut_cable_set_reel_speed(cable, 0, 15, 30));
    EXPECT_FALSE(watch.unchanged());
    const taut_joint held = end_joint(cable, 0);
    for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(p.world));
    ASSERT_OK(taut_cable_get_reel_speed(cable, 0, &speed));
    EXPECT_NEAR(speed, 15, 1e-4);
    EXPECT_EQ(end_joint(cable, 0).bits, held.bits);
    EXPECT_GT(bodies_of(cable).size(), 15u);
}

TEST(Cable, HandlesGoStale) {
    Populated p;
    expect_all({0}, TAUT_STALE_HANDLE);
    expect_all({0x123456789abcdef0}, TAUT_STALE_HANDLE);
    const taut_cable cable = add_cable(p.world, cable_def());
    EXPECT_TRUE(taut_cable_is_valid(cable));
    ASSERT_OK(taut_cable_remove(cable));
    EXPECT_FALSE(taut_cable_is_valid(cable));
    expect_all(cable, TAUT_STALE_HANDLE);
    const taut_cable next = add_cable(p.world, cable_def());
    expect_all(cable, TAUT_STALE_HANDLE);
    EXPECT_TRUE(taut_cable_is_valid(next));
    EXPECT_FALSE(taut_cable_is_valid({0}));
}

// A cable's bodies stay; its joints and what it hangs on may go.
TEST(Cable, LosesWhatIsTakenFromIt) {
    for (taut_cable_kind kind : {TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS}) {
        Populated p;
        taut_cable_def def = cable_def(kind);
        def.end[1].body = p.wedge;
        def.end[1].anchor = {0, 0, 0};
        const taut_cable cable = add_cable(p.world, def);
        const auto bodies = bodies_of(cable);
        Watch watch(p.world);
        EXPECT_EQ(taut_body_remove(bodies[3]), TAUT_IN_USE);
        EXPECT_TRUE(contains(taut_last_error(), "cable")) << taut_last_error();
        EXPECT_TRUE(watch.unchanged());
        // What the end hangs on: the end is free.
        EXPECT_NE(end_joint(cable, 1).bits, 0u);
        ASSERT_OK(taut_cable_set_reel_speed(cable, 1, 1, 0));
        ASSERT_OK(taut_world_step(p.world));
        ASSERT_OK(taut_body_remove(p.wedge));
        EXPECT_EQ(end_joint(cable, 1).bits, 0u);
        EXPECT_EQ(taut_cable_reel(cable, 1, 1), TAUT_INVALID_ARGUMENT);
        float speed = 1, length = 0;
        ASSERT_OK(taut_cable_get_reel_speed(cable, 1, &speed));
        EXPECT_EQ(speed, 0);
        ASSERT_OK(taut_world_step(p.world));
        // Something tied to a point, which that point takes with it when it is hauled in.
        const auto now = bodies_of(cable);
        const taut_joint hook = add_ball(p.world, now[1], p.bob);
        // Hauled in, cut behind the first segment, hauled in again: it stops at the cut.
        ASSERT_OK(taut_cable_reel(cable, 0, -2));
        for (int i = 0; i < 60; ++i) ASSERT_OK(taut_world_step(p.world));
        EXPECT_FALSE(kind == TAUT_CABLE_PARTICLES && taut_joint_is_valid(hook));
        const auto left = bodies_of(cable);
        ASSERT_GT(left.size(), 3u);
        std::vector<taut_pos> points(left.size() + 1);
        uint32_t count = 0;
        ASSERT_OK(taut_joint_remove(end_joint(cable, 0)));
        EXPECT_EQ(end_joint(cable, 0).bits, 0u);
        ASSERT_OK(taut_world_step(p.world));
        ASSERT_OK(taut_cable_get_points(cable, points.data(), static_cast<uint32_t>(points.size()), &count));
        ASSERT_OK(taut_cable_get_length(cable, &length));
        EXPECT_GT(length, 0.5f);
        // Others' joints on a cable's body go with the cable.
        const taut_joint other = add_ball(p.world, left[1], p.crate);
        ASSERT_OK(taut_cable_remove(cable));
        EXPECT_FALSE(taut_joint_is_valid(other));
        for (taut_body body : left) EXPECT_FALSE(taut_body_is_valid(body));
        ASSERT_OK(taut_world_step(p.world));
    }
}

// Cut in the middle of a reel.
TEST(Cable, StopsReelingAtACut) {
    for (taut_cable_kind kind : {TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS}) {
        const taut_world world = make_world();
        const taut_cable cable = add_cable(world, cable_def(kind));
        ASSERT_OK(taut_world_step(world));
        const auto bodies = bodies_of(cable);
        ASSERT_OK(taut_cable_cut(cable, 1));
        ASSERT_OK(taut_cable_set_reel_speed(cable, 0, -2, 0));
        for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(world));
        EXPECT_GE(bodies_of(cable).size(), bodies.size() - 1);
        ASSERT_OK(taut_cable_set_reel_speed(cable, 0, 2, 0));
        for (int i = 0; i < 120; ++i) ASSERT_OK(taut_world_step(world));
        EXPECT_GT(bodies_of(cable).size(), bodies.size() + 3);
        std::vector<float> tensions(100);
        uint32_t count = 0;
        ASSERT_OK(taut_cable_get_tensions(cable, tensions.data(), 100, &count));
        for (uint32_t i = 0; i < count; ++i) EXPECT_TRUE(std::isfinite(tensions[i]));
        EXPECT_OK(taut_world_destroy(world));
    }
}

// What hung below falls, and only that.
TEST(Cable, IsCutWhereItIsAsked) {
    for (taut_cable_kind kind : {TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS}) {
        const taut_world world = make_world();
        taut_cable_def def = cable_def(kind);
        def.end[1] = {};
        const taut_pos points[2] = {{0, 10, 0}, {0, 6, 0}};
        def.points = points;
        def.point_count = 2;
        def.end[0].anchor = points[0];
        const taut_cable cable = add_cable(world, def);
        const uint32_t last = kind == TAUT_CABLE_LINKS ? 6 : 7;
        EXPECT_EQ(taut_cable_cut(cable, last + 1), TAUT_INVALID_ARGUMENT);
        ASSERT_OK(taut_world_step(world));
        ASSERT_OK(taut_cable_cut(cable, 3));
        ASSERT_OK(taut_cable_cut(cable, 3));  // it is
        for (int i = 0; i < 30; ++i) ASSERT_OK(taut_world_step(world));
        taut_pos at[9];
        uint32_t count = 0;
        ASSERT_OK(taut_cable_get_points(cable, at, 9, &count));
        EXPECT_NEAR(at[3].y, 8.5, 0.02);
        EXPECT_NEAR(at[5].y, 7.5 - 0.5 * 9.81 * 0.25, 0.1);
        EXPECT_OK(taut_world_destroy(world));
    }
}

TEST(Cable, LockedWorldsRefuse) {
    Ledger ledger;
    Populated p(ledger.hooks());
    const taut_cable cable = add_cable(p.world, cable_def());
    int entered = 0;
    ledger.on_allocate = [&] {
        ++entered;
        expect_all(cable, TAUT_LOCKED);
        EXPECT_FALSE(taut_cable_is_valid(cable));
    };
    ASSERT_OK(taut_world_step(p.world));
    EXPECT_GT(entered, 0);
    ledger.on_allocate = nullptr;
    expect_all(cable, TAUT_OK);
}

// Any allocation of a call or of a reeling step may fail: the call changes nothing, the step can be taken again.
TEST(Cable, OutOfMemoryIsAResult) {
    for (taut_cable_kind kind : {TAUT_CABLE_PARTICLES, TAUT_CABLE_LINKS}) {
        for (uint64_t n = 1; n <= 120; ++n) {
            SCOPED_TRACE(testing::Message() << "kind " << kind << " call " << n);
            Ledger ledger;
            {
                const taut_world world = make_world(ledger.hooks());
                ASSERT_OK(taut_world_step(world));
                const Watch watch(world);
                ledger.fail_from = ledger.calls + n;
                ledger.fail_until = ledger.fail_from + 1;
                taut_cable_def def = cable_def(kind);
                def.length = 5;
                taut_cable cable = {0};
                if (const taut_result result = taut_world_add_cable(world, &def, &cable); result != TAUT_OK) {
                    ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << taut_last_error();
                    ASSERT_TRUE(watch.unchanged());
                    ASSERT_OK(taut_world_add_cable(world, &def, &cable));
                }
                ASSERT_OK(taut_cable_set_reel_speed(cable, 0, 5, 0));
                ASSERT_OK(taut_cable_set_reel_speed(cable, 1, -2, 0));
                int failed = 0;
                for (int i = 0; i < 40; ++i) {
                    const taut_result result = taut_world_step(world);
                    ASSERT_TRUE(result == TAUT_OK || (result == TAUT_OUT_OF_MEMORY && ++failed < 2));
                }
                float length = 0;
                ASSERT_OK(taut_cable_get_length(cable, &length));
                EXPECT_NEAR(length, 5 + 3.0f * static_cast<float>(40) / 60, 0.11f);
                ASSERT_OK(taut_cable_remove(cable));
                EXPECT_EQ(counts_of(world), Counts{});
                EXPECT_OK(taut_world_destroy(world));
            }
            EXPECT_TRUE(ledger.empty());
            EXPECT_EQ(ledger.errors, 0u);
            if (testing::Test::HasFailure()) return;
        }
    }
}

}  // namespace
