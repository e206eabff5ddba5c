/**
 * @file event.h
 * What the steps did since their events were read last, as arrays: a host that reads once a frame is told everything
 * once, however many steps its frame took, and nothing where it took none. The first taut_world_step or
 * taut_world_advance after a reading, whether it takes a step or not, forgets what was read; until then it can be read
 * again, and a view's pointer is valid until then or the end of the world. Handles inside may have become stale since.
 *
 * Events that nobody reads wait: of the last TAUT_EVENT_STEPS steps at least (of the world's max_catch_up, where that
 * is more), of twice as many at most. Older ones are dropped, and their steps counted in taut_events.dropped_steps: who
 * follows what touches by begin and end then asks taut_world_get_contacts and taut_collider_get_overlaps anew. Moved
 * bodies are not dropped.
 * Each function here: thread safety: any thread between steps while no other changes the world.
 */
#ifndef TAUT_EVENT_H
#define TAUT_EVENT_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Steps whose events wait at least until they are read. */
#define TAUT_EVENT_STEPS 60

/**
 * Two colliders began or stopped touching in a step, or touch as they did before it; a cloth or solid as one, by the
 * first of its vertices that has a collider, see deformable.h. Who overlapped as the step
 * began touches in it, and who was pushed within it, be it off again by its end.
 */
typedef struct taut_contact_event {
    taut_body body_a;         /**< one of the pair */
    taut_body body_b;         /**< the other one */
    taut_collider collider_a; /**< of body_a */
    taut_collider collider_b; /**< of body_b */
    uint32_t first_point;     /**< of its points in taut_events.points */
    uint32_t point_count;     /**< 0 where they end, and where nobody asks for points */
    uint32_t step;            /**< that it happened in: 0 for the first of taut_events.steps, 1 for the next */
    uint32_t reserved;        /**< zero */
} taut_contact_event;

/** A point of a contact event: where it was found before the bodies moved, and what its step did there. */
typedef struct taut_contact_point {
    taut_pos position;      /**< midway between the two surfaces, carried along with body a [m] */
    taut_vec3 normal;       /**< unit, from a to b */
    float separation;       /**< [m], negative when overlapping */
    float normal_impulse;   /**< sum over the substeps [N s]; what points gave that were gone before the step's end is
                                 with the nearest that is left */
    float friction_impulse; /**< magnitude of the vector sum over the substeps [N s] */
    float approach_speed; /**< at which a and b closed along the normal before the step [m/s]; negative: they parted */
    uint32_t reserved;    /**< zero */
} taut_contact_point;

/**
 * A touch that closed faster than the world's hit_speed, at its fastest point. A blow may be spread over two steps: a
 * pair that hit in one step does not hit in the next.
 */
typedef struct taut_hit_event {
    taut_body body_a;
    taut_body body_b;
    taut_collider collider_a;
    taut_collider collider_b;
    taut_pos position;    /**< as of a contact point [m] */
    taut_vec3 normal;     /**< unit, from a to b */
    float approach_speed; /**< along the normal before the step [m/s] */
    float normal_impulse; /**< of all points of the pair, sum over the substeps [N s] */
    uint32_t step;        /**< as of a contact event */
} taut_hit_event;

/** A collider came into a sensor or left it; see sensor.h. */
typedef struct taut_sensor_event {
    taut_collider sensor;   /**< that detects */
    taut_collider visitor;  /**< that is detected */
    taut_body sensor_body;  /**< of sensor */
    taut_body visitor_body; /**< of visitor */
    uint32_t step;          /**< as of a contact event */
    uint32_t reserved;      /**< zero */
} taut_sensor_event;

/** A dynamic, kinematic or particle body that a step moved, once with its newest pose. */
typedef struct taut_moved_event {
    taut_body body; /**< that it tells of */
    uint64_t user_data;
    taut_pose pose; /**< after the last step */
} taut_moved_event;

/** A body whose motion diverged: it was put back to its pose before the step, and stays there like a static one until
 * taut_body_release. Told once; what it touches or is tied to goes on. */
typedef struct taut_quarantine_event {
    taut_body body;
    uint64_t user_data;
    uint32_t step;                 /**< as of a contact event */
    taut_quarantine_reason reason; /**< never TAUT_QUARANTINE_NONE */
} taut_quarantine_event;

/** A joint that ended a step with more force or torque than its def allows, and was removed then. */
typedef struct taut_joint_break_event {
    taut_joint joint; /**< stale by now: good for comparing only */
    uint64_t user_data;
    taut_vec3 force;   /**< on end b, as taut_joint_get_force would have said [N] */
    taut_vec3 torque;  /**< on end b about its anchor [N m] */
    uint32_t step;     /**< as of a contact event */
    uint32_t reserved; /**< zero */
} taut_joint_break_event;

/** An attachment that ended a step with more force or torque than it bears, and was removed then. */
typedef struct taut_attachment_break_event {
    taut_attachment attachment; /**< stale by now: good for comparing only */
    uint64_t user_data;
    taut_vec3 force;   /**< on b, as taut_attachment_get_force would have said [N] */
    taut_vec3 torque;  /**< on b, likewise [N m] */
    uint32_t step;     /**< as of a contact event */
    uint32_t reserved; /**< zero */
} taut_attachment_break_event;
/** A vertex of a cloth that a step split, as an edge on it was stretched too far; see taut_cloth_def::tear_strain. */
typedef struct taut_tear_event {
    taut_cloth cloth;    /**< that tore */
    uint64_t user_data;  /**< of the cloth */
    uint32_t edge[2];    /**< vertices of the edge that was stretched too far */
    uint32_t vertex;     /**< that was split: one of these, or one beside it that the tear parted in two */
    uint32_t new_vertex; /**< its other part: the cloth's last vertex then */
    float strain;        /**< of the edge, its length over that at rest - 1 */
    uint32_t step;       /**< as of a contact event */
} taut_tear_event;

