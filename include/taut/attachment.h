/**
 * @file attachment.h
 * Attachments hold a point of some bodies on a point of others, be these rigid bodies, particles, or the vertices of
 * cables, cloths and solids, which are bodies too.
 *
 * Such a point is an anchor: p = sum over its bodies of weight (x + R point), with weights whose sum is 1. One body: a
 * point of it. The three vertices of a triangle: a point of a cloth, or of the boundary of a solid. The four of a
 * tetrahedron: a point within a solid. Two points of a cable: one between them. Several rigid bodies: a point skinned
 * to them. No body: a point of the world. A force on the anchor acts on each of its bodies at its point by its weight.
 *
 *   kind      holds
 *   ball      the two anchors on each other; with compliance a spring in all directions
 *   distance  the distance between them; with compliance a spring of that length
 *   fixed     each vertex of one anchor where it is at creation on the other, which is a rigid body or the world: welds
 *             a triangle or cell to it, its weights are not looked at
 *
 * A distance may hold one side alone (pulls): as a rope or strap does, where the anchors are further apart than length.
 * And it may have a limit, a length from which on a second spring pulls beside it, that of limit_compliance: soft at
 * first and stiff at its end, as ligaments and bungees are. What is read is the force of both.
 *
 * force = -(error / compliance) - damping * d(error)/dt; compliance 0 is rigid, damping then has no effect. Of a fixed
 * one that is the law of each vertex.
 *
 * A step that ends with an attachment above its break_force or break_torque removes it, as it does joints (joint.h); of
 * the joints and attachments of one mechanism the one that is furthest above. taut_events::detached tells. What removes
 * a body, cable, cloth or solid removes the attachments on it.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_ATTACHMENT_H
#define TAUT_ATTACHMENT_H

#include <taut/base.h>
#include <taut/joint.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most bodies of an anchor. */
#define TAUT_ANCHOR_BODIES 4

/** A point that moves with some bodies; all zero is the origin of the world. */
typedef struct taut_anchor {
    uint32_t count;                       /**< of bodies, [0, TAUT_ANCHOR_BODIES]; 0: points[0] is in the world */
    uint32_t reserved;                    /**< zero */
    taut_body bodies[TAUT_ANCHOR_BODIES]; /**< none twice */
    taut_pos points[TAUT_ANCHOR_BODIES];  /**< in the frame of each, within 1e4; of particles and vertices 0 [m] */
    float weights[TAUT_ANCHOR_BODIES];    /**< [-8, 8], of sum 1 within 1e-3; they are brought to 1 */
} taut_anchor;

/** The origin of the world. */
TAUT_API void taut_anchor_init(taut_anchor* anchor);

/** What an attachment holds. */
typedef enum taut_attachment_kind {
    TAUT_ATTACHMENT_BALL = 0,
    TAUT_ATTACHMENT_DISTANCE = 1,
    TAUT_ATTACHMENT_FIXED = 2,
    TAUT_ATTACHMENT_KIND_MAX = 0x7fffffff
} taut_attachment_kind;

/** An attachment between two anchors; of all their bodies together at least one must be dynamic or a particle. */
typedef struct taut_attachment_def {
    uint32_t struct_size;
    taut_attachment_kind kind;  /**< default TAUT_ATTACHMENT_BALL */
    taut_anchor a;              /**< on it acts the opposite of the force that is told */
    taut_anchor b;              /**< on it acts that force */
    float length;               /**< of a distance [m], 0 or [1e-4, 1e6]; 0: that at creation. Default 0 */
    float compliance;           /**< [m/N], [0, 1e6]. Default 0 */
    float damping;              /**< [N s/m], [0, 1e12]. Default 0 */
    float break_force;          /**< [N], [0, 1e24]; 0: never. Default 0 */
    float break_torque;         /**< of a fixed one [N m], [0, 1e24]; 0: never. Default 0 */
    uint32_t collide_connected; /**< 1: bodies of a still collide with bodies of b. Default 0 */
    taut_joint_solve solve;     /**< default TAUT_JOINT_SOLVE_DIRECT */
    uint32_t pulls;             /**< of a distance, 1: it holds where it is longer than length alone. Default 0 */
    float limit;                /**< of a distance [m], 0 or [1e-4, 1e6], at least its length; 0: none. Default 0 */
    float limit_compliance;     /**< of what pulls beyond limit [m/N], [0, 1e6]; 0: rigid. Default 0 */
    uint64_t user_data;
} taut_attachment_def;

/** An attachment as of the last step. */
typedef struct taut_attachment_state {
    taut_attachment attachment; /**< that it is of */
    uint64_t user_data;
    taut_pos point_a; /**< of the anchors, in the world [m] */
    taut_pos point_b; /**< likewise */
    taut_vec3 force;  /**< on b, world axes [N]; a receives the opposite. Zero before the first step */
    float error;      /**< [m], as taut_attachment_get_error */
} taut_attachment_state;

