/**
 * @file decomposition.h
 * Convex decomposition: a closed mesh as a few convex hulls, so that bodies of its form can move. What it gives is
 * baked, for any number of worlds: a body takes each part as a collider, at the place of its own frame.
 *
 *     taut_baked parts[32];
 *     uint32_t count;
 *     taut_decomposition_info info;
 *     taut_bake_decomposition(&def, NULL, parts, 32, &count, &info);
 *     for (uint32_t i = 0; i < count; ++i) {
 *         taut_world_add_baked(world, parts[i], &collider.shape);
 *         taut_body_add_collider(body, &collider, &out);
 *     }
 *
 * Parts may overlap one another. The mass of the body is better taken from info.solid, which counts nothing twice, than
 * from its colliders.
 */
#ifndef TAUT_DECOMPOSITION_H
#define TAUT_DECOMPOSITION_H

#include <taut/base.h>
#include <taut/math.h>
#include <taut/shape.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Largest number of parts of a decomposition, and of triangles of its mesh. */
#define TAUT_DECOMPOSITION_MAX_PARTS 256
#define TAUT_DECOMPOSITION_MAX_TRIANGLES 1048576

/**
 * A closed mesh in the body's frame. Inside is where its winding number is not 0: it does not matter to which side all
 * its triangles look, nor whether it intersects itself. Vertices at the same place but for 5e-7 of the largest
 * coordinate are one.
 */
typedef struct taut_decomposition_def {
    uint32_t struct_size;
    uint32_t vertex_count;     /**< at least 4 */
    const taut_vec3* vertices; /**< [m], within TAUT_SHAPE_MAX_SIZE */
    const uint32_t* indices;   /**< 3 * triangle_count of them, each below vertex_count */
    uint32_t triangle_count;   /**< [1, TAUT_DECOMPOSITION_MAX_TRIANGLES] */
    uint32_t max_parts;        /**< [1, TAUT_DECOMPOSITION_MAX_PARTS]. Default 32 */
    uint32_t max_vertices;     /**< of each hull, [4, TAUT_HULL_MAX_VERTICES]. Default TAUT_HULL_MAX_VERTICES */
    float tolerance;           /**< distance at most of any point of a hull from the solid, and of any point of the
                                    solid over the faces of its hull [m], 0 or in the range of shapes' sizes; 0: a
                                    40th of the longest side. Kept where max_parts allows. Default 0 */
    uint32_t close_holes; /**< 1: the rim of each hole is joined to its middle. Default 0: open meshes are refused */
    uint32_t reserved;    /**< zero */
} taut_decomposition_def;

/** What became of a mesh. */
typedef struct taut_decomposition_info {
    uint32_t parts;             /**< hulls */
    uint32_t without_area;      /**< triangles left out, as two of their corners are one */
    uint32_t open_edges;        /**< of holes that were closed */
    float departure;            /**< of the points of the hulls from the solid, at most [m] */
    float shortfall;            /**< of the solid's points over the faces of their hulls, at most [m] */
    taut_mass_properties solid; /**< what the mesh encloses, at a density of 1 kg/m^3 */
} taut_decomposition_info;

TAUT_API void taut_decomposition_def_init_sized(taut_decomposition_def* def, uint32_t size);
static inline void taut_decomposition_def_init(taut_decomposition_def* def) {
    taut_decomposition_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Finds the parts and bakes each as taut_bake_hull does. It takes seconds for ten thousand triangles; the parts depend
 * on the def alone. Pieces thinner than TAUT_SHAPE_MIN_SIZE are thickened by that.
 * Thread safety: any threads, the allocator permitting.
 * @param allocator as that of taut_bake_hull. @param parts room for def->max_parts handles. @param info null: not told.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value; an open
 *         mesh without close_holes, triangles that look to either side, no volume), TAUT_TOO_SMALL if capacity is below
 * def->max_parts, with that in *count; TAUT_LIMIT, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_bake_decomposition_sized(const taut_decomposition_def* def, const taut_allocator* allocator,
                                                   taut_baked* parts, uint32_t capacity, uint32_t* count,
                                                   taut_decomposition_info* info, uint32_t size);
static inline taut_result taut_bake_decomposition(const taut_decomposition_def* def, const taut_allocator* allocator,
                                                  taut_baked* parts, uint32_t capacity, uint32_t* count,
                                                  taut_decomposition_info* info) {
    return taut_bake_decomposition_sized(def, allocator, parts, capacity, count, info, (uint32_t)sizeof(*info));
}

#ifdef __cplusplus
}
#endif

#endif
