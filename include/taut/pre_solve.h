/**
 * @file pre_solve.h
 * A function of the host that is asked about contacts after they are found and before they are solved. It may ignore
 * one for the step or give it another friction and restitution: doors for some, ice under others, bodies that pass
 * through each other by rules of the game.
 *
 * It is asked about the contacts of colliders with TAUT_COLLIDER_PRE_SOLVE, once a step each, on the thread that steps,
 * in the order of contact events; about a mesh or height field once for each of its parts that is near, about a cloth
 * or solid once for each vertex, and then for each point of an edge or triangle, that is near. Its answers hold for the
 * step, also where contacts are found anew within it. Steps are reproducible only if the answers are.
 */
#ifndef TAUT_PRE_SOLVE_H
#define TAUT_PRE_SOLVE_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Where two colliders touch, or may come to touch within the step. */
typedef struct taut_pre_solve_point {
    taut_pos position;    /**< midway between the two surfaces [m] */
    float separation;     /**< [m], negative when overlapping; before they touch, positive */
    float approach_speed; /**< along the normal [m/s]; negative: they part */
} taut_pre_solve_point;

/** A contact before it is solved. */
typedef struct taut_pre_solve {
    taut_body body_a;               /**< of collider_a */
    taut_body body_b;               /**< of collider_b */
    taut_collider collider_a;       /**< one of the pair */
    taut_collider collider_b;       /**< the other one */
    taut_pre_solve_point points[4]; /**< where they are near */
    uint32_t point_count;           /**< 1 to 4 of points; the others are zero */
    uint32_t touching;              /**< 1 if the colliders touched in the last step, else 0 */
    taut_vec3 normal;               /**< unit, from a to b */
    uint32_t reserved;              /**< zero */
} taut_pre_solve;

/** What an accepted contact is solved with. */
typedef struct taut_pre_solve_answer {
    float friction;    /**< Coulomb coefficient, [0, 100] */
    float restitution; /**< [0, 1] */
} taut_pre_solve_answer;

/**
 * Returns 1 to accept a contact, 0 to ignore it in this step. answer holds the friction and restitution of the two
 * surfaces and may be changed. Another return value or a number out of range is refused: the contact is accepted as it
 * was, and the step logs a warning; what it throws is refused likewise. Calls on the world from inside return
 * TAUT_LOCKED.
 */
typedef int32_t (*taut_pre_solve_fn)(const taut_pre_solve* contact, taut_pre_solve_answer* answer, void* user_data);

/**
 * Sets the function that steps of this world ask; null: none, all contacts are accepted. Bodies with colliders that
 * ask wake up, and what touches them.
 * Thread safety: one thread at a time per world, not inside a step.
 * @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_set_pre_solve(taut_world world, taut_pre_solve_fn pre_solve, void* user_data);

#ifdef __cplusplus
}
#endif

#endif
