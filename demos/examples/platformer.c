/* A character that runs, climbs stairs, rides a lift that is led up and down, jumps off and pushes a crate.
 * cc platformer.c $(pkg-config --cflags --libs taut) && ./a.out */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

static taut_body add_box(taut_world world, taut_body_kind kind, float x, float y, float half_x, float half_y) {
    taut_box_def box;
    taut_box_def_init(&box);
    box.half_extents = (taut_vec3){half_x, half_y, 2};
    taut_shape shape;
    check(taut_world_add_box(world, &box, &shape));
    taut_body_def def;
    taut_body_def_init(&def);
    def.kind = kind, def.shape = shape, def.position = (taut_pos){x, y, 0}, def.mass = 40;
    taut_body body;
    check(taut_world_add_body(world, &def, &body));
    return body;
}

int main(void) {
    taut_world world;
    taut_world_def world_def;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &world));
    add_box(world, TAUT_BODY_STATIC, 0, -1, 100, 1);
    for (int i = 0; i < 8; ++i) /* stairs of 25 cm from x = 3 */
        add_box(world, TAUT_BODY_STATIC, 3.2f + 0.4f * (float)i, 0.125f * (float)(i + 1), 0.2f,
                0.125f * (float)(i + 1));
    taut_body lift = add_box(world, TAUT_BODY_KINEMATIC, 7.2f, 1.9f, 1, 0.1f);
    taut_body crate = add_box(world, TAUT_BODY_DYNAMIC, 14, 0.5f, 0.5f, 0.5f);

    taut_capsule_def capsule;
    taut_capsule_def_init(&capsule);
    capsule.radius = 0.3f, capsule.half_length = 0.6f;
    taut_character_def def;
    taut_character_def_init(&def);
    check(taut_world_add_capsule(world, &capsule, &def.shape));
    taut_character hero;
    taut_character_init(&hero);
    hero.position = (taut_pos){0, 1, 0};

    const float seconds = 1 / 60.0f;
    for (int frame = 0; frame < 720; ++frame) {
        float time = (float)frame * seconds;
        taut_pose target; /* of the lift: up by 2 m between the third and the fifth second */
        check(taut_body_get_pose(lift, &target));
        target.position.y = 1.9 + (time < 3 ? 0 : time < 5 ? time - 3 : 2);
        check(taut_body_move_kinematic(lift, &target));
        check(taut_world_advance(world, seconds, NULL));

        taut_vec3 walk = {0, 0, 0};
        if (hero.position.x < 7.2 || time > 6) walk.x = 3; /* stops on the lift */
        float jump = frame == 370 ? 5 : 0;
        check(taut_character_move(world, &def, walk, jump, seconds, &hero));
        if (frame % 60 == 59)
            printf("%2d s: at %.2f, %.2f, %s\n", frame / 60 + 1, hero.position.x, hero.position.y,
                   hero.state == TAUT_CHARACTER_ON_GROUND ? "on the ground" : "in the air");
    }
    taut_pose end;
    check(taut_body_get_pose(crate, &end));
    printf("the crate was pushed from 14 to %.2f\n", end.position.x);
    check(taut_world_destroy(world));
    return hero.position.x > 12 && end.position.x > 14.5 ? 0 : 1;
}
