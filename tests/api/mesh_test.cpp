// Meshes and height fields: what is refused and why, repairs, read-back, where they may be used.
#include "def_check.h"

using namespace taut_test;

namespace {

class Meshes : public testing::Test {
protected:
    Meshes() {
        EXPECT_EQ(make_mesh(p.world, &mesh), TAUT_OK) << taut_last_error();
        EXPECT_EQ(make_height_field(p.world, &field), TAUT_OK) << taut_last_error();
    }

    Populated p;
    taut_shape mesh{}, field{};
};

TEST_F(Meshes, RefuseBadDefs) {
    taut_vec3 vertices[] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    uint32_t indices[] = {0, 1, 2};
    taut_mesh_def def = mesh_def(vertices, indices);
    DefCheck check(p.world, "taut_world_add_mesh", taut_world_add_mesh);
    check.run(def, {});
    for (float bad : {NAN, INFINITY, 1.1e4f}) {
        vertices[1].y = bad;
        check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "vertices");
    }
    vertices[1].y = 0;
    indices[2] = 3;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "indices");
    indices[2] = 1;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "no triangle has an area");
    def.two_sided = 2;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "two_sided");
    def.triangle_count = TAUT_MESH_MAX_TRIANGLES + 1;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "triangle_count");
    def.vertex_count = 2;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "vertex_count");
}

TEST_F(Meshes, RefuseBadHeights) {
    float heights[] = {0, 0, 0, 0};
    taut_height_field_def def;
    taut_height_field_def_init(&def);
    def.heights = heights;
    def.rows = def.columns = 2;
    DefCheck check(p.world, "taut_world_add_height_field", taut_world_add_height_field);
    check.run(def, {FIELD(taut_height_field_def, row_spacing, 1e-3f, 1e4f),
                    FIELD(taut_height_field_def, column_spacing, 1e-3f, 1e4f)});
    heights[3] = INFINITY;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "heights");
    heights[3] = heights[0] = heights[1] = NAN;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "holes");
    def.rows = 1;
    check.expect_refused(&def, TAUT_INVALID_ARGUMENT, "rows");
}

TEST_F(Meshes, BelongOnStaticAndKinematicBodies) {
    taut_body body{};
    for (taut_shape shape : {mesh, field}) {
        for (taut_body_kind kind : {TAUT_BODY_STATIC, TAUT_BODY_KINEMATIC}) {
            const taut_body_def def = body_def(kind, shape);
            EXPECT_EQ(taut_world_add_body(p.world, &def, &body), TAUT_OK) << taut_last_error();
        }
        const taut_body_def def = body_def(TAUT_BODY_DYNAMIC, shape);
        EXPECT_EQ(taut_world_add_body(p.world, &def, &body), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "static and kinematic")) << taut_last_error();
        taut_mass_properties mass;
        EXPECT_EQ(taut_shape_get_mass_properties(shape, 1000, &mass), TAUT_INVALID_ARGUMENT);
        EXPECT_TRUE(contains(taut_last_error(), "no volume")) << taut_last_error();
    }
}

TEST_F(Meshes, AreReadBackScaled) {
    taut_shape scaled{}, twice{};
    ASSERT_OK(taut_shape_add_scaled(mesh, {2, 1, -3}, &scaled));
    ASSERT_OK(taut_shape_add_scaled(scaled, {0.5f, 1, 1}, &twice));
    taut_vec3 points[6];
    uint32_t count = 0;
    EXPECT_EQ(taut_shape_get_triangles(twice, nullptr, 0, &count), TAUT_TOO_SMALL);
    ASSERT_EQ(count, 6u);
    ASSERT_OK(taut_shape_get_triangles(twice, points, 6, &count));
    for (int t = 0; t < 6; t += 3) {
        const taut_vec3 &a = points[t], &b = points[t + 1], &c = points[t + 2];
        EXPECT_GT((b.z - a.z) * (c.x - a.x) - (b.x - a.x) * (c.z - a.z), 0) << "looks down";
    }
    for (const taut_vec3& q : points) EXPECT_TRUE((q.x == 0 || q.x == 1) && (q.z == 0 || q.z == -3));
    taut_mesh_info info;
    ASSERT_OK(taut_shape_get_mesh_info(field, &info));
    EXPECT_EQ(info.triangles, 1u);
    for (taut_vec3 bad : {taut_vec3{0, 1, 1}, taut_vec3{NAN, 1, 1}, taut_vec3{2000, 1, 1}})
        EXPECT_EQ(taut_shape_add_scaled(mesh, bad, &scaled), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_add_scaled(p.box, {1, 1, 1}, &scaled), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_get_mesh_info(p.hull, &info), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_get_triangles(p.box, points, 6, &count), TAUT_INVALID_ARGUMENT);
}

