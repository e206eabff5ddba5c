/**
 * @file body.h
 * Rigid bodies and particles: the nodes of the one system that Taut solves.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_BODY_H
#define TAUT_BODY_H

#include <taut/base.h>
#include <taut/collider.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How a node moves. */
typedef enum taut_body_kind {
    TAUT_BODY_STATIC = 0,    /**< never moves */
    TAUT_BODY_KINEMATIC = 1, /**< moves at its own velocity; pushes, is not pushed */
    TAUT_BODY_DYNAMIC = 2,   /**< moved by forces, contacts and joints; 6 degrees of freedom */
    TAUT_BODY_PARTICLE = 3,  /**< point mass; 3 degrees of freedom, no rotation; at most a sphere as shape */
    TAUT_BODY_KIND_MAX = 0x7fffffff
} taut_body_kind;

/** Bits of locked_axes: motions along and about the world's axes that a body does not make; see
 * taut_body_set_locked_axes. */
/** Motion of the centre of mass along x. */
#define TAUT_LOCK_X 1u
/** Likewise along y. */
#define TAUT_LOCK_Y 2u
/** Likewise along z. */
#define TAUT_LOCK_Z 4u
/** Spin about the world's x axis. */
#define TAUT_LOCK_ANGULAR_X 8u
/** Likewise about y. */
#define TAUT_LOCK_ANGULAR_Y 16u
/** Likewise about z. */
#define TAUT_LOCK_ANGULAR_Z 32u
/** Spin about any axis: the rotation stays as it is, to the bit. */
#define TAUT_LOCK_ROTATION 56u
/** All but motion in the plane of x and y and the spin about z. */
#define TAUT_LOCK_TO_PLANE_XY 28u
/** All axes. */
#define TAUT_LOCK_ALL 63u

/** A rigid body. Its shape, if any, becomes its first collider; the colliders of the def follow in their order. */
typedef struct taut_body_def {
    uint32_t struct_size;
    taut_body_kind kind;        /**< default TAUT_BODY_DYNAMIC; particles have their own def */
    taut_pos position;          /**< of the body's origin [m] */
    taut_quat rotation;         /**< default identity */
    taut_vec3 linear_velocity;  /**< of the centre of mass [m/s]; zero for a static body */
    taut_vec3 angular_velocity; /**< world axes [rad/s]; zero for a static body */
    taut_shape shape;           /**< null: none; a dynamic body without colliders needs mass and inertia */
    taut_material material;     /**< of shape */
    taut_filter filter;         /**< of shape */
    float density;              /**< of shape [kg/m^3], (0, 1e8]. Default 1000 */
    float mass;                 /**< [kg], 0 or [1e-6, 1e15]. 0: from the colliders' densities. Default 0 */
    taut_vec3 centre_of_mass;   /**< in the body's frame [m]; used when inertia is given. Default 0 */
    taut_sym3 inertia;          /**< about the centre of mass [kg m^2], positive definite, within 1e30; all zero: from
                                   the colliders, scaled to mass */
    float gravity_scale;        /**< [-1000, 1000]. Default 1 */
    uint32_t collider_count;    /**< of colliders. Default 0 */
    uint64_t user_data;
    const taut_collider_def* colliders; /**< collider_count of them, copied; null if there are none */
    uint32_t collider_flags;            /**< of shape: sum of TAUT_COLLIDER_ bits. Default 0 */
    uint32_t contact_events;            /**< of shape: sum of TAUT_CONTACT_EVENTS_ bits. Default 0 */
    float linear_damping;               /**< [1/s], [0, 1e6], see taut_body_set_damping. Default 0 */
    float angular_damping;              /**< likewise */
    float max_linear_speed;             /**< [m/s], (0, 1e6], see taut_body_set_max_speed; 0: none. Default 0 */
    float max_angular_speed;            /**< [rad/s], likewise */
    uint32_t locked_axes;               /**< sum of TAUT_LOCK_ bits, see taut_body_set_locked_axes. Default 0 */
} taut_body_def;

