/* What the pieces of C in the pages take for given. */
#include <stdio.h>
#include <stdlib.h>
#include <taut/taut.h>

static taut_world world;
static taut_body body, other, wall, door;
static taut_shape shape;
static taut_collider runner;
static taut_joint joint;
static taut_cable cable;
static taut_cloth cloth;
static taut_solid solid;
static taut_pos place, pivot;
static taut_vec3 up, walk;
static float jump;
static double seconds;
static const taut_pos* points;
static const uint32_t *triangles, *cells;
static uint32_t point_count, triangle_count, cell_count;
static taut_ragdoll_def skeleton;
static taut_pose animated[TAUT_RAGDOLL_MAX_BONES], drawn[TAUT_RAGDOLL_MAX_BONES];
static FILE* file;

static int32_t write_bytes(const void* bytes, uint64_t size, void* user_data) {
    return fwrite(bytes, 1, (size_t)size, (FILE*)user_data) == size;
}

static void check(taut_result result) {
    if (result != TAUT_OK) fprintf(stderr, "%s\n", taut_last_error());
}

static void play(taut_pos position, float speed) { (void)position, (void)speed; }
