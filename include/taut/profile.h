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
    float step_us; /**< the whole step */
    float broadphase_us;
    float narrowphase_us;
    float partition_us; /**< islands, blocks, colours */
    float predict_us;   /**< forces, world inertia, contact preparation */
    float assemble_us;  /**< rows and geometric stiffness */
    float factor_us;    /**< direct solves */
    float sweep_us;     /**< iterative sweeps, biased and relaxed */
    float commit_us;    /**< positions */
    float publish_us;   /**< restitution, quarantine, events */
    /* counts */
    uint32_t bodies;   /**< dynamic bodies and particles */
    uint32_t pairs;    /**< overlapping fat boxes */
    uint32_t touching; /**< pairs with contact points */
    uint32_t points;   /**< contact points */
    uint32_t joints;
    uint32_t islands;
    uint32_t blocks; /**< joint-connected components solved directly */
    uint32_t colours;
    uint32_t substeps;    /**< largest number of substeps that an island took */
    uint32_t solves;      /**< direct block solves, all substeps together */
    uint32_t resolves;    /**< of these, second solves on a grown force */
    uint32_t guard_trips; /**< blocks on which the energy guard tripped */
    /* quality */
    float residual;       /**< largest remaining joint velocity error of the last substep, J v - target [m/s] */
    float joint_error;    /**< largest joint error after the step [m] */
    float penetration;    /**< deepest overlap found by the step [m] */
    uint64_t bytes;       /**< held from the allocator */
    uint64_t allocations; /**< calls of the allocator during the step */
    uint32_t awake;       /**< of the bodies; counts and quality above, but for bodies and joints, are theirs alone */
    uint32_t sleeping_islands;
    uint32_t dropped_contacts; /**< found beyond the world's max_contacts, and not solved */
    uint32_t reserved;         /**< zero */
} taut_profile;

/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE, TAUT_LOCKED. Thread safety: as event.h. */
TAUT_API taut_result taut_world_get_profile(taut_world world, taut_profile* out);

#ifdef __cplusplus
}
#endif

#endif
