/* Threads: a step on one thread, on the world's own threads, and on the workers of the host's task system.
 *
 * All three give the same bits. A world with threads above 1 starts its own, which sleep between steps; a game that has
 * a task system of its own gives it by two hooks. The one here starts a thread for each worker and step, to be short:
 * a real one has its workers waiting.
 */
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static void check(taut_result result) {
    if (result == TAUT_OK) return;
    fprintf(stderr, "%s\n", taut_last_error());
    exit(1);
}

enum { WORKERS = 3 };

typedef struct {
    pthread_t thread;
    int runs;
    taut_task_fn task;
    void* task_data;
    uint32_t number;
} Worker;

typedef struct {
    Worker workers[WORKERS];
    unsigned handed_out, finished;
} TaskSystem;

static void* work(void* data) {
    Worker* worker = data;
    worker->task(worker->number, worker->number + 1, worker->number, worker->task_data);
    return NULL;
}

/* Each of the step's count tasks goes to one worker; what nobody takes the stepping thread does itself. */
static void* enqueue(taut_task_fn task, uint32_t count, uint32_t grain, void* task_data, void* user_data) {
    TaskSystem* system = user_data;
    (void)grain;
    for (uint32_t i = 0; i < WORKERS; ++i) {
        Worker* worker = &system->workers[i];
        worker->task = task;
        worker->task_data = task_data;
        worker->number = i;
        worker->runs = i < count && pthread_create(&worker->thread, NULL, work, worker) == 0;
    }
    ++system->handed_out;
    return system;
}

static void finish(void* token, void* user_data) {
    TaskSystem* system = token;
    (void)user_data;
    for (int i = 0; i < WORKERS; ++i)
        if (system->workers[i].runs) pthread_join(system->workers[i].thread, NULL);
    ++system->finished;
}

/* 1000 boxes fall in a heap for three seconds. */
static uint64_t run(const char* how, const taut_world_def* world_def) {
    taut_world world;
    taut_plane_def plane;
    taut_box_def box;
    taut_body_def ground, crate;
    taut_body body;
    check(taut_world_create(world_def, &world));
    taut_plane_def_init(&plane);
    taut_box_def_init(&box);
    box.half_extents = (taut_vec3){0.25f, 0.25f, 0.25f};
    taut_body_def_init(&ground);
    taut_body_def_init(&crate);
    ground.kind = TAUT_BODY_STATIC;
    check(taut_world_add_plane(world, &plane, &ground.shape));
    check(taut_world_add_box(world, &box, &crate.shape));
    check(taut_world_add_body(world, &ground, &body));
    for (int i = 0; i < 1000; ++i) {
        const int layer = i / 100, row = i / 10 % 10, column = i % 10;
        crate.position = (taut_pos){0.6 * column + 0.05 * (layer % 3), 0.3 + 0.6 * layer, 0.6 * row};
        check(taut_world_add_body(world, &crate, &body));
    }
    for (int step = 0; step < 180; ++step) check(taut_world_step(world));
    uint64_t hash;
    check(taut_world_get_state_hash(world, &hash));
    printf("%s: state %016llx\n", how, (unsigned long long)hash);
    check(taut_world_destroy(world));
    return hash;
}

int main(void) {
    taut_world_def def;
    taut_world_def_init(&def);
    const uint64_t alone = run("one thread", &def);

    def.threads = 4;
    const uint64_t own = run("four threads of the world", &def);

    TaskSystem system = {.handed_out = 0};
    def.threads = 1;
    def.hooks.enqueue_task = enqueue;
    def.hooks.finish_task = finish;
    def.hooks.task_user_data = &system;
    def.hooks.worker_count = WORKERS;
    const uint64_t host = run("three workers of the host", &def);

    printf("tasks handed out in %u steps, %u finished\n", system.handed_out, system.finished);
    return alone == own && alone == host ? 0 : 1;
}
