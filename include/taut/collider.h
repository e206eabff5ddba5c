/**
 * @file collider.h
 * Colliders: shapes on a body, each at a place in the body's frame with its own surface and filter. A body has as many
 * as it needs: a table is five boxes. A body made with a shape has one from the start, a particle at most one.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_COLLIDER_H
#define TAUT_COLLIDER_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * How a coefficient of a pair follows from those of its two surfaces, a and b. Where the surfaces name different
 * rules, the one further down this list is used.
 */
typedef enum taut_combine {
    TAUT_COMBINE_DEFAULT = 0,        /**< friction: geometric mean; restitution: maximum */
    TAUT_COMBINE_GEOMETRIC_MEAN = 1, /**< sqrt(a b) */
    TAUT_COMBINE_AVERAGE = 2,        /**< (a + b) / 2 */
    TAUT_COMBINE_MINIMUM = 3,        /**< min(a, b) */
    TAUT_COMBINE_PRODUCT = 4,        /**< a b */
    TAUT_COMBINE_MAXIMUM = 5,        /**< max(a, b) */
    TAUT_COMBINE_MAX = 0x7fffffff
} taut_combine;

/**
 * Surface of a collider. Fields not named in an initialiser are 0, which is the default of all but the first.
 *
 * Rolling and spinning friction are what a soft surface does to a body that rolls or spins on it: a torque of at most
 * their length times the contact's normal force, against the relative rotation about the axes in the contact's plane
 * and about its normal. A ball of radius r stays on slopes up to tan(angle) = rolling_friction / r. A pair uses the
 * larger value of its two surfaces. Particles do not rotate, and are not affected.
 *
 * At least, where a shape is round (all but boxes, hulls and planes), the two touch in a patch of radius a, 3 % of the
 * smaller one's reach from its origin, which resists spinning by an arm of 2/3 friction a, and rolling, but of spheres
 * and capsules, by an arm of 1 % of a; so that what spins on its poles or rocks comes to rest. Bodies that joints
 * solved directly hold in contact are left out.
 */
typedef struct taut_material {
    float friction;                /**< Coulomb coefficient, [0, 100]. Default 0.5 */
    float restitution;             /**< approach speed kept as separation speed, [0, 1]. Default 0 */
    taut_combine friction_rule;    /**< of friction in a pair */
    taut_combine restitution_rule; /**< of restitution in a pair */
    float rolling_friction;        /**< arm of the rolling resistance [m], [0, 1000]. Default 0 */
    float spinning_friction;       /**< arm of the torque against spinning [m], [0, 1000]. Default 0 */
} taut_material;

/**
 * What friction of a collider is beyond one coefficient for sticking and sliding, in all directions. Fields not named
 * in an initialiser are 0, as by default: then friction is that of the material alone.
 *
 * Static friction: a contact point that does not slide holds up to static_friction times its normal force; one that
 * slides is held back by the material's friction times it, until it comes to rest or the slip turns round. Creep slower
 * than about a third of (static_friction - friction) g h, with the substep h, counts as sticking. Of a pair it follows
 * from the static_friction of its two surfaces, where that is below a surface's friction from the latter, by the rule
 * of friction. An answer of the pre-solve function that changes the friction holds for both.
 *
 * By direction: along slide_direction, as seen on the contact's plane, friction is slide_factor times as large as
 * across it, where the coefficients are as given: skis, blades, rollers, wood grain. Forces stay within an ellipse, and
 * of those on its rim the one that takes most energy acts: with the factor m, the slip v and the normal force N,
 *   (F_along / (m mu N))^2 + (F_across / (mu N))^2 <= 1,   F_i parallel to -mu_i^2 v_i.
 * Where the direction leaves the plane by an angle t, the factor is 1 / sqrt(1 + (1 / m^2 - 1) cos(t)^2). Below 1e-6 m
 * counts as 1e-6. Where both surfaces have a direction, what they let slip adds up: the ellipse's matrix, 1 of a circle
 * and 1 + (1 / m^2 - 1) d d^T of a direction d, is 1 and what either has beyond it.
 *
 * Static friction is that of contacts that the solvers block_ldlt and projected_gauss_seidel sweep: those that a direct
 * solve takes in with joints, and those of other solvers, have the material's. Grains, and contacts of cloths, solids,
 * and worlds that minimise, have the material's friction alone. Rolling and spinning friction know no direction.
 */
