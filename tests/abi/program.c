/* A program as one is built against a header of its time: what it prints is the same with an older, smaller header as with
 * today's, and nothing is written beyond its structs. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <taut/taut.h>

#define CHECK(condition)                                                               \
    do {                                                                               \
        if (!(condition)) {                                                            \
            printf("line %d: %s (%s)\n", __LINE__, #condition, taut_last_error());     \
            exit(1);                                                                   \
        }                                                                              \
    } while (0)
#define OK(call) CHECK((call) == TAUT_OK)

/* One or more of a type between bytes that must stay. */
#define GUARDED(type, name, count)    \
    struct {                          \
        unsigned char before[16];     \
        type of[count];               \
        unsigned char after[64];      \
    } name;                           \
    memset(&name, 0xa5, sizeof(name))
static int is_whole(const unsigned char* bytes, size_t count) {
    for (size_t i = 0; i < count; ++i)
        if (bytes[i] != 0xa5) return 0;
    return 1;
}
#define WHOLE(name) CHECK(is_whole((name).before, 16) && is_whole((name).after, 64))

enum { BOXES = 80, HITS = 100 };

static taut_world world;
static taut_body boxes[BOXES];

static void build(void) {
    GUARDED(taut_world_def, world_def, 1);
    taut_world_def_init(world_def.of);
    WHOLE(world_def);
    world_def.of[0].contact_events = TAUT_CONTACT_EVENTS_ALL;
    OK(taut_world_create(world_def.of, &world));
    OK(taut_world_get_def(world, world_def.of));
    WHOLE(world_def);
    CHECK(world_def.of[0].struct_size == sizeof(taut_world_def));

    taut_shape box;
    GUARDED(taut_box_def, box_def, 1);
    taut_box_def_init(box_def.of);
    WHOLE(box_def);
    OK(taut_world_add_box(world, box_def.of, &box));

    static const taut_vec3 corners[4] = {{-50, 0, -50}, {-50, 0, 50}, {50, 0, 50}, {50, 0, -50}};
    static const uint32_t indices[9] = {0, 1, 2, 0, 2, 3, 0, 2, 3};
    taut_shape ground;
    taut_mesh_def mesh_def;
    GUARDED(taut_mesh_info, info, 1);
    taut_mesh_def_init(&mesh_def);
    mesh_def.vertices = corners, mesh_def.vertex_count = 4;
    mesh_def.indices = indices, mesh_def.triangle_count = 3;
    OK(taut_world_add_mesh(world, &mesh_def, &ground));
    OK(taut_shape_get_mesh_info(ground, info.of));
    WHOLE(info);
    printf("%u triangles, %u facets\n", info.of[0].triangles, info.of[0].facets);

    taut_body body;
    taut_body_def body_def;
    taut_body_def_init(&body_def);
    body_def.kind = TAUT_BODY_STATIC, body_def.shape = ground;
    OK(taut_world_add_body(world, &body_def, &body));
    taut_collider_def pair[2]; /* of their own length */
    for (int i = 0; i < 2; ++i) {
        taut_collider_def_init(&pair[i]);
        pair[i].shape = box, pair[i].position.y = (float)i;
    }
    for (int i = 0; i < BOXES; ++i) {
        taut_body_def_init(&body_def);
        body_def.colliders = pair, body_def.collider_count = 2;
        body_def.position.x = 1.5 * i - 45, body_def.position.y = 0.6;
        OK(taut_world_add_body(world, &body_def, &boxes[i]));
    }

    /* A box on a hinge, whose def has a struct inside and an axis behind it. */
    taut_joint joint;
    GUARDED(taut_hinge_joint_def, hinge_def, 1);
    taut_hinge_joint_def_init(hinge_def.of);
    WHOLE(hinge_def);
    hinge_def.of[0].base.body_b = boxes[BOXES - 1];
    hinge_def.of[0].base.frame_a.position.x = 1.5 * (BOXES - 1) - 46, hinge_def.of[0].base.frame_a.position.y = 0.6;
    hinge_def.of[0].base.frame_b.position.x = -1;
    OK(taut_world_add_hinge_joint(world, hinge_def.of, &joint));
    WHOLE(hinge_def);
}

static void look(void) {
    GUARDED(taut_events, events, 1);
    OK(taut_world_get_events(world, events.of));
    WHOLE(events);
    printf("%u began, %u moved\n", events.of[0].begin_count, events.of[0].moved_count);

    static struct {
        unsigned char before[16];
        taut_contact of[8 * BOXES];
        unsigned char after[64];
    } contacts;
    memset(&contacts, 0xa5, sizeof contacts);
    uint32_t count = 0;
    OK(taut_world_get_contacts(world, contacts.of, 8 * BOXES, &count));
    WHOLE(contacts);
    double pressed = 0;
    for (uint32_t i = 0; i < count; ++i) pressed += (double)contacts.of[i].normal_impulse;
    printf("%u contacts, %.9g N s\n", count, pressed);

    GUARDED(taut_query_hit, hits, 2 * HITS); /* more than wait on the stack */
    taut_ray ray;
    memset(&ray, 0, sizeof ray);
    ray.origin.x = -60, ray.origin.y = 0.5, ray.translation.x = 200;
    OK(taut_world_cast_ray_all(world, &ray, NULL, hits.of, 2 * HITS, &count));
    WHOLE(hits);
    for (uint32_t i = 1; i < count; ++i) CHECK(hits.of[i - 1].fraction <= hits.of[i].fraction);
    printf("%u hits from %.9g to %.9g\n", count, (double)hits.of[0].fraction, (double)hits.of[count - 1].fraction);
    OK(taut_world_cast_ray(world, &ray, NULL, hits.of));
    GUARDED(taut_profile, profile, 1);
    profile.of[0].struct_size = sizeof(taut_profile);
    OK(taut_world_get_profile(world, profile.of));
    WHOLE(profile);
    GUARDED(taut_advance, advanced, 1);
    OK(taut_world_advance(world, 1.0 / 60, advanced.of));
    WHOLE(advanced);
}

int main(void) {
    build();
    for (int i = 0; i < 30; ++i) OK(taut_world_step(world));
    look();
    uint64_t hash;
    OK(taut_world_get_state_hash(world, &hash));
    printf("state %016llx\n", (unsigned long long)hash);

    /* What is newer than the library is refused with words. */
    struct {
        taut_box_def def;
        char more[16];
    } newer;
    taut_shape shape;
    taut_box_def_init_sized(&newer.def, sizeof newer);
    CHECK(newer.def.struct_size == sizeof newer);
    CHECK(taut_world_add_box(world, &newer.def, &shape) == TAUT_STRUCT_SIZE);
    CHECK(strstr(taut_last_error(), "newer header"));
    OK(taut_world_destroy(world));
    return 0;
}
