/**
 * @file joint.h
 * Joints between two ends, each a rigid body, a particle or the world (null handle).
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_JOINT_H
#define TAUT_JOINT_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Which joint a handle names. */
typedef enum taut_joint_kind {
    TAUT_JOINT_BALL = 0,
    TAUT_JOINT_DISTANCE = 1,
    TAUT_JOINT_KIND_MAX = 0x7fffffff
} taut_joint_kind;

/**
 * Holds a point of one end on a point of the other (3 rows).
 * force = -(error / compliance) - damping * d(error)/dt; compliance 0 is rigid, damping then has no effect.
 */
typedef struct taut_ball_joint_def {
    uint32_t struct_size;
    uint32_t collide_connected; /**< 1: the two bodies still collide. Default 0 */
    taut_body body_a;           /**< null: the world */
    taut_body body_b;           /**< null: the world; at least one end must be dynamic or a particle */
    taut_pos anchor_a; /**< in the frame of end a, within 1e4; world position if null [m]; a particle takes only 0 */
    taut_pos anchor_b; /**< in the frame of end b, world position if null [m]; a particle takes only 0 */
    float compliance;  /**< [m/N], [0, 1e6]. Default 0 */
    float damping;     /**< [N s/m], [0, 1e12]. Default 0 */
    uint64_t user_data;
} taut_ball_joint_def;

/** Holds two points at a distance (1 row): a rod, or a spring when compliant. */
typedef struct taut_distance_joint_def {
    uint32_t struct_size;
    uint32_t collide_connected; /**< 1: the two bodies still collide. Default 0 */
    taut_body body_a;           /**< null: the world */
    taut_body body_b;           /**< null: the world; at least one end must be dynamic or a particle */
    taut_pos anchor_a;          /**< as for the ball joint */
    taut_pos anchor_b;
    float length;      /**< [m], 0: the distance at creation, else [1e-4, 1e6]. Default 0 */
    float compliance;  /**< [m/N], [0, 1e6]. Default 0 */
    float damping;     /**< [N s/m], [0, 1e12]. Default 0 */
    uint32_t reserved; /**< zero */
    uint64_t user_data;
} taut_distance_joint_def;

TAUT_API void taut_ball_joint_def_init(taut_ball_joint_def* def);
TAUT_API void taut_distance_joint_def_init(taut_distance_joint_def* def);

/**
 * Adds a joint.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (both ends fixed or the same, anchor off a particle, points of a distance
 *         joint closer than 1e-4 m, range), TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE, TAUT_STRUCT_SIZE,
 * TAUT_NULL_POINTER, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_ball_joint(taut_world world, const taut_ball_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_distance_joint(taut_world world, const taut_distance_joint_def* def,
                                                   taut_joint* out);
TAUT_API taut_result taut_joint_remove(taut_joint joint);
/** 1 if the handle names a live joint, else 0. */
TAUT_API int32_t taut_joint_is_valid(taut_joint joint);

TAUT_API taut_result taut_joint_get_kind(taut_joint joint, taut_joint_kind* out);
TAUT_API taut_result taut_joint_get_user_data(taut_joint joint, uint64_t* out);
TAUT_API taut_result taut_joint_get_bodies(taut_joint joint, taut_body* body_a, taut_body* body_b);
/** World positions of the two anchors after the last step [m]. */
TAUT_API taut_result taut_joint_get_anchors(taut_joint joint, taut_pos* anchor_a, taut_pos* anchor_b);
/** Force on end b in the last substep, world axes [N]; end a receives the opposite. */
TAUT_API taut_result taut_joint_get_force(taut_joint joint, taut_vec3* out);
/** Distance by which the joint is violated at the present poses [m]: gap of a ball joint, |length error| of a rod. */
TAUT_API taut_result taut_joint_get_error(taut_joint joint, float* out);
/** Changes compliance [m/N] and damping [N s/m]; ranges as in the defs. */
TAUT_API taut_result taut_joint_set_compliance(taut_joint joint, float compliance, float damping);
/** Changes the length of a distance joint [m], [1e-4, 1e6]; TAUT_INVALID_ARGUMENT for another kind. */
TAUT_API taut_result taut_joint_set_length(taut_joint joint, float length);

#ifdef __cplusplus
}
#endif

#endif
