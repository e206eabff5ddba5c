/* A ragdoll: a skeleton of ten bones, capsules on joints with the limits of limbs, dropped on the ground.
 *
 * Each joint is given where it is at rest, its x axis along the bone, about which that twists: shoulders, hips and the
 * neck lean to any side, elbows and knees bend about one axis, the other two being locked.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

enum { TRUNK, HEAD, BONES = 10 };

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

static taut_world world;

/* A capsule whose axis goes from one height to another, at x. */
static taut_bone_def limb(int parent, double x, double low, double high, float radius, float mass) {
    taut_capsule_def capsule;
    taut_bone_def bone;
    taut_capsule_def_init(&capsule);
    capsule.radius = radius;
    capsule.half_length = (float)(high - low) / 2 - radius;
    taut_bone_def_init(&bone);
    check(taut_world_add_capsule(world, &capsule, &bone.shape));
    bone.parent = parent;
    bone.mass = mass;
    bone.friction = 3; /* muscles at rest [N m] */
    bone.pose.position = (taut_pos){x, (low + high) / 2, 0};
    bone.joint.position = (taut_pos){x, high, 0};
    return bone;
}

/* A shoulder, hip or neck: leans by up to swing [rad] from hanging down (or up), and twists by up to half a radian. */
static taut_bone_def lean(taut_bone_def bone, float up, float swing) {
    bone.joint.rotation = (taut_quat){0, 0, up * 0.70710678f, 0.70710678f}; /* x up or down */
    bone.upper = (taut_vec3){0.5f, swing, swing};
    bone.lower = (taut_vec3){-0.5f, -swing, -swing};
    return bone;
}

/* An elbow or a knee: bends about the world's x, or against it, from straight to 140 degrees. */
static taut_bone_def bend(taut_bone_def bone, float side) {
    bone.joint.rotation = (taut_quat){-0.5f * side, 0.5f * side, -0.5f, 0.5f}; /* x down, z along the world's */
    bone.lower = (taut_vec3){0, 0, 0};
    bone.upper = (taut_vec3){0, 0, 2.44f};
    return bone;
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

    taut_bone_def bones[BONES]; /* heights over the soles */
    bones[TRUNK] = limb(-1, 0, 0.95, 1.5, 0.15f, 40);
    bones[HEAD] = lean(limb(TRUNK, 0, 1.52, 1.8, 0.1f, 5), 1, 0.7f);
    bones[HEAD].joint.position.y = 1.52;
    for (int i = 0; i < 2; ++i) {
        const double side = i ? 1 : -1;
        const int thigh = 2 + 4 * i, arm = thigh + 2;
        bones[thigh] = lean(limb(TRUNK, side * 0.12, 0.5, 0.95, 0.075f, 9), -1, 1.2f);
        bones[thigh + 1] = bend(limb(thigh, side * 0.12, 0, 0.5, 0.055f, 4), 1);
        bones[arm] = lean(limb(TRUNK, side * 0.25, 1.1, 1.42, 0.045f, 2), -1, 1.5f);
        bones[arm + 1] = bend(limb(arm, side * 0.25, 0.8, 1.1, 0.04f, 2), -1);
    }
    taut_ragdoll_def def;
    taut_ragdoll ragdoll;
    taut_ragdoll_def_init(&def);
    def.bones = bones;
    def.bone_count = BONES;
    def.pose.position.y = 1; /* of the soles [m] */
    taut_ragdoll_init(&ragdoll);
    check(taut_world_add_ragdoll(world, &def, &ragdoll));
    /* Tipped forwards, so that it does not stand. */
    check(taut_body_set_velocity(ragdoll.bodies[TRUNK], (taut_vec3){0, 0, 1}, (taut_vec3){1, 0, 0}));

    float widest = 0;
    for (int step = 0; step < 600; ++step) {
        check(taut_world_step(world));
        for (int i = 1; i < BONES; ++i) {
            float gap;
            check(taut_joint_get_error(ragdoll.joints[i], &gap));
            if (gap > widest) widest = gap;
        }
    }
    taut_pose poses[BONES];
    double highest = 0, fastest = 0;
    check(taut_ragdoll_get_poses(&ragdoll, poses, BONES));
    for (int i = 0; i < BONES; ++i) {
        taut_vec3 v;
        check(taut_body_get_velocity(ragdoll.bodies[i], &v, NULL));
        highest = fmax(highest, poses[i].position.y);
        fastest = fmax(fastest, sqrt((double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z));
    }
    printf("%d bodies on %d joints, opened by %.1f mm at most\n", BONES, BONES - 1, 1e3 * (double)widest);
    printf("after 10 s it lies: highest body at %.2f m, fastest at %.3f m/s\n", highest, fastest);
    check(taut_world_destroy(world));
    return 0;
}
