/**
 * @file profile.h
 * Where the last step spent its time, and how large and how well solved it was.
 */
#ifndef TAUT_PROFILE_H
#define TAUT_PROFILE_H

#include <taut/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Figures of the last step. */
typedef struct taut_profile {
    uint32_t struct_size; /**< set by the caller to sizeof(taut_profile) */
    /* time [us] */
    float step_us;        /**< the whole step */
    float broadphase_us;  /**< which colliders are near */
    float narrowphase_us; /**< where they touch */
    float partition_us;   /**< islands, blocks, colours */
    float predict_us;     /**< forces, world inertia, contact preparation */
    float assemble_us;    /**< rows and geometric stiffness */
    float factor_us;      /**< direct solves */
    float sweep_us;       /**< iterative sweeps, biased and relaxed */
    float commit_us;      /**< positions */
    float publish_us;     /**< restitution, quarantine, events */
    /* counts */
    uint32_t bodies;      /**< dynamic bodies and particles */
    uint32_t pairs;       /**< overlapping fat boxes */
    uint32_t touching;    /**< pairs with contact points, those between grains too */
    uint32_t points;      /**< contact points */
    uint32_t joints;      /**< of the world, cables of links included */
    uint32_t islands;     /**< bodies that touch or are tied together */
    uint32_t blocks;      /**< joint-connected components solved directly */
    uint32_t colours;     /**< groups of rows of which no two share a body */
    uint32_t substeps;    /**< largest number of substeps that an island took */
    uint32_t solves;      /**< direct block solves, or steps of Newton's method of TAUT_SOLVER_MINIMISATION, all
                               substeps together */
    uint32_t resolves;    /**< solves on top of these: on a grown force, or where elements' energy had not fallen */
    uint32_t guard_trips; /**< blocks on which the energy guard tripped */
    /* quality */
    float residual;       /**< largest remaining joint velocity error of the last substep, J v - target; of minimisation
                               that of a free vertex by the forces left, root mean square of an island [m/s] */
    float joint_error;    /**< largest gap of a joint, and of a link or attachment without compliance, after it [m] */
    float penetration;    /**< deepest overlap found by the step [m] */
    uint64_t bytes;       /**< held from the allocator */
    uint64_t allocations; /**< calls of the allocator during the step */
    uint32_t awake;       /**< of the bodies; counts and quality above, but for bodies and joints, are theirs alone */
    uint32_t sleeping_islands; /**< that rest asleep */
    uint32_t dropped_contacts; /**< not solved: in a crowd, or beyond taut_world_def.max_contacts */
    uint32_t elements;         /**< of cables of particles, cloths and solids */
    /* what the solves of the step left, largest of all islands and substeps; 0 unless taut_world_def.report is 1 */
    float yield;          /**< by which a swept contact or rigid joint gives way under its force, s h^2 w |f| [m]: h
                               the substep, w the inverse mass along the row, s 0.4 for contacts and 0.025 for joints */
    float solve_residual; /**< what one more pass would change of a row's velocity, times h [m]; of joints solved
                               directly what is missing from theirs */
    float linearisation;  /**< by which constraints curve within a substep, |C(x + h v) - C(x) - h J v| [m] */
    float energy_gain;    /**< kinetic energy that an island gained in a substep beyond the work of gravity, loads,
                               springs, drives and kinematic bodies [J]; what pushes bodies out of overlaps is in it */
} taut_profile;

/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_LOCKED. Thread safety: as event.h. */
TAUT_API taut_result taut_world_get_profile(taut_world world, taut_profile* out);

/**
 * Told that a stage begins (end 0) or ends (end 1). Scopes of a thread are nested and each ends on the thread that it
 * began on.
 *  - Thread 0 steps: "step", and in it one after the other, some of them many times, "broadphase", "narrowphase",
 *    "partition", "predict", "assemble", "solve" (direct solves too), "commit" and "publish": the times of
 *    taut_profile.
 *  - Threads from 1 on, the world's own and the host's, help within these: "work", the part of one in a loop. Several
 *    call at once. All have ended when the call that steps returns.
 * name: a text of the library's that lives as long as it. Calls on the world from inside return TAUT_LOCKED; what the
 * function throws is dropped.
 */
typedef void (*taut_profile_scope_fn)(const char* name, uint32_t thread, uint32_t end, void* user_data);

/**
 * Sets the function that steps of this world tell their stages; null: none, which costs nothing. No result of a step
 * depends on it, and no snapshot holds it.
 * Thread safety: one thread at a time per world, not inside a step.
 * @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_set_profile_scopes(taut_world world, taut_profile_scope_fn scope, void* user_data);

#ifdef __cplusplus
}
#endif

#endif
