// Joints with a housing, and frames from two axes: what is read back of them and what is refused.
#include "joint_support.h"

using namespace taut_test;

namespace {

taut_vec3 turned(taut_quat q, taut_vec3 v) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double t[3] = {2 * (y * v.z - z * v.y), 2 * (z * v.x - x * v.z), 2 * (x * v.y - y * v.x)};
    return {static_cast<float>(v.x + w * t[0] + y * t[2] - z * t[1]),
            static_cast<float>(v.y + w * t[1] + z * t[0] - x * t[2]),
            static_cast<float>(v.z + w * t[2] + x * t[1] - y * t[0])};
}

void expect_along(taut_vec3 found, taut_vec3 expected) {
    EXPECT_NEAR(found.x, expected.x, 1e-6);
    EXPECT_NEAR(found.y, expected.y, 1e-6);
    EXPECT_NEAR(found.z, expected.z, 1e-6);
}

TEST(FramesFromTwoAxes, LieAlongTheFirstAndMakeTheSecondSquare) {
    TwoBoxes boxes;
    ASSERT_OK(set_pose(boxes.b, at(1, 5, 0, {0, 0.6f, 0, 0.8f})));
    taut_frame a, b;
    ASSERT_OK(taut_joint_frames_from_two_axes(boxes.world, boxes.a, boxes.b, {0, 5, 0}, {0, 3, 0}, {0, 1, -2}, &a, &b));
    expect_along(turned(a.rotation, {1, 0, 0}), {0, 1, 0});
    expect_along(turned(a.rotation, {0, 1, 0}), {0, 0, -1});
    EXPECT_NEAR(a.position.x, 1, 1e-9);
    // The same in the world from the other body.
    const taut_quat pose = {0, 0.6f, 0, 0.8f};
    expect_along(turned(pose, turned(b.rotation, {1, 0, 0})), {0, 1, 0});
    expect_along(turned(pose, turned(b.rotation, {0, 1, 0})), {0, 0, -1});
    // On the world: as given.
    ASSERT_OK(taut_joint_frames_from_two_axes(boxes.world, {0}, boxes.b, {1, 2, 3}, {1, 0, 0}, {0, 1e-3f, 0}, &a, &b));
    expect_along(turned(a.rotation, {0, 1, 0}), {0, 1, 0});
    EXPECT_EQ(a.position.z, 3);
}

TEST(FramesFromTwoAxes, RefuseWhatGivesNone) {
    TwoBoxes boxes;
    const Watch watch(boxes.world);
    taut_frame a, b;
    const auto refuse = [&](taut_vec3 x, taut_vec3 y, const char* word) {
        EXPECT_EQ(taut_joint_frames_from_two_axes(boxes.world, boxes.a, boxes.b, {0, 0, 0}, x, y, &a, &b),
                  TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), word)) << taut_last_error();
    };
    refuse({0, 0, 0}, {1, 0, 0}, "axis_x is 0");
    refuse({1, 0, 0}, {0, 0, 0}, "axis_y is 0");
    refuse({1, 2, 3}, {-2, -4, -6}, "parallel");
    refuse({1, 0, 0}, {1, 9e-4f, 0}, "parallel");
    refuse({NAN, 0, 0}, {1, 0, 0}, "axis_x.x");
    refuse({1, 0, 0}, {0, INFINITY, 0}, "axis_y.y");
    EXPECT_EQ(
        taut_joint_frames_from_two_axes(boxes.world, boxes.a, boxes.b, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, nullptr, &b),
        TAUT_NULL_POINTER);
    EXPECT_TRUE(watch.unchanged());
}

struct Housed : testing::Test {
    Housed() {
        housing = add_body(boxes.world, body_def(TAUT_BODY_DYNAMIC, boxes.box, 0, 9, 0));
        taut_gear_joint_def def;
        taut_gear_joint_def_init(&def);
        def.base.body_a = boxes.a, def.base.body_b = boxes.b, def.housing = housing;
        def.housing_frame_a = frame(-1, -4, 0), def.housing_frame_b = frame(1, -4, 0);
        def.ratio = -2.5f;
        EXPECT_OK(taut_world_add_gear_joint(boxes.world, &def, &gear));
        taut_pulley_joint_def rope;
        taut_pulley_joint_def_init(&rope);
        rope.base.body_a = boxes.a, rope.base.body_b = boxes.b, rope.housing = housing;
        rope.housing_frame_a.position = {-1, -1, 0}, rope.housing_frame_b.position = {1, -1, 0};
        rope.ratio = 2;
        EXPECT_OK(taut_world_add_pulley_joint(boxes.world, &rope, &pulley));
        hinge = boxes.add(framed_kinds()[1]);
    }

    TwoBoxes boxes;
    taut_body housing{};
    taut_joint gear{}, pulley{}, hinge{};
};

