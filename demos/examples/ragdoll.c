/* A ragdoll: capsules on joints with the limits of limbs, dropped on the ground.
 *
 * Each joint is placed where the two bodies lie now, by taut_joint_frames_from_world: a hinge where a limb bends one
 * way alone, a cone with a twist where it may lean to any side.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

static taut_world world;
static taut_body bodies[16];
static taut_joint joints[16];
static int body_count, joint_count;

/* A capsule whose axis goes from one height to another, at x. */
static taut_body limb(double x, double low, double high, float radius, float mass) {
    taut_capsule_def capsule;
    taut_body_def def;
    taut_capsule_def_init(&capsule);
    capsule.radius = radius;
    capsule.half_length = (float)(high - low) / 2 - radius;
    taut_body_def_init(&def);
    check(taut_world_add_capsule(world, &capsule, &def.shape));
    def.mass = mass;
    def.position = (taut_pos){x, (low + high) / 2, 0};
    check(taut_world_add_body(world, &def, &bodies[body_count]));
    return bodies[body_count++];
}

static void limit(taut_axis_def* axis, float lower, float upper) {
    axis->mode = TAUT_AXIS_LIMITED;
    axis->lower = lower;
    axis->upper = upper;
    axis->friction = 3; /* muscles at rest [N m] */
}

/* An elbow or a knee: bends about the world's x from straight to 140 degrees. */
static void bend(taut_body upper, taut_body lower, double x, double y, float side) {
    taut_hinge_joint_def def;
    taut_hinge_joint_def_init(&def);
    def.body_a = upper;
    def.body_b = lower;
    limit(&def.angle, 0, 2.44f);
    check(taut_joint_frames_from_world(world, upper, lower, (taut_pos){x, y, 0}, (taut_vec3){side, 0, 0}, &def.frame_a,
                                       &def.frame_b));
    check(taut_world_add_hinge_joint(world, &def, &joints[joint_count++]));
}

/* A shoulder, hip or neck: leans by up to swing [rad] from hanging down (or up), and twists by up to half a radian. */
static void lean(taut_body trunk, taut_body part, double x, double y, float up, float swing) {
    taut_cone_twist_joint_def def;
    taut_cone_twist_joint_def_init(&def);
    def.body_a = trunk;
    def.body_b = part;
    limit(&def.swing, 0, swing);
    limit(&def.twist, -0.5f, 0.5f);
    check(taut_joint_frames_from_world(world, trunk, part, (taut_pos){x, y, 0}, (taut_vec3){0, up, 0}, &def.frame_a,
                                       &def.frame_b));
    check(taut_world_add_cone_twist_joint(world, &def, &joints[joint_count++]));
}

int main(void) {
    taut_world_def world_def;
    taut_plane_def plane;
    taut_body_def ground_def;
    taut_body ground;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));
    taut_plane_def_init(&plane);
    taut_body_def_init(&ground_def);
    check(taut_world_add_plane(world, &plane, &ground_def.shape));
    ground_def.kind = TAUT_BODY_STATIC;
    check(taut_world_add_body(world, &ground_def, &ground));

    const double up = 1; /* the soles' height [m] */
    taut_body trunk = limb(0, up + 0.95, up + 1.5, 0.15f, 40);
    lean(trunk, limb(0, up + 1.52, up + 1.8, 0.1f, 5), 0, up + 1.52, 1, 0.7f);
    for (int side = -1; side <= 1; side += 2) {
        taut_body thigh = limb(side * 0.12, up + 0.5, up + 0.95, 0.075f, 9);
        lean(trunk, thigh, side * 0.12, up + 0.95, -1, 1.2f);
        bend(thigh, limb(side * 0.12, up, up + 0.5, 0.055f, 4), side * 0.12, up + 0.5, 1);
        taut_body arm = limb(side * 0.25, up + 1.1, up + 1.42, 0.045f, 2);
        lean(trunk, arm, side * 0.25, up + 1.42, -1, 1.6f);
        bend(arm, limb(side * 0.25, up + 0.8, up + 1.1, 0.04f, 2), side * 0.25, up + 1.1, -1);
    }
    /* Tipped forwards, so that it does not stand. */
    check(taut_body_set_velocity(trunk, (taut_vec3){0, 0, 1}, (taut_vec3){1, 0, 0}));

    float widest = 0;
    for (int step = 0; step < 600; ++step) {
        check(taut_world_step(world));
        for (int i = 0; i < joint_count; ++i) {
            float gap;
            check(taut_joint_get_error(joints[i], &gap));
            if (gap > widest) widest = gap;
        }
    }
    double highest = 0, fastest = 0;
    for (int i = 0; i < body_count; ++i) {
        taut_pose pose;
        taut_vec3 v;
        check(taut_body_get_pose(bodies[i], &pose));
        check(taut_body_get_velocity(bodies[i], &v, NULL));
        highest = fmax(highest, pose.position.y);
        fastest = fmax(fastest, sqrt((double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z));
    }
    printf("%d bodies on %d joints, opened by %.1f mm at most\n", body_count, joint_count, 1e3 * (double)widest);
    printf("after 10 s it lies: highest body at %.2f m, fastest at %.3f m/s\n", highest, fastest);
    check(taut_world_destroy(world));
    return 0;
}