/**
 * A cell of a solid that began to flow: for the first time, or after it had been unloaded to less than nine tenths of
 * the strain at which it yields; see taut_solid_def::yield_stress.
 */
typedef struct taut_yield_event {
    taut_solid solid;   /**< that it is of */
    uint64_t user_data; /**< of the solid */
    uint32_t cell;      /**< that yielded, as the def numbers them */
    float stress;       /**< von Mises', of what is left after it has flowed, as taut_solid_get_stresses says [Pa] */
    float strain;       /**< plastic, as taut_solid_get_plastic_strains says */
    uint32_t step;      /**< as of a contact event */
} taut_yield_event;

/** A body or particle that fell asleep or woke; see sleep.h. */
typedef struct taut_sleep_event {
    taut_body body;
    uint64_t user_data;
    uint32_t step;     /**< as of a contact event */
    uint32_t reserved; /**< zero */
} taut_sleep_event;

/**
 * The events of the steps since they were read last. Each list goes step by step. Within a step contacts and hits are
 * sorted by collider_a and then collider_b, those of sensors by sensor and then visitor, all in the order of their
 * slots: that of creation as long as none is removed. What began and ended between two readings is in both lists: who
 * follows what touches goes through both, step by step, and reads of a step the ends before the beginnings, and leaves
 * before enters: where a call changed a collider, both may come in one step.
 */
typedef struct taut_events {
    const taut_contact_event* begin;          /**< pairs that touch and did not before */
    const taut_contact_event* end;            /**< pairs that touch no more */
    const taut_moved_event* moved;            /**< bodies that moved, each once */
    const taut_quarantine_event* quarantined; /**< bodies that were frozen */
    uint32_t begin_count;
    uint32_t end_count;
    uint32_t moved_count;
    uint32_t quarantined_count;
    const taut_joint_break_event* broken; /**< in the order of the joints' slots */
    uint32_t broken_count;
    uint32_t steps;                        /**< that these are the events of */
    const taut_contact_event* persist;     /**< pairs that touched before and still do */
    const taut_hit_event* hit;             /**< of pairs that began or go on */
    const taut_contact_point* points;      /**< of begin and persist */
    const taut_sensor_event* sensor_enter; /**< into sensors; for each there comes one of sensor_leave */
    const taut_sensor_event* sensor_leave; /**< out of sensors */
    uint32_t persist_count;
    uint32_t hit_count;
    uint32_t point_count;
    uint32_t sensor_enter_count;
    uint32_t sensor_leave_count;
    uint32_t dropped_steps;              /**< whose events waited too long to be read */
    const taut_sleep_event* fell_asleep; /**< asleep after a step, awake by the events before; by slots */
    const taut_sleep_event* woke;        /**< the other way round */
    uint32_t fell_asleep_count;
    uint32_t woke_count;
    uint32_t dropped_contacts; /**< not solved: in a crowd, or beyond taut_world_def.max_contacts; sum over the steps */
    uint32_t torn_count;
    const taut_attachment_break_event* detached; /**< in the order of the attachments' slots */
    const taut_tear_event* torn;                 /**< by cloths' slots, of each the largest strain first */
    uint32_t detached_count;
    uint32_t yielded_count;
    const taut_yield_event* yielded; /**< step by step; within one by solids' slots, then cells */
} taut_events;

/** One point of a touching pair. */
typedef struct taut_contact {
    taut_body body_a;
    taut_body body_b;
    taut_pos position;      /**< midway between the two surfaces [m] */
    taut_vec3 normal;       /**< unit, from a to b */
    float separation;       /**< [m], negative when overlapping */
    float normal_impulse;   /**< of the force in the last substep, over the world's least substep [N s]: time_step /
                                 taut_world_def::substeps, however many its island took */
    float friction_impulse; /**< magnitude, likewise [N s] */
    taut_collider collider_a;
    taut_collider collider_b;
} taut_contact;

/**
 * The events of the steps since they were read last. The next taut_world_step or taut_world_advance forgets them.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_events_sized(taut_world world, taut_events* out, uint32_t size);
static inline taut_result taut_world_get_events(taut_world world, taut_events* out) {
    return taut_world_get_events_sized(world, out, (uint32_t)sizeof(*out));
}
/**
 * Copies the contact points of the last step, sorted by pair; after them those between grains, in the order of place.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_contacts_sized(taut_world world, taut_contact* contacts, uint32_t capacity,
                                                   uint32_t* count, uint32_t size);
static inline taut_result taut_world_get_contacts(taut_world world, taut_contact* contacts, uint32_t capacity,
                                                  uint32_t* count) {
    return taut_world_get_contacts_sized(world, contacts, capacity, count, (uint32_t)sizeof(*contacts));
}
/** Those of one body, which is a or b of each, in the same order. @return as taut_world_get_contacts. */
TAUT_API taut_result taut_body_get_contacts_sized(taut_body body, taut_contact* contacts, uint32_t capacity,
                                                  uint32_t* count, uint32_t size);
static inline taut_result taut_body_get_contacts(taut_body body, taut_contact* contacts, uint32_t capacity,
                                                 uint32_t* count) {
    return taut_body_get_contacts_sized(body, contacts, capacity, count, (uint32_t)sizeof(*contacts));
}

#ifdef __cplusplus
}
#endif

#endif
