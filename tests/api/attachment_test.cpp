// Attachments: arguments, read-back, handles, removal, breaking, contacts between their ends, memory.
#include <algorithm>
#include <limits>

#include "support.h"

using namespace taut_test;

namespace {

const taut_pos kAttachedSheet[] = {{0, 5, 0}, {0, 5, 1}, {1, 5, 0}, {1, 5, 1}};
const uint32_t kAttachedTriangles[] = {0, 1, 3, 0, 3, 2};
const taut_pos kAttachedCube[] = {{0, 7, 0}, {1, 7, 0}, {1, 7, 1}, {0, 7, 1},
                                  {0, 8, 0}, {1, 8, 0}, {1, 8, 1}, {0, 8, 1}};
const uint32_t kAttachedCell[] = {0, 3, 2, 1, 4, 7, 6, 5};

struct Attachments : testing::Test {
    Attachments() {
        taut_world_def def;
        taut_world_def_init(&def);
        def.hooks = ledger.hooks();
        EXPECT_OK(taut_world_create(&def, &world));
        taut_cloth_def sheet;
        taut_cloth_def_init(&sheet);
        sheet.points = kAttachedSheet;
        sheet.point_count = 4;
        sheet.triangles = kAttachedTriangles;
        sheet.triangle_count = 2;
        sheet.thickness = 0.1f;
        EXPECT_OK(taut_world_add_cloth(world, &sheet, &cloth));
        taut_solid_def cube;
        taut_solid_def_init(&cube);
        cube.points = kAttachedCube;
        cube.point_count = 8;
        cube.cells = kAttachedCell;
        cube.cell_count = 1;
        cube.corners = 8;
        EXPECT_OK(taut_world_add_solid(world, &cube, &solid));
        box = add_box(world);
        crate = add_body(world, body_def(TAUT_BODY_DYNAMIC, box, 0.5, 4.4, 0.5));
        bob = add_particle(world, 3, 3, 3);
        anchored = add_body(world, body_def(TAUT_BODY_STATIC, {}));
    }
    ~Attachments() override {
        taut_world_destroy(world);
        EXPECT_TRUE(ledger.empty());
        EXPECT_EQ(ledger.errors, 0u);
    }

    taut_anchor on_cloth(taut_pos place = {0.25, 5, 0.6}) const {
        taut_anchor out{};
        EXPECT_OK(taut_cloth_find_anchor(cloth, place, &out, nullptr));
        return out;
    }
    taut_anchor on(taut_body body, taut_pos place = {}) const {
        taut_anchor out{};
        EXPECT_OK(taut_world_get_anchor(world, body, place, &out));
        return out;
    }
    // A ball between cloth and crate.
    taut_attachment_def good() const {
        taut_attachment_def def;
        taut_attachment_def_init(&def);
        def.a = on_cloth();
        def.b = on(crate, {0.25, 4.9, 0.6});
        def.user_data = 7;
        return def;
    }
    taut_attachment add(const taut_attachment_def& def) const {
        taut_attachment out{};
        EXPECT_OK(taut_world_add_attachment(world, &def, &out));
        return out;
    }
    void refused(const taut_attachment_def& def, taut_result code, const char* text) const {
        const Watch watch(world);
        taut_attachment out{0x77};
        EXPECT_EQ(taut_world_add_attachment(world, &def, &out), code) << text;
        EXPECT_TRUE(contains(taut_last_error(), text)) << taut_last_error();
        EXPECT_TRUE(contains(taut_last_error(), "taut_world_add_attachment: ")) << taut_last_error();
        EXPECT_TRUE(watch.unchanged()) << text;
        EXPECT_EQ(out.bits, 0x77u);
    }
    uint32_t count() const {
        uint32_t out = 0;
        taut_world_get_attachments(world, nullptr, 0, &out);
        return out;
    }
    uint32_t elements() const {
        taut_profile profile{};
        profile.struct_size = sizeof profile;
        EXPECT_OK(taut_world_get_profile(world, &profile));
        return profile.elements;
    }

