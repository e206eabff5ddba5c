/**
 * @file shape.h
 * Collision shapes. A shape belongs to a world and may be used by any number of its bodies.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_SHAPE_H
#define TAUT_SHAPE_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest number of vertices of a convex hull; more points are reduced to that many. */
#define TAUT_HULL_MAX_VERTICES 64

/** Shapes' sizes and coordinates lie in [TAUT_SHAPE_MIN_SIZE, TAUT_SHAPE_MAX_SIZE] [m]. */
#define TAUT_SHAPE_MIN_SIZE 1e-3f
#define TAUT_SHAPE_MAX_SIZE 1e4f

/** Half space below a plane: all points p with normal . p <= 0 in the body's frame. Static and kinematic bodies only.
 */
typedef struct taut_plane_def {
    uint32_t struct_size;
    taut_vec3 normal; /**< outward, non-zero; normalised. Default (0, 1, 0) */
} taut_plane_def;

/** Box centred on the body's origin. */
typedef struct taut_box_def {
    uint32_t struct_size;
    taut_vec3 half_extents; /**< [m]. Default 0.5 each */
} taut_box_def;

/** Sphere centred on the body's origin. */
typedef struct taut_sphere_def {
    uint32_t struct_size;
    float radius; /**< [m]. Default 0.5 */
} taut_sphere_def;

/** Capsule along the body's y axis, centred on its origin. */
typedef struct taut_capsule_def {
    uint32_t struct_size;
    float radius;      /**< [m]. Default 0.25 */
    float half_length; /**< half the distance between the centres of the two caps [m]. Default 0.5 */
} taut_capsule_def;

/**
 * Convex hull of points given in the body's frame. The hull keeps at most TAUT_HULL_MAX_VERTICES of
 * them. Refused: fewer than 4 points, points in one plane or closer than TAUT_SHAPE_MIN_SIZE thick.
 */
typedef struct taut_hull_def {
    uint32_t struct_size;
    uint32_t point_count;
    const taut_vec3* points; /**< point_count points [m]; copied */
} taut_hull_def;

/** Mass properties of a shape at a density, about its centre of mass, axes of the body's frame. */
typedef struct taut_mass_properties {
    float mass;               /**< [kg] */
    taut_vec3 centre_of_mass; /**< in the body's frame [m] */
    taut_sym3 inertia;        /**< about the centre of mass [kg m^2] */
} taut_mass_properties;

TAUT_API void taut_plane_def_init(taut_plane_def* def);
TAUT_API void taut_box_def_init(taut_box_def* def);
TAUT_API void taut_sphere_def_init(taut_sphere_def* def);
TAUT_API void taut_capsule_def_init(taut_capsule_def* def);
TAUT_API void taut_hull_def_init(taut_hull_def* def);

/**
 * Adds a shape to a world.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_INVALID_ARGUMENT (size out of range, zero normal, degenerate points), TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_plane(taut_world world, const taut_plane_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_box(taut_world world, const taut_box_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_sphere(taut_world world, const taut_sphere_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_capsule(taut_world world, const taut_capsule_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_hull(taut_world world, const taut_hull_def* def, taut_shape* out);

/** Removes a shape. @return TAUT_OK; TAUT_IN_USE while a body uses it; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_shape_remove(taut_shape shape);
/** 1 if the handle names a live shape, else 0. */
TAUT_API int32_t taut_shape_is_valid(taut_shape shape);

/**
 * Mass properties at a density [kg/m^3] > 0.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT for a density out of range or a plane (no volume); TAUT_STALE_HANDLE.
 */
TAUT_API taut_result taut_shape_mass_properties(taut_shape shape, float density, taut_mass_properties* out);

/**
 * Triangles of a hull shape for drawing, outward counter-clockwise: positions receives three points a
 * triangle in the body's frame. With positions null or capacity too small: TAUT_TOO_SMALL and *count holds the number
 * of points needed.
 * @return TAUT_OK; TAUT_TOO_SMALL; TAUT_INVALID_ARGUMENT if the shape is not a hull; TAUT_STALE_HANDLE.
 */
TAUT_API taut_result taut_shape_hull_triangles(taut_shape shape, taut_vec3* positions, uint32_t capacity,
                                               uint32_t* count);

#ifdef __cplusplus
}
#endif

#endif
