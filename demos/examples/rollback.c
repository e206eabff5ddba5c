/* Rollback: a game over a network guesses what the other player does, and puts right what it guessed wrong.
 *
 * Two players push a ball. The inputs of the other one arrive six steps late; until then they are taken for his last
 * known ones. Where they turn out to be others, the world goes back to its snapshot of that step and takes the steps
 * since again. In the end it is, bit by bit, where a world is that knew every input at once.
 */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

enum { STEPS = 240, LATE = 6, SLOTS = LATE + 1 };

typedef struct {
    taut_world world;
    taut_body ball, crates[10];
} Game;

static Game start(void) {
    Game game;
    taut_world_def world_def;
    taut_plane_def plane;
    taut_sphere_def sphere;
    taut_box_def box;
    taut_body_def ground_def, ball_def, crate_def;
    taut_body ground;
    taut_world_def_init(&world_def);
    check(taut_world_create(&world_def, &game.world));
    taut_plane_def_init(&plane);
    taut_sphere_def_init(&sphere);
    taut_box_def_init(&box);
    taut_body_def_init(&ground_def);
    taut_body_def_init(&ball_def);
    taut_body_def_init(&crate_def);
    ground_def.kind = TAUT_BODY_STATIC;
    check(taut_world_add_plane(game.world, &plane, &ground_def.shape));
    check(taut_world_add_body(game.world, &ground_def, &ground));
    check(taut_world_add_sphere(game.world, &sphere, &ball_def.shape));
    ball_def.position.y = 0.5;
    check(taut_world_add_body(game.world, &ball_def, &game.ball));
    box.half_extents = (taut_vec3){0.25f, 0.25f, 0.25f};
    check(taut_world_add_box(game.world, &box, &crate_def.shape));
    crate_def.mass = 20;
    for (int i = 0; i < 10; ++i) { /* two rows to run into */
        crate_def.position = (taut_pos){i < 5 ? 2 : -2, 0.25 + 0.5 * (i % 5), 0};
        check(taut_world_add_body(game.world, &crate_def, &game.crates[i]));
    }
    return game;
}

/* Force of a player on the ball in a step [N]. */
static float input(int player, int step) {
    if (player == 0) return step < 40 ? 4000.0f : 0;
    return step / 50 % 2 == 1 ? -3000.0f : 500.0f;
}

static void step_with(const Game* game, float first, float second) {
    check(taut_body_apply_force(game->ball, (taut_vec3){first + second, 0, 0}, (taut_vec3){0, 0, 0}));
    check(taut_world_step(game->world));
}

static uint64_t state(const Game* game) {
    uint64_t hash;
    check(taut_world_get_state_hash(game->world, &hash));
    return hash;
}

int main(void) {
    Game known = start();
    for (int step = 0; step < STEPS; ++step) step_with(&known, input(0, step), input(1, step));

    Game guessed = start();
    uint64_t bytes;
    check(taut_world_snapshot_size(guessed.world, &bytes));
    const uint64_t capacity = 4 * bytes; /* it grows as things touch */
    char* ring = malloc(SLOTS * capacity);
    uint64_t sizes[SLOTS];
    float used[STEPS];
    int rollbacks = 0, again = 0;
    for (int step = 0; step < STEPS + LATE; ++step) {
        const int arrived = step - LATE; /* the step whose input comes in now */
        if (arrived >= 0 && input(1, arrived) != used[arrived]) {
            const int slot = arrived % SLOTS;
            check(taut_world_restore(guessed.world, ring + slot * capacity, sizes[slot]));
            ++rollbacks;
            for (int redo = arrived; redo < step && redo < STEPS; ++redo, ++again) {
                check(taut_world_save(guessed.world, ring + redo % SLOTS * capacity, capacity, &sizes[redo % SLOTS]));
                used[redo] = input(1, arrived);
                step_with(&guessed, input(0, redo), used[redo]);
            }
        }
        if (step >= STEPS) continue;
        check(taut_world_save(guessed.world, ring + step % SLOTS * capacity, capacity, &sizes[step % SLOTS]));
        used[step] = arrived >= 0 ? input(1, arrived) : 0;
        step_with(&guessed, input(0, step), used[step]);
    }

    taut_pose pose;
    check(taut_body_get_pose(guessed.ball, &pose));
    printf("went back %d times and took %d steps again\n", rollbacks, again);
    printf("known from the start: state %016llx\n", (unsigned long long)state(&known));
    printf("guessed and put right: state %016llx\n", (unsigned long long)state(&guessed));
    printf("the ball is at x %.2f\n", pose.position.x);
    const int same = state(&known) == state(&guessed);
    free(ring);
    check(taut_world_destroy(known.world));
    check(taut_world_destroy(guessed.world));
    return same ? 0 : 1;
}
