/* The pile of binding_test.py through the C interface: prints the state after so many steps. */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

int main(void) {
    taut_world_def world_def;
    taut_world world;
    taut_plane_def plane;
    taut_box_def box;
    taut_sphere_def sphere;
    taut_body_def def;
    taut_shape ground, shapes[2];
    taut_body body, last = {0};
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));
    taut_plane_def_init(&plane);
    check(taut_world_add_plane(world, &plane, &ground));
    taut_box_def_init(&box);
    box.half_extents = (taut_vec3){0.25f, 0.125f, 0.25f};
    check(taut_world_add_box(world, &box, &shapes[0]));
    taut_sphere_def_init(&sphere);
    sphere.radius = 0.25f;
    check(taut_world_add_sphere(world, &sphere, &shapes[1]));
    taut_body_def_init(&def);
    def.kind = TAUT_BODY_STATIC;
    def.shape = ground;
    check(taut_world_add_body(world, &def, &body));
    for (int i = 0; i < 200; ++i) {
        taut_body_def_init(&def);
        def.shape = shapes[i % 2];
        def.position = (taut_pos){0.625 * (i % 5) + 0.03125 * (i % 3), 0.5 + 0.625 * (i / 25), 0.625 * (i / 5 % 5)};
        def.material.friction = 0.75f;
        check(taut_world_add_body(world, &def, &last));
    }
    taut_ball_joint_def joint_def;
    taut_joint joint;
    taut_ball_joint_def_init(&joint_def);
    joint_def.base.body_b = last;
    joint_def.base.frame_a.position = (taut_pos){2.5, 6, 2.5};
    joint_def.base.frame_b.position = (taut_pos){0, 1, 0};
    check(taut_world_add_ball_joint(world, &joint_def, &joint));
    for (int step = 0; step < 240; ++step) check(taut_world_step(world));
    uint64_t hash;
    check(taut_world_get_state_hash(world, &hash));
    printf("%016llx\n", (unsigned long long)hash);
    check(taut_world_destroy(world));
    return 0;
}