    Ledger ledger;
    taut_world world{};
    taut_cloth cloth{};
    taut_solid solid{};
    taut_shape box{};
    taut_body crate{}, bob{}, anchored{};
};

void expect_same_place(const taut_pos& a, const taut_pos& b) {
    EXPECT_NEAR(a.x, b.x, 1e-6);
    EXPECT_NEAR(a.y, b.y, 1e-6);
    EXPECT_NEAR(a.z, b.z, 1e-6);
}

TEST_F(Attachments, ReadBackWhatTheyAre) {
    const taut_attachment_def def = good();
    const taut_attachment attachment = add(def);
    taut_attachment_def read;
    EXPECT_OK(taut_attachment_get_def(attachment, &read));
    EXPECT_EQ(read.struct_size, sizeof read);
    EXPECT_EQ(read.kind, TAUT_ATTACHMENT_BALL);
    EXPECT_EQ(read.user_data, 7u);
    EXPECT_EQ(read.a.count, 3u);
    EXPECT_EQ(read.b.count, 1u);
    for (uint32_t n = 0; n < 3; ++n) {
        EXPECT_EQ(read.a.bodies[n].bits, def.a.bodies[n].bits);
        EXPECT_NEAR(read.a.weights[n], def.a.weights[n], 1e-6);
    }
    expect_same_place(read.b.points[0], def.b.points[0]);
    taut_pos a{}, b{};
    EXPECT_OK(taut_attachment_get_points(attachment, &a, &b));
    expect_same_place(a, {0.25, 5, 0.6});
    expect_same_place(b, {0.25, 4.9, 0.6});
    float error = 0;
    EXPECT_OK(taut_attachment_get_error(attachment, &error));
    EXPECT_NEAR(error, 0.1, 1e-6);
    taut_vec3 force{};
    EXPECT_OK(taut_attachment_get_force(attachment, &force));
    EXPECT_EQ(force.y, 0);
    EXPECT_OK(taut_attachment_set_user_data(attachment, 8));
    uint64_t data = 0;
    EXPECT_OK(taut_attachment_get_user_data(attachment, &data));
    EXPECT_EQ(data, 8u);
    taut_attachment_state state{};
    uint32_t needed = 0;
    EXPECT_EQ(taut_world_get_attachments(world, &state, 0, &needed), TAUT_TOO_SMALL);
    EXPECT_EQ(needed, 1u);
    EXPECT_OK(taut_world_step(world));
    EXPECT_OK(taut_world_get_attachments(world, &state, 1, &needed));
    EXPECT_EQ(state.attachment.bits, attachment.bits);
    EXPECT_EQ(state.user_data, 8u);
    EXPECT_LT(state.error, 0.1f);
    EXPECT_NE(state.force.y, 0);
}

// A read def can be added again.
TEST_F(Attachments, DefsOfEachKindGoRound) {
    for (const taut_attachment_kind kind : {TAUT_ATTACHMENT_BALL, TAUT_ATTACHMENT_DISTANCE, TAUT_ATTACHMENT_FIXED}) {
        taut_attachment_def def = good(), read, again;
        def.kind = kind;
        def.compliance = 1e-3f, def.damping = 2, def.break_force = 100, def.collide_connected = 1;
        def.break_torque = kind == TAUT_ATTACHMENT_FIXED ? 5.0f : 0.0f;
        def.solve = TAUT_JOINT_SOLVE_BY_LOAD;
        EXPECT_OK(taut_attachment_get_def(add(def), &read));
        EXPECT_EQ(read.compliance, def.compliance);
        EXPECT_EQ(read.damping, def.damping);
        EXPECT_EQ(read.break_force, def.break_force);
        EXPECT_EQ(read.break_torque, def.break_torque);
        EXPECT_EQ(read.collide_connected, 1u);
        EXPECT_EQ(read.solve, def.solve);
        EXPECT_NEAR(read.length, kind == TAUT_ATTACHMENT_DISTANCE ? 0.1 : 0, 1e-6);
        EXPECT_OK(taut_attachment_get_def(add(read), &again));
        EXPECT_EQ(again.length, read.length);
        EXPECT_EQ(again.a.weights[1], read.a.weights[1]);
    }
}

TEST_F(Attachments, BadAnchorsAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    taut_attachment_def def = good();
    def.a.count = 5;
    refused(def, TAUT_INVALID_ARGUMENT, "a.count");
    def = good();
    def.b.reserved = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "b.reserved");
    def = good();
    def.a.weights[1] = nan;
    refused(def, TAUT_INVALID_ARGUMENT, "a.weights[1]");
    def.a.weights[1] = 9;
    refused(def, TAUT_INVALID_ARGUMENT, "a.weights[1]");
    def = good();
    def.a.weights[0] += 0.01f;
    refused(def, TAUT_INVALID_ARGUMENT, "a.weights: their sum is not 1");
    def = good();
    def.a.weights[0] = 0, def.a.weights[1] = 0, def.a.weights[2] = 0;
    refused(def, TAUT_INVALID_ARGUMENT, "a.weights");
    def = good();
    def.a.bodies[2] = def.a.bodies[0];
    refused(def, TAUT_INVALID_ARGUMENT, "a.bodies[2] is there twice");
    def = good();
    def.a.bodies[1] = {0};
    refused(def, TAUT_STALE_HANDLE, "a.bodies[1]");
    def = good();
    def.a.points[2].x = 0.1;
    refused(def, TAUT_INVALID_ARGUMENT, "a.points[2] is not 0 on a particle");
    def = good();
    def.b.points[0].x = 2e4;
    refused(def, TAUT_INVALID_ARGUMENT, "b.points[0].x");
    def = good();
    def.b = {};
    def.b.points[0].y = std::numeric_limits<double>::infinity();
    refused(def, TAUT_INVALID_ARGUMENT, "b.points[0].y");
    def = good();
    const taut_world other = make_world();
    def.b.bodies[0] = add_body(other, body_def(TAUT_BODY_DYNAMIC, add_box(other)));
    refused(def, TAUT_FOREIGN_HANDLE, "b.bodies[0]");
    EXPECT_OK(taut_world_destroy(other));
}

