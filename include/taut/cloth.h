/**
 * @file cloth.h
 * Cloths: sheets of links or of triangles, from any triangle mesh, in one system with rigid bodies and cables.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_CLOTH_H
#define TAUT_CLOTH_H

#include <taut/base.h>
#include <taut/collider.h>
#include <taut/deformable.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most tethers of a vertex. */
#define TAUT_CLOTH_MAX_TETHERS 8

/** What a cloth is made of. */
typedef enum taut_cloth_kind {
    TAUT_CLOTH_TRIANGLES = 0, /**< a sheet of finite stiffness: St-Venant-Kirchhoff triangles, and bending */
    TAUT_CLOTH_LINKS = 1,     /**< links along the edges and across them, each rigid or soft */
    TAUT_CLOTH_QUADS = 2,     /**< as triangles, of quadrilaterals with two by two Gauss points each */
    TAUT_CLOTH_KIND_MAX = 0x7fffffff
} taut_cloth_kind;

/** How triangles and quadrilaterals measure strain; stress is linear in it. */
typedef enum taut_cloth_strain {
    TAUT_CLOTH_STRAIN_GREEN = 0,     /**< (F^T F - 1) / 2 */
    TAUT_CLOTH_STRAIN_COROTATED = 1, /**< stretch - 1, of F turned back by its rotation */
    TAUT_CLOTH_STRAIN_MAX = 0x7fffffff
} taut_cloth_strain;

/** Fabrics whose figures taut_cloth_def_set_fabric() writes. */
typedef enum taut_fabric {
    TAUT_FABRIC_COTTON = 0,
    TAUT_FABRIC_SILK = 1,
    TAUT_FABRIC_DENIM = 2,
    TAUT_FABRIC_LEATHER = 3,
    TAUT_FABRIC_MAX = 0x7fffffff
} taut_fabric;

/**
 * A cloth. Warp is the direction in which u of a triangle's texture coordinates grows, weft is across it; without
 * coordinates warp is the direction of the first triangle's first edge. A link that goes by less than an eighth of a
 * turn from warp or weft counts as such, others as shear. Across each inner edge there is a link between the two
 * vertices beside it, which resists bending, or shear where the edge itself does.
 *
 * Quadrilaterals are given in place of triangles; each is read as two triangles, of its corners 0, 1, 2 and 0, 2, 3,
 * in this order, by all that counts triangles, and by bending, limits, air and contact. They do not tear.
 *
 * Tethers keep cloth from stretching that sweeps do not hold: each vertex is tied to its nearest pinned vertices, one
 * link each that only pulls, as long as the way there along edges at rest. They cost a swept link each, and nothing
 * where nothing is pinned; they follow pins and tears. What hangs on no pin, or between two that come apart, they do
 * not help.
 *
 * A cloth tears where an edge is stretched beyond tear_strain: at one end of it, that where less is cut, along the
 * edges there that go most nearly across it. The vertex is split, and so is one on the rim that the cut comes to; new
 * vertices come after all others, with bodies, contacts and velocity as the old ones, whose mass they share; triangles
 * keep their place and get new vertices; links along the cut are halved, those across it go. Joints stay on the old
 * vertex. Pinned vertices are not torn off, but the cut may come to one: then both parts are pinned. What lies around a
 * cut waits for the next step, when its load is known. Each split is told as a taut_tear_event.
 */