/** Room for the name of a body with its final 0 [bytes]. */
#define TAUT_BODY_NAME_SIZE 32

/** A particle: a point mass that joints connect to particles, rigid bodies and the world; a grain, with a shape. */
typedef struct taut_particle_def {
    uint32_t struct_size;
    float mass;          /**< [kg], [1e-9, 1e21]. Default 1 */
    taut_pos position;   /**< [m] */
    taut_vec3 velocity;  /**< [m/s] */
    float gravity_scale; /**< [-1000, 1000]. Default 1 */
    uint64_t user_data;
    taut_shape shape;        /**< a sphere about the particle, which gives it contacts; null: none. Default null */
    taut_material material;  /**< of shape */
    taut_filter filter;      /**< of shape */
    uint32_t collider_flags; /**< of shape: sum of TAUT_COLLIDER_ bits. Default 0 */
    uint32_t contact_events; /**< of shape: sum of TAUT_CONTACT_EVENTS_ bits. Default 0 */
    float damping;           /**< [1/s], [0, 1e6], see taut_body_set_damping. Default 0 */
    float max_speed;         /**< [m/s], (0, 1e6], see taut_body_set_max_speed; 0: none. Default 0 */
} taut_particle_def;

/** Position of the body's origin and rotation of its frame. */
typedef struct taut_pose {
    taut_pos position; /**< [m] */
    taut_quat rotation;
    uint32_t reserved[2]; /**< zero; keeps the size a multiple of 16 */
} taut_pose;

/** The origin, unturned. Nothing where pose is null. Thread safety: any thread; so too of the like functions of other
    headers that have no struct_size. */
TAUT_API void taut_pose_init(taut_pose* pose);

/** Why a step froze a body or particle. */
typedef enum taut_quarantine_reason {
    TAUT_QUARANTINE_NONE = 0,       /**< it did not */
    TAUT_QUARANTINE_NON_FINITE = 1, /**< its pose or velocity, or what a force would make of it, was no finite number */
    TAUT_QUARANTINE_TOO_FAST = 2,   /**< it was faster than 1e6 m/s or rad/s, or a force would make it so */
    TAUT_QUARANTINE_REASON_MAX = 0x7fffffff
} taut_quarantine_reason;