TEST_F(Attachments, BadDefsAreRefused) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    taut_attachment_def def = good();
    def.struct_size = sizeof def + 8;
    refused(def, TAUT_STRUCT_SIZE, "struct_size");
    def = good();
    def.kind = static_cast<taut_attachment_kind>(3);
    refused(def, TAUT_INVALID_ARGUMENT, "kind");
    const struct {
        const char* name;
        float taut_attachment_def::*field;
    } fields[] = {{"length", &taut_attachment_def::length},
                  {"compliance", &taut_attachment_def::compliance},
                  {"damping", &taut_attachment_def::damping},
                  {"break_force", &taut_attachment_def::break_force},
                  {"break_torque", &taut_attachment_def::break_torque}};
    for (const auto& each : fields)
        for (const float value : {nan, -1.0f, std::numeric_limits<float>::infinity(), 2e24f}) {
            def = good();
            def.*each.field = value;
            refused(def, TAUT_INVALID_ARGUMENT, each.name);
        }
    def = good();
    def.break_torque = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "break_torque");
    def = good();
    def.collide_connected = 2;
    refused(def, TAUT_INVALID_ARGUMENT, "collide_connected");
    def = good();
    def.solve = static_cast<taut_joint_solve>(9);
    refused(def, TAUT_INVALID_ARGUMENT, "solve");
    def = good();
    def.pulls = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "pulls");
    def = good();
    def.limit = 1;
    refused(def, TAUT_INVALID_ARGUMENT, "limit");
    def = good();
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    def.pulls = 2;
    refused(def, TAUT_INVALID_ARGUMENT, "pulls");
    def.pulls = 1;
    def.length = 0.5f;
    def.limit = 0.4f;
    refused(def, TAUT_INVALID_ARGUMENT, "limit is less than the length");
    def.limit = nan;
    refused(def, TAUT_INVALID_ARGUMENT, "limit");
    def.limit = 0.6f;
    def.limit_compliance = -1;
    refused(def, TAUT_INVALID_ARGUMENT, "limit_compliance");
    taut_attachment out{};
    EXPECT_EQ(taut_world_add_attachment(world, nullptr, &out), TAUT_NULL_POINTER);
    def = good();
    EXPECT_EQ(taut_world_add_attachment(world, &def, nullptr), TAUT_NULL_POINTER);
}

