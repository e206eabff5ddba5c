/* A game loop: frames of any length over steps of a fixed one.
 *
 * A lift carries a crate up by two metres. What the host does once a frame (lead the lift, push the crate, read events)
 * means the same at any rate of frames; what is drawn lies between two steps. The program plays the same four seconds
 * at 24, 60 and 144 frames a second and tells where the crate came to.
 */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

static taut_body add_box(taut_world world, taut_body_kind kind, taut_vec3 half_extents, double y) {
    taut_box_def box;
    taut_body_def def;
    taut_body body;
    taut_box_def_init(&box);
    box.half_extents = half_extents;
    taut_body_def_init(&def);
    check(taut_world_add_box(world, &box, &def.shape));
    def.kind = kind;
    def.position.y = y;
    check(taut_world_add_body(world, &def, &body));
    return body;
}

/* Of the lift's floor after so many seconds [m]: up by 1 m/s for two of them. */
static double lift_height(double time) { return time < 1 ? 0 : time < 3 ? time - 1 : 2; }

static void play(double frames_a_second) {
    taut_world_def world_def;
    taut_world world;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));
    taut_body lift = add_box(world, TAUT_BODY_KINEMATIC, (taut_vec3){2, 0.1f, 2}, -0.1);
    taut_body crate = add_box(world, TAUT_BODY_DYNAMIC, (taut_vec3){0.5f, 0.5f, 0.5f}, 0.5);

    const double seconds = 1 / frames_a_second; /* a real game measures what the frame before took */
    uint32_t steps = 0, lands = 0;
    double drawn = 0;
    const int frames = (int)(4 * frames_a_second + 0.5);
    for (int frame = 1; frame <= frames; ++frame) {
        taut_pose target = {.rotation = {0, 0, 0, 1}};
        target.position.y = lift_height(frame * seconds) - 0.1;
        check(taut_body_move_kinematic(lift, &target)); /* by the end of this frame */
        check(taut_body_apply_force(crate, (taut_vec3){100, 0, 0}, (taut_vec3){0, 0, 0})); /* its friction bears that */

        taut_advance advanced;
        check(taut_world_advance(world, seconds, &advanced)); /* no step, one or several */
        steps += advanced.steps;

        taut_events events; /* each once, however many steps the frame took */
        check(taut_world_get_events(world, &events));
        lands += events.begin_count;

        taut_pose pose; /* one to draw: up to a step behind, and smooth */
        check(taut_body_get_render_pose(crate, &pose));
        drawn = pose.position.y;
    }
    printf("%3.0f frames a second: %u steps, %u landings, crate drawn at %.3f m\n", frames_a_second, steps, lands,
           drawn);
    check(taut_world_destroy(world));
}

int main(void) {
    play(24);
    play(60);
    play(144);
    return 0;
}
