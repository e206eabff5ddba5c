/**
 * @file world.h
 * Worlds and stepping.
 * Worlds are independent: different worlds may be used from different threads at once. One world: one
 * thread at a time, and nothing inside its step (a call then returns TAUT_LOCKED).
 */
#ifndef TAUT_WORLD_H
#define TAUT_WORLD_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** How constraints are solved. All work on the same assembled system. */
typedef enum taut_solver {
    TAUT_SOLVER_BLOCK_LDLT = 0,             /**< joints directly, contacts by sweeps: the default */
    TAUT_SOLVER_PROJECTED_GAUSS_SEIDEL = 1, /**< everything by coloured sweeps */
    TAUT_SOLVER_ACCELERATED_JACOBI = 2,     /**< all rows at once, with momentum (Frâncu 2016, eq. 6.41, 7.35) */
    TAUT_SOLVER_JACOBI = 3,                 /**< the same without momentum */
    TAUT_SOLVER_NONLINEAR_GAUSS_SEIDEL = 4, /**< row after row, each at the positions reached (section 6.6.1); SOR with
                                                 a relaxation above 1 */
    TAUT_SOLVER_MINIMUM_RESIDUAL = 5,       /**< algorithm 2 */
    TAUT_SOLVER_CONJUGATE_RESIDUALS = 6,    /**< algorithm 3 */
    TAUT_SOLVER_CONJUGATE_GRADIENTS = 7,    /**< algorithm 1, on the energy: rigid rows are stiff springs */
    TAUT_SOLVER_MINIMISATION = 8, /**< cloths, solids and free cables of particles, by Newton's method with line search
                                       on the energy of a substep in any scheme (Gast and Schroeder 2014): for long
                                       steps and tangles, which Newmark does not calm. Vertices stay out of static and
                                       kinematic shapes and of cells, do not bounce, and are rubbed after a step.
                                       TAUT_UNSUPPORTED: rigid dynamic bodies, joints, attachments, gas, a compliance
                                       of 0, and of contacts those of cables, of cloth with cloth and with meshes
                                       without distances */
    TAUT_SOLVER_MAX = 0x7fffffff
} taut_solver;

/** How a row's error depends on velocities, for solvers that iterate over rows (TAUT_SOLVER_ACCELERATED_JACOBI to
 *  TAUT_SOLVER_CONJUGATE_GRADIENTS); with others the last three are refused. Those go twice over a substep's rows, each
 *  time with all iterations (Frâncu 2016, section 8.3). */
typedef enum taut_stepping {
    TAUT_STEPPING_PROJECTION = 0, /**< evaluated at the end of the substep, again in each iteration (eq. 6.26) */
    TAUT_STEPPING_VELOCITY = 1,   /**< linearised where the substep begins: velocity time stepping (eq. 6.17 to 6.21) */
    TAUT_STEPPING_LINKS_FIRST = 2,    /**< joints and elements by projection, then contacts alone on the velocities that
                                           these left: what contacts do to links is left to the next substep, and
                                           sheets burst under what is heavier than they are */
    TAUT_STEPPING_VELOCITY_FIRST = 3, /**< velocity time stepping that undoes no error, then projection from there */
    TAUT_STEPPING_POST_STABILISED = 4, /**< the same, but projection moves positions only: the velocities kept are
                                            those of the first pass (Cline and Pai 2003). Of implicit Euler alone, and
                                            not with conjugate gradients, to which rigid rows are springs */
    TAUT_STEPPING_MAX = 0x7fffffff
} taut_stepping;

/** Time integration of what joints, cables, cloths and solids do. In all contacts act as in implicit Euler, and damping
 *  by the mean velocity of a substep, with order 1. */
typedef enum taut_scheme {
    TAUT_SCHEME_IMPLICIT_EULER = 0, /**< damps most and bears any force */
    TAUT_SCHEME_NEWMARK = 1, /**< Frâncu 2016, eq. 6.28 to 6.32: with beta 1/4, gamma 1/2 springs keep their energy */
    TAUT_SCHEME_BDF2 = 2,    /**< two steps back: damps slow motion little and fast motion much */
    TAUT_SCHEME_MAX = 0x7fffffff
} taut_scheme;

/** How a contact's friction is bounded, for the same solvers (sections 7.3 to 7.8). */
typedef enum taut_friction_model {
    TAUT_FRICTION_CYLINDER = 0, /**< its size by the coefficient times the normal force as it is */
    TAUT_FRICTION_CONE = 1,     /**< the nearest point of the cone, which changes the normal force too */
    TAUT_FRICTION_BOX = 2,      /**< both of its components: a square pyramid */
    TAUT_FRICTION_MAX = 0x7fffffff
} taut_friction_model;