// Of two elements, in sets that several share: each goes with its attachment, and the others stay what they are.
TEST_F(Attachments, OfTwoLawsReadBackAndGoOneByOne) {
    taut_attachment_def def = good();
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    def.length = 0.1f;
    def.compliance = 1e-3f;
    def.pulls = 1;
    def.limit = 0.2f;
    def.limit_compliance = 1e-5f;
    EXPECT_OK(taut_world_step(world));
    const uint32_t before = elements();
    const taut_attachment first = add(def);
    def.length = def.limit = 0.15f;
    def.limit_compliance = 0;
    const taut_attachment second = add(def);
    def.limit = 0;
    const taut_attachment third = add(def);
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), before + 5);
    taut_attachment_def read;
    EXPECT_OK(taut_attachment_get_def(first, &read));
    EXPECT_EQ(read.pulls, 1u);
    EXPECT_EQ(read.limit, 0.2f);
    EXPECT_EQ(read.limit_compliance, 1e-5f);
    EXPECT_OK(taut_attachment_set_compliance(first, 2e-3f, 1));
    EXPECT_EQ(taut_attachment_set_length(second, 0.2f), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "limit is less")) << taut_last_error();
    EXPECT_OK(taut_attachment_set_length(third, 0.3f));
    EXPECT_OK(taut_attachment_remove(first));
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), before + 3);
    EXPECT_OK(taut_attachment_get_def(second, &read));
    EXPECT_EQ(read.limit, 0.15f);
    EXPECT_OK(taut_attachment_get_def(third, &read));
    EXPECT_EQ(read.length, 0.3f);
    EXPECT_OK(taut_attachment_remove(second));
    EXPECT_OK(taut_attachment_remove(third));
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), before);
}

TEST_F(Attachments, EndsThatHoldNothingAreRefused) {
    taut_attachment_def def = good();
    def.b = def.a;
    refused(def, TAUT_INVALID_ARGUMENT, "same point");
    def.a = on({}), def.b = on(anchored);
    refused(def, TAUT_INVALID_ARGUMENT, "no body is dynamic");
    def = good();
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    def.b = on(crate, {0.25, 5, 0.6});
    refused(def, TAUT_INVALID_ARGUMENT, "distance between the anchors");
    def = good();
    def.kind = TAUT_ATTACHMENT_FIXED;
    def.a = on(anchored);
    refused(def, TAUT_INVALID_ARGUMENT, "expected particles alone");
    def.a = on_cloth(), def.b = on_cloth({0.7, 5, 0.2});
    refused(def, TAUT_INVALID_ARGUMENT, "expected particles alone");
    // Of two points of one triangle the corners' weights cancel where they are alike.
    def = good();
    def.a = on_cloth({0.1, 5, 0.6}), def.b = on_cloth({0.25, 5, 0.6});
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    add(def);
    EXPECT_OK(taut_world_step(world));
}