typedef struct taut_cloth_def {
    uint32_t struct_size;
    taut_cloth_kind kind;        /**< default TAUT_CLOTH_TRIANGLES */
    const taut_pos* points;      /**< of the vertices [m]; copied */
    const taut_pos* rest;        /**< of the vertices in the rest shape [m]; null: points. Copied */
    uint32_t point_count;        /**< [3, TAUT_DEFORMABLE_MAX] */
    uint32_t triangle_count;     /**< [1, TAUT_DEFORMABLE_MAX]; of quadrilaterals 0 */
    const uint32_t* triangles;   /**< [triangle_count][3] vertices, all turned the same way, null of quadrilaterals;
                                      copied */
    const uint32_t* quads;       /**< [quad_count][4] vertices, round each and all turned the same way; null of other
                                      kinds. Copied */
    uint32_t quad_count;         /**< [1, TAUT_DEFORMABLE_MAX / 2]; of other kinds 0 */
    taut_cloth_strain strain;    /**< of triangles and quadrilaterals. Default TAUT_CLOTH_STRAIN_GREEN */
    uint32_t plane_strain;       /**< 1: what lies in the sheet is a slice of something that keeps its thickness, of one
                                      stretch_stiffness both ways and a poisson_ratio below 1/2; 0: it thins freely
                                      (plane stress). Default 0 */
    const float* uv;             /**< [point_count][2] texture coordinates; null: none. Copied */
    float area_density;          /**< [kg/m^2], [1e-3, 1e4]. Default 0.2 */
    float thickness;             /**< of the material, and of what touches others [m], [1e-4, 1]. Default 0.005 */
    float stretch_stiffness[2];  /**< along warp and weft, of triangles [N/m], [1e-3, 1e9]. Default 5000 */
    float shear_stiffness;       /**< [N/m], [1e-3, 1e9]. Default 2000 */
    float poisson_ratio;         /**< contraction along weft over stretch along warp, (-1, 1). Default 0.3 */
    float bending_stiffness;     /**< of triangles [N m], 0 (limp) or [1e-9, 1e6]. Default 0 */
    float stretch_compliance[2]; /**< of each link along warp and weft [m/N], [0, 1e6]; 0: rigid. Default 1e-6 */
    float shear_compliance;      /**< of each such link [m/N], [0, 1e6], or INFINITY: there are none. Default 1e-4 */
    float bend_compliance;       /**< likewise. Default INFINITY */
    float damping;               /**< d in stress = D (strain + d rate of strain) [s], [0, 10]. Default 0 */
    float mass_damping;          /**< Rayleigh's, see deformable.h [1/s], [0, 1e4]. Default 0 */
    float stiffness_damping;     /**< likewise [s], [0, 10]. Default 0 */
    float compression;      /**< stiffness of links that are pressed over that of pulled ones, but of those that resist
                                 bending: [0, 1]; below 1 these may not be rigid. Default 1 */
    float strain_limit;     /**< stretch of edges - 1 from which on limit_compliance acts too: [1e-4, 100], or INFINITY:
                                 there is none. Default INFINITY */
    float limit_compliance; /**< of each edge beyond strain_limit, and of tethers [m/N], [1e-9, 1e6]. Default 1e-6 */
    uint32_t tethers;       /**< of each vertex: [0, TAUT_CLOTH_MAX_TETHERS]. Default 0 */
    float tether_slack;     /**< how much longer than the way to its pin each is, over that: [0, 10]. Default 0.01 */
    float tear_strain;      /**< 0: it does not tear; or [1e-3, 100]. Default 0 */
    /** [0, 100]; see deformable.h. Default 0. */
    float air_drag;
    /** [0, air_drag]. Default 0. */
    float air_lift;
    /** Within over the world's air_pressure [Pa], [-1e7, 1e7]; not 0 or with gas: of a closed mesh alone, solved
     *  directly, in worlds of TAUT_SOLVER_BLOCK_LDLT. Default 0. */
    float pressure;
    /** 1: the pressure is that of a gas, which keeps pressure times volume (isothermal) from what they are in points
     *  on; 0: it stays as it is. Default 0. */
    uint32_t gas;
    float gravity_scale;         /**< [-1000, 1000]. Default 1 */
    taut_deformable_solve solve; /**< default TAUT_DEFORMABLE_DIRECT */
    float stretch_tolerance;     /**< of a swept cloth: by which it may stretch beyond what its stiffness lets it, and
                                      for which it and what it touches take substeps, up to 64 a step, [1e-4, 10].
                                      Default 0.2 */
    taut_material material;      /**< of the surface */
    uint32_t self_collision;     /**< 1: it touches itself, see deformable.h; 0: it goes through itself. Default 0 */
    taut_filter filter;          /**< mask 0: no contacts; group may not be positive, 0: the cloth has a negative one */
    uint64_t user_data;          /**< of the cloth and of each of its vertices */
} taut_cloth_def;

TAUT_API void taut_cloth_def_init_sized(taut_cloth_def* def, uint32_t size);
static inline void taut_cloth_def_init(taut_cloth_def* def) { taut_cloth_def_init_sized(def, (uint32_t)sizeof(*def)); }
/**
 * Writes density, thickness, stiffnesses and bending in the order of a common fabric's, to be tuned.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT.
 */
