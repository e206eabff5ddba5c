/**
 * @file sleep.h
 * Sleeping: what came to rest costs next to nothing until something happens to it.
 * A world sleeps if its def says so (world.h: sleeping, sleep_speed, sleep_time). Bodies connected by joints, by
 * attachments, or by contacts with gaps of at most 5 mm, form an island; static and kinematic bodies connect nothing.
 * An island falls asleep as a whole once no point of any of its bodies has been faster than sleep_speed for sleep_time:
 * over the step and at its end, with |v| + |w| r for the speed of the surface. What touches a moving kinematic body, or
 * hangs on it, stays awake.
 *
 * While asleep a body has no velocity and no moved events; joints and contacts keep their forces, and queries find it.
 * The island wakes as a whole, and goes on with those forces, when
 * - an awake body, or a kinematic one that moves, touches it or will within the step,
 * - a call changes the motion, pose, forces (but by nothing), mass, colliders or filters of one of its bodies, or of
 *   what it touches; or adds, changes or removes a joint or attachment of it; or reels a cable of it,
 * - a static or kinematic body, or a collider of one, comes to where it lies,
 * - gravity changes; taut_body_set_awake or taut_world_wake_box says so.
 * A kinematic body that taut_body_move_kinematic sends to where it is wakes nobody, nor does a drive that is told its
 * target again.
 *
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_SLEEP_H
#define TAUT_SLEEP_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** 1 if the body is awake, else 0. Static and kinematic bodies count as awake, a disabled one as events said last.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_awake(taut_body body, uint32_t* out);
/**
 * Wakes the island of a body (awake 1; its quiet time begins anew), or puts it to sleep now, moving or not (awake 0).
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT for a static, kinematic or disabled body, awake above 1, and 0 in a world
 *         without sleeping; TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_awake(taut_body body, uint32_t awake);
/** Whether islands with this body may fall asleep. @return as taut_body_get_awake. */
TAUT_API taut_result taut_body_get_can_sleep(taut_body body, uint32_t* out);
/**
 * Says so; 0 wakes its island, and lets only taut_body_set_awake put it to sleep. A new body can sleep.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (above 1), TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_set_can_sleep(taut_body body, uint32_t can_sleep);
/**
 * Wakes each island of which a collider's bounds meet a box; for what no call tells the world, and for what a query
 * found. In a world without sleeping it does nothing.
 * @param low, high corners [m], each within 1e7, low at most high.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_wake_box(taut_world world, taut_pos low, taut_pos high);

#ifdef __cplusplus
}
#endif

#endif
