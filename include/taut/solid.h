/**
 * @file solid.h
 * Deformable solids: meshes of tetrahedra or hexahedra, or clouds of points without a mesh, in one system with rigid
 * bodies, cables and cloths.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_SOLID_H
#define TAUT_SOLID_H

#include <taut/base.h>
#include <taut/collider.h>
#include <taut/deformable.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** The law between strain and stress. */
typedef enum taut_solid_material {
    TAUT_SOLID_NEO_HOOKEAN = 0, /**< rubber: nothing inverts by itself; Poisson's ratio to 0.49 */
    TAUT_SOLID_ST_VENANT_KIRCHHOFF =
        1,                          /**< Green strain: cheapest; for stiff ones, as it collapses when pressed to half */
    TAUT_SOLID_COROTATED = 2,       /**< Hooke's law of the principal stretches */
    TAUT_SOLID_FIXED_COROTATED = 3, /**< the same with the true volume (Stomakhin et al. 2012) */
    TAUT_SOLID_ORTHOTROPIC = 4,     /**< St. Venant's and Kirchhoff's with three axes: wood, muscle, composites */
    TAUT_SOLID_MATERIAL_MAX = 0x7fffffff
} taut_solid_material;

/** What taut_solid_def::corners is of a solid without a mesh. */
#define TAUT_SOLID_MESHLESS 0
/** Fewest vertices of a solid without a mesh, and those that each of its samples knows. */
#define TAUT_SOLID_NEIGHBOURS 8

/** Substances whose figures taut_solid_def_set_substance() writes. */
typedef enum taut_substance {
    TAUT_SUBSTANCE_RUBBER = 0,
    TAUT_SUBSTANCE_JELLY = 1,
    TAUT_SUBSTANCE_FOAM = 2,
    TAUT_SUBSTANCE_MUSCLE = 3,
    TAUT_SUBSTANCE_WOOD = 4,
    TAUT_SUBSTANCE_MAX = 0x7fffffff
} taut_substance;

/** Constants along three axes that are at right angles to each other in the rest shape. */
typedef struct taut_orthotropic {
    float young_moduli[3];   /**< along axes 1, 2, 3 [Pa], [1, 1e12]. Default 1e6 */
    float poisson_ratios[3]; /**< nu_23, nu_13, nu_12: contraction along the second axis over stretch along the first,
                                  [-10, 10], such that every strain is resisted. Default 0.3 */
    float shear_moduli[3];   /**< in the planes 23, 13, 12 [Pa], [1, 1e12]. Default 384615 */
    taut_quat axes;          /**< from the axes to the rest shape. Default: x, y, z */
    const taut_quat* cells;  /**< [cell_count] of each cell in its place, null without a mesh; null: axes. Copied */
} taut_orthotropic;

/**
 * A solid. Tetrahedra: corners 1, 2, 3 go round counterclockwise as seen from outside, where corner 0 is on the other
 * side. Hexahedra: corners 0 to 3 go round the bottom counterclockwise as seen from above, 4 to 7 lie over them.
 *
 * Without a mesh (TAUT_SOLID_MESHLESS) vertices are nodes of a field that is fitted to them by moving least squares,
 * exact where it is linear. Strain is taken at samples: points of the rest shape, each with the volume that it stands
 * for, which take the place of cells in all that is read. A sample knows its 8 nearest vertices, by the weight
 * (1 - (distance / reach)^2)^2, where reach is the distance of the ninth, or neighbour_radius where that is less; of
 * those further than it none. At least four of them may not lie in a plane. Samples in the middle between vertices that
 * surround them alike do not feel it when these move to and fro in turns: better are some about each vertex. Without
 * samples the library makes such, up to 8 about each vertex: half way to the mean of the up to 8 vertices that are
 * nearest to it within each octant of the axes, with the volume of a brick of the same second moments over 8. The
 * boundary is what triangles say; without them each vertex touches, and air finds nothing to push.
 */
