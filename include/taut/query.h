/**
 * @file query.h
 * Questions about where colliders, and the triangles of cloths and solids, are now: rays, shapes on their way,
 * overlaps, distances.
 *
 * Meshes and height fields are met triangle by triangle, from the front alone unless they have two sides; nothing is
 * inside them, and what overlaps one of their triangles overlaps them.
 * Of cloths and solids these see the spheres by which vertices touch. Their triangles answer calls of their own, at the
 * end of this file, in time that grows with the number of triangles.
 * All answers are of the poses at the time of the call. They depend on the scene alone: hits are sorted by fraction,
 * colliders where they tie or where there is no fraction by their slots, which are those of the order of creation as
 * long as none is removed.
 * Each function here: thread safety: any number of threads at once, not inside a step and while no other thread changes
 * the world; the world allocates nothing.
 */
#ifndef TAUT_QUERY_H
#define TAUT_QUERY_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/collider.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Bits of taut_query_filter.kinds: of whose bodies' colliders a query sees; bit n is taut_body_kind n. Sensors are
 * seen with TAUT_QUERY_SENSOR only, by the kind of their bodies. */
#define TAUT_QUERY_STATIC 1u
#define TAUT_QUERY_KINEMATIC 2u
#define TAUT_QUERY_DYNAMIC 4u
#define TAUT_QUERY_PARTICLE 8u
#define TAUT_QUERY_ALL_KINDS 15u
#define TAUT_QUERY_SENSOR 16u

/** Most bodies, and most colliders, that a filter can ignore. */
#define TAUT_QUERY_MAX_IGNORED 64

/**
 * Non-zero if the query shall see the collider. Called on the thread that calls the query, in any order, for colliders
 * near the query that passed the rest of the filter, maybe twice; it may read from the world, not change it.
 */
typedef int32_t (*taut_query_accept_fn)(taut_body body, taut_collider collider, void* user_data);

/**
 * Which colliders a query sees. It has a category and a mask as a collider does and sees those that a collider with
 * them would collide with: each one's category is in the other's mask. Groups do not matter.
 */
typedef struct taut_query_filter {
    uint32_t struct_size;
    uint32_t kinds;                         /**< sum of TAUT_QUERY_ bits. Default all */
    uint64_t category;                      /**< default all bits */
    uint64_t mask;                          /**< default all bits */
    const taut_body* ignored_bodies;        /**< ignored_body_count of them. Default null */
    const taut_collider* ignored_colliders; /**< ignored_collider_count of them. Default null */
    uint32_t ignored_body_count;            /**< at most TAUT_QUERY_MAX_IGNORED. Default 0 */
    uint32_t ignored_collider_count;        /**< likewise */
    taut_query_accept_fn accept;            /**< null: all. Default null */
    void* user_data;                        /**< of accept */
} taut_query_filter;

TAUT_API void taut_query_filter_init_sized(taut_query_filter* filter, uint32_t size);
static inline void taut_query_filter_init(taut_query_filter* filter) {
    taut_query_filter_init_sized(filter, (uint32_t)sizeof(*filter));
}

/** From a point to another: the ray ends at origin + translation. */
typedef struct taut_ray {
    taut_pos origin;       /**< [m], within 1e7 */
    taut_vec3 translation; /**< direction times length [m], its length in [1e-6, 1e7] */
    uint32_t reserved;     /**< zero */
} taut_ray;

/** A shape that goes from a pose to another without turning. */
typedef struct taut_shape_cast {
    taut_shape shape;      /**< not a plane, mesh or height field; it need not be on a body */
    taut_pose pose;        /**< of the shape's origin at the start */
    taut_vec3 translation; /**< direction times length [m], its length in [1e-6, 1e7] */
    uint32_t reserved;     /**< zero */
} taut_shape_cast;

/** All zero: where the ray begins and where it goes is to be said. */
TAUT_API void taut_ray_init(taut_ray* ray);
/** At the origin, unturned; shape and way are to be said. */
TAUT_API void taut_shape_cast_init(taut_shape_cast* cast);

