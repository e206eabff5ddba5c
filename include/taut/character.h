/**
 * @file character.h
 * Characters: upright capsules that walk, climb steps, slide along walls, ride what moves and push what is loose, by
 * queries alone. A character is a plain struct of the host's and no part of a world: it has no handle, takes no
 * memory, and is copied, saved and restored as any struct, beside a snapshot of the world.
 *
 * A frame is taut_world_advance and then taut_character_move, both with its seconds:
 *
 *     taut_world_advance(world, seconds, NULL);
 *     taut_character_move(world, &def, walk, jump, seconds, &character);
 *
 * Its path hardly depends on the length of the frames: falls are parabolas, changes of speed are constant
 * accelerations, and along the ground the horizontal speed is what is asked for, on slopes and stairs as on the level.
 */
#ifndef TAUT_CHARACTER_H
#define TAUT_CHARACTER_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>
#include <taut/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** What carries a character. */
typedef enum taut_character_state {
    TAUT_CHARACTER_IN_AIR = 0,    /**< nothing */
    TAUT_CHARACTER_ON_GROUND = 1, /**< a surface no steeper than max_slope, the edge of one, or a gap too narrow to fall
                                       into */
    TAUT_CHARACTER_SLIDING = 2,   /**< a steeper surface, down which it slides without friction */
    TAUT_CHARACTER_STATE_MAX = 0x7fffffff
} taut_character_state;

/** What a character is like. It may be another one at each call: to crouch, take a lower shape. */
typedef struct taut_character_def {
    uint32_t struct_size;
    float gap;          /**< kept between the capsule and all else [m], [1e-4, 0.1]. Default 0.01 */
    taut_shape shape;   /**< a capsule of the world, which need not be on a body. Not null */
    taut_body body;     /**< a kinematic body that is led after the character, so that others touch it; queries of the
                             character do not see it. Null: none, and only what the character pushes feels it */
    taut_vec3 up;       /**< direction of its axis, against which it falls; not zero. Default (0, 1, 0) */
    float gravity;      /**< acceleration against up [m/s^2], [0, 1e4]. Default 9.81 */
    float step_height;  /**< of what it steps onto and down from without leaving the ground [m], [0, 1e3]. Default
                             0.35 */
    float max_slope;    /**< steepest ground that it can walk on [rad], [0, 1.55]. Default 0.87: 50 degrees */
    float acceleration; /**< at which its speed on the ground becomes what is asked for [m/s^2], [0, 1e6]. Default 50 */
    float air_acceleration;          /**< the same in the air and sliding [m/s^2], [0, 1e6]. Default 5 */
    float mass;                      /**< its weight on dynamic bodies that it stands on [kg], [0, 1e6]. Default 80 */
    float push_force;                /**< most force on each dynamic body in its way [N], [0, 1e9]. Default 400 */
    const taut_query_filter* filter; /**< what it meets; null: all but sensors. It ignores up to
                                          TAUT_QUERY_MAX_IGNORED - 1 bodies and TAUT_QUERY_MAX_IGNORED - 16 colliders */
} taut_character_def;

/**
 * A character. taut_character_init and then a position make one; the host may change position and velocity at any time.
 * The rest is told by taut_character_move, which needs it again at the next call.
 */
typedef struct taut_character {
    uint32_t struct_size;
    taut_character_state state;    /**< what carries it */
    taut_pos position;             /**< of the capsule's centre [m], within 9e6 of the origin */
    taut_vec3 velocity;            /**< relative to ground_velocity [m/s], within 1e4; on the ground horizontal */
    taut_vec3 ground_velocity;     /**< of the ground beneath it; in the air and sliding, as it left the ground [m/s] */
    taut_vec3 ground_normal;       /**< unit, of the surface that carries it, against which it slides; 0 in the air */
    float ground_turn;             /**< by which the ground turned about up within the call, for the direction that the
                                        character looks in [rad] */
    taut_pos ground_point;         /**< where that touches the capsule [m]; 0 in the air */
    taut_pose ground_pose;         /**< of ground_body at the end of the call */
    taut_body ground_body;         /**< that carries it; null in the air. It may be removed since */
    taut_collider ground_collider; /**< likewise */
    float overlap;                 /**< how deep it is within what leaves it no room [m]; 0: it is free */
    uint32_t pushed;               /**< dynamic bodies that were in its way and got a force */
} taut_character;

TAUT_API void taut_character_def_init_sized(taut_character_def* def, uint32_t size);
static inline void taut_character_def_init(taut_character_def* def) {
    taut_character_def_init_sized(def, (uint32_t)sizeof(*def));
}
/** At the origin, at rest, in the air. */
TAUT_API void taut_character_init_sized(taut_character* character, uint32_t size);
static inline void taut_character_init(taut_character* character) {
    taut_character_init_sized(character, (uint32_t)sizeof(*character));
}

/**
 * Moves a character by a frame: it is carried along with the ground, gets out of what moved into it, walks or falls
 * along what is in its way, and ends on ground that is within its reach. What it is pushed by and rides on is where
 * the last step left it; forces on what it stands on and pushes act over the time of the next call of taut_world_step
 * or taut_world_advance, as those of taut_body_apply_force_at.
 *
 * A dynamic body in its way gets the force that would stop their approach within the frame, at most push_force: boxes
 * slide before it at the speed of its walk, if friction lets them. Where there is no room it gives way to what is
 * static before what moves, see overlap. Meshes are met from their front.
 *
 * Thread safety: one thread at a time per world, not inside a step.
 * @param walk horizontal velocity wanted, relative to the ground [m/s], its length at most 1e4; what is along up does
 *        not matter. @param jump speed along up to leave the ground with [m/s], [0, 1e4]; 0: none. In the air and where
 *        it slides it does nothing. @param seconds 0 or [1e-4, 1].
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value; a shape that
 *         is no capsule, a body that is not kinematic), TAUT_STALE_HANDLE and TAUT_FOREIGN_HANDLE (world, shape, body,
 *         what the filter ignores), TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_character_move(taut_world world, const taut_character_def* def, taut_vec3 walk, float jump,
                                         float seconds, taut_character* character);

#ifdef __cplusplus
}
#endif

#endif