typedef struct taut_solid_def {
    uint32_t struct_size;
    taut_solid_material material; /**< default TAUT_SOLID_NEO_HOOKEAN */
    const taut_pos* points;       /**< of the vertices [m]; copied */
    const taut_pos* rest;         /**< of the vertices in the rest shape [m]; null: points. Copied */
    uint32_t point_count;         /**< [4, TAUT_DEFORMABLE_MAX] */
    uint32_t cell_count;          /**< [1, TAUT_DEFORMABLE_MAX]; without a mesh 0 */
    const uint32_t* cells;        /**< [cell_count][corners] vertices, null without a mesh; copied */
    uint32_t corners;             /**< 4: tetrahedra, 8: hexahedra, or TAUT_SOLID_MESHLESS. Default 4 */
    uint32_t sample_count;        /**< of samples, without a mesh: [0, TAUT_DEFORMABLE_MAX]; else 0. Default 0 */
    const taut_pos* samples;      /**< of the rest shape [m]; null: made by the library. Copied */
    const float* sample_volumes;  /**< [m^3], [1e-18, 1e12]; of samples, else null. Copied */
    const uint32_t* triangles; /**< [triangle_count][3] of the boundary, outward, without a mesh; null: none. Copied */
    uint32_t triangle_count;   /**< [0, TAUT_DEFORMABLE_MAX], with a mesh 0. Default 0 */
    float neighbour_radius;    /**< without a mesh [m], 0 or [1e-4, 1e6]; 0: twice the mean distance of vertices to
                                    their sixth-nearest other one. Default 0 */
    float density;             /**< [kg/m^3], [1e-2, 1e6]. Default 1000 */
    float young_modulus;       /**< [Pa], [1, 1e12]. Default 1e6 */
    float poisson_ratio;       /**< [0, 0.499]; more than 0 for TAUT_SOLID_FIXED_COROTATED. Default 0.3 */
    float damping;             /**< d in stress = D (strain + d rate of strain) [s], [0, 10]. Default 0 */
    float mass_damping;        /**< Rayleigh's, see deformable.h [1/s], [0, 1e4]. Default 0 */
    float stiffness_damping;   /**< likewise [s], [0, 10]. Default 0 */
    float thickness;           /**< of the spheres by which boundary vertices touch [m], [1e-4, 1]. Default 0.01 */
    float air_drag;            /**< of the boundary, [0, 100]; see deformable.h. Default 0 */
    float air_lift;            /**< [0, air_drag]. Default 0 */
    float yield_stress;        /**< in simple tension, von Mises' [Pa], [1, 1e12], or INFINITY: it stays elastic.
                                    Default INFINITY */
    float creep;               /**< rate at which strain beyond the yield flows [1/s], [0, 1e6], or INFINITY: all of
                                    it within a step. Default INFINITY */
    float hardening;           /**< isotropic: yield stress over plastic strain in simple tension [Pa], [0, 1e12].
                                    Default 0 */
    float plastic_limit;       /**< largest plastic strain, by taut_solid_get_plastic_strains, [0, 10], or INFINITY.
                                    Default 1 */
    taut_orthotropic orthotropic; /**< of TAUT_SOLID_ORTHOTROPIC, which has none of the isotropic constants and does
                                       not yield */
    float gravity_scale;          /**< [-1000, 1000]. Default 1 */
    taut_deformable_solve solve;  /**< default TAUT_DEFORMABLE_DIRECT */
    taut_material surface;        /**< friction and restitution */
    uint32_t self_collision;      /**< 1: it touches itself, see deformable.h; 0: it goes through itself. Default 0 */
    taut_filter filter; /**< mask 0: no contacts; group may not be positive, 0: the solid has a negative one */
    uint64_t user_data; /**< of the solid and of each of its vertices */
} taut_solid_def;

TAUT_API void taut_solid_def_init_sized(taut_solid_def* def, uint32_t size);
static inline void taut_solid_def_init(taut_solid_def* def) { taut_solid_def_init_sized(def, (uint32_t)sizeof(*def)); }
/**
 * Writes material, density and elastic constants of a substance, to be tuned.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT.
 */
TAUT_API taut_result taut_solid_def_set_substance(taut_solid_def* def, taut_substance substance);

