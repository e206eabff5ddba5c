/**
 * @file vehicle.h
 * Vehicles: a dynamic body on wheels that are rays, or shapes on their way, with suspension, tyres, engine, gears,
 * brakes and steering. A vehicle is a plain struct of the host's and no part of a world: it has no handle, takes no
 * memory, and is copied, saved and restored as any struct, beside a snapshot of the world.
 *
 * Called before each step, with its length:
 *
 *     taut_vehicle_drive(world, &def, &input, time_step, &vehicle);
 *     taut_world_step(world);
 *
 * or before each taut_world_advance, with its seconds, where frames are no shorter than steps.
 *
 * Springs, dampers, tyres and brakes are solved together, for the velocities at the end of the call's seconds, so that
 * stiff ones neither explode nor tremble at 30 Hz. A tyre is a brush of bristles: within its length of relaxation they
 * bend as far as the slip asks for, and where nothing slips they hold, so that a car with its brakes on stays on a
 * slope.
 */
#ifndef TAUT_VEHICLE_H
#define TAUT_VEHICLE_H

#include <taut/base.h>
#include <taut/body.h>
#include <taut/math.h>
#include <taut/query.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Most wheels, and most forward gears, of a vehicle. */
#define TAUT_VEHICLE_MAX_WHEELS 16
#define TAUT_VEHICLE_MAX_GEARS 16

/** taut_vehicle_input.gear: the forward gear with the most force at the wheels at the chassis' speed. */
#define TAUT_VEHICLE_AUTOMATIC 100
/** taut_vehicle_input.gear: backwards. 0 is neutral. */
#define TAUT_VEHICLE_REVERSE (-1)

/**
 * A wheel. Its centre moves on a straight line of the chassis, against up, by its travel: from position, where the
 * spring is pressed in as far as it goes, down to where it hangs free.
 *
 * The tyre's slip is the velocity at which it slides over the ground in parts of the one at which it goes or rolls,
 * whichever is larger. Its friction rises with the slip to a peak, friction, and falls to sliding_friction:
 * with r the slip in parts of that at the peak, by 2 r / (1 + r^2) of what it is above. Along and across the wheel add
 * up as vectors, each in parts of its own slip at the peak. With the friction of the ground's material each coefficient
 * makes a geometric mean, sqrt(tyre x ground). The struct keeps its size.
 */
typedef struct taut_wheel_def {
    taut_vec3 position;        /**< of its centre pressed in, in the chassis' frame [m], each within 1e4 */
    float radius;              /**< [m], [0.01, 100]. Default 0.35 */
    float inertia;             /**< about its axle [kg m^2], (0, 1e9]. Default 1.2 */
    float travel;              /**< of its centre [m], [0.01, 100]. Default 0.3 */
    float stiffness;           /**< of the spring, which is slack where it hangs free [N/m], [0, 1e12]. Default 30000 */
    float compression_damping; /**< [N s/m], [0, 1e12]. Default 3000 */
    float extension_damping;   /**< [N s/m], [0, 1e12]. Default 3000 */
    float friction;            /**< at the peak, [0, 100]. Default 1 */
    float sliding_friction;    /**< of much slip, [0, friction]. Default 0.8 */
    float peak_slip;           /**< along the wheel, [0.01, 1]. Default 0.12 */
    float peak_slip_across;    /**< across it: the sine of the angle, [0.01, 1]. Default 0.14 */
    float relaxation;          /**< way on which slip builds up [m], [0.01, 10]. Default 0.3 */
    float rolling_resistance;  /**< force against rolling in parts of the load, [0, 1]. Default 0.012 */
    float steering;            /**< angle at an input of 1, about up [rad], [-1.5, 1.5]. Default 0 */
    float brake;               /**< torque at an input of 1 [N m], [0, 1e9]. Default 3000 */
    float handbrake;           /**< torque at an input of 1 [N m], [0, 1e9]. Default 0 */
    float drive;               /**< its share in the engine's torque, in parts of the sum of all, [0, 1e3]. Default 0 */
    taut_shape shape;          /**< that goes along the line in place of a ray, such as a sphere of the radius, or a
                                    cylinder along the y axis, which comes to lie along the axle. Null: a ray. Default */
} taut_wheel_def;

/** An engine's torque at a speed. */
typedef struct taut_engine_point {
    float speed;  /**< [rad/s], [0, 1e5] */
    float torque; /**< with full throttle [N m], [-1e9, 1e9] */
} taut_engine_point;

/** What a vehicle is like. */
typedef struct taut_vehicle_def {
    uint32_t struct_size;
    uint32_t wheel_count;            /**< [1, TAUT_VEHICLE_MAX_WHEELS] */
    const taut_wheel_def* wheels;    /**< wheel_count of them */
    taut_body chassis;               /**< a dynamic body of gravity_scale 1. Not null */
    taut_vec3 forward;               /**< in the chassis' frame; not along up. Default (1, 0, 0) */
    taut_vec3 up;                    /**< in the chassis' frame, not zero. Default (0, 1, 0) */
    const taut_engine_point* torque; /**< torque_count of them, speeds rising; straight in between, the first one's
                                        torque below. Beyond the last it has none. Null with a count of 0: no engine */
    uint32_t torque_count;           /**< [0, 64]. Default 0 */
    uint32_t gear_count;             /**< [0, TAUT_VEHICLE_MAX_GEARS]. Default 0 */
    const float* gears;              /**< turns of the engine for one of the wheels, of each forward gear, (0, 1e3] */
    float reverse_gear;              /**< likewise of the one backwards, [0, 1e3]; 0: none. Default 12 */
    float idle_speed;                /**< below which the clutch slips, and the engine turns at it [rad/s], [0, 1e5].
                                          Default 90 */
    float engine_inertia;            /**< [kg m^2], [0, 1e6]. Default 0.2 */
    float engine_brake;              /**< torque against turning above idle_speed with no throttle [N m], [0, 1e9].
                                          Default 40 */
    float shift_time;                /**< without torque after a change of gears [s], [0, 10]. Default 0.2 */
    float drag_area;                 /**< drag coefficient times area [m^2], [0, 1e6]: with the world's air_density and
                                          wind it brakes by 1/2 density drag_area v^2. Default 0.7 */
    const taut_query_filter* filter; /**< what wheels meet; null: all but sensors. The chassis is never met. It ignores
                                          up to TAUT_QUERY_MAX_IGNORED - 1 bodies */
} taut_vehicle_def;

