/**
 * @file shape.h
 * Collision shapes. A shape belongs to a world and may be used by any number of its bodies.
 * Each function here, where nothing else is said: thread safety: one thread at a time per world, not inside a step.
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

/** Cylinder along the body's y axis, centred on its origin. */
typedef struct taut_cylinder_def {
    uint32_t struct_size;
    float radius;      /**< [m]. Default 0.5 */
    float half_length; /**< half the distance between the two flat ends [m]. Default 0.5 */
} taut_cylinder_def;

/**
 * Cone along the body's y axis: base at y = -half_length, apex at y = +half_length, so that the origin is the middle
 * of its height; the centre of mass lies half_length / 2 below it.
 */
typedef struct taut_cone_def {
    uint32_t struct_size;
    float radius;      /**< of the base [m]. Default 0.5 */
    float half_length; /**< half the height [m]. Default 0.5 */
} taut_cone_def;

/**
 * Tapered capsule along the body's y axis: the hull of two balls centred at y = -half_length and y = +half_length.
 * Refused: one ball inside the other, |bottom_radius - top_radius| >= 2 half_length.
 */
typedef struct taut_tapered_capsule_def {
    uint32_t struct_size;
    float bottom_radius; /**< of the ball at -half_length [m]. Default 0.3 */
    float top_radius;    /**< of the ball at +half_length [m]. Default 0.2 */
    float half_length;   /**< half the distance between the balls' centres [m]. Default 0.5 */
} taut_tapered_capsule_def;

/**
 * A hull shape whose points are those of another hull shape multiplied axis by axis about the body's origin. It is a
 * shape of its own: the source may be removed. Refused: a source that is not a hull, points beyond
 * TAUT_SHAPE_MAX_SIZE, a hull less than TAUT_SHAPE_MIN_SIZE thick.
 */
typedef struct taut_scaled_hull_def {
    uint32_t struct_size;
    uint32_t reserved; /**< 0 */
    taut_shape hull;   /**< a hull shape of the same world */
    taut_vec3 scale;   /**< factors; negative ones mirror. Size of each in [1e-3, 1e3]. Default 1 each */
} taut_scaled_hull_def;

/** What a shape is. A scaled hull is a hull. Further kinds may be appended. */
typedef enum taut_shape_kind {
    TAUT_SHAPE_PLANE = 0,
    TAUT_SHAPE_BOX = 1,
    TAUT_SHAPE_SPHERE = 2,
    TAUT_SHAPE_CAPSULE = 3,
    TAUT_SHAPE_HULL = 4,
    TAUT_SHAPE_CYLINDER = 5,
    TAUT_SHAPE_CONE = 6,
    TAUT_SHAPE_TAPERED_CAPSULE = 7,
    TAUT_SHAPE_SURFACE = 8, /**< a mesh or height field */
    TAUT_SHAPE_KIND_MAX = 0x7fffffff
} taut_shape_kind;
/** Largest number of triangles of a mesh, and of samples along a side of a height field. */
#define TAUT_MESH_MAX_TRIANGLES 16777216
#define TAUT_HEIGHT_FIELD_MAX_SIDE 4097

/**
 * Surface of triangles, in the body's frame. Static and kinematic bodies only; it collides with all convex shapes but
 * planes, round ones exactly. A triangle looks to the side from which its corners run counter-clockwise, and is met
 * from that side alone: a body whose centre is behind it by more than half of the body's reach passes. Edges at which
 * the surface is flat or hollow catch nothing, whatever the triangulation. Coordinates that differ by less than 5e-7 of
 * the largest become equal, and vertices at the same place one. Left out and counted in taut_mesh_info: triangles
 * thinner than 1e-5 of their longest edge, and second copies of a triangle. Refused: no triangle left, an index out of
 * range, a coordinate that is not finite or beyond TAUT_SHAPE_MAX_SIZE.
 */