typedef struct taut_friction {
    float static_friction; /**< coefficient while it sticks, [0, 100]; below the material's friction: that. Default 0 */
    float slide_factor;    /**< of the coefficients along slide_direction, [0, 1]; 0: it slides freely. Default 0 */
    taut_vec3 slide_direction; /**< in the collider's frame, each component within 1e4, the length does not matter; 0:
                                  friction is the same all ways. Default 0 */
    uint32_t reserved;         /**< zero */
} taut_friction;

/**
 * Who collides with whom: two colliders collide when they share a non-zero group with positive sign, never
 * when they share a negative one; else when each one's category is in the other's mask. Those of one body never do.
 */
typedef struct taut_filter {
    uint64_t category; /**< default 1 */
    uint64_t mask;     /**< default all bits */
    int32_t group;     /**< default 0 */
    uint32_t reserved; /**< zero */
} taut_filter;

/** The defaults that a def has. */
TAUT_API void taut_material_init(taut_material* material);
TAUT_API void taut_filter_init(taut_filter* filter);
TAUT_API void taut_friction_init(taut_friction* friction);

/** Bits of taut_collider_def.flags. */
#define TAUT_COLLIDER_SENSOR 1u        /**< detects what overlaps it and collides with nothing; see sensor.h */
#define TAUT_COLLIDER_SENSES_STATIC 2u /**< a sensor that detects colliders of static bodies too */
#define TAUT_COLLIDER_PRE_SOLVE 4u /**< the world's pre-solve function is asked about its contacts; see pre_solve.h */
/** A grain of sand or the like, of which a world may hold tens of thousands; on particles alone. Contacts between two
 * grains are found and solved on a path of their own, several times cheaper: with filters, joints and friction as ever,
 * but without events, the pre-solve function, restitution, and without counting for max_contacts. As particles do not
 * turn, friction stands for what resists rolling too. Contacts of grains with all else are as any other. Where the
 * world's solver has no sweeps (taut_solver) it means nothing. */
#define TAUT_COLLIDER_GRAIN 8u

/** Bits of contact_events: what taut_events tells of a pair's contact. A pair gives what one of its colliders or the
 * world's def asks for. */
#define TAUT_CONTACT_EVENTS_BEGIN_END 1u /**< that it began or ended */
#define TAUT_CONTACT_EVENTS_PERSIST 2u   /**< that it goes on, in each step */
#define TAUT_CONTACT_EVENTS_POINTS 4u    /**< the points of those that began or go on */
#define TAUT_CONTACT_EVENTS_HIT 8u       /**< that it closed faster than the world's hit_speed */
/** All of these. */
#define TAUT_CONTACT_EVENTS_ALL 15u

/** A shape on a body. */
typedef struct taut_collider_def {
    uint32_t struct_size;
    float density;          /**< its share in a mass taken from colliders [kg/m^3], [0, 1e8]; 0: none. Default 1000 */
    taut_shape shape;       /**< of the body's world; not null */
    taut_vec3 position;     /**< of the shape's origin in the body's frame [m], within TAUT_SHAPE_MAX_SIZE. Default 0 */
    taut_quat rotation;     /**< of the shape in the body's frame. Default identity */
    taut_material material; /**< of the surface */
    taut_filter filter;     /**< who collides with it */
    uint64_t user_data;
    uint32_t flags;          /**< sum of TAUT_COLLIDER_ bits. Default 0 */
    uint32_t contact_events; /**< sum of TAUT_CONTACT_EVENTS_ bits, beside the world's. Default 0 */
    /** Other colliders touch it only from the side that this direction of the collider's frame points to, as a platform
     * that is jumped through from below: see taut_collider_set_one_way. Each component within 1e4, the length does not
     * matter; 0: it is touched from everywhere. Default 0 */
    taut_vec3 one_way;
    uint32_t reserved;      /**< zero */
    taut_friction friction; /**< static friction, and friction by direction. Default: none */
} taut_collider_def;

TAUT_API void taut_collider_def_init_sized(taut_collider_def* def, uint32_t size);
static inline void taut_collider_def_init(taut_collider_def* def) {
    taut_collider_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Adds a collider to a body. The body's mass stays as it is; see taut_body_set_mass_from_colliders.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (text names field and value; a plane, mesh or height field on a dynamic
 *         body; a particle, whose
 *         collider comes with its def), TAUT_STRUCT_SIZE, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE,
 *         TAUT_IN_USE (a body of a cable), TAUT_LIMIT, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_add_collider(taut_body body, const taut_collider_def* def, taut_collider* out);