TEST_F(Attachments, AnchorsAreFoundWhereTheyAreNearest) {
    taut_anchor out{};
    uint32_t element = 9;
    taut_pos at{};
    EXPECT_OK(taut_cloth_find_anchor(cloth, {0.8, 6, 0.3}, &out, &element));
    EXPECT_EQ(element, 1u);
    EXPECT_OK(taut_world_get_anchor_point(world, &out, &at));
    expect_same_place(at, {0.8, 5, 0.3});
    EXPECT_OK(taut_cloth_find_anchor(cloth, {-1, 5, 0.4}, &out, &element));  // beside its edge
    EXPECT_EQ(element, 0u);
    EXPECT_OK(taut_world_get_anchor_point(world, &out, &at));
    expect_same_place(at, {0, 5, 0.4});
    for (const taut_pos& place : {taut_pos{0.5, 7.5, 0.5}, taut_pos{0.1, 7.2, 0.1}, taut_pos{0.9, 7.9, 0.2},
                                  taut_pos{0.9, 7.1, 0.9}, taut_pos{0.15, 7.8, 0.9}}) {
        EXPECT_OK(taut_solid_find_anchor(solid, place, &out, &element));
        EXPECT_EQ(element, 0u);
        EXPECT_EQ(out.count, 4u);
        for (const float weight : out.weights) EXPECT_GE(weight, 0);
        EXPECT_OK(taut_world_get_anchor_point(world, &out, &at));
        expect_same_place(at, place);
    }
    EXPECT_OK(taut_solid_find_anchor(solid, {0.5, 9, 2}, &out, &element));
    EXPECT_OK(taut_world_get_anchor_point(world, &out, &at));
    expect_same_place(at, {0.5, 8, 1});
    const float weights[] = {0.2f, 0.3f, 0.5f}, bad[] = {0.2f, 0.3f, 0.4f};
    EXPECT_OK(taut_cloth_get_anchor(cloth, 1, weights, &out));
    EXPECT_OK(taut_world_get_anchor_point(world, &out, &at));
    expect_same_place(at, {0.3 + 0.5, 5, 0.3});
    EXPECT_EQ(taut_cloth_get_anchor(cloth, 2, weights, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_get_anchor(cloth, 0, bad, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_get_anchor(cloth, 0, nullptr, &out), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_solid_get_anchor(solid, 12, weights, &out), TAUT_INVALID_ARGUMENT);
    EXPECT_OK(taut_solid_get_anchor(solid, 11, weights, &out));
    EXPECT_EQ(taut_cloth_find_anchor(cloth, {NAN, 0, 0}, &out, nullptr), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_cloth_find_anchor(taut_cloth{solid.bits}, {0, 0, 0}, &out, nullptr), TAUT_STALE_HANDLE);
    EXPECT_EQ(taut_world_get_anchor(world, crate, {2e4, 0, 0}, &out), TAUT_INVALID_ARGUMENT);
    // The anchor stays on the body as it turns.
    const taut_anchor corner = on(crate, {1, 4.9, 1});
    EXPECT_OK(set_pose(crate, {{0.5, 4.4, 0.5}, {1, 0, 0, 0}, {0, 0}}));  // half a turn about x
    EXPECT_OK(taut_world_get_anchor_point(world, &corner, &at));
    expect_same_place(at, {1, 3.9, 0});
}

TEST_F(Attachments, GoWithWhatTheyAreOn) {
    const taut_attachment_def def = good();
    taut_attachment attachment = add(def);
    EXPECT_OK(taut_world_step(world));
    const uint32_t with = elements();
    EXPECT_OK(taut_attachment_remove(attachment));
    EXPECT_EQ(taut_attachment_is_valid(attachment), 0);
    EXPECT_EQ(taut_attachment_remove(attachment), TAUT_STALE_HANDLE);
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), with - 1);
    attachment = add(def);
    taut_attachment_def fixed = def;
    fixed.kind = TAUT_ATTACHMENT_FIXED;
    const taut_attachment weld = add(fixed);
    fixed.b = on({});
    const taut_attachment nailed = add(fixed);
    EXPECT_OK(taut_body_remove(crate));
    EXPECT_EQ(taut_attachment_is_valid(attachment), 0);
    EXPECT_EQ(taut_attachment_is_valid(weld), 0);
    EXPECT_EQ(taut_attachment_is_valid(nailed), 1);
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), with - 1 + 3);
    EXPECT_OK(taut_cloth_remove(cloth));
    EXPECT_EQ(taut_attachment_is_valid(nailed), 0);
    EXPECT_EQ(count(), 0u);
    taut_anchor in_solid{};
    EXPECT_OK(taut_solid_find_anchor(solid, {0.3, 7.4, 0.6}, &in_solid, nullptr));
    taut_attachment_def hung;
    taut_attachment_def_init(&hung);
    hung.a = in_solid, hung.b = on(bob);
    add(hung);
    EXPECT_OK(taut_solid_remove(solid));
    EXPECT_EQ(count(), 0u);
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(elements(), 0u);
}

// Others in the same set keep their own when one is taken out of the middle.
TEST_F(Attachments, RemovalLeavesTheOthersAsTheyAre) {
    std::vector<taut_attachment> all;
    std::vector<taut_body> weights;
    for (int i = 0; i < 6; ++i) {
        weights.push_back(add_particle(world, i, 1, 8));
        taut_attachment_def def;
        taut_attachment_def_init(&def);
        def.kind = TAUT_ATTACHMENT_DISTANCE;
        def.a.points[0] = {static_cast<double>(i), 2.0 + i, 8};
        def.b = on(weights.back());
        all.push_back(add(def));
    }
    EXPECT_OK(taut_attachment_remove(all[1]));
    EXPECT_OK(taut_attachment_remove(all[4]));
    for (int i = 0; i < 30; ++i) EXPECT_OK(taut_world_step(world));
    for (size_t i = 0; i < 6; ++i) {
        taut_pose pose;
        EXPECT_OK(taut_body_get_pose(weights[i], &pose));
        if (i == 1 || i == 4) {
            EXPECT_LT(pose.position.y, 0.5);
            continue;
        }
        EXPECT_NEAR(pose.position.y, 1, 1e-5);
        float error = 1;
        taut_vec3 force{};
        EXPECT_OK(taut_attachment_get_error(all[i], &error));
        EXPECT_OK(taut_attachment_get_force(all[i], &force));
        EXPECT_LT(error, 1e-5);
        EXPECT_NEAR(force.y, 9.81, 1e-3);
    }
}