TEST_F(Housed, ReadAsTheyWereMade) {
    taut_body read;
    float number;
    taut_frame a, b;
    for (const taut_joint joint : {gear, pulley}) {
        ASSERT_OK(taut_joint_get_housing(joint, &read));
        EXPECT_EQ(read.bits, housing.bits);
    }
    ASSERT_OK(taut_joint_get_housing(hinge, &read));
    EXPECT_EQ(read.bits, 0u);
    ASSERT_OK(taut_joint_get_ratio(gear, &number));
    EXPECT_EQ(number, -2.5f);
    ASSERT_OK(taut_joint_get_ratio(pulley, &number));
    EXPECT_EQ(number, 2);
    ASSERT_OK(taut_joint_get_length(pulley, &number));
    EXPECT_NEAR(number, 3 + 2 * 3, 1e-6);
    ASSERT_OK(taut_joint_get_housing_frames(pulley, &a, &b));
    EXPECT_NEAR(a.position.x, -1, 1e-12);
    EXPECT_NEAR(b.position.x, 1, 1e-12);
    ASSERT_OK(taut_joint_get_housing_frames(gear, &a, &b));
    EXPECT_NEAR(a.position.y, -4, 1e-12);
    EXPECT_NEAR(b.position.x, 1, 1e-12);
    taut_joint_kind kind;
    ASSERT_OK(taut_joint_get_kind(gear, &kind));
    EXPECT_EQ(kind, TAUT_JOINT_GEAR);
    uint32_t axes;
    ASSERT_OK(taut_joint_get_axis_count(gear, &axes));
    EXPECT_EQ(axes, 0u);
    ASSERT_OK(taut_joint_get_axis_count(pulley, &axes));
    EXPECT_EQ(axes, 1u);
}

TEST_F(Housed, AreMovedOnTheirHousing) {
    const taut_frame a = frame(-2, -1, 0, {0.6f, 0, 0, 0.8f}), b = frame(2, -1, 0);
    ASSERT_OK(taut_joint_set_housing_frames(gear, &a, &b));
    taut_frame read_a, read_b;
    ASSERT_OK(taut_joint_get_housing_frames(gear, &read_a, &read_b));
    EXPECT_NEAR(read_a.position.x, -2, 1e-12);
    EXPECT_NEAR(read_a.rotation.x, 0.6, 1e-6);
    float error;
    ASSERT_OK(taut_joint_get_angular_error(gear, &error));
    EXPECT_LE(error, 1e-6);  // meshed as it stands
    // A body's new centre of mass leaves its joints where they were.
    const taut_sym3 inertia = {100, 100, 100, 0, 0, 0};
    ASSERT_OK(taut_body_set_mass(housing, 500, {0.25f, 0, 0}, inertia));
    ASSERT_OK(taut_joint_get_housing_frames(gear, &read_a, &read_b));
    EXPECT_NEAR(read_a.position.x, -2, 1e-6);
    EXPECT_NEAR(read_b.position.x, 2, 1e-6);
    ASSERT_OK(taut_joint_get_housing_frames(pulley, &read_a, &read_b));
    EXPECT_NEAR(read_b.position.x, 1, 1e-6);
}

TEST_F(Housed, RefuseWhatOthersHave) {
    const Watch watch(boxes.world);
    const taut_frame at = frame(0, 0, 0), far = frame(2e4, 0, 0);
    taut_frame a, b;
    float number;
    EXPECT_EQ(taut_joint_get_housing_frames(hinge, &a, &b), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "hinge joint has no housing")) << taut_last_error();
    EXPECT_EQ(taut_joint_set_housing_frames(hinge, &at, &at), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_housing_frames(gear, &at, &far), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "frame_b.position")) << taut_last_error();
    EXPECT_EQ(taut_joint_get_ratio(hinge, &number), TAUT_INVALID_ARGUMENT);
    for (const taut_joint joint : {hinge, pulley}) EXPECT_EQ(taut_joint_set_ratio(joint, 2), TAUT_INVALID_ARGUMENT);
    for (const float ratio : {0.0f, NAN, 1e5f, -1e5f})
        EXPECT_EQ(taut_joint_set_ratio(gear, ratio), TAUT_INVALID_ARGUMENT) << ratio;
    EXPECT_EQ(taut_joint_get_length(gear, &number), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_length(gear, 2), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_compliance(gear, 0, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(contains(taut_last_error(), "holds angles alone")) << taut_last_error();
    EXPECT_EQ(taut_joint_set_break(gear, 10, 10), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_break(pulley, 10, 10), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_joint_set_angular_compliance(pulley, 0, 0), TAUT_INVALID_ARGUMENT);
    EXPECT_TRUE(watch.unchanged());
    EXPECT_OK(taut_joint_set_break(gear, 0, 10));
    EXPECT_OK(taut_joint_set_break(pulley, 10, 0));
}

TEST_F(Housed, GoWithTheirHousing) {
    ASSERT_OK(taut_body_remove(housing));
    EXPECT_FALSE(taut_joint_is_valid(gear));
    EXPECT_FALSE(taut_joint_is_valid(pulley));
    EXPECT_TRUE(taut_joint_is_valid(hinge));
    EXPECT_OK(taut_world_step(boxes.world));
}

}  // namespace
