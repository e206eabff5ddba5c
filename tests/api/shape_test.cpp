// Shapes read back: kinds, defs, bounds; scaled hulls.
#include <cmath>
#include <cstring>

#include "support.h"

using namespace taut_test;

namespace {

struct Shapes : testing::Test {
    Populated p;

    taut_shape tapered(float bottom, float top, float half) const {
        taut_tapered_capsule_def def;
        taut_tapered_capsule_def_init(&def);
        def.bottom_radius = bottom;
        def.top_radius = top;
        def.half_length = half;
        taut_shape out = {0};
        EXPECT_EQ(taut_world_add_tapered_capsule(p.world, &def, &out), TAUT_OK) << taut_last_error();
        return out;
    }
    taut_shape scaled(taut_vec3 scale) const {
        taut_scaled_hull_def def;
        taut_scaled_hull_def_init(&def);
        def.hull = p.hull;
        def.scale = scale;
        taut_shape out = {0};
        EXPECT_EQ(taut_world_add_scaled_hull(p.world, &def, &out), TAUT_OK) << taut_last_error();
        return out;
    }
};

// Adds a shape by its default def, then reads kind and def back.
template <class Def>
void expect_read_back(taut_world world, taut_shape_kind kind, void (*init)(Def*),
                      taut_result (*add)(taut_world, const Def*, taut_shape*), taut_result (*get)(taut_shape, Def*),
                      taut_shape other) {
    Def def, read;
    init(&def);
    init(&read);
    taut_shape shape = {0};
    ASSERT_EQ(add(world, &def, &shape), TAUT_OK) << taut_last_error();
    taut_shape_kind found = TAUT_SHAPE_KIND_MAX;
    ASSERT_EQ(taut_shape_get_kind(shape, &found), TAUT_OK);
    EXPECT_EQ(found, kind);
    ASSERT_EQ(get(shape, &read), TAUT_OK) << taut_last_error();
    EXPECT_EQ(std::memcmp(&def, &read, sizeof def), 0);
    EXPECT_EQ(get(shape, nullptr), TAUT_NULL_POINTER);
    EXPECT_EQ(get(other, &read), TAUT_INVALID_ARGUMENT);
    read.struct_size = 1;
    EXPECT_EQ(get(shape, &read), TAUT_STRUCT_SIZE);
}

TEST_F(Shapes, AreReadBackAsTheyWereMade) {
    expect_read_back(p.world, TAUT_SHAPE_PLANE, taut_plane_def_init, taut_world_add_plane, taut_shape_get_plane,
                     p.hull);
    expect_read_back(p.world, TAUT_SHAPE_BOX, taut_box_def_init, taut_world_add_box, taut_shape_get_box, p.hull);
    expect_read_back(p.world, TAUT_SHAPE_SPHERE, taut_sphere_def_init, taut_world_add_sphere, taut_shape_get_sphere,
                     p.hull);
    expect_read_back(p.world, TAUT_SHAPE_CAPSULE, taut_capsule_def_init, taut_world_add_capsule, taut_shape_get_capsule,
                     p.hull);
    expect_read_back(p.world, TAUT_SHAPE_CYLINDER, taut_cylinder_def_init, taut_world_add_cylinder,
                     taut_shape_get_cylinder, p.hull);
    expect_read_back(p.world, TAUT_SHAPE_CONE, taut_cone_def_init, taut_world_add_cone, taut_shape_get_cone, p.hull);
    expect_read_back(p.world, TAUT_SHAPE_TAPERED_CAPSULE, taut_tapered_capsule_def_init, taut_world_add_tapered_capsule,
                     taut_shape_get_tapered_capsule, p.hull);
    taut_shape_kind kind = TAUT_SHAPE_KIND_MAX;
    ASSERT_OK(taut_shape_get_kind(scaled({1, 2, 3}), &kind));
    EXPECT_EQ(kind, TAUT_SHAPE_HULL);
    EXPECT_EQ(taut_shape_get_kind(p.box, nullptr), TAUT_NULL_POINTER);
}

TEST_F(Shapes, HaveTightBounds) {
    taut_vec3 low, high;
    ASSERT_OK(taut_shape_get_bounds(tapered(0.3f, 0.1f, 0.5f), &low, &high));
    EXPECT_FLOAT_EQ(low.x, -0.3f);
    EXPECT_FLOAT_EQ(high.z, 0.3f);
    EXPECT_FLOAT_EQ(low.y, -0.8f);
    EXPECT_FLOAT_EQ(high.y, 0.6f);
    EXPECT_EQ(taut_shape_get_bounds(p.plane, &low, &high), TAUT_INVALID_ARGUMENT);
    EXPECT_EQ(taut_shape_get_bounds(p.box, nullptr, &high), TAUT_NULL_POINTER);
    EXPECT_EQ(taut_shape_get_bounds(p.box, &low, nullptr), TAUT_NULL_POINTER);
}

// Volumes go with the product of the factors, mirrored or not, and a shape outlives its source.
TEST_F(Shapes, ScaledHullsHaveScaledVolumeAndBounds) {
    taut_mass_properties base;
    ASSERT_OK(taut_shape_get_mass_properties(p.hull, 1000, &base));
    taut_vec3 low, high;
    ASSERT_OK(taut_shape_get_bounds(p.hull, &low, &high));
    for (const taut_vec3 scale : {taut_vec3{2, 0.5f, 3}, taut_vec3{-2, 0.5f, 3}, taut_vec3{-1, -1, -1}}) {
        const taut_shape shape = scaled(scale);
        taut_mass_properties mass;
        ASSERT_OK(taut_shape_get_mass_properties(shape, 1000, &mass));
        EXPECT_NEAR(mass.mass, base.mass * std::fabs(scale.x * scale.y * scale.z), 1e-4f * mass.mass);
        EXPECT_NEAR(mass.centre_of_mass.x, base.centre_of_mass.x * scale.x, 1e-5f);
        taut_vec3 lo, hi;
        ASSERT_OK(taut_shape_get_bounds(shape, &lo, &hi));
        EXPECT_NEAR(hi.x - lo.x, std::fabs(scale.x) * (high.x - low.x), 1e-5f);
        uint32_t count = 0, base_count = 0;
        EXPECT_EQ(taut_shape_get_triangles(shape, nullptr, 0, &count), TAUT_TOO_SMALL);
        EXPECT_EQ(taut_shape_get_triangles(p.hull, nullptr, 0, &base_count), TAUT_TOO_SMALL);
        EXPECT_EQ(count, base_count);
    }
}

}  // namespace