/** Momentum of TAUT_SOLVER_ACCELERATED_JACOBI. */
typedef enum taut_momentum {
    TAUT_MOMENTUM_NESTEROV = 0, /**< eq. 6.42 and 6.43 */
    TAUT_MOMENTUM_POWER = 1,    /**< eq. 6.39 with a = 1, b = 0.6 */
    TAUT_MOMENTUM_MAX = 0x7fffffff
} taut_momentum;

/** A world. */
typedef struct taut_world_def {
    uint32_t struct_size;
    taut_solver solver;      /**< default TAUT_SOLVER_BLOCK_LDLT */
    taut_vec3 gravity;       /**< [m/s^2], each within 1e4. Default (0, -9.81, 0) */
    float time_step;         /**< step [s], [1e-4, 0.1]. Default 1/60 */
    uint32_t substeps;       /**< least substeps of a frame, [1, 64]; an island may take more: up to four times as many
                                  where walls are tall or what is heavy rests on what is light, eight times while its
                                  joints whip about, and up to 64 for swept cloths and solids. Default 4 */
    uint32_t fixed_substeps; /**< 1: no island takes more than substeps. Default 0 */
    uint32_t sweeps;         /**< iterations a substep, [0, 1000]; 0: the solver's own: 1 of sweeps, 60 of conjugate
                                  gradients, at most 1000 of minimisation, 30 of others. Default 0 */
    uint32_t geometric_stiffness; /**< 0 leaves it out (for comparison only). Default 1 */
    float velocity_filter;        /**< low-pass factor of the velocity that geometric stiffness spares, [0, 1]; 0: plain
                                       implicit Euler damping (Tournier 2015). Default 0.25 */
    uint32_t max_catch_up;        /**< most steps in one taut_world_advance, [1, 1000]. Default 4 */
    uint32_t threads;             /**< that work on a step, the calling one included, [1, 64]: above 1 the world starts
                                       its own, which sleep between steps; no more of them wake than there are cores
                                       for. With task hooks the host's workers help instead, and it stays 1. Results do
                                       not depend on it. Default 1 */
    taut_hooks hooks;             /**< default: none */
    uint32_t sleeping;            /**< 1: islands that came to rest fall asleep and cost next to nothing; see sleep.h.
                                       Default 0 */
    float sleep_speed;            /**< a body is quiet while no point of it is faster [m/s], [0, 10]. Default 0.03 */
    float sleep_time;             /**< an island falls asleep after all of it was quiet for so long [s], [0, 1e3].
                                       Default 0.5 */
    uint32_t contact_events;      /**< of all pairs: sum of TAUT_CONTACT_EVENTS_ bits. Default
                                       TAUT_CONTACT_EVENTS_BEGIN_END */
    float hit_speed;              /**< approach that makes a hit event [m/s], [0, 1e4]. Default 1 */
    uint32_t continuous;          /**< 1: what moves past its own thickness in a step is looked for along its way, so
                                       that nothing tunnels; 0: for no body. See taut_body_set_continuous. Default 1 */
    uint32_t max_bodies;          /**< bodies and particles, static ones and those of cables included; with one more a
                                       call returns TAUT_LIMIT. Points that a cable's reel adds within a step count and
                                       are not refused. 0: no limit. Default 0 */
    uint32_t max_colliders;       /**< likewise of colliders */
    uint32_t max_joints;          /**< likewise of joints, those inside cables included */
    uint32_t max_contacts;        /**< contacts (manifolds of up to four points; of a surface one for each part that is
                                       touched) that a step solves. Of more, the deepest are kept, and of equal ones
                                       the first by colliders; the rest are as if the two did not touch, and counted by
                                       taut_events and taut_profile. 0: no limit. Default 0. Whatever it is, of bodies
                                       in one place, each with more than 12 others sunk into it by more than contacts
                                       begin at, each touches the 12 deepest alone, and what is not crowded so */
    uint32_t adaptive_damping;    /**< 1: joints solved directly damp as much as the size of their force asks for,
                                       whichever way it points (Andrews, Teichmann and Kry 2017): h^2 |K| [kg m^2] in the
                                       place of h^2 K in each substep h. Weights of 1000000 links then hang from light
                                       links in steps of up to 0.1 s without substeps (with velocity_filter 0, which is
                                       the safest and costs most energy). Costs nothing under tension, but bodies
                                       pushed together, and cables and ropes gone slack, move more lazily. Of no effect
                                       without geometric_stiffness. Default 0 */
    float restitution_threshold;  /**< approaches up to this speed do not bounce [m/s], [0, 1e4]; nor do those up to
                                       what forces give a body within a substep, g h: what rests would bounce by that
                                       (0.04 m/s, from a height of 0.1 mm, by default). Default 0 */
    taut_stepping stepping;       /**< default TAUT_STEPPING_PROJECTION */
    float stabilisation;          /**< gamma: share of their error that rigid joints undo in a substep with the
                                       solvers that iterate over rows (eq. 6.19), [0, 1]: 1 is position based
                                       dynamics, for which those must converge. Default 0.2 */
    float relaxation;             /**< omega: share of an iteration's step that is taken, by the solvers that
                                       iterate over rows, [0.001, 1.999]. Default 1 */
    taut_friction_model friction_model; /**< default TAUT_FRICTION_CYLINDER */
    taut_momentum momentum;             /**< default TAUT_MOMENTUM_NESTEROV */
    uint32_t fixed_step;                /**< 1: minimum and conjugate residuals take steps of 1/rho, the spectral radius
                                             by the power method, in place of measured ones. Default 0 */
    taut_scheme scheme;                 /**< default TAUT_SCHEME_IMPLICIT_EULER */
    float newmark_beta;                 /**< [0.25, 0.5]. Default 0.25 */
    float newmark_gamma;                /**< [0.5, 1], at most 2 newmark_beta; above 0.5 it damps. Default 0.5 */
    uint32_t report;                    /**< 1: each step measures what its solves leave, for taut_profile: yield,
                                             solve_residual, linearisation and energy_gain. Changes no result; a step of
                                             many contacts takes several times as long. Default 0 */
    float air_density;                  /**< of the air about cloths and solids with air_drag [kg/m^3], [0, 1e4].
                                             Default 1.2 */
    float air_pressure;                 /**< of that air [Pa], [0, 1e7]; see taut_cloth_def. Default 101325 */
    taut_vec3 wind;                     /**< velocity of that air [m/s], each within 1e3. Default 0 */
    float minimise_tolerance;           /**< of TAUT_SOLVER_MINIMISATION: it ends where forces that are left would move
                                             free vertices by so much in a substep, root mean square [m], [1e-12, 1].
                                             Default 1e-6 */
    uint32_t line_search;               /**< of the same: 0 takes each step of Newton's method as it comes (for
                                             comparison only). Default 1 */
    float contact_stabilisation;        /**< share of their overlap that contacts undo in a substep with the solvers
                                             that iterate over rows, as stabilisation is of joints, [0, 1]; 0: softly,
                                             by about a fourteenth and at most 3 m/s. Default 0 */
    float velocity_gain;                /**< k_v: share of the velocity along rows, left after positions moved, that
                                             each iteration of the same solvers takes away in a second pass, [0, 1];
                                             0: none, velocities are those that moved the positions. With
                                             stabilisation and contact_stabilisation (k_c) of 1, TAUT_STEPPING_PROJECTION
                                             is plain position based dynamics at 0, and the Sequential Positions of
                                             Frâncu 2016, section 8.2, at 0.1. Default 1 */
} taut_world_def;

