/**
 * @file ragdoll.h
 * Ragdolls: bodies on joints made from the bones of a skeleton, limp, powered towards the poses of an animation, or led
 * by it. A ragdoll is a plain struct of the host's that names bodies and joints of the world, which the host may use as
 * any others; what it holds beside them is the targets of the last call.
 *
 * A frame is taut_ragdoll_drive with the pose wanted at its end, and then taut_world_advance:
 *
 *     taut_ragdoll_drive(&def, TAUT_RAGDOLL_POWERED, animated, seconds, &ragdoll);
 *     taut_world_advance(world, seconds, NULL);
 *     taut_ragdoll_get_poses(&ragdoll, drawn, bone_count);
 */
#ifndef TAUT_RAGDOLL_H
#define TAUT_RAGDOLL_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most bones of a ragdoll. */
#define TAUT_RAGDOLL_MAX_BONES 64

/** What moves a ragdoll. */
typedef enum taut_ragdoll_mode {
    TAUT_RAGDOLL_LIMP = 0,    /**< gravity and contacts; joints with their friction alone */
    TAUT_RAGDOLL_POWERED = 1, /**< also torques at its joints towards the angles of a pose */
    TAUT_RAGDOLL_HELD = 2,    /**< as powered, with its roots led as below */
    TAUT_RAGDOLL_LED = 3,     /**< all bones are kinematic and arrive at the pose as the frame ends */
    TAUT_RAGDOLL_MODE_MAX = 0x7fffffff
} taut_ragdoll_mode;

/**
 * A bone: a body, and the joint to its parent. Rest poses are in the frame of the ragdoll. The joint's x axis is the
 * one of twist; its coordinates are the angles about x of the parent, the turned y and z of the bone, which are 0 at
 * rest.
 */
typedef struct taut_bone_def {
    uint32_t struct_size;
    int32_t parent;           /**< number of another bone, below its own; -1: a root. Default -1 */
    const char* name;         /**< of the body, as taut_body_set_name; null: none */
    taut_pose pose;           /**< of the body at rest */
    taut_shape shape;         /**< of the world, not null */
    taut_vec3 shape_position; /**< in the body's frame [m] */
    taut_quat shape_rotation; /**< default identity */
    float mass;               /**< [kg], 0 or [1e-6, 1e15]. 0: of the shape at 1000 kg/m^3. Default 0 */
    float friction;           /**< of the joint about each free axis [N m], [0, 1e24]. Default 0 */
    taut_pose joint;          /**< its frame at rest; not of a root */
    taut_vec3 lower;          /**< least angles about x [-pi, 0], y [-1.5, 0], z [-pi, 0] [rad]. Default -0.5 each */
    taut_vec3 upper;     /**< greatest [0, pi], [0, 1.5], [0, pi]; where both are 0 it is locked. Default 0.5 each */
    float frequency;     /**< of drives, for the inertia of the two bones alone [Hz], 0 or [1e-3, 1e3]; 0: none.
                              Default 5 */
    float damping_ratio; /**< of drives, [0, 1000]. Default 1 */
    float max_torque;    /**< of each drive [N m], [0, 1e24] or INFINITY. Default INFINITY */
    uint32_t reserved;   /**< zero */
} taut_bone_def;

/** A skeleton and where it stands. */
typedef struct taut_ragdoll_def {
    uint32_t struct_size;
    uint32_t bone_count;        /**< [1, TAUT_RAGDOLL_MAX_BONES] */
    const taut_bone_def* bones; /**< bone_count of them */
    taut_pose pose;             /**< of its frame in the world. Default: the origin, unturned */
    taut_material material;     /**< of all bones */
    taut_filter filter;         /**< likewise; bones that a joint ties together never collide */
} taut_ragdoll_def;

/** A ragdoll. Told by taut_world_add_ragdoll and taut_ragdoll_drive, which need it again. */
typedef struct taut_ragdoll {
    uint32_t struct_size;
    uint32_t bone_count;
    taut_ragdoll_mode mode;                    /**< of the last call */
    uint32_t reserved;                         /**< zero */
    taut_body bodies[TAUT_RAGDOLL_MAX_BONES];  /**< by bone */
    taut_joint joints[TAUT_RAGDOLL_MAX_BONES]; /**< six-dof joints, from parent (a) to bone (b); null of roots */
    taut_vec3 targets[TAUT_RAGDOLL_MAX_BONES]; /**< angles that drives were last given [rad] */
} taut_ragdoll;

TAUT_API void taut_bone_def_init_sized(taut_bone_def* def, uint32_t size);
static inline void taut_bone_def_init(taut_bone_def* def) { taut_bone_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_ragdoll_def_init_sized(taut_ragdoll_def* def, uint32_t size);
static inline void taut_ragdoll_def_init(taut_ragdoll_def* def) {
    taut_ragdoll_def_init_sized(def, (uint32_t)sizeof(*def));
}
/** Without bones. */
TAUT_API void taut_ragdoll_init_sized(taut_ragdoll* ragdoll, uint32_t size);
static inline void taut_ragdoll_init(taut_ragdoll* ragdoll) {
    taut_ragdoll_init_sized(ragdoll, (uint32_t)sizeof(*ragdoll));
}

/**
 * Adds bodies and joints at rest pose, limp. What is refused leaves no body behind.
 * Thread safety, here and below: one thread at a time per world, not inside a step.
 * @param ragdoll initialised.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value),
 *         TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE, TAUT_LIMIT, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_ragdoll(taut_world world, const taut_ragdoll_def* def, taut_ragdoll* ragdoll);
/** Removes its bodies, and with them its joints; those that are gone are passed over. @return TAUT_OK;
 * TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (bone_count), TAUT_LOCKED, TAUT_OUT_OF_MEMORY. */
TAUT_API taut_result taut_ragdoll_remove(taut_ragdoll* ragdoll);
/**
 * Poses of the bones' bodies in the world, by bone.
 * @return TAUT_OK; TAUT_TOO_SMALL if capacity is below bone_count; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE,
 *         TAUT_INVALID_ARGUMENT (bone_count), TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_ragdoll_get_poses(const taut_ragdoll* ragdoll, taut_pose* poses, uint32_t capacity);
/**
 * Places the bones at once, as taut_body_set_pose; their velocities stay.
 * @param poses of all bones, in the world. @return as above; TAUT_INVALID_ARGUMENT (a pose out of range).
 */
TAUT_API taut_result taut_ragdoll_set_poses(taut_ragdoll* ragdoll, const taut_pose* poses);
/**
 * Says what moves it over the next frame. Drives take the angles between the poses of neighbouring bones, kept within
 * their limits, and the rates at which these changed since the last call; the places of bones count for those that are
 * led alone. A joint that is gone has no drive.
 * @param def as it was added. @param poses wanted at the end of the frame, in the world, by bone; null: limp alone.
 * @param seconds that the frame takes, [1e-4, 1].
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_ragdoll_drive(const taut_ragdoll_def* def, taut_ragdoll_mode mode, const taut_pose* poses,
                                        float seconds, taut_ragdoll* ragdoll);

#ifdef __cplusplus
}
#endif

#endif
