/* Ropes: a cable of particles on a winch lifts a crate, and a rope joint catches another.
 *
 * A cable is one thing to the host: it tells tension and length, and is reeled at an end. Where a rope need neither
 * sag nor touch anything, a distance joint with a max_length alone does, and costs one row.
 */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

static taut_body add_crate(taut_world world, float mass, double x, double y) {
    taut_box_def box;
    taut_body_def def;
    taut_body body;
    taut_box_def_init(&box);
    box.half_extents = (taut_vec3){0.25f, 0.25f, 0.25f};
    taut_body_def_init(&def);
    check(taut_world_add_box(world, &box, &def.shape));
    def.mass = mass;
    def.position = (taut_pos){x, y, 0};
    check(taut_world_add_body(world, &def, &body));
    return body;
}

static double height(taut_body body) {
    taut_pose pose;
    check(taut_body_get_pose(body, &pose));
    return pose.position.y;
}

/* Of the uppermost segment [N]. */
static float top_tension(taut_cable cable) {
    float tensions[64];
    uint32_t count;
    check(taut_cable_get_tensions(cable, tensions, 64, &count));
    return tensions[0];
}

static void run(taut_world world, double seconds) {
    for (int step = 0; step < (int)(60 * seconds); ++step) check(taut_world_step(world));
}

int main(void) {
    taut_world_def world_def;
    taut_world world;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));

    /* 500 kg on 6 m of cable of 1 kg/m, whose upper end is the winch. */
    taut_body load = add_crate(world, 500, 0, 3.75);
    const taut_pos path[2] = {{0, 10, 0}, {0, 4, 0}};
    taut_cable_def cable_def;
    taut_cable cable;
    taut_cable_def_init(&cable_def);
    cable_def.kind = TAUT_CABLE_PARTICLES;
    cable_def.points = path;
    cable_def.point_count = 2;
    cable_def.segment_count = 24;
    cable_def.mass_per_metre = 1;
    cable_def.end[0].attached = 1; /* to the world */
    cable_def.end[0].anchor = path[0];
    cable_def.end[1].attached = 1;
    cable_def.end[1].body = load;
    cable_def.end[1].anchor.y = 0.25; /* the middle of its lid */
    check(taut_world_add_cable(world, &cable_def, &cable));

    /* 20 kg that fall until a rope of 3 m is taut. */
    taut_body bucket = add_crate(world, 20, 5, 9);
    taut_distance_joint_def rope_def;
    taut_joint rope;
    taut_distance_joint_def_init(&rope_def);
    rope_def.base.frame_a.position = (taut_pos){5, 10, 0};
    rope_def.base.body_b = bucket;
    rope_def.max_length = 3;
    check(taut_world_add_distance_joint(world, &rope_def, &rope));

    run(world, 5);
    taut_vec3 pull;
    check(taut_joint_get_force(rope, &pull));
    printf("hanging: load at %.3f m, the winch bears %.0f N\n", height(load), top_tension(cable));
    printf("bucket at %.3f m, its rope bears %.1f N\n", height(bucket), pull.y);

    check(taut_cable_set_reel_speed(cable, 0, -0.5f, 1)); /* hauls in at 0.5 m/s, reached at 1 m/s^2 */
    run(world, 5);
    check(taut_cable_set_reel_speed(cable, 0, 0, 1));
    run(world, 3);
    float length;
    check(taut_cable_get_length(cable, &length));
    printf("hauled in: load at %.3f m, %.3f m of cable are out, the winch bears %.0f N\n", height(load), length,
           top_tension(cable));

    check(taut_cable_cut(cable, 2));
    run(world, 0.5);
    printf("cut: load at %.3f m and falling\n", height(load));
    check(taut_world_destroy(world));
    return 0;
}
