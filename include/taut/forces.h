/**
 * @file forces.h
 * What fluids and explosions do to bodies: buoyancy, drag, wind and blasts, by the surfaces of their colliders. The
 * host calls these before a step or a frame, for the bodies that it wants: nothing of it is kept in the world.
 *
 * Colliders are polyhedra here: boxes and hulls as they are, round shapes as ones of the same volume with 32 corners
 * around (a sphere's volume beneath a surface is right within 0.2 % of its whole). What a body is given acts as
 * taut_body_apply_force does, over the time of the next call of taut_world_step or taut_world_advance.
 */
#ifndef TAUT_FORCES_H
#define TAUT_FORCES_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>
#include <taut/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * A fluid beneath a plane, or everywhere: water, air that stands or blows. On each part dA of the surface of a body
 * that is in the fluid and moves through it at v, with the unit normal n out of the body, act the pressure of the
 * depth, which together is -density gravity V at the middle of the volume V in the fluid; -1/2 density drag max(0, v .
 * n) v dA, which of a convex body that does not turn is 1/2 density drag A v^2, A the area that it shows to the flow;
 *     -skin_drag v dA.
 * Each is taken as it will be at the end of the frame, as far as it depends on the motion, so that nothing is gained by
 * long frames: what floats does not swing up, and drag stops no more than there is.
 */
typedef struct taut_fluid_def {
    uint32_t struct_size;
    float density;      /**< [kg/m^3], [0, 1e6]. Default 1000 */
    taut_pos point;     /**< of the surface [m] */
    taut_vec3 normal;   /**< of the surface, out of the fluid; normalised. 0: the fluid is everywhere. Default
                             (0, 1, 0) */
    taut_vec3 gravity;  /**< [m/s^2], each within 1e4, also that of the bodies. Default (0, -9.81, 0) */
    taut_vec3 velocity; /**< of the fluid [m/s], length at most 1e4. Default 0 */
    float drag;         /**< coefficient of the area in the flow, [0, 100]. Default 1 */
    float skin_drag;    /**< per area of the surface [N s/m^3], [0, 1e9]. Default 0 */
} taut_fluid_def;

/** What a fluid does to a body. */
typedef struct taut_fluid_report {
    float volume;     /**< in the fluid [m^3] */
    float area;       /**< of the surface of colliders in it [m^2] */
    taut_pos centre;  /**< of the volume [m]; 0 where there is none */
    taut_vec3 force;  /**< put on the body [N] */
    taut_vec3 torque; /**< about its centre of mass [N m] */
} taut_fluid_report;

/**
 * A blast: an impulse per area that its centre drives outward, on each part of a surface that looks to the centre, by
 * the cosine. At a distance r it is impulse (1 - r / radius)^falloff. Bodies turn as it meets them off their centre.
 */
typedef struct taut_explosion_def {
    uint32_t struct_size;
    float radius;                    /**< [m], [1e-3, 1e6]. Default 10 */
    taut_pos position;               /**< [m] */
    float impulse;                   /**< at its centre [N s/m^2], [-1e12, 1e12]; below 0 it pulls. Default 1000 */
    uint32_t falloff;                /**< [0, 16]. Default 1 */
    uint32_t occlusion;              /**< 1: colliders whose middle is behind another collider, by a ray, feel nothing.
                                          Default 0 */
    uint32_t reserved;               /**< zero */
    const taut_query_filter* filter; /**< what it reaches and what is in the way; null: all but sensors */
} taut_explosion_def;

TAUT_API void taut_fluid_def_init_sized(taut_fluid_def* def, uint32_t size);
static inline void taut_fluid_def_init(taut_fluid_def* def) { taut_fluid_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_explosion_def_init_sized(taut_explosion_def* def, uint32_t size);
static inline void taut_explosion_def_init(taut_explosion_def* def) {
    taut_explosion_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Puts the forces of a fluid on a dynamic body, over its next seconds; a body that is out of the fluid, or is not moved
 * by forces, gets none. A body in two fluids takes a call for each. Where nothing is to be done a sleeping body sleeps
 * on; what floats at rest gets a force all the same and stays awake.
 * Thread safety: one thread at a time per world, not inside a step.
 * @param seconds of the next step or frame, [1e-4, 1]. @param report null: not told.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value),
 *         TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_apply_fluid_sized(taut_body body, const taut_fluid_def* def, float seconds,
                                                 taut_fluid_report* report, uint32_t size);
static inline taut_result taut_body_apply_fluid(taut_body body, const taut_fluid_def* def, float seconds,
                                                taut_fluid_report* report) {
    return taut_body_apply_fluid_sized(body, def, seconds, report, (uint32_t)sizeof(*report));
}

/**
 * Gives all bodies within its radius the impulse of a blast, at once, and wakes them; particles as spheres.
 * Thread safety: one thread at a time per world, not inside a step.
 * @param pushed bodies that got an impulse; null: not told.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value; a body that
 *         it would drive past 1e4 m/s or rad/s), TAUT_STALE_HANDLE and TAUT_FOREIGN_HANDLE (world, what the filter
 *         ignores), TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_apply_explosion(taut_world world, const taut_explosion_def* def, uint32_t* pushed);

#ifdef __cplusplus
}
#endif

#endif