TAUT_API taut_result taut_cloth_def_set_fabric(taut_cloth_def* def, taut_fabric fabric);

/**
 * Adds a cloth at rest.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; a vertex on no triangle; a triangle without area at rest, a
 *         quadrilateral that is not convex there; a mesh that is not manifold or not all turned the same way; links of
 * no length; pressure within a mesh that is open or in several pieces, or not solved directly, gas of no volume or no
 * pressure), TAUT_STRUCT_SIZE, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LIMIT, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_cloth(taut_world world, const taut_cloth_def* def, taut_cloth* out);
/** Removes a cloth with its vertices and all joints and attachments on them; taut_body_remove of one: TAUT_IN_USE. */
TAUT_API taut_result taut_cloth_remove(taut_cloth cloth);
/** 1 if the handle names a live cloth, else 0. */
TAUT_API int32_t taut_cloth_is_valid(taut_cloth cloth);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_cloth_get_user_data(taut_cloth cloth, uint64_t* out);
/** How the world's default solver takes its elements: TAUT_DEFORMABLE_DIRECT or TAUT_DEFORMABLE_SWEPT. */
TAUT_API taut_result taut_cloth_get_solve(taut_cloth cloth, taut_deformable_solve* out);
/**
 * Which contact events it gives beside those that the world or the other side asks for:
 * taut_collider_set_contact_events of all its vertices. How it is told, see deformable.h.
 * @param contact_events sum of TAUT_CONTACT_EVENTS_ bits.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cloth_set_contact_events(taut_cloth cloth, uint32_t contact_events);
/** Whether the world's pre-solve function is asked about its contacts: 1 or 0, of all vertices. @return as above. */
TAUT_API taut_result taut_cloth_set_pre_solve(taut_cloth cloth, int32_t pre_solve);
/** The cloth that a body is a vertex of; null for any other body. */
TAUT_API taut_result taut_body_get_cloth(taut_body body, taut_cloth* out);

/**
 * Pins a vertex or lets it go. A pinned one is a kinematic body, which stays, or moves as taut_body_move_kinematic and
 * taut_body_set_velocity of it say.
 * @param pinned 0 or 1.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_cloth_pin(taut_cloth cloth, uint32_t vertex, uint32_t pinned);

/**
 * Vertices after the last step [m], in the order of the def, then those that tears made.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cloth_get_points(taut_cloth cloth, taut_pos* points, uint32_t capacity, uint32_t* count);
/** Their velocities [m/s]; results as above. */
TAUT_API taut_result taut_cloth_get_velocities(taut_cloth cloth, taut_vec3* velocities, uint32_t capacity,
                                               uint32_t* count);
/** Their normals, by the angles of the triangles about them: unit, or 0 where these cancel; results as above. */
TAUT_API taut_result taut_cloth_get_normals(taut_cloth cloth, taut_vec3* normals, uint32_t capacity, uint32_t* count);
/** Their bodies; results as above. */
TAUT_API taut_result taut_cloth_get_bodies(taut_cloth cloth, taut_body* bodies, uint32_t capacity, uint32_t* count);
/** Triangles, [count][3] vertices, capacity in triangles; results as above. */
TAUT_API taut_result taut_cloth_get_triangles(taut_cloth cloth, uint32_t* triangles, uint32_t capacity,
                                              uint32_t* count);
/** Largest principal strain of each triangle, stretch - 1; results as above. */
TAUT_API taut_result taut_cloth_get_strains(taut_cloth cloth, float* strains, uint32_t capacity, uint32_t* count);

/**
 * Volume within a closed cloth as it is now [m^3], below 0 where it is turned inside out; of its whole mesh.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (its mesh is open), TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cloth_get_volume(taut_cloth cloth, double* out);
/** Pressure within over the world's air_pressure, at the volume as it is now [Pa]; results as above. */
TAUT_API taut_result taut_cloth_get_pressure(taut_cloth cloth, float* out);
/**
 * Pressure within over the world's air_pressure [Pa], [-1e7, 1e7]. With gas as much is let in or out as gives that at
 * the volume as it is now: more than 0 in all.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; the mesh is open, in several pieces or not solved directly; gas
 *         without a volume),
 *         TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_cloth_set_pressure(taut_cloth cloth, float pressure);

#ifdef __cplusplus
}
#endif

#endif