// A box that slides from facet to facet keeps touching the body: one begin, no end.
TEST_F(Meshes, SendEventsByPair) {
    const taut_world world = make_world();
    taut_shape steps{};
    const taut_vec3 vertices[] = {{-9, 0, -9}, {-9, 0, 9}, {0, 0, 9}, {0, 0, -9}, {9, 1, 9}, {9, 1, -9}};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
    const taut_mesh_def def = mesh_def(vertices, indices);
    ASSERT_OK(taut_world_add_mesh(world, &def, &steps));
    add_body(world, body_def(TAUT_BODY_STATIC, steps));
    const taut_body box = add_body(world, body_def(TAUT_BODY_DYNAMIC, add_box(world), -2, 0.5, 0));
    ASSERT_OK(taut_body_set_velocity(box, {6, 0, 0}, {0, 0, 0}));
    uint32_t begun = 0, ended = 0;
    for (int i = 0; i < 30; ++i) {
        ASSERT_OK(taut_world_step(world));
        const taut_events events = events_of(world);
        begun += events.begin_count, ended += events.end_count;
    }
    EXPECT_EQ(begun, 1u);
    EXPECT_EQ(ended, 0u);
    ASSERT_OK(taut_body_remove(box));
    ASSERT_OK(taut_world_step(world));
    EXPECT_EQ(events_of(world).end_count, 1u);
    ASSERT_OK(taut_world_destroy(world));
}

// What touches parts of a mesh goes on touching the box that comes in its place, and the mesh after that.
TEST_F(Meshes, GiveWayToABoxAndComeBack) {
    const taut_world world = make_world();
    taut_shape floor{};
    const taut_vec3 vertices[] = {{-9, 0, -9}, {-9, 0, 9}, {9, 0, 9}, {9, 0, -9}};
    const uint32_t indices[] = {0, 1, 2, 0, 2, 3};
    const taut_mesh_def def = mesh_def(vertices, indices);
    ASSERT_OK(taut_world_add_mesh(world, &def, &floor));
    const taut_body ground = add_body(world, body_def(TAUT_BODY_STATIC, floor));
    const taut_shape cube = add_box(world);
    add_body(world, body_def(TAUT_BODY_DYNAMIC, cube, 0, 0.5, 0));
    taut_collider collider{};
    uint32_t count = 0;
    ASSERT_OK(taut_body_get_colliders(ground, &collider, 1, &count));
    for (const auto& [shape, y] : {std::pair(floor, 0.0f), std::pair(cube, -0.5f), std::pair(floor, 0.0f)}) {
        ASSERT_OK(taut_collider_set_shape(collider, shape, {0, y, 0}, {0, 0, 0, 1}));
        for (int i = 0; i < 10; ++i) {
            ASSERT_OK(taut_world_step(world));
            EXPECT_EQ(events_of(world).end_count, 0u) << i;
            taut_contact contacts[8];
            ASSERT_OK(taut_world_get_contacts(world, contacts, 8, &count));
            EXPECT_EQ(count, 4u) << i;
        }
    }
    ASSERT_OK(taut_world_destroy(world));
}

}  // namespace
