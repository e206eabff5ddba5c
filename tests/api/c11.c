/* The headers as a C11 compiler sees them, each before any other of its kind, and a world that falls. */
#include <taut/attachment.h>
#include <taut/sleep.h>
#include <taut/query.h>
#include <taut/lint.h>
#include <taut/profile.h>
#include <taut/joint.h>
#include <taut/event.h>
#include <taut/body.h>
#include <taut/shape.h>
#include <taut/world.h>
#include <taut/math.h>
#include <taut/base.h>
#include <taut/taut.h>

#include <stddef.h>

/* The ABI: what a binding in another language relies on. */
_Static_assert(sizeof(taut_body) == 8 && sizeof(taut_world) == 8, "handles are one word");
_Static_assert(sizeof(taut_result) == 4 && sizeof(taut_body_kind) == 4, "enums are 32 bits");
_Static_assert(sizeof(taut_pos) == 24 && sizeof(taut_vec3) == 12 && sizeof(taut_quat) == 16, "plain values");
_Static_assert(sizeof(taut_pose) == 48, "poses have no hidden padding");
_Static_assert(sizeof(taut_frame) == 40 && sizeof(taut_axis_def) == 56 && sizeof(taut_lint_entry) == 72, "plain values");
_Static_assert(sizeof(taut_joint_base) == 152 && offsetof(taut_hinge_joint_def, base) == 8, "no hidden padding");
_Static_assert(sizeof(taut_ball_joint_def) == 160 && sizeof(taut_distance_joint_def) == 208, "no hidden padding");
_Static_assert(sizeof(taut_gear_joint_def) == 248 && sizeof(taut_pulley_joint_def) == 256, "no hidden padding");
_Static_assert(sizeof(taut_fixed_joint_def) == 160 && sizeof(taut_hinge_joint_def) == 216, "no hidden padding");
_Static_assert(sizeof(taut_joint_break_event) == 48 && sizeof(taut_events) == 192, "no hidden padding");
_Static_assert(sizeof(taut_anchor) == 152 && sizeof(taut_attachment_def) == 360, "no hidden padding");
_Static_assert(sizeof(taut_attachment_state) == 80 && sizeof(taut_attachment_break_event) == 48, "likewise");
_Static_assert(sizeof(taut_contact_event) == 48 && sizeof(taut_contact_point) == 56, "likewise");
_Static_assert(sizeof(taut_hit_event) == 80 && sizeof(taut_sensor_event) == 40, "likewise");
_Static_assert(sizeof(taut_pre_solve) == 184 && sizeof(taut_pre_solve_answer) == 8, "likewise");
_Static_assert(sizeof(taut_query_filter) == 64 && sizeof(taut_query_hit) == 64, "no hidden padding");
_Static_assert(sizeof(taut_ray) == 40 && sizeof(taut_shape_cast) == 72 && sizeof(taut_distance) == 80, "likewise");
_Static_assert(offsetof(taut_body_def, struct_size) == 0 && offsetof(taut_world_def, struct_size) == 0, "size first");

int taut_c11_run(void);

/* 0, or the line that failed. */
#define CHECK(condition) \
    if (!(condition)) return __LINE__

int taut_c11_run(void) {
    taut_world_def world_def;
    taut_world world;
    taut_world_def_init(&world_def);
    CHECK(taut_world_create(&world_def, &world) == TAUT_OK);

    taut_sphere_def sphere_def;
    taut_shape sphere;
    taut_sphere_def_init(&sphere_def);
    CHECK(taut_world_add_sphere(world, &sphere_def, &sphere) == TAUT_OK);

    taut_body_def body_def;
    taut_body body;
    taut_body_def_init(&body_def);
    body_def.shape = sphere;
    body_def.position = (taut_pos){0.0, 10.0, 0.0};
    CHECK(taut_world_add_body(world, &body_def, &body) == TAUT_OK);

    /* One base for two kinds: a ball below a rod of 1 m and one below a hinge. */
    taut_joint_base base;
    taut_joint_base_init(&base);
    base.frame_a.position = (taut_pos){20.0, 10.0, 0.0};
    body_def.position = (taut_pos){20.0, 9.0, 0.0};
    CHECK(taut_world_add_body(world, &body_def, &base.body_b) == TAUT_OK);
    taut_distance_joint_def rod = {sizeof(rod), 1, base, 0, 0, 0, 1, {0, 0, 0, 0, 0, 1, 0}, 0};
    taut_hinge_joint_def hinge;
    taut_joint joints[2];
    CHECK(taut_world_add_distance_joint(world, &rod, &joints[0]) == TAUT_OK);
    taut_hinge_joint_def_init(&hinge);
    hinge.base = base;
    hinge.base.frame_a.position.x = 30;
    hinge.base.frame_b.position.y = 1;
    body_def.position.x = 30;
    CHECK(taut_world_add_body(world, &body_def, &hinge.base.body_b) == TAUT_OK);
    CHECK(taut_world_add_hinge_joint(world, &hinge, &joints[1]) == TAUT_OK);

    for (int i = 0; i < 60; ++i) CHECK(taut_world_step(world) == TAUT_OK);
    taut_pose pose;
    for (int i = 0; i < 2; ++i) {
        CHECK(taut_body_get_pose(i == 0 ? base.body_b : hinge.base.body_b, &pose) == TAUT_OK);
        CHECK(pose.position.y > 8.999 && pose.position.y < 9.001);
    }
    CHECK(taut_body_get_pose(body, &pose) == TAUT_OK);
    CHECK(pose.position.y > 4.9 && pose.position.y < 5.2); /* g t^2 / 2 after one second */

    body_def.density = -1.0f;
    CHECK(taut_world_add_body(world, &body_def, &body) == TAUT_INVALID_ARGUMENT);
    CHECK(taut_last_error()[0] == 't');
    CHECK(taut_world_destroy(world) == TAUT_OK);
    CHECK(!taut_body_is_valid(body));
    return 0;
}