// A weight of 1 kg hangs from a point of a pinned triangle by what holds more or less than that.
TEST_F(Attachments, BreakAboveTheForceAndNotBelow) {
    for (uint32_t v = 0; v < 4; ++v) EXPECT_OK(taut_cloth_pin(cloth, v, 1));
    taut_attachment_def def = good();
    taut_pos place{};
    EXPECT_OK(taut_world_get_anchor_point(world, &def.a, &place));
    for (const bool holds : {true, false}) {
        const taut_body weight = add_particle(world, place.x, place.y, place.z);
        def.b = on(weight);
        def.break_force = holds ? 9.9f : 9.7f;
        def.user_data = 77;
        const taut_attachment hung = add(def);
        uint32_t broken = 0;
        for (int i = 0; i < 60; ++i) {
            EXPECT_OK(taut_world_step(world));
            const taut_events events = events_of(world);
            broken += events.detached_count;
            if (events.detached_count == 0) continue;
            EXPECT_EQ(events.detached[0].attachment.bits, hung.bits);
            EXPECT_EQ(events.detached[0].user_data, 77u);
            EXPECT_NEAR(events.detached[0].force.y, 9.81, 0.01);
            EXPECT_EQ(taut_attachment_is_valid(hung), 0);
        }
        EXPECT_EQ(broken, holds ? 0u : 1u);
        EXPECT_EQ(taut_attachment_is_valid(hung), holds ? 1 : 0);
        EXPECT_OK(taut_body_remove(weight));
    }
    def.break_force = 0;
    const taut_body weight = add_particle(world, place.x, place.y, place.z);
    def.b = on(weight);
    const taut_attachment hung = add(def);
    for (int i = 0; i < 10; ++i) EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(taut_attachment_set_break(hung, 5, 1), TAUT_INVALID_ARGUMENT);
    EXPECT_OK(taut_attachment_set_break(hung, 5, 0));
    EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(events_of(world).detached_count, 1u);
}

// A chain of a joint and an attachment that both hold too little: the weaker for its load goes, the other is relieved.
TEST_F(Attachments, OfAMechanismTheMostOverloadedBreaks) {
    const taut_body upper = add_particle(world, 9, 5, 0), lower = add_particle(world, 9, 4, 0);
    taut_ball_joint_def joint;
    taut_ball_joint_def_init(&joint);
    joint.base.body_b = upper;
    joint.base.frame_a.position = {9, 5, 0};
    joint.base.break_force = 19;  // carries 19.62
    taut_joint held{};
    EXPECT_OK(taut_world_add_ball_joint(world, &joint, &held));
    taut_attachment_def def;
    taut_attachment_def_init(&def);
    def.kind = TAUT_ATTACHMENT_DISTANCE;
    def.a = on(upper), def.b = on(lower);
    def.break_force = 5;  // carries 9.81
    const taut_attachment rod = add(def);
    EXPECT_OK(taut_world_step(world));
    const taut_events events = events_of(world);
    EXPECT_EQ(events.detached_count, 1u);
    EXPECT_EQ(events.broken_count, 0u);
    EXPECT_EQ(taut_attachment_is_valid(rod), 0);
    for (int i = 0; i < 30; ++i) EXPECT_OK(taut_world_step(world));
    EXPECT_EQ(taut_joint_is_valid(held), 1);
}