/** What taut_world_advance did. */
typedef struct taut_advance {
    uint32_t steps; /**< steps taken */
    float fraction; /**< time left over, in parts of the last step, [0, 1): weight of the newer pose when rendering */
    double dropped; /**< time given up because of max_catch_up [s] */
} taut_advance;

/** What taut_world_relax reached. */
typedef struct taut_relaxation {
    uint32_t steps;     /**< of Newton's method, of all islands together */
    uint32_t converged; /**< 1: every island is within the tolerance */
    float residual;     /**< largest acceleration left of an island, root mean square over its masses [m/s^2] */
} taut_relaxation;

TAUT_API void taut_world_def_init_sized(taut_world_def* def, uint32_t size);
static inline void taut_world_def_init(taut_world_def* def) { taut_world_def_init_sized(def, (uint32_t)sizeof(*def)); }
/** Name of a solver, such as "block_ldlt"; null beyond the last one. Thread safety: any thread. */
TAUT_API const char* taut_solver_name(taut_solver solver);

/**
 * Creates a world. Thread safety: any thread.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT, TAUT_LIMIT (1023 worlds at
 *         once, 16.7 million in the life of a process: no handle comes again), TAUT_OUT_OF_MEMORY, TAUT_UNSUPPORTED
 *         (collision library of the wrong precision).
 */
TAUT_API taut_result taut_world_create(const taut_world_def* def, taut_world* out);
/** Destroys a world and all in it; every handle into it becomes stale. */
TAUT_API taut_result taut_world_destroy(taut_world world);
/** 1 if the handle names a live world, else 0. Thread safety: any thread. */
TAUT_API int32_t taut_world_is_valid(taut_world world);

/** Advances by one time step, beside the time that taut_world_advance has left over.
 * @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY, TAUT_UNSUPPORTED (what the solver does not take,
 *         by name; nothing has changed). */
TAUT_API taut_result taut_world_step(taut_world world);
/**
 * Adds seconds [0, 1e3] of frame time to an accumulator and takes whole steps from it, none or several. What the host
 * does each frame means the same at any rate of frames: forces act over the frame's time (body.h), kinematic bodies
 * reach their targets at its end, events are those of all steps since they were read (event.h). out may be null.
 * @return as taut_world_step; TAUT_INVALID_ARGUMENT.
 */