typedef struct taut_mesh_def {
    uint32_t struct_size;
    uint32_t vertex_count;     /**< at least 3 */
    const taut_vec3* vertices; /**< [m]; copied */
    const uint32_t* indices;   /**< 3 * triangle_count of them, each below vertex_count; copied */
    uint32_t triangle_count;   /**< [1, TAUT_MESH_MAX_TRIANGLES] */
    uint32_t two_sided;        /**< 1: triangles look to the side on which a body's centre is. Default 0 */
} taut_mesh_def;

/**
 * Grid of heights along the body's y axis, looking up. Sample (row, column) lies at (column * column_spacing, height,
 * row * row_spacing). Each cell is two triangles that share the diagonal from (row + 1, column) to
 * (row, column + 1). Static and kinematic bodies only; met from above, as a mesh is from its front.
 */
typedef struct taut_height_field_def {
    uint32_t struct_size;
    uint32_t rows, columns; /**< [2, TAUT_HEIGHT_FIELD_MAX_SIDE] samples */
    float row_spacing;      /**< along z [m], in the range of shapes' sizes. Default 1 */
    float column_spacing;   /**< along x [m]. Default 1 */
    uint32_t reserved;      /**< zero */
    const float* heights;   /**< rows * columns of them [m], row by row; NaN: a hole up to the next samples; copied */
} taut_height_field_def;

/** Where the memory of what is baked comes from. Both null: the C runtime. */
typedef struct taut_allocator {
    taut_allocate_fn allocate; /**< allocate and free: both or neither */
    taut_free_fn free;         /**< gives back what allocate gave */
    void* user_data;
} taut_allocator;

/** What became of the triangles of a mesh or height field. */
typedef struct taut_mesh_info {
    uint32_t triangles;    /**< that are there */
    uint32_t facets;       /**< of neighbouring triangles in one plane, which touch as one */
    uint32_t without_area; /**< left out: too thin */
    uint32_t duplicates;   /**< left out: second copies */
} taut_mesh_info;

/** Mass properties of a shape at a density, about its centre of mass, axes of the body's frame. */
typedef struct taut_mass_properties {
    float mass;               /**< [kg] */
    taut_vec3 centre_of_mass; /**< in the body's frame [m] */
    taut_sym3 inertia;        /**< about the centre of mass [kg m^2] */
} taut_mass_properties;