TAUT_API void taut_attachment_def_init_sized(taut_attachment_def* def, uint32_t size);
static inline void taut_attachment_def_init(taut_attachment_def* def) {
    taut_attachment_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * The anchor on a body that is at a point of the world now; of a particle or vertex it is at the body itself.
 * @param body null: the world. @param point [m], within 1e7.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (further than 1e4 m from the body), TAUT_NULL_POINTER, TAUT_STALE_HANDLE,
 *         TAUT_FOREIGN_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_anchor(taut_world world, taut_body body, taut_pos point, taut_anchor* out);
/** Where an anchor is now [m]; results as for adding an attachment. */
TAUT_API taut_result taut_world_get_anchor_point(taut_world world, const taut_anchor* anchor, taut_pos* out);
/**
 * The anchor at a point of a triangle, as taut_cloth_get_triangles numbers them.
 * @param weights of its three vertices, in the order of taut_cloth_get_triangles; as those of an anchor.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cloth_get_anchor(taut_cloth cloth, uint32_t triangle, const float weights[3],
                                           taut_anchor* out);
/** The same on a triangle of a solid's boundary, as taut_solid_get_triangles numbers them. */
TAUT_API taut_result taut_solid_get_anchor(taut_solid solid, uint32_t triangle, const float weights[3],
                                           taut_anchor* out);
/**
 * The anchor on a cloth that is nearest to a point of the world now, on the first of equally near triangles. Looks at
 * all triangles.
 * @param point [m], within 1e7. @param triangle that it is on; null if not asked for.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cloth_find_anchor(taut_cloth cloth, taut_pos point, taut_anchor* out, uint32_t* triangle);
/**
 * The anchor in a solid that is nearest to a point of the world now: within one of its cells, or on the boundary. Of a
 * hexahedron it is in one of five tetrahedra of its corners, of which one is within and the others lie beside it. Of a
 * solid without a mesh it is on one of its triangles, or without these at a vertex. Looks at all of them.
 * @param cell that it is in, or the triangle or vertex; null if not asked for.
 */
TAUT_API taut_result taut_solid_find_anchor(taut_solid solid, taut_pos point, taut_anchor* out, uint32_t* cell);

/**
 * Adds an attachment. A body on both sides is on one by the difference of its weights.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; a body twice in an anchor; a point off a particle; nothing moves; both
 *         anchors the same point of the same bodies; anchors of a distance closer than 1e-4 m; a limit below the
 *         length; pulls or a limit of what is no distance; a fixed one that is not
 *         of particles on one side and of a rigid body or the world on the other), TAUT_STALE_HANDLE,
 *         TAUT_FOREIGN_HANDLE, TAUT_STRUCT_SIZE, TAUT_NULL_POINTER, TAUT_LIMIT, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_attachment(taut_world world, const taut_attachment_def* def, taut_attachment* out);
/** Removes an attachment. @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_attachment_remove(taut_attachment attachment);
/** 1 if the handle names a live attachment, else 0. */
TAUT_API int32_t taut_attachment_is_valid(taut_attachment attachment);

/** The def as it is now: weights brought to 1, the length of a distance. */
TAUT_API taut_result taut_attachment_get_def_sized(taut_attachment attachment, taut_attachment_def* out, uint32_t size);
static inline taut_result taut_attachment_get_def(taut_attachment attachment, taut_attachment_def* out) {
    return taut_attachment_get_def_sized(attachment, out, (uint32_t)sizeof(*out));
}
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_attachment_get_user_data(taut_attachment attachment, uint64_t* out);
TAUT_API taut_result taut_attachment_set_user_data(taut_attachment attachment, uint64_t value);
/** World positions of the two anchors after the last step [m]. */
TAUT_API taut_result taut_attachment_get_points(taut_attachment attachment, taut_pos* point_a, taut_pos* point_b);
/** Force on b in the last substep, world axes [N]; a receives the opposite. Zero before the first step. */
TAUT_API taut_result taut_attachment_get_force(taut_attachment attachment, taut_vec3* out);
/** Torque of a fixed one on b about the anchor whose vertices it holds, likewise [N m]; 0 of the others. */
TAUT_API taut_result taut_attachment_get_torque(taut_attachment attachment, taut_vec3* out);
/** How far it is off at the present poses [m]: gap, |length error| of a distance, of one that pulls 0 where it is
 *  slack, of a fixed one its widest gap; what a compliant one gives counts too. */
TAUT_API taut_result taut_attachment_get_error(taut_attachment attachment, float* out);
/**
 * All attachments of a world, in the order of their slots.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_attachments_sized(taut_world world, taut_attachment_state* states,
                                                      uint32_t capacity, uint32_t* count, uint32_t size);
static inline taut_result taut_world_get_attachments(taut_world world, taut_attachment_state* states, uint32_t capacity,
                                                     uint32_t* count) {
    return taut_world_get_attachments_sized(world, states, capacity, count, (uint32_t)sizeof(*states));
}

/** Changes compliance [m/N] and damping [N s/m]; ranges as in the def. May be TAUT_OUT_OF_MEMORY. */
TAUT_API taut_result taut_attachment_set_compliance(taut_attachment attachment, float compliance, float damping);
/** Changes the length of a distance [m], [1e-4, 1e6], over the next step; TAUT_INVALID_ARGUMENT for another kind, and
 *  for one with a limit below the new length. */
TAUT_API taut_result taut_attachment_set_length(taut_attachment attachment, float length);
/** Changes what it breaks at [N], [N m], [0, 1e24]; 0: never. The torque of what is not fixed must be 0. */
TAUT_API taut_result taut_attachment_set_break(taut_attachment attachment, float force, float torque);

#ifdef __cplusplus
}
#endif

#endif