/** Where a ray or a shape on its way meets a collider. */
typedef struct taut_query_hit {
    taut_body body;         /**< null: nothing is met, fraction is 1 and all else 0 */
    taut_collider collider; /**< that is met */
    taut_pos point;         /**< on the collider [m] */
    taut_vec3 normal;       /**< unit, out of the collider */
    float fraction;         /**< of the translation, [0, 1] */
    uint32_t feature;       /**< triangle of a mesh or height field, as it counts them; 0 of other shapes */
    /** 1 if it overlaps the collider at the start. fraction is 0 then; of a ray, point is its origin and normal points
     * against it; of a shape, they are those of the least push out of the collider. Else 0. */
    uint32_t inside;
} taut_query_hit;

/** Two colliders, or a point or shape (a) and a collider (b), where they are nearest. */
typedef struct taut_distance {
    taut_body body;         /**< b's. Null: none is near, and all else is 0 */
    taut_collider collider; /**< b */
    taut_pos on_a;          /**< [m] */
    taut_pos on_b;          /**< [m] */
    taut_vec3 normal;       /**< unit, from a to b */
    float distance;         /**< [m]; negative where they overlap: the least push along normal that parts them */
} taut_distance;

/**
 * The first collider that a ray meets. filter: null for none.
 * @return TAUT_OK, also when nothing is met; TAUT_INVALID_ARGUMENT, TAUT_STRUCT_SIZE, TAUT_NULL_POINTER,
 *         TAUT_STALE_HANDLE and TAUT_FOREIGN_HANDLE (of what is ignored too), TAUT_LOCKED. So do all below.
 */
TAUT_API taut_result taut_world_cast_ray_sized(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                               taut_query_hit* out, uint32_t size);
static inline taut_result taut_world_cast_ray(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                              taut_query_hit* out) {
    return taut_world_cast_ray_sized(world, ray, filter, out, (uint32_t)sizeof(*out));
}
/** All colliders that a ray meets, each once, sorted. @return also TAUT_TOO_SMALL with the number needed in *count. */
TAUT_API taut_result taut_world_cast_ray_all_sized(taut_world world, const taut_ray* ray,
                                                   const taut_query_filter* filter, taut_query_hit* hits,
                                                   uint32_t capacity, uint32_t* count, uint32_t size);
static inline taut_result taut_world_cast_ray_all(taut_world world, const taut_ray* ray,
                                                  const taut_query_filter* filter, taut_query_hit* hits,
                                                  uint32_t capacity, uint32_t* count) {
    return taut_world_cast_ray_all_sized(world, ray, filter, hits, capacity, count, (uint32_t)sizeof(*hits));
}
/** 1 if a ray meets anything, else 0: faster than the first. */
TAUT_API taut_result taut_world_cast_ray_any(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                             int32_t* out);
/** The first collider that each of count rays meets, hits[i] of rays[i], as taut_world_cast_ray says. */
TAUT_API taut_result taut_world_cast_rays_sized(taut_world world, const taut_ray* rays, uint32_t count,
                                                const taut_query_filter* filter, taut_query_hit* hits, uint32_t size);
static inline taut_result taut_world_cast_rays(taut_world world, const taut_ray* rays, uint32_t count,
                                               const taut_query_filter* filter, taut_query_hit* hits) {
    return taut_world_cast_rays_sized(world, rays, count, filter, hits, (uint32_t)sizeof(*hits));
}

/**
 * The first collider that a shape meets on its way. It stops up to 1e-5 of its (or the collider's) inner radius short
 * of contact. What it touches and leaves is not met.
 */
TAUT_API taut_result taut_world_cast_shape_sized(taut_world world, const taut_shape_cast* cast,
                                                 const taut_query_filter* filter, taut_query_hit* out, uint32_t size);
static inline taut_result taut_world_cast_shape(taut_world world, const taut_shape_cast* cast,
                                                const taut_query_filter* filter, taut_query_hit* out) {
    return taut_world_cast_shape_sized(world, cast, filter, out, (uint32_t)sizeof(*out));
}
/** All colliders that a shape meets on its way, each once, sorted. @return also TAUT_TOO_SMALL as above. */
TAUT_API taut_result taut_world_cast_shape_all_sized(taut_world world, const taut_shape_cast* cast,
                                                     const taut_query_filter* filter, taut_query_hit* hits,
                                                     uint32_t capacity, uint32_t* count, uint32_t size);