// Its bodies do not touch unless they are asked to, and touch again when it is gone.
TEST_F(Attachments, KeepItsBodiesApart) {
    const auto touches = [&] {
        for (int i = 0; i < 3; ++i) EXPECT_OK(taut_world_step(world));
        taut_contact out[64];
        uint32_t found = 0;
        EXPECT_OK(taut_world_get_contacts(world, out, 64, &found));
        return found > 0;
    };
    EXPECT_OK(taut_world_set_gravity(world, {0, 0, 0}));
    EXPECT_OK(taut_solid_remove(solid));
    EXPECT_OK(taut_cloth_remove(cloth));
    taut_sphere_def sphere;
    taut_sphere_def_init(&sphere);
    sphere.radius = 0.5f;
    taut_shape ball{};
    EXPECT_OK(taut_world_add_sphere(world, &sphere, &ball));
    const taut_body other = add_body(world, body_def(TAUT_BODY_DYNAMIC, ball, 0.5, 5.35, 0.5));
    taut_attachment_def def;
    taut_attachment_def_init(&def);
    def.compliance = 1;
    def.a = on(crate, {0.5, 4.9, 0.5}), def.b = on(other, {0.5, 4.9, 0.5});
    const taut_attachment attachment = add(def);
    EXPECT_FALSE(touches());
    EXPECT_OK(taut_attachment_remove(attachment));
    EXPECT_TRUE(touches());
    def.collide_connected = 1;
    add(def);
    EXPECT_OK(set_pose(other, at(0.5, 5.35, 0.5)));
    EXPECT_TRUE(touches());
}

// Shapes that shift a body's centre of mass leave its attachments where they are.
TEST_F(Attachments, StayWhereTheyAreOnABody) {
    const taut_attachment attachment = add(good());
    taut_attachment_def fixed = good();
    fixed.kind = TAUT_ATTACHMENT_FIXED;
    const taut_attachment weld = add(fixed);
    taut_collider_def more;
    taut_collider_def_init(&more);
    more.shape = box;
    more.position = {2, 0, 0};
    taut_collider made{};
    EXPECT_OK(taut_body_add_collider(crate, &more, &made));
    EXPECT_OK(taut_body_set_mass_from_colliders(crate));
    EXPECT_GT(mass_of(crate).centre.x, 0.5f);
    taut_pos a{}, b{};
    EXPECT_OK(taut_attachment_get_points(attachment, &a, &b));
    expect_same_place(b, {0.25, 4.9, 0.6});
    float error = 1;
    EXPECT_OK(taut_attachment_get_error(attachment, &error));
    EXPECT_NEAR(error, 0.1, 1e-6);
    EXPECT_OK(taut_attachment_get_error(weld, &error));
    EXPECT_NEAR(error, 0, 1e-6);
}

TEST_F(Attachments, FailedAllocationsChangeNothing) {
    for (const taut_attachment_kind kind : {TAUT_ATTACHMENT_BALL, TAUT_ATTACHMENT_FIXED}) {
        taut_attachment_def def = good();
        def.kind = kind;
        for (uint64_t fail = 1;; ++fail) {
            const uint64_t before = hash_of(world);
            ledger.fail_from = ledger.calls + fail;
            ledger.fail_until = ledger.fail_from + 1;
            const uint64_t failed = ledger.failed;
            taut_attachment out{};
            const taut_result result = taut_world_add_attachment(world, &def, &out);
            ledger.fail_from = ledger.fail_until = UINT64_MAX;
            if (ledger.failed == failed) {
                EXPECT_EQ(result, TAUT_OK);
                EXPECT_OK(taut_attachment_remove(out));
                break;
            }
            ASSERT_EQ(result, TAUT_OUT_OF_MEMORY) << fail;
            ASSERT_EQ(hash_of(world), before) << fail;
            ASSERT_EQ(count(), 0u);
        }
    }
}

TEST_F(Attachments, AreSeenByLint) {
    const taut_attachment attachment = add(good());
    taut_lint_entry entries[16];
    uint32_t found = 0;
    EXPECT_OK(taut_world_lint(world, entries, 16, &found));
    const auto end = entries + found;
    const auto apart = std::find_if(entries, end, [](const auto& e) { return e.kind == TAUT_LINT_JOINT_APART; });
    ASSERT_NE(apart, end);
    EXPECT_EQ(apart->attachment.bits, attachment.bits);
    EXPECT_NEAR(apart->value, 0.1, 1e-6);
}

}  // namespace