TAUT_API void taut_plane_def_init_sized(taut_plane_def* def, uint32_t size);
static inline void taut_plane_def_init(taut_plane_def* def) { taut_plane_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_box_def_init_sized(taut_box_def* def, uint32_t size);
static inline void taut_box_def_init(taut_box_def* def) { taut_box_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_sphere_def_init_sized(taut_sphere_def* def, uint32_t size);
static inline void taut_sphere_def_init(taut_sphere_def* def) {
    taut_sphere_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_capsule_def_init_sized(taut_capsule_def* def, uint32_t size);
static inline void taut_capsule_def_init(taut_capsule_def* def) {
    taut_capsule_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_hull_def_init_sized(taut_hull_def* def, uint32_t size);
static inline void taut_hull_def_init(taut_hull_def* def) { taut_hull_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_cylinder_def_init_sized(taut_cylinder_def* def, uint32_t size);
static inline void taut_cylinder_def_init(taut_cylinder_def* def) {
    taut_cylinder_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_cone_def_init_sized(taut_cone_def* def, uint32_t size);
static inline void taut_cone_def_init(taut_cone_def* def) { taut_cone_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_tapered_capsule_def_init_sized(taut_tapered_capsule_def* def, uint32_t size);
static inline void taut_tapered_capsule_def_init(taut_tapered_capsule_def* def) {
    taut_tapered_capsule_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_scaled_hull_def_init_sized(taut_scaled_hull_def* def, uint32_t size);
static inline void taut_scaled_hull_def_init(taut_scaled_hull_def* def) {
    taut_scaled_hull_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_mesh_def_init_sized(taut_mesh_def* def, uint32_t size);
static inline void taut_mesh_def_init(taut_mesh_def* def) { taut_mesh_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_height_field_def_init_sized(taut_height_field_def* def, uint32_t size);
static inline void taut_height_field_def_init(taut_height_field_def* def) {
    taut_height_field_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Adds a shape to a world.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_INVALID_ARGUMENT (size out of range, zero normal, degenerate points, a ball inside the other, a scaled
 *         hull's source of another kind or world), TAUT_LIMIT, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_plane(taut_world world, const taut_plane_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_box(taut_world world, const taut_box_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_sphere(taut_world world, const taut_sphere_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_capsule(taut_world world, const taut_capsule_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_hull(taut_world world, const taut_hull_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_cylinder(taut_world world, const taut_cylinder_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_cone(taut_world world, const taut_cone_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_tapered_capsule(taut_world world, const taut_tapered_capsule_def* def,
                                                    taut_shape* out);
TAUT_API taut_result taut_world_add_scaled_hull(taut_world world, const taut_scaled_hull_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_mesh(taut_world world, const taut_mesh_def* def, taut_shape* out);
TAUT_API taut_result taut_world_add_height_field(taut_world world, const taut_height_field_def* def, taut_shape* out);

/**
 * Builds a hull, mesh or height field ahead, without a world: in a loader's thread, while worlds step. Adding it to a
 * world then takes no time, and any number of worlds share the data. What is baked is the same, to the bit, as what the
 * world's call makes of the def.
 * Thread safety: any threads, the allocator permitting.
 * @param allocator copied; null: the C runtime. Its memory is taken within this call, and given back within the one, on
 *        whatever thread, that lets go of the last: taut_baked_release, taut_shape_remove or taut_world_destroy.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT as the world's call; TAUT_LIMIT (65535
 * are there), TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_bake_hull(const taut_hull_def* def, const taut_allocator* allocator, taut_baked* out);
TAUT_API taut_result taut_bake_mesh(const taut_mesh_def* def, const taut_allocator* allocator, taut_baked* out);
TAUT_API taut_result taut_bake_height_field(const taut_height_field_def* def, const taut_allocator* allocator,
                                            taut_baked* out);
/**
 * Adds a shape of what is baked to a world. The data stay where they are and are not among the world's bytes.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE (also of what is baked), TAUT_LOCKED, TAUT_LIMIT,
 *         TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_baked(taut_world world, taut_baked baked, taut_shape* out);
/**
 * Lets go of what is baked: the handle becomes stale, and the data go with the last shape that a world has of them.
 * Thread safety: any thread. @return TAUT_OK; TAUT_STALE_HANDLE.
 */
TAUT_API taut_result taut_baked_release(taut_baked baked);
/** 1 if the handle names what is baked, else 0. Thread safety: any thread. */
TAUT_API int32_t taut_baked_is_valid(taut_baked baked);
/** Bytes from its allocator. Thread safety: any thread. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE. */
TAUT_API taut_result taut_baked_get_bytes(taut_baked baked, uint64_t* out);

/**
 * Adds a shape that is a mesh or height field scaled along its axes, on top of the scale that it has; the data are
 * shared. Negative factors mirror it: it looks to the same side as before, mirrored.
 * @param scale [-1000, 1000] each, at least 1e-3 in size; the result's coordinates within TAUT_SHAPE_MAX_SIZE.
 * @return as taut_world_add_mesh; TAUT_INVALID_ARGUMENT if the shape is neither mesh nor height field.
 */
TAUT_API taut_result taut_shape_add_scaled(taut_shape mesh, taut_vec3 scale, taut_shape* out);

/**
 * Samples the signed distance of a closed mesh on a grid, for worlds of TAUT_SOLVER_MINIMISATION: vertices of cloths
 * and solids that come within it are pushed out by a penalty of k depth^3, k the modulus of their material. A grid
 * takes the place of an earlier one; scaled copies of the shape have none of their own.
 * @param mesh closed, its triangles looking outward. @param cell_size [m], in the range of shapes' sizes; 0: a 64th of
 * its longest side. Features thinner than a cell are lost.
 * @return TAUT_OK; TAUT_UNSUPPORTED with the reason for an open mesh, a height field, one that looks inward, or cells
 * so small that it would take more than 16777216; TAUT_INVALID_ARGUMENT if the shape is neither mesh nor height field,
 * or for a cell_size out of range; TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_shape_sample_distance(taut_shape mesh, float cell_size);

/** Removes a shape. @return TAUT_OK; TAUT_IN_USE while a body uses it; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_shape_remove(taut_shape shape);
/**
 * The shapes that a world was given and has, by slots; not those inside cables, cloths and solids.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_shapes(taut_world world, taut_shape* shapes, uint32_t capacity, uint32_t* count);
/** 1 if the handle names a live shape, else 0. */
TAUT_API int32_t taut_shape_is_valid(taut_shape shape);

/** What a shape is. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE. */
TAUT_API taut_result taut_shape_get_kind(taut_shape shape, taut_shape_kind* out);

/**
 * The def that a shape was made from, normals normalised. The out's struct_size is checked: initialise it first.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_INVALID_ARGUMENT if the shape is of
 *         another kind.
 */
TAUT_API taut_result taut_shape_get_plane(taut_shape shape, taut_plane_def* out);
TAUT_API taut_result taut_shape_get_box(taut_shape shape, taut_box_def* out);
TAUT_API taut_result taut_shape_get_sphere(taut_shape shape, taut_sphere_def* out);
TAUT_API taut_result taut_shape_get_capsule(taut_shape shape, taut_capsule_def* out);
TAUT_API taut_result taut_shape_get_cylinder(taut_shape shape, taut_cylinder_def* out);
TAUT_API taut_result taut_shape_get_cone(taut_shape shape, taut_cone_def* out);
TAUT_API taut_result taut_shape_get_tapered_capsule(taut_shape shape, taut_tapered_capsule_def* out);

/**
 * The least box along the axes of the body's frame that holds the shape [m].
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_INVALID_ARGUMENT for a plane, which has no bounds.
 */
TAUT_API taut_result taut_shape_get_bounds(taut_shape shape, taut_vec3* low, taut_vec3* high);

/**
 * Mass properties at a density [kg/m^3] > 0.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT for a density out of range or a plane, mesh or height field (no volume);
 *         TAUT_STALE_HANDLE.
 */
TAUT_API taut_result taut_shape_get_mass_properties_sized(taut_shape shape, float density, taut_mass_properties* out,
                                                          uint32_t size);
static inline taut_result taut_shape_get_mass_properties(taut_shape shape, float density, taut_mass_properties* out) {
    return taut_shape_get_mass_properties_sized(shape, density, out, (uint32_t)sizeof(*out));
}

/**
 * Triangles of a hull, mesh or height field for drawing, of a hull outward counter-clockwise: positions receives three
 * points a triangle in the body's frame. With positions null or capacity too small: TAUT_TOO_SMALL and *count holds the
 * number of points needed.
 * @return TAUT_OK; TAUT_TOO_SMALL; TAUT_INVALID_ARGUMENT for other shapes; TAUT_NULL_POINTER, TAUT_STALE_HANDLE.
 */
TAUT_API taut_result taut_shape_get_triangles(taut_shape shape, taut_vec3* positions, uint32_t capacity,
                                              uint32_t* count);
/** @return TAUT_OK; TAUT_INVALID_ARGUMENT if the shape is neither mesh nor height field; TAUT_STALE_HANDLE. */
TAUT_API taut_result taut_shape_get_mesh_info_sized(taut_shape shape, taut_mesh_info* out, uint32_t size);
static inline taut_result taut_shape_get_mesh_info(taut_shape shape, taut_mesh_info* out) {
    return taut_shape_get_mesh_info_sized(shape, out, (uint32_t)sizeof(*out));
}

#ifdef __cplusplus
}
#endif

#endif
