/**
 * @file cable.h
 * Cables: a row of particles or of rigid links, made, reeled and read as one thing. The parts are ordinary bodies of
 * the world, which all other calls may read, push and attach to. What holds an end is an ordinary joint, and so is what
 * ties links to each other; segments of particles are elements of the cable alone, and cost no joint.
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_CABLE_H
#define TAUT_CABLE_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most segments of one cable; paying out stops there. */
#define TAUT_CABLE_MAX_SEGMENTS 4096

/** What a cable is made of. */
typedef enum taut_cable_kind {
    TAUT_CABLE_PARTICLES = 0, /**< n + 1 points at the distances of n segments, which collide as capsules between their
                                   points: the cheaper one. No twist. A segment holds against pull and push.
                                   Looked for along its way as taut_body_set_continuous of both points says; what
                                   hits a wall by an end stays on its side as well */
    TAUT_CABLE_LINKS = 1,     /**< n capsules tied end to end: bodies that turn, and roll on what they touch */
    TAUT_CABLE_KIND_MAX = 0x7fffffff
} taut_cable_kind;

/** Where one end of a cable goes. An end that is attached is tied by a ball joint, or a fixed one where clamped. */
typedef struct taut_cable_end_def {
    uint32_t attached; /**< 0: free. Default 0 */
    uint32_t clamped;  /**< 1: the direction that the cable has there is held too, with the cable's bending stiffness;
                            attached ends of cables with bending_stiffness only. Default 0 */
    taut_body body;    /**< null: the world */
    taut_pos anchor;   /**< in the body's frame, within 1e4; world position if null [m]; a particle takes only 0 */
} taut_cable_end_def;

/**
 * A cable. Segments are numbered from end 0 to end 1; so are points, of which there is one more.
 *
 * Bending: the moment is bending_stiffness * curvature + bending_damping * d(curvature)/dt, about both axes across;
 * of links about the cable as well (twist has the same stiffness), which particles do not know. The cable at rest is
 * straight and not twisted. As good as a beam up to some 30 degrees a segment; beyond 90 the moment falls again.
 * Without bending stiffness links turn and twist freely.
 */
typedef struct taut_cable_def {
    uint32_t struct_size;
    taut_cable_kind kind;      /**< default TAUT_CABLE_LINKS */
    taut_cable_end_def end[2]; /**< where its first and last point go */
    const taut_pos* points;    /**< point_count points of the path, from end 0 to end 1 [m]; copied. The path's own ends
                                    give way to the anchors of attached ends */
    uint32_t point_count;      /**< 0 (both ends attached: straight from one to the other) or at least 2 */
    uint32_t segment_count;    /**< the path is cut into so many; at most TAUT_CABLE_MAX_SEGMENTS. Default 0 */
    float segment_length;      /**< or into segments of about this length [m], [0.01, 1000]. Default 0. Both 0: each
                                    stretch of the path is a segment, and a straight path is cut into 16 */
    float length;              /**< [m], 0: the path's own. More than the distance of the ends: it sags, as a parabola;
                                    straight paths only. Default 0 */
    float diameter;            /**< [m], [0.002, 1000]. Default 0.02 */
    float mass_per_metre;      /**< [kg/m], [1e-3, 1e9]. Default 1 */
    float stretch_compliance;  /**< strain per force [1/N], [0, 1000]. Default 0: does not stretch */
    float stretch_damping;     /**< force per rate of strain [N s], [0, 1e9]; of a compliant cable. Default 0 */
    float bending_stiffness;   /**< [N m^2], 0 or [1e-9, 1e12]. Default 0: limp */
    float bending_damping;     /**< [N m^2 s], [0, 1e9]. Default 0 */
    taut_material material;    /**< of the surface */
    taut_filter filter;        /**< mask 0: no contacts */
    uint32_t self_collision;   /**< 1: segments collide with all others of the cable but the next; of particles but the
                                    next two. 0: they do not; they then share a negative group of their own (below -1e9)
                                    where filter.group is 0, and it may not be positive. 1 asks for filter.group >= 0.
                                    Default 0 */
    float gravity_scale;       /**< [-1000, 1000]. Default 1 */
    uint64_t user_data;        /**< of the cable and of each of its bodies */
} taut_cable_def;

