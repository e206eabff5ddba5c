// Structs without a struct_size, whatever was in them: what their _init functions write is what defs have and what
// calls take.
#include <cstring>

#include "support.h"

using namespace taut_test;

namespace {

template <class Value>
Value garbage_then(void (*init)(Value*)) {
    Value out;
    std::memset(static_cast<void*>(&out), 0xa5, sizeof out);
    init(&out);
    init(nullptr);
    return out;
}

// Of structs without padding.
template <class Value>
void expect_same(const Value& a, const Value& b) {
    EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
}

TEST(Values, AreTheDefaultsOfDefs) {
    taut_body_def body;
    taut_body_def_init(&body);
    expect_same(garbage_then(taut_material_init), body.material);
    expect_same(garbage_then(taut_filter_init), body.filter);
    taut_hinge_joint_def hinge;
    taut_hinge_joint_def_init(&hinge);
    expect_same(garbage_then(taut_frame_init), hinge.base.frame_a);
    expect_same(garbage_then(taut_drive_init), hinge.angle.drive);
    expect_same(garbage_then(taut_joint_base_init), hinge.base);
    taut_attachment_def attachment;
    taut_attachment_def_init(&attachment);
    expect_same(garbage_then(taut_anchor_init), attachment.a);
    taut_world_def world;
    taut_world_def_init(&world);
    expect_same(garbage_then(taut_hooks_init), world.hooks);
}

TEST(Values, AreTakenByCalls) {
    Populated p;
    const taut_pose origin = garbage_then(taut_pose_init);
    ASSERT_OK(taut_body_set_pose(p.lift, &origin));
    taut_pose read;
    ASSERT_OK(taut_body_get_pose(p.lift, &read));
    expect_same(read, origin);

    taut_ray ray = garbage_then(taut_ray_init);
    ray.origin = {0, 9, 0};
    ray.translation = {0, -20, 0};
    taut_query_hit hit;
    ASSERT_OK(taut_world_cast_ray(p.world, &ray, nullptr, &hit));
    EXPECT_NE(hit.body.bits, 0u);

    taut_shape_cast cast = garbage_then(taut_shape_cast_init);
    cast.shape = p.box;
    cast.pose.position = {0, 9, 0};
    cast.translation = {0, -20, 0};
    ASSERT_OK(taut_world_cast_shape(p.world, &cast, nullptr, &hit));
    EXPECT_NE(hit.body.bits, 0u);

    const taut_vehicle_input input = garbage_then(taut_vehicle_input_init);
    taut_wheel_def wheels[4];
    for (taut_wheel_def& wheel : wheels) taut_wheel_def_init(&wheel);
    taut_vehicle_def def;
    taut_vehicle_def_init(&def);
    def.chassis = p.crate;
    def.wheels = wheels;
    def.wheel_count = 4;
    taut_vehicle vehicle;
    taut_vehicle_init(&vehicle);
    EXPECT_OK(taut_vehicle_drive(p.world, &def, &input, 1 / 60.0f, &vehicle));
}

}  // namespace