/**
 * Removes a collider. The body's mass stays as it is; its contacts end with the next step's events.
 * @return TAUT_OK; TAUT_IN_USE (of a cable), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_collider_remove(taut_collider collider);
/** 1 if the handle names a live collider, else 0. */
TAUT_API int32_t taut_collider_is_valid(taut_collider collider);

/**
 * Copies the colliders of a body in the order in which they were added.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_get_colliders(taut_body body, taut_collider* colliders, uint32_t capacity,
                                             uint32_t* count);
/**
 * Gives a dynamic body the mass, centre of mass and inertia of its colliders at their densities. Joints stay where they
 * hold it; the motion of every point of the body stays.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT if the body is not dynamic or the sum is not within [1e-6, 1e15] kg;
 *         TAUT_IN_USE (a body of a cable), TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_set_mass_from_colliders(taut_body body);

/** The collider as a def would make it anew, but for its surface velocity. */
TAUT_API taut_result taut_collider_get_def_sized(taut_collider collider, taut_collider_def* out, uint32_t size);
static inline taut_result taut_collider_get_def(taut_collider collider, taut_collider_def* out) {
    return taut_collider_get_def_sized(collider, out, (uint32_t)sizeof(*out));
}
/** The body that it is on. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_collider_get_body(taut_collider collider, taut_body* out);
/** Its least axis-aligned box [m], as taut_body_get_bounds. */
TAUT_API taut_result taut_collider_get_bounds(taut_collider collider, taut_pos* low, taut_pos* high);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_collider_get_user_data(taut_collider collider, uint64_t* out);
TAUT_API taut_result taut_collider_set_user_data(taut_collider collider, uint64_t value);
/**
 * Changes the shape, and where it is in the body's frame. Contact impulses carried over go on where points stay.
 * @return as taut_body_add_collider; a particle's shape must be a sphere at its centre.
 */
TAUT_API taut_result taut_collider_set_shape(taut_collider collider, taut_shape shape, taut_vec3 position,
                                             taut_quat rotation);
/** Changes its surface, from the next step on. @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER,
 *  TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_collider_set_material(taut_collider collider, const taut_material* material);
/**
 * Changes its static friction and its friction by direction, from the next step on. taut_collider_get_def tells them,
 * the direction as a unit vector.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (text names field and value), TAUT_NULL_POINTER, TAUT_IN_USE (of a cable,
 * cloth or solid), TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_collider_set_friction(taut_collider collider, const taut_friction* friction);
/** Changes who collides with it, from the next step on. */
TAUT_API taut_result taut_collider_set_filter(taut_collider collider, const taut_filter* filter);
/** Changes its share in a mass taken from colliders [kg/m^3], [0, 1e8]; the body's mass stays as it is. */
TAUT_API taut_result taut_collider_set_density(taut_collider collider, float density);
/**
 * Moves the surface of a collider along itself while its body stays as it is: a conveyor belt, a turntable, a track.
 * At a point p, in the collider's frame (that of its shape, which turns with the body), the surface runs at
 * velocity + spin x p. Friction drives what touches it to the part of this along the contact's plane, with the
 * opposite force on the collider's body. Kept until the next call; 0 by default.
 * @param velocity [m/s], length at most 10000. @param spin [rad/s], length at most 10000.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (text names argument and value), TAUT_IN_USE (of a cable), TAUT_STALE_HANDLE,
 *         TAUT_LOCKED.
 */
TAUT_API taut_result taut_collider_set_surface_velocity(taut_collider collider, taut_vec3 velocity, taut_vec3 spin);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_collider_get_surface_velocity(taut_collider collider, taut_vec3* velocity, taut_vec3* spin);

/**
 * Which contact events its pairs give beside those that the world or the other collider asks for, from the next step
 * on.
 * @param contact_events sum of TAUT_CONTACT_EVENTS_ bits.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_collider_set_contact_events(taut_collider collider, uint32_t contact_events);
/** Whether the world's pre-solve function is asked about its contacts: 1 or 0. @return as above. */
TAUT_API taut_result taut_collider_set_pre_solve(taut_collider collider, int32_t pre_solve);
/**
 * Sets the one-way direction (collider_def.one_way); 0: none. A contact is solved if its normal, out of this collider,
 * is within 60 degrees of the direction, and the other collider touched it in the last step or is no deeper than 5 mm.
 * Decided once a step. @return as above.
 */
TAUT_API taut_result taut_collider_set_one_way(taut_collider collider, taut_vec3 direction);

#ifdef __cplusplus
}
#endif

#endif
