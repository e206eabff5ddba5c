/* A box falls on the ground. Prints its height after one second. */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "drop: %s\n", taut_last_error());
    exit(1);
}

int main(void) {
    taut_world_def world_def;
    taut_world world;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));

    taut_plane_def plane;
    taut_body_def ground;
    taut_body body;
    taut_plane_def_init(&plane);
    taut_body_def_init(&ground);
    check(taut_world_add_plane(world, &plane, &ground.shape));
    ground.kind = TAUT_BODY_STATIC;
    check(taut_world_add_body(world, &ground, &body));

    taut_box_def box;
    taut_body_def falling;
    taut_box_def_init(&box);
    taut_body_def_init(&falling);
    check(taut_world_add_box(world, &box, &falling.shape));
    falling.position.y = 2.0;
    check(taut_world_add_body(world, &falling, &body));

    for (int step = 0; step < 60; ++step) check(taut_world_step(world));
    taut_pose pose;
    check(taut_body_get_pose(body, &pose));
    check(taut_world_destroy(world));
    printf("%.4f\n", pose.position.y);
    return pose.position.y > 0.45 && pose.position.y < 0.55 ? 0 : 1; /* it lies on the ground */
}