static inline taut_result taut_world_cast_shape_all(taut_world world, const taut_shape_cast* cast,
                                                    const taut_query_filter* filter, taut_query_hit* hits,
                                                    uint32_t capacity, uint32_t* count) {
    return taut_world_cast_shape_all_sized(world, cast, filter, hits, capacity, count, (uint32_t)sizeof(*hits));
}
/** The first collider that each of count shapes meets, hits[i] of casts[i], as taut_world_cast_shape says. */
TAUT_API taut_result taut_world_cast_shapes_sized(taut_world world, const taut_shape_cast* casts, uint32_t count,
                                                  const taut_query_filter* filter, taut_query_hit* hits, uint32_t size);
static inline taut_result taut_world_cast_shapes(taut_world world, const taut_shape_cast* casts, uint32_t count,
                                                 const taut_query_filter* filter, taut_query_hit* hits) {
    return taut_world_cast_shapes_sized(world, casts, count, filter, hits, (uint32_t)sizeof(*hits));
}

/** The colliders that overlap or touch a shape (no plane, mesh or height field) at a pose. @return also TAUT_TOO_SMALL
 * as above. */
TAUT_API taut_result taut_world_overlap_shape(taut_world world, taut_shape shape, const taut_pose* pose,
                                              const taut_query_filter* filter, taut_collider* colliders,
                                              uint32_t capacity, uint32_t* count);
/** The colliders that hold a point [m]. @return also TAUT_TOO_SMALL as above. */
TAUT_API taut_result taut_world_overlap_point(taut_world world, taut_pos point, const taut_query_filter* filter,
                                              taut_collider* colliders, uint32_t capacity, uint32_t* count);
/**
 * The colliders whose least axis-aligned boxes overlap or touch the box from low to high [m]; a plane's is all of
 * space. @return also TAUT_TOO_SMALL as above; TAUT_INVALID_ARGUMENT if low is above high.
 */
TAUT_API taut_result taut_world_overlap_box(taut_world world, taut_pos low, taut_pos high,
                                            const taut_query_filter* filter, taut_collider* colliders,
                                            uint32_t capacity, uint32_t* count);

/**
 * Where a ray meets one collider, whatever its filter and whether or not its body is enabled.
 * @return TAUT_OK, also when it does not; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. So
 *         do the next two.
 */
TAUT_API taut_result taut_collider_cast_ray_sized(taut_collider collider, const taut_ray* ray, taut_query_hit* out,
                                                  uint32_t size);
static inline taut_result taut_collider_cast_ray(taut_collider collider, const taut_ray* ray, taut_query_hit* out) {
    return taut_collider_cast_ray_sized(collider, ray, out, (uint32_t)sizeof(*out));
}
/** 1 if a shape (no plane, mesh or height field) at a pose overlaps or touches a collider, else 0. @return also
 * TAUT_FOREIGN_HANDLE (shape of another world). */
TAUT_API taut_result taut_collider_overlap_shape(taut_collider collider, taut_shape shape, const taut_pose* pose,
                                                 int32_t* out);
/** 1 if a collider holds a point [m], else 0. */
TAUT_API taut_result taut_collider_overlap_point(taut_collider collider, taut_pos point, int32_t* out);
/** The point of a collider's surface nearest to a point [m], which is a; the distance is negative inside. */
TAUT_API taut_result taut_collider_closest_point_sized(taut_collider collider, taut_pos point, taut_distance* out,
                                                       uint32_t size);
