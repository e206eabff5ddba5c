/**
 * @file sensor.h
 * Sensors: colliders that nothing collides with and that tell what overlaps them.
 *
 * A collider is a sensor by TAUT_COLLIDER_SENSOR in its def or by taut_collider_set_sensor; its body may be of any
 * kind. After each step it detects the colliders of other bodies that overlap or touch it where they are then: shape
 * against shape as in query.h, without the margins of contacts. A cloth or solid is one visitor, by its vertices and
 * triangles, half of its thickness about them, and what is within a solid; see deformable.h. It detects what its filter
 * would let it collide with, on dynamic and kinematic bodies and particles, and on static ones with
 * TAUT_COLLIDER_SENSES_STATIC. Joints do not matter. It detects no other sensor, and a plane, mesh or height field as
 * sensor detects none of those three. What passes through within one step is missed.
 *
 * A sensor has no share in a mass taken from colliders, is solved with nobody and connects nobody. Queries pass it by
 * unless their filter has TAUT_QUERY_SENSOR.
 *
 * taut_events.sensor_enter and sensor_leave tell the changes, step by step. Each visit has one enter and then one
 * leave, be it in the same reading, whatever ends it: motion, removal of a collider or body, another filter, another
 * shape, a sensor that is one no longer.
 */
#ifndef TAUT_SENSOR_H
#define TAUT_SENSOR_H

#include <taut/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Makes a collider a sensor (1) or one that collides again (0). Its contacts, or its visits, end with the next step's
 * events; its body's mass stays as it is. Thread safety: one thread at a time per world, not inside a step.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_IN_USE (of a cable), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_collider_set_sensor(taut_collider collider, uint32_t sensor);

/**
 * Copies the colliders that overlapped a sensor after the last step and live, in the order of their slots; none if the
 * collider is no sensor. Thread safety: any thread between steps while no other changes the world.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_collider_get_overlaps(taut_collider sensor, taut_collider* colliders, uint32_t capacity,
                                                uint32_t* count);

#ifdef __cplusplus
}
#endif

#endif
