/* Triggers: a sensor tells who comes and goes, contact events tell what hits what.
 *
 * A ball falls through a ring, lands on a floor and bounces. The ring is a sensor: a collider that collides with
 * nothing. Events are read once a frame and name bodies by the host's own number, their user_data.
 */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

enum { FLOOR, RING, BALL }; /* what the game calls its things */
static const char* const name_of[] = {"floor", "ring", "ball"};

static const char* name(taut_body body) {
    uint64_t which;
    check(taut_body_get_user_data(body, &which));
    return name_of[which];
}

static taut_body add(taut_world world, taut_body_kind kind, taut_shape shape, uint64_t which, double y,
                     uint32_t flags) {
    taut_body_def def;
    taut_body body;
    taut_body_def_init(&def);
    def.kind = kind;
    def.shape = shape;
    def.position.y = y;
    def.user_data = which;
    def.collider_flags = flags;
    def.contact_events = TAUT_CONTACT_EVENTS_HIT; /* beside those that the world gives of all: begin and end */
    def.material.restitution = 0.5f;
    check(taut_world_add_body(world, &def, &body));
    return body;
}

int main(void) {
    taut_world_def world_def;
    taut_world world;
    taut_world_def_init(&world_def);
    world_def.hit_speed = 2; /* slower touches make no noise [m/s] */
    check(taut_world_create(&world_def, &world));

    taut_plane_def plane;
    taut_box_def box;
    taut_sphere_def sphere;
    taut_shape ground, ring, ball;
    taut_plane_def_init(&plane);
    taut_box_def_init(&box);
    taut_sphere_def_init(&sphere);
    box.half_extents = (taut_vec3){1, 0.5f, 1};
    sphere.radius = 0.25f;
    check(taut_world_add_plane(world, &plane, &ground));
    check(taut_world_add_box(world, &box, &ring));
    check(taut_world_add_sphere(world, &sphere, &ball));
    add(world, TAUT_BODY_STATIC, ground, FLOOR, 0, 0);
    add(world, TAUT_BODY_STATIC, ring, RING, 3, TAUT_COLLIDER_SENSOR);
    add(world, TAUT_BODY_DYNAMIC, ball, BALL, 5, 0);

    for (int frame = 1; frame <= 180; ++frame) {
        taut_events events;
        check(taut_world_step(world));
        check(taut_world_get_events(world, &events));
        const double time = frame / 60.0;
        for (uint32_t i = 0; i < events.sensor_enter_count; ++i)
            printf("%.2f s: %s enters the %s\n", time, name(events.sensor_enter[i].visitor_body),
                   name(events.sensor_enter[i].sensor_body));
        for (uint32_t i = 0; i < events.sensor_leave_count; ++i)
            printf("%.2f s: %s leaves the %s\n", time, name(events.sensor_leave[i].visitor_body),
                   name(events.sensor_leave[i].sensor_body));
        for (uint32_t i = 0; i < events.hit_count; ++i)
            printf("%.2f s: %s hits %s at %.1f m/s\n", time, name(events.hit[i].body_b), name(events.hit[i].body_a),
                   events.hit[i].approach_speed);
    }
    check(taut_world_destroy(world));
    return 0;
}