TAUT_API taut_result taut_world_advance_sized(taut_world world, double seconds, taut_advance* out, uint32_t size);
static inline taut_result taut_world_advance(taut_world world, double seconds, taut_advance* out) {
    return taut_world_advance_sized(world, seconds, out, (uint32_t)sizeof(*out));
}

/**
 * Brings all that moves to rest where its forces balance, in a world of TAUT_SOLVER_MINIMISATION: a minimum of elastic
 * energy and gravity, found from where things are, whatever that is, with what is pinned where it is now. No time
 * passes; velocities are 0 after it; what it changes is told by taut_events.moved as a step's. A world that takes this
 * may be of any use after it: cloths and solids hung, loaded or pressed into their places before a game begins.
 * @param tolerance where it ends: acceleration left, root mean square over the masses of an island [m/s^2],
 *        [1e-9, 1e3]. @param max_steps of Newton's method, of each island, [1, 100000]. @param out may be null.
 * @return TAUT_OK, also where max_steps did not suffice (see out); TAUT_INVALID_ARGUMENT, TAUT_UNSUPPORTED (another
 *         solver; what a step of this one refuses; gravity and an island that nothing holds), TAUT_STALE_HANDLE,
 *         TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_relax_sized(taut_world world, float tolerance, uint32_t max_steps, taut_relaxation* out,
                                            uint32_t size);
static inline taut_result taut_world_relax(taut_world world, float tolerance, uint32_t max_steps,
                                           taut_relaxation* out) {
    return taut_world_relax_sized(world, tolerance, max_steps, out, (uint32_t)sizeof(*out));
}

/** The def as checked at creation, with what was set since. */
TAUT_API taut_result taut_world_get_def_sized(taut_world world, taut_world_def* out, uint32_t size);
static inline taut_result taut_world_get_def(taut_world world, taut_world_def* out) {
    return taut_world_get_def_sized(world, out, (uint32_t)sizeof(*out));
}
/**
 * Length of the steps from the next one on [s], [1e-4, 0.1]: for slow motion, or a display's own rate. What moves keeps
 * its velocity, what rests stays: forces of joints and contacts go on as they were. Time left over by
 * taut_world_advance is kept; steps that fit into it are made up for in the next call. A cable is reeled by at most
 * half a segment a step. Substeps get no longer than they were: a step k times as long takes k times the least number,
 * of 64 at most; with longer ones what rests settles anew, by .4 h^2 of gravity for a contact of one body.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_set_time_step(taut_world world, float time_step);
/**
 * Least substeps of a step from the next one on, [1, 64]. What rests stays, but where substeps become longer than those
 * of the world's def at creation, or were: there it settles anew.
 * @return as taut_world_set_time_step.
 */
TAUT_API taut_result taut_world_set_substeps(taut_world world, uint32_t substeps);
/** Gravity [m/s^2]. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_world_get_gravity(taut_world world, taut_vec3* out);
/** Gravity from the next step on [m/s^2], each within 1e4; wakes all that sleeps.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_world_set_gravity(taut_world world, taut_vec3 gravity);
/** Velocity of the air, everywhere the same [m/s]. */
TAUT_API taut_result taut_world_get_wind(taut_world world, taut_vec3* out);
/**
 * Wind from the next step on [m/s], each within 1e3: what it does is said in deformable.h.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_set_wind(taut_world world, taut_vec3 wind);
/** Contact events of all pairs from the next step on: sum of TAUT_CONTACT_EVENTS_ bits. */
TAUT_API taut_result taut_world_set_contact_events(taut_world world, uint32_t contact_events);
/** Approach speed that makes a hit event [m/s], [0, 1e4]. */
TAUT_API taut_result taut_world_set_hit_speed(taut_world world, float hit_speed);
/** Approach speed up to which nothing bounces [m/s], [0, 1e4]; see taut_world_def. */
TAUT_API taut_result taut_world_set_restitution_threshold(taut_world world, float restitution_threshold);
/** Live bodies and particles, shapes and joints; any pointer may be null. */
TAUT_API taut_result taut_world_get_counts(taut_world world, uint32_t* bodies, uint32_t* shapes, uint32_t* joints);
/** Bytes that the world holds from its allocator, those of meshes, height fields and hulls included, but not of baked
 *  ones: see taut_baked_get_bytes. */
TAUT_API taut_result taut_world_get_bytes(taut_world world, uint64_t* out);
/** Hash of the whole simulation state (poses, velocities, carried impulses); equal hashes: equal continuation. */
TAUT_API taut_result taut_world_get_state_hash(taut_world world, uint64_t* out);

#ifdef __cplusplus
}
#endif

#endif