/**
 * Adds a solid at rest.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; a vertex in no cell; a cell that is flat or inverted at rest, a
 *         sample with too few neighbours or with neighbours that lie in a plane, whose number the text gives; what is
 *         of the other kind, mesh or not), TAUT_STRUCT_SIZE, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LIMIT,
 * TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_solid(taut_world world, const taut_solid_def* def, taut_solid* out);
/** Removes a solid with its vertices and all joints and attachments on them; taut_body_remove of one: TAUT_IN_USE. */
TAUT_API taut_result taut_solid_remove(taut_solid solid);
/** 1 if the handle names a live solid, else 0. */
TAUT_API int32_t taut_solid_is_valid(taut_solid solid);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_solid_get_user_data(taut_solid solid, uint64_t* out);
/** As taut_cloth_get_solve. */
TAUT_API taut_result taut_solid_get_solve(taut_solid solid, taut_deformable_solve* out);
/** As taut_cloth_set_contact_events. */
TAUT_API taut_result taut_solid_set_contact_events(taut_solid solid, uint32_t contact_events);
/** As taut_cloth_set_pre_solve. */
TAUT_API taut_result taut_solid_set_pre_solve(taut_solid solid, int32_t pre_solve);
/** The solid that a body is a vertex of; null for any other body. */
TAUT_API taut_result taut_body_get_solid(taut_body body, taut_solid* out);

/** As taut_cloth_pin. */
TAUT_API taut_result taut_solid_pin(taut_solid solid, uint32_t vertex, uint32_t pinned);

/**
 * Vertices after the last step [m], in the order of the def.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_solid_get_points(taut_solid solid, taut_pos* points, uint32_t capacity, uint32_t* count);
/** Their velocities [m/s]; results as above. */
TAUT_API taut_result taut_solid_get_velocities(taut_solid solid, taut_vec3* velocities, uint32_t capacity,
                                               uint32_t* count);
/** Their normals, by the angles of the boundary's triangles about them; 0 of inner ones. Results as above. */
TAUT_API taut_result taut_solid_get_normals(taut_solid solid, taut_vec3* normals, uint32_t capacity, uint32_t* count);
/** Their bodies; results as above. */
TAUT_API taut_result taut_solid_get_bodies(taut_solid solid, taut_body* bodies, uint32_t capacity, uint32_t* count);
/** Triangles of the boundary, outward, [count][3] vertices, capacity in triangles; results as above. */
TAUT_API taut_result taut_solid_get_triangles(taut_solid solid, uint32_t* triangles, uint32_t capacity,
                                              uint32_t* count);
/** Von Mises stress of each cell, the mean of its Gauss points' [Pa]; results as above. */
TAUT_API taut_result taut_solid_get_stresses(taut_solid solid, float* stresses, uint32_t capacity, uint32_t* count);
/**
 * Takes a solid that is tangled, by a teleport, a bad import or a blow that no step could follow, towards a shape
 * without inverted cells: by at most so many of Newton's steps, with line search, to a minimum of its elastic energy
 * (Gast and Schroeder 2014). Called once a frame, a few steps each, its cost is spread; some 60 steps untangle what
 * began anywhere at random. Pinned vertices stay, the centre of mass of a free one too; its vertices go on with the
 * velocity of that, and are strained as they are. Contacts and attachments are met by the world's next steps. Of one
 * without inverted cells nothing changes. A solid all of whose vertices are in one place comes back with
 * TAUT_SOLID_FIXED_COROTATED alone: others are in balance there.
 * @param max_steps 1 to 1000
 * @param inverted out, may be null: inverted cells left
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY; TAUT_UNSUPPORTED in a
 *         world of TAUT_SOLVER_MINIMISATION, whose steps do so themselves.
 */
TAUT_API taut_result taut_solid_recover(taut_solid solid, uint32_t max_steps, uint32_t* inverted);
/** Volume of each cell over that at rest, negative where it is inverted; results as above. */
TAUT_API taut_result taut_solid_get_volumes(taut_solid solid, float* ratios, uint32_t capacity, uint32_t* count);
/**
 * Plastic strain of each cell, the mean of its Gauss points': the root of the sum of squares of stretch - 1 of what
 * remains without load, 0 where nothing flowed; results as above.
 */
TAUT_API taut_result taut_solid_get_plastic_strains(taut_solid solid, float* strains, uint32_t capacity,
                                                    uint32_t* count);

#ifdef __cplusplus
}
#endif

#endif