static inline taut_result taut_collider_closest_point(taut_collider collider, taut_pos point, taut_distance* out) {
    return taut_collider_closest_point_sized(collider, point, out, (uint32_t)sizeof(*out));
}
/** Two colliders of a world, not both planes, meshes or height fields, where they are nearest. */
TAUT_API taut_result taut_collider_distance_sized(taut_collider a, taut_collider b, taut_distance* out, uint32_t size);
static inline taut_result taut_collider_distance(taut_collider a, taut_collider b, taut_distance* out) {
    return taut_collider_distance_sized(a, b, out, (uint32_t)sizeof(*out));
}
/** The collider nearest to a shape (as above, a) at a pose, no further than max_distance [m], [0, 1e7]. */
TAUT_API taut_result taut_world_nearest_collider_sized(taut_world world, taut_shape shape, const taut_pose* pose,
                                                       float max_distance, const taut_query_filter* filter,
                                                       taut_distance* out, uint32_t size);
static inline taut_result taut_world_nearest_collider(taut_world world, taut_shape shape, const taut_pose* pose,
                                                      float max_distance, const taut_query_filter* filter,
                                                      taut_distance* out) {
    return taut_world_nearest_collider_sized(world, shape, pose, max_distance, filter, out, (uint32_t)sizeof(*out));
}

// ---------------------------------------------------------------- triangles of cloths and solids

/** A point of a triangle of a cloth, or of the boundary of a solid. */
typedef struct taut_surface_hit {
    taut_cloth cloth;  /**< null: it is a solid's. Both null: nothing is met or near, and all else is 0 */
    taut_solid solid;  /**< null: it is a cloth's */
    taut_pos point;    /**< [m] */
    taut_vec3 normal;  /**< unit, of the triangle as its corners go round; 0 where it has no area */
    uint32_t triangle; /**< as taut_cloth_get_triangles and taut_solid_get_triangles number them */
    float weights[3];  /**< of its corners, not negative, of sum 1: as taut_cloth_get_anchor takes them */
    float distance;    /**< from the ray's origin along it, or from the point asked about [m] */
} taut_surface_hit;

/**
 * The first triangle that a ray meets, from either side; of those at the same distance the first of the first cloth or
 * solid by slots. Triangles whose plane holds the ray are not met. A triangle is seen by a filter if one of its
 * vertices is: its collider, or where it has none, as it touches nothing, its kind alone.
 * @param filter null: all. @return as taut_world_cast_ray.
 */
TAUT_API taut_result taut_world_cast_ray_surface_sized(taut_world world, const taut_ray* ray,
                                                       const taut_query_filter* filter, taut_surface_hit* out,
                                                       uint32_t size);
static inline taut_result taut_world_cast_ray_surface(taut_world world, const taut_ray* ray,
                                                      const taut_query_filter* filter, taut_surface_hit* out) {
    return taut_world_cast_ray_surface_sized(world, ray, filter, out, (uint32_t)sizeof(*out));
}
/**
 * The point of all triangles that is nearest to a point, no further than max_distance, [0, 1e7]; ties and filter as
 * above.
 */
TAUT_API taut_result taut_world_closest_surface_sized(taut_world world, taut_pos point, float max_distance,
                                                      const taut_query_filter* filter, taut_surface_hit* out,
                                                      uint32_t size);
static inline taut_result taut_world_closest_surface(taut_world world, taut_pos point, float max_distance,
                                                     const taut_query_filter* filter, taut_surface_hit* out) {
    return taut_world_closest_surface_sized(world, point, max_distance, filter, out, (uint32_t)sizeof(*out));
}
/**
 * The triangles that come within radius [m], [0, 1e7], of a point, each with its point nearest to that, sorted by slots
 * and triangles; filter as above. @return also TAUT_TOO_SMALL with the number needed in *count.
 */
TAUT_API taut_result taut_world_overlap_surfaces_sized(taut_world world, taut_pos point, float radius,
                                                       const taut_query_filter* filter, taut_surface_hit* hits,
                                                       uint32_t capacity, uint32_t* count, uint32_t size);
static inline taut_result taut_world_overlap_surfaces(taut_world world, taut_pos point, float radius,
                                                      const taut_query_filter* filter, taut_surface_hit* hits,
                                                      uint32_t capacity, uint32_t* count) {
    return taut_world_overlap_surfaces_sized(world, point, radius, filter, hits, capacity, count,
                                             (uint32_t)sizeof(*hits));
}

#ifdef __cplusplus
}
#endif

#endif