/** What the driver does. */
typedef struct taut_vehicle_input {
    float throttle;    /**< [0, 1] */
    float brake;       /**< [0, 1] */
    float handbrake;   /**< [0, 1] */
    float steering;    /**< [-1, 1]: positive turns by the right hand about up, to the left */
    int32_t gear;      /**< TAUT_VEHICLE_REVERSE, 0, [1, gear_count] or TAUT_VEHICLE_AUTOMATIC. One that is not there is
                            refused */
    uint32_t reserved; /**< zero */
} taut_vehicle_input;

/** Nothing pressed, steering straight, TAUT_VEHICLE_AUTOMATIC. */
TAUT_API void taut_vehicle_input_init(taut_vehicle_input* input);

/** A wheel now. speed, turn and slip go on from call to call; the rest is told anew by each. */
typedef struct taut_wheel {
    float speed;             /**< about its axle, positive forwards [rad/s], within 1e5 */
    float turn;              /**< its sum in [-pi, pi], for drawing [rad] */
    float slip[2];           /**< how far bristles are bent along and across [m], within 100: slip times relaxation */
    float steering;          /**< angle about up [rad] */
    float compression;       /**< of the spring [m]; 0: it hangs free, travel or more: it is pressed in */
    float load;              /**< along the ground's normal [N] */
    taut_vec3 force;         /**< of the ground on it, load included, world axes [N] */
    taut_vec3 ground_normal; /**< unit; 0 in the air */
    uint32_t on_ground;      /**< 1: it touches */
    uint32_t reserved;       /**< zero */
    taut_pose pose;          /**< of its centre: x forwards, y along the chassis' up, z the axle; steered, not turned */
    taut_pos ground_point;   /**< where it touches [m]; 0 in the air */
    taut_body ground_body;   /**< null in the air; it may be removed since */
    taut_collider ground_collider; /**< likewise */
} taut_wheel;

/** A vehicle, made by taut_vehicle_init. All of it is told by taut_vehicle_drive, which needs it again. */
typedef struct taut_vehicle {
    uint32_t struct_size;
    int32_t gear;                               /**< that is in */
    float engine_speed;                         /**< [rad/s] */
    float shifting;                             /**< time until the gear is in [s], [0, 10] */
    float forward_speed;                        /**< of the chassis' centre of mass along its forward [m/s] */
    float quiet;                                /**< time for which it has stood still [s], [0, 1e4] */
    taut_wheel wheels[TAUT_VEHICLE_MAX_WHEELS]; /**< the first wheel_count of them */
} taut_vehicle;

/** With all defaults, at the chassis' origin. */
TAUT_API void taut_wheel_def_init(taut_wheel_def* def);
TAUT_API void taut_vehicle_def_init_sized(taut_vehicle_def* def, uint32_t size);
static inline void taut_vehicle_def_init(taut_vehicle_def* def) {
    taut_vehicle_def_init_sized(def, (uint32_t)sizeof(*def));
}
/** At rest, in neutral. */
TAUT_API void taut_vehicle_init_sized(taut_vehicle* vehicle, uint32_t size);
static inline void taut_vehicle_init(taut_vehicle* vehicle) {
    taut_vehicle_init_sized(vehicle, (uint32_t)sizeof(*vehicle));
}

/**
 * Drives a vehicle through the coming step or frame: finds what its wheels touch, and applies their forces to the
 * chassis and, the other way round, to dynamic bodies beneath, over the time of the next call of taut_world_step or
 * taut_world_advance, as those of taut_body_apply_force. In a world with sleeping a vehicle that stands still on static
 * ground for sleep_time with no throttle and a brake on is put to sleep, and stays asleep until that changes or
 * something wakes the chassis.
 *
 * Springs, dampers and tyres know the chassis' mass and the world's gravity, and take it that nothing else pushes it;
 * what does is met a step later. What is at the end of its travel is stopped there as by something hard, from deeper in
 * softly. Dampers feel the motion of dynamic ground as far as its mass allows within a step.
 *
 * Thread safety: one thread at a time per world, not inside a step.
 * @param seconds [1e-4, 0.1].
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_INVALID_ARGUMENT (text names field and value; a chassis
 * that is not dynamic), TAUT_STALE_HANDLE and TAUT_FOREIGN_HANDLE (world, chassis, shapes, what the filter ignores),
 *         TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_vehicle_drive(taut_world world, const taut_vehicle_def* def, const taut_vehicle_input* input,
                                        float seconds, taut_vehicle* vehicle);

#ifdef __cplusplus
}
#endif

#endif