TAUT_API void taut_cable_def_init_sized(taut_cable_def* def, uint32_t size);
static inline void taut_cable_def_init(taut_cable_def* def) { taut_cable_def_init_sized(def, (uint32_t)sizeof(*def)); }

/**
 * Adds a cable at rest. Its segments are chords of the path, so it is a little shorter than a path with bends.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (range; points or anchors closer than a segment may be short, 0.01 m),
 *         TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE, TAUT_STRUCT_SIZE, TAUT_NULL_POINTER,
 *         TAUT_LIMIT, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_cable(taut_world world, const taut_cable_def* def, taut_cable* out);
/**
 * Removes a cable with all its bodies and joints, and every other joint and attachment on its bodies.
 * Its bodies cannot be removed one by one: taut_body_remove then returns TAUT_IN_USE. Its joints can: taking one out
 * cuts a cable of links there, and taking out an end's joint, or removing the body that it is attached to, lets the end
 * go.
 */
TAUT_API taut_result taut_cable_remove(taut_cable cable);
/**
 * Cuts a cable: of particles the segment goes, with its shape at the next step; of links what ties the link to the
 * next. Nothing changes where it is cut already.
 * @param segment below the number of segments, of links below that less one.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_cable_cut(taut_cable cable, uint32_t segment);
/** 1 if the handle names a live cable, else 0. */
TAUT_API int32_t taut_cable_is_valid(taut_cable cable);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_cable_get_user_data(taut_cable cable, uint64_t* out);
/** The cable that a body is part of; null for any other body. */
TAUT_API taut_result taut_body_get_cable(taut_body body, taut_cable* out);

/** Unstretched length of what is paid out [m]. */
TAUT_API taut_result taut_cable_get_length(taut_cable cable, float* out);
/**
 * Points of the cable after the last step, from end 0 to end 1 [m]: one more than there are segments.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cable_get_points(taut_cable cable, taut_pos* points, uint32_t capacity, uint32_t* count);
/**
 * Tension of each segment in the last substep [N], at its middle, positive where it pulls; results as above. Between
 * two heights of a cable that hangs still it is the weight below the middle of the segment.
 */
TAUT_API taut_result taut_cable_get_tensions(taut_cable cable, float* tensions, uint32_t capacity, uint32_t* count);
/**
 * Bodies of the cable in order: the points of particles, or the links, which lie along their y axis. Reeling makes and
 * removes bodies at its end. The collider of a segment of particles is that of its first point. Results as above.
 */
TAUT_API taut_result taut_cable_get_bodies(taut_cable cable, taut_body* bodies, uint32_t capacity, uint32_t* count);
/** The joint that holds end 0 or 1; it stays the same while the cable is reeled. Null: the end is free. */
TAUT_API taut_result taut_cable_get_end_joint(taut_cable cable, uint32_t end, taut_joint* out);

/**
 * Pays out (positive) or hauls in (negative) at an attached end, from the next step on until changed.
 *
 * The segment at the end grows and shrinks; where it is 1.6 of the cable's mean segment, a new one is cut off it, and
 * below 0.4 it is joined with the next; at fast hauling both a little later and earlier, so that what is left lasts the
 * step. The last one is not hauled in below 0.2 of a segment. What is paid out
 * comes with the cable's mass per metre and the velocity of the end, without any force on what it comes from; what is
 * hauled in takes its momentum away. Where bent segments are joined the cable loses the difference to the chord; that
 * is made good by and by, with a tenth of what passes the end. A body that goes takes with it whatever else was tied to
 * it.
 *
 * @param end 0 or 1. @param speed [m/s]; at most half a segment a step.
 * @param acceleration with which the speed is reached [m/s^2], [0, 1e6]; 0: at once.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (a free end, range), TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_cable_set_reel_speed(taut_cable cable, uint32_t end, float speed, float acceleration);
/** Speed of the last step [m/s]; 0 once the end is free. */
TAUT_API taut_result taut_cable_get_reel_speed(taut_cable cable, uint32_t end, float* out);
/** Pays out so many metres more, [-1e6, 1e6]; spread over steps where it is more than half a segment. As above. */
TAUT_API taut_result taut_cable_reel(taut_cable cable, uint32_t end, float metres);

#ifdef __cplusplus
}
#endif

#endif