TAUT_API void taut_body_def_init_sized(taut_body_def* def, uint32_t size);
static inline void taut_body_def_init(taut_body_def* def) { taut_body_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_particle_def_init_sized(taut_particle_def* def, uint32_t size);
static inline void taut_particle_def_init(taut_particle_def* def) {
    taut_particle_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Adds a rigid body. Positions lie within 1e7 m of the origin, speeds within 1e4 m/s and 1e4 rad/s.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (text names field and value), TAUT_STRUCT_SIZE, TAUT_NULL_POINTER,
 *         TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE (shape of another world), TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_body(taut_world world, const taut_body_def* def, taut_body* out);
/** Adds a particle; ranges and results as for taut_world_add_body. */
TAUT_API taut_result taut_world_add_particle(taut_world world, const taut_particle_def* def, taut_body* out);
/**
 * Removes a body or particle and every joint and attachment on it. Its contacts end with the next step's events.
 * @return TAUT_OK; TAUT_IN_USE for a body of a cable, cloth or solid, TAUT_STALE_HANDLE, TAUT_LOCKED,
 * TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_remove(taut_body body);
/** 1 if the handle names a live body or particle, else 0. */
TAUT_API int32_t taut_body_is_valid(taut_body body);

/** What moves it. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_kind(taut_body body, taut_body_kind* out);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_user_data(taut_body body, uint64_t* out);
TAUT_API taut_result taut_body_set_user_data(taut_body body, uint64_t value);
/**
 * Makes a rigid body static, kinematic or dynamic. Its contacts end with the next step's events and are found anew;
 * joints stay. What is static from now on has no velocity, any other keeps its own; forces put on it and targets of
 * taut_body_move_kinematic are forgotten. What is dynamic from now on has the mass that it had as a dynamic body or
 * that taut_body_set_mass gave it since, else that of its colliders at their densities.
 * @param kind not TAUT_BODY_PARTICLE.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (the body is a particle or in quarantine; dynamic with a plane, mesh or height
 *         field, or with a mass from colliders that is not within [1e-6, 1e15] kg), TAUT_IN_USE (a body of a cable,
 *         cloth or solid), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_kind(taut_body body, taut_body_kind kind);
/**
 * Takes a body out of the world (0) or puts it back (1, as it comes). Disabled, it stays where it is and keeps all that
 * it has, its velocity too, but nothing moves it, nothing touches it or finds it in a query of the world, and its
 * joints are off. Its contacts end with the next step's events. All but forces, impulses and targets can be set
 * meanwhile.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT unless 0 or 1; TAUT_IN_USE (a body of a cable, cloth or solid, or one that a
 *         cable or attachment holds), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_enabled(taut_body body, uint32_t enabled);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_enabled(taut_body body, uint32_t* out);
/**
 * What the texts of refused calls, the log and taut_lint_entry call the body; it means nothing else.
 * @param name UTF-8 of at most TAUT_BODY_NAME_SIZE - 1 bytes, copied; null or empty: none, as it comes.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (too long), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_name(taut_body body, const char* name);
/**
 * Copies the name with its final 0; empty for a body without one.
 * @param count of bytes written. @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count;
 *        TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_get_name(taut_body body, char* name, uint32_t capacity, uint32_t* count);

/** Mass properties as the solver uses them; zero mass for a static or kinematic body. */
TAUT_API taut_result taut_body_get_mass(taut_body body, float* mass, taut_vec3* centre_of_mass, taut_sym3* inertia);
/**
 * Sets what a def's mass, centre_of_mass and inertia say, by the same rules: a mass of 0 is that of the colliders, an
 * inertia of 0 theirs, scaled to the mass, with their centre. Joints stay where they hold the body, and the motion of
 * every point of it stays. A static or kinematic body has the mass once it is dynamic. A particle takes a mass alone,
 * [1e-9, 1e21] kg.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; not positive definite; in quarantine; a centre or inertia of a
 *         particle), TAUT_IN_USE (a body of a cable, cloth or solid), TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_mass(taut_body body, float mass, taut_vec3 centre_of_mass, taut_sym3 inertia);
/**
 * Damping [1/s] of a body's own motion, [0, 1e6]: what air or oil would do. A velocity v that a force m a drives decays
 * by dv/dt = a - c v, and each substep of h takes the solution, e^(-c h) v + a (1 - e^(-c h)) / c: after t seconds
 * v e^(-c t), and a body that falls reaches g / c, with any step and any c. The spin likewise: the angular momentum
 * decays by the angular damping. A particle has no angular one. Contacts and joints act after that with whole impulses,
 * so that what rests bears on them with (1 - e^(-c h)) / (c h) of its weight: 1 % less at 5/s in substeps of 4 ms.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; angular of a particle), TAUT_IN_USE (a body of a cable, cloth or
 *         solid), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_damping(taut_body body, float linear, float angular);
/** Either pointer may be null. @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_damping(taut_body body, float* linear, float* angular);
/** Changes what gravity does to a body, [-1000, 1000] times that of the world. @return as taut_body_set_damping. */
TAUT_API taut_result taut_body_set_gravity_scale(taut_body body, float gravity_scale);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_gravity_scale(taut_body body, float* out);
/**
 * Greatest speed of the centre of mass [m/s] and of the spin [rad/s], (0, 1e6]; 0: none. What is faster, by whatever
 * means, keeps its direction and has this speed: before each substep's solve, after forces, and after it. Only what
 * contacts and joints give within a substep moves a body faster, for that substep.
 * @return as taut_body_set_damping.
 */
TAUT_API taut_result taut_body_set_max_speed(taut_body body, float linear, float angular);
/** Either pointer may be null. @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_max_speed(taut_body body, float* linear, float* angular);
/**
 * Locks a body's motion along and about axes of the world: the velocity of its centre of mass along a locked axis, and
 * the component of its spin about one, are zero from now on. It is as if the body had an infinite mass or moment about
 * these axes: contacts, joints and forces there meet something immovable, and move it along the others as they would.
 * With M the mass matrix and P what is free, the inverse that all solvers see is (P M P)^+: of one free angular axis
 * the spin changes by T t / I, I the moment about that axis of the world. No joint does this and no position drifts: a
 * locked coordinate keeps its bits. Two free angular axes keep a spin about both, which carries the body's own axes out
 * of any plane: bodies that are to stay in one lock two. A body with all axes locked is still dynamic, and no contact
 * moves it.
 * Velocities along what is locked are dropped, when it is locked and when they are set; so is what forces and impulses
 * would give. taut_body_set_pose places the body anywhere. Only a dynamic body is held; another keeps its locks for
 * when it is one.
 * @param locked_axes sum of TAUT_LOCK_ bits; 0: none, as it comes.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (other bits; a particle), TAUT_IN_USE (a body of a cable, cloth or solid),
 *         TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_set_locked_axes(taut_body body, uint32_t locked_axes);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_locked_axes(taut_body body, uint32_t* out);
/** Material of the first collider. @return TAUT_INVALID_ARGUMENT for a body without colliders. */
TAUT_API taut_result taut_body_get_material(taut_body body, taut_material* out);
/** Material of all colliders of the body. */
TAUT_API taut_result taut_body_set_material(taut_body body, const taut_material* material);
/** Contact events of all colliders of the body, see taut_collider_set_contact_events. */
TAUT_API taut_result taut_body_set_contact_events(taut_body body, uint32_t contact_events);

/** Pose after the last step. */
TAUT_API taut_result taut_body_get_pose(taut_body body, taut_pose* out);
/** Teleports. A particle ignores the rotation. Carried contact impulses of the body are dropped. */
TAUT_API taut_result taut_body_set_pose(taut_body body, const taut_pose* pose);
/**
 * A point of the body's frame in the world, and back, after the last step; a vector is turned alone.
 * @param local, point [m], within 1e7. @param vector each component, and of a local vector, within 1e30.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_get_world_point(taut_body body, taut_vec3 local, taut_pos* out);
TAUT_API taut_result taut_body_get_local_point(taut_body body, taut_pos point, taut_vec3* out);
TAUT_API taut_result taut_body_get_world_vector(taut_body body, taut_vec3 local, taut_vec3* out);
TAUT_API taut_result taut_body_get_local_vector(taut_body body, taut_vec3 vector, taut_vec3* out);
/** Velocity [m/s] of what of the body is at a world point [m], v + w x r; world axes. @return as above. */
TAUT_API taut_result taut_body_get_point_velocity(taut_body body, taut_pos point, taut_vec3* out);
/**
 * The least axis-aligned box about the body's colliders as they are [m], sensors included, within single precision of
 * its size; that of a plane is +-1e9 m on every side.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (a body without colliders), TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_get_bounds(taut_body body, taut_pos* low, taut_pos* high);

/** Pose between the last two steps at the fraction left by taut_world_advance, for rendering: that of one step ago. */
TAUT_API taut_result taut_body_get_render_pose(taut_body body, taut_pose* out);

/**
 * Poses and velocities of many bodies at once, in the order given. Each array may be null; its stride is the distance
 * of two entries [bytes], 0: packed; else at least the size of an entry and a multiple of 8 (poses) or 4.
 * @param bodies count handles of this world. Nothing is written unless all are good.
 * @param linear of the centres of mass [m/s]. @param angular world axes [rad/s].
 * @return TAUT_OK; TAUT_NULL_POINTER (bodies, with count > 0), TAUT_INVALID_ARGUMENT (stride), TAUT_STALE_HANDLE,
 *         TAUT_FOREIGN_HANDLE (the text names the first bad body), TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_body_states(taut_world world, const taut_body* bodies, uint32_t count,
                                                taut_pose* poses, size_t pose_stride, taut_vec3* linear,
                                                size_t linear_stride, taut_vec3* angular, size_t angular_stride);

/**
 * The bodies and particles of a world by slots, those of cables, cloths and solids too.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_bodies(taut_world world, taut_body* bodies, uint32_t capacity, uint32_t* count);
/** The joints that end on a body, by slots. @return as taut_world_get_bodies. */
TAUT_API taut_result taut_body_get_joints(taut_body body, taut_joint* joints, uint32_t capacity, uint32_t* count);

/** Velocity of the centre of mass [m/s] and angular velocity [rad/s], world axes. Either pointer may be null. */
TAUT_API taut_result taut_body_get_velocity(taut_body body, taut_vec3* linear, taut_vec3* angular);
/** Sets both; refused for a static body, and a non-zero angular velocity for a particle. */
TAUT_API taut_result taut_body_set_velocity(taut_body body, taut_vec3 linear, taut_vec3 angular);
/**
 * Sends a kinematic body to a pose, which it reaches by the end of the next call: of taut_world_step, or of the seconds
 * of taut_world_advance. Frame time goes on where that call before ended, and steps find the body where it is by their
 * own end: led on at a constant speed, by frames of whatever length, it has the same velocity in every step. It keeps
 * the velocity of that call until changed. The next new target, taut_body_set_velocity or taut_world_step forgets a
 * target; taut_world_advance by 0 s leaves it waiting.
 * @param target at most 1e4 m/s and rad/s away, as one step goes.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_INVALID_ARGUMENT (range, not kinematic), TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_move_kinematic(taut_body body, const taut_pose* target);

/**
 * Whether the body's colliders are looked for along their way where they move past their own thickness in a step
 * (1, the default, but 0 for all in a world whose def says so) or meet only what they are near at a step's beginning,
 * by at most 0.5 m of motion (0). One such moving body in a pair is enough to leave it out.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT unless 0 or 1, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_body_set_continuous(taut_body body, uint32_t continuous);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_continuous(taut_body body, uint32_t* out);

/**
 * Force [N] at the centre of mass and torque [N m], world axes, over the time of the next call only: of one
 * taut_world_step, or of the seconds of taut_world_advance. What no step takes of these yet waits for the next one;
 * what is given up because of max_catch_up does not count. Applied before each frame of T seconds, F changes momentum
 * by F T, however many steps the frame takes. Calls add up. Dynamic bodies and (force) particles; each component within
 * 1e24.
 */
TAUT_API taut_result taut_body_apply_force(taut_body body, taut_vec3 force, taut_vec3 torque);
/** Force [N] at a world point, over the same time; its arm is as of now. */
TAUT_API taut_result taut_body_apply_force_at(taut_body body, taut_vec3 force, taut_pos point);
/** Impulse [N s] at the centre of mass and angular impulse [N m s], at once; refused where it would push the body past
 * 1e4 m/s or rad/s. */
TAUT_API taut_result taut_body_apply_impulse(taut_body body, taut_vec3 impulse, taut_vec3 angular_impulse);
/** Impulse [N s] at a world point, at once. */
TAUT_API taut_result taut_body_apply_impulse_at(taut_body body, taut_vec3 impulse, taut_pos point);

/** Whether the body is in quarantine, and why: see taut_quarantine_event. Its kind is TAUT_BODY_STATIC meanwhile.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_body_get_quarantine(taut_body body, taut_quarantine_reason* out);
/**
 * Lets a body in quarantine go: from the next step on it is what it was before, at rest where it stands, with no force
 * on it and its contacts found anew. Where the cause goes on, it comes back; taut_body_set_pose moves it away before.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (it is in none), TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_body_release(taut_body body);

#ifdef __cplusplus
}
#endif

#endif
