/**
 * @file joint.h
 * Joints between two ends, each a rigid body, a particle or the world (null handle).
 *
 * A joint locks some of the two ends' relative motions and leaves the rest, its axes, to the host: each axis may be
 * locked, free or limited by stops, driven by a motor or spring, and held by friction. Kinds that have axes are placed
 * by a frame on each end; where the frames coincide every coordinate is 0. Coordinates are those of end b in the frame
 * of end a. A particle has no rotation: only ball and distance joints take one.
 *
 *   kind         locks                              axes, by index
 *   ball         a point on a point                 none
 *   distance     (see its def)                      0: distance of two points, less `length` [m]
 *   fixed        everything                         none
 *   hinge        all but the angle about x          0: angle [rad]
 *   slider       all but the slide along x          0: slide [m]
 *   cylindrical  all but slide along, angle about x 0: slide [m], 1: angle [rad]
 *   universal    position; x of a square to y of b  0: angle about x of a, 1: angle about y of b [rad]
 *   cone_twist   position                           0: swing, between the x axes, [0, pi]; 1: twist about x [rad]
 *   six_dof      what its axes lock                 0 to 2: position in frame a [m], 3 to 5: Cardan angles [rad]
 *   wheel        all but these                      0: slide along x of a [m], 1: steering about x of a,
 *                                                   2: spin about y of b [rad]
 *   gear         turns of b to turns of a           none
 *   rack_pinion  slide of b to turns of a           none
 *   pulley       a rope from a over b's and its     0: its length, less `length` [m]
 *                own sheave to b
 *
 * An angle is read in (-pi, pi]. Two stops, up to a whole turn apart, hold it in the turn that it came to; from a
 * single stop it may turn away as often as it likes, and comes back as often. A target between two stops is reached
 * between them, any other in the turn that is nearest. Where the host places an end (taut_body_set_pose) or changes the
 * stops the angle is taken in a turn that is between them. "[N]" of an axis that is an angle reads "[N m]", "[m]"
 * "[rad]", and so on.
 *
 * Gears, racks and pulleys have a third end, the housing, in which bodies a and b are guided by joints of their own:
 * hinges, sliders or wheels. It is a rigid body that may move as it likes, or the world; it bears what a and b leave
 * over, as a gearbox does. Turns are counted, any number of them.
 *
 * A step that ends with a joint above its break_force or break_torque removes it; of several such joints in one
 * mechanism, bodies that joints tie together, the one that is furthest above, of like ones the oldest: what the others
 * carry without it is known after the next step.
 *
 * Each function here: thread safety: one thread at a time per world, not inside a step.
 */
#ifndef TAUT_JOINT_H
#define TAUT_JOINT_H

#include <taut/base.h>
#include <taut/math.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Which joint a handle names. */
typedef enum taut_joint_kind {
    TAUT_JOINT_BALL = 0,
    TAUT_JOINT_DISTANCE = 1,
    TAUT_JOINT_FIXED = 2,
    TAUT_JOINT_HINGE = 3,
    TAUT_JOINT_SLIDER = 4,
    TAUT_JOINT_UNIVERSAL = 5,
    TAUT_JOINT_CYLINDRICAL = 6,
    TAUT_JOINT_CONE_TWIST = 7,
    TAUT_JOINT_SIX_DOF = 8,
    TAUT_JOINT_WHEEL = 9,
    TAUT_JOINT_GEAR = 10,
    TAUT_JOINT_RACK_PINION = 11,
    TAUT_JOINT_PULLEY = 12,
    TAUT_JOINT_KIND_MAX = 0x7fffffff
} taut_joint_kind;

/** How a joint is solved. */
typedef enum taut_joint_solve {
    /** With all joints it hangs together with, at once: exact whatever they carry. Where a factor of their matrix takes
        more than 16000 multiplications for each of them (of an element in proportion to its rows and nodes), as of
        dense graphs and of a thousand joints between two bodies, all are swept. Solvers without a direct one sweep
        all. */
    TAUT_JOINT_SOLVE_DIRECT = 0,
    /** By sweeps: cheap, gives way under loads far heavier than the bodies it holds, by .0253 h^2 |f| (1/m_a + 1/m_b)
       in substeps of h. A drive's stiffness K, damping with it, is at most half of the inertia I of its ends' own
       turning over h^2, I / (2 h^2): some 13 Hz for limbs. */
    TAUT_JOINT_SOLVE_SOFT = 1,
    /** By need and cost. Directly with all that it hangs together with where that costs at most three times what sweeps
        do, as of chains and doors, or where a joint can break, whose force is exact then. Ragdolls, whose stops come
        and go, and nets are swept while sweeps give way by less than 1/500 of the size of a joint's smaller body and no
        joint stands open by as much for a second, as of jammed limbs, else solved directly, until sweeps would have
        held them for a quarter of a second. From the start they are solved directly where sweeps would not hold the
        weight of the heaviest of their bodies by the lightest, and where they hang, n joints deep, by what does not
        move: sweeps carry a force from joint to joint in a substep h, in which the last falls by g (n h)^2 / 2. That is
        worth c times the cost where it is over c^2 / 500 of a body's size. What has no size, a particle, is held
        directly, and so is what hangs on a direct joint, within the bound above. */
    TAUT_JOINT_SOLVE_BY_LOAD = 2,
    TAUT_JOINT_SOLVE_MAX = 0x7fffffff
} taut_joint_solve;

/** What an axis lets its coordinate do. */
typedef enum taut_axis_mode {
    TAUT_AXIS_LOCKED = 0,  /**< held at 0 */
    TAUT_AXIS_FREE = 1,    /**< moves */
    TAUT_AXIS_LIMITED = 2, /**< moves between two stops */
    TAUT_AXIS_MODE_MAX = 0x7fffffff
} taut_axis_mode;

/** Where a joint sits on an end. The x axis is the one that the joint is about. */
typedef struct taut_frame {
    taut_pos position;  /**< in the frame of the end's body, each component within 1e4; in the world if null [m] */
    taut_quat rotation; /**< from the joint's axes to the body's; to the world's if null */
} taut_frame;

/**
 * Motor or spring along an axis: force = -stiffness (coordinate - target) - damping (rate - speed), at most max_force
 * either way. There is none while stiffness, damping and frequency are 0, or max_force is.
 */
typedef struct taut_drive {
    float target;        /**< [m], within 1e6; an angle within 2 pi [rad]. Default 0 */
    float speed;         /**< [m/s], within 1e4. Default 0 */
    float stiffness;     /**< [N/m], [0, 1e24]. Default 0 */
    float damping;       /**< [N s/m], [0, 1e24], or INFINITY: holds the speed exactly, without stiffness. Default 0 */
    float frequency;     /**< [Hz], 0 or [1e-3, 1e3]: stiffness and damping (then 0 here) follow from it and
                              damping_ratio, for the mass or inertia that the joint's two ends alone set against motion
                              along the axis, at the pose where this is given, while the joint holds what it locks:
                              for a hinge, inertia about the hinge. Default 0 */
    float damping_ratio; /**< of frequency, [0, 1000]; 1: critical. Default 1 */
    float max_force;     /**< [N], [0, 1e24] or INFINITY. Default INFINITY */
} taut_drive;

/** One axis of a joint. Drive and friction act on free and limited axes; a locked one takes none. */
typedef struct taut_axis_def {
    uint32_t struct_size;
    taut_axis_mode mode;   /**< what its coordinate may do */
    float lower;           /**< stop of a limited axis [m], within 1e6, or -INFINITY: none. Of an angle, each within
                                2 pi and not more than 2 pi apart [rad]. Default -INFINITY */
    float upper;           /**< not below lower, or INFINITY: none. Default INFINITY */
    float stop_compliance; /**< of the stops [m/N], [0, 1e6]; 0: rigid. Default 0 */
    float stop_damping;    /**< of compliant stops [N s/m], [0, 1e12]. Default 0 */
    taut_drive drive;      /**< motor or spring */
    float friction;        /**< force at most, against the motion [N], [0, 1e24]. Default 0 */
} taut_axis_def;

/**
 * What the defs of all kinds share: the ends, where the joint sits on them, what it gives way by and what it breaks at.
 * A loader or editor fills one struct for whatever kind it makes. taut_joint_base_init writes the defaults, which are
 * those of all defs but for solve of gears and collide_connected of pulleys.
 *
 * A spring: force = -(error / compliance) - damping * d(error)/dt; compliance 0 is rigid, damping then has no effect.
 *
 * What a kind has no use for keeps its default, 0, and is refused otherwise: angular_compliance, angular_damping and
 * break_torque of ball and distance joints, racks and pulleys, which hold no angles; compliance, damping and
 * break_force of gears, which hold an angle alone. Ball and distance joints and pulleys sit on points: they do not look
 * at the rotations of frames, which must be valid all the same.
 *
 * As it lies within the defs it keeps its size while older programs run on: fields to come take the place of reserved.
 */
typedef struct taut_joint_base {
    taut_body body_a;   /**< null: the world; a particle for ball and distance joints and pulleys alone */
    taut_body body_b;   /**< likewise; one end or the housing must be dynamic or a particle, and no two the same */
    taut_frame frame_a; /**< on body_a; a particle takes position 0 alone. Default: the origin, unturned */
    taut_frame frame_b; /**< on body_b, likewise */
    float compliance;   /**< of what is held in metres [m/N], [0, 1e6]. Default 0 */
    float damping;      /**< likewise [N s/m], [0, 1e12]. Default 0 */
    float angular_compliance;   /**< of the held angles [rad/(N m)], [0, 1e6]. Default 0 */
    float angular_damping;      /**< likewise [N m s/rad], [0, 1e12]. Default 0 */
    float break_force;          /**< on end b [N], [0, 1e24]; a step that ends with more removes the joint; 0: never.
                                     Default 0 */
    float break_torque;         /**< the same of the torque about the anchor of end b [N m] */
    taut_joint_solve solve;     /**< default TAUT_JOINT_SOLVE_BY_LOAD */
    uint32_t collide_connected; /**< 1: the bodies that it ties still collide. Default 0 */
    uint64_t user_data;         /**< number of the host's own. Default 0 */
    uint32_t reserved[4];       /**< zero */
} taut_joint_base;

/** Holds a point of one end, the position of its frame, on a point of the other (3 rows). */
typedef struct taut_ball_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
} taut_ball_joint_def;

/**
 * Holds two points, the positions of the frames, at a distance (1 row): a rod, or a spring when compliant. With
 * min_length or max_length it keeps them within a range instead: a rope has a max_length alone. Its axis 0 has the
 * coordinate distance - length.
 */
typedef struct taut_distance_joint_def {
    uint32_t struct_size;
    float length;         /**< [m], 0 or [1e-4, 1e6]; 0: max_length if finite, else min_length, else the distance at
                               creation. Default 0 */
    taut_joint_base base; /**< compliance and damping: of the rod, or of the stops of a range */
    float min_length;     /**< [m], 0 or [1e-4, 1e6]; 0: no lower stop. Default 0 */
    float max_length;     /**< [m], 0, [1e-4, 1e6] or INFINITY; 0: no upper stop; INFINITY likewise, but not a rod.
                               Default 0 */
    float frequency;      /**< [Hz], 0 or [1e-3, 1e3]: compliance and damping (then 0 in base) follow from it and
                               damping_ratio, as for a taut_drive. Default 0 */
    float damping_ratio;  /**< of frequency, [0, 1000]. Default 1 */
    taut_drive drive;     /**< of a range: target is distance - length */
    float friction;       /**< of a range [N], [0, 1e24]. Default 0 */
} taut_distance_joint_def;

/** Holds two frames together (6 rows). */
typedef struct taut_fixed_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
} taut_fixed_joint_def;

/** Leaves the angle about x. */
typedef struct taut_hinge_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
    taut_axis_def angle;  /**< default free */
} taut_hinge_joint_def;

/** Leaves the slide along x. */
typedef struct taut_slider_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
    taut_axis_def slide;  /**< default free */
} taut_slider_joint_def;

/** Leaves the slide along and the angle about x. */
typedef struct taut_cylindrical_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
    taut_axis_def slide;  /**< default free */
    taut_axis_def angle;  /**< default free */
} taut_cylindrical_joint_def;

/** Leaves the angles about x of frame a and about y of frame b: a cardan joint. */
typedef struct taut_universal_joint_def {
    uint32_t struct_size;
    uint32_t reserved;     /**< zero */
    taut_joint_base base;  /**< ends, places, springs, breaking */
    taut_axis_def angle_a; /**< about x of frame a; default free */
    taut_axis_def angle_b; /**< about y of frame b; default free */
} taut_universal_joint_def;

/** A ball joint with a limited cone and twist: shoulder, neck. */
typedef struct taut_cone_twist_joint_def {
    uint32_t struct_size;
    uint32_t reserved;    /**< zero */
    taut_joint_base base; /**< ends, places, springs, breaking */
    taut_axis_def swing;  /**< free (default) or limited by upper, (0, pi], alone: lower is not looked at. A drive's
                               target is a swing, [0, pi], towards whichever side the joint leans. Its damping and
                               friction act around the cone too, but where the joint is swept */
    taut_axis_def twist;  /**< default free */
} taut_cone_twist_joint_def;

/** Each of the six relative motions as the host wants it. */
typedef struct taut_six_dof_joint_def {
    uint32_t struct_size;
    uint32_t reserved;     /**< zero */
    taut_joint_base base;  /**< ends, places, springs, breaking */
    taut_axis_def axes[6]; /**< position along x, y, z of a; angle about x of a, the turned y, z of b, of which that
                              about y must keep off +-pi/2; default locked */
} taut_six_dof_joint_def;

/**
 * A wheel on a strut of a chassis: body a is the chassis, x of frame a the strut; body b is the wheel, y of frame b its
 * axle. The wheel slides along the strut, is steered about it and spins about the axle, which stays square to the strut
 * and does not turn with the spin. taut_joint_frames_from_two_axes gives both frames from strut and axle.
 * A strut's spring carries a chassis: to let a mass m on it swing at f [Hz] its stiffness is m (2 pi f)^2. A drive's
 * frequency counts the two ends alone, of which the wheel is the lighter, and gives far less.
 */
typedef struct taut_wheel_joint_def {
    uint32_t struct_size;
    uint32_t reserved;        /**< zero */
    taut_joint_base base;     /**< ends, places, springs, breaking */
    taut_axis_def suspension; /**< slide along x of frame a; default locked */
    taut_axis_def steering;   /**< angle about x of frame a; default locked */
    taut_axis_def spin;       /**< angle about y of frame b; default free */
} taut_wheel_joint_def;

/**
 * Two bodies that turn with each other in a housing, each about x of its frames: gears, belts, a differential's bevels
 * (1 row). A body's two frames, on itself and on the housing, are those of the hinge that holds it there
 * (taut_joint_get_frames); of them positions only say where it is drawn. Gears mesh as they stand when the joint is
 * made, switched on, given frames or another ratio, or an end is placed by the host. A shaft may lean in the housing,
 * as a steered wheel's does: it is driven evenly then, as by a joint of constant velocity.
 */
typedef struct taut_gear_joint_def {
    uint32_t struct_size;
    float ratio;                /**< turns of b for one of a, magnitude in [1e-4, 1e4]; below 0 they turn against each
                                     other about axes that point the same way, as spur gears do: -teeth a / teeth b.
                                     Default -1 */
    taut_joint_base base;       /**< angular_compliance and angular_damping: of b's angle. solve: default
                                     TAUT_JOINT_SOLVE_DIRECT: what a gear gives way by is an angle, of which
                                     TAUT_JOINT_SOLVE_BY_LOAD knows no need */
    taut_body housing;          /**< null: the world; no particle. At least one of the three must be dynamic, and no two
                                     the same */
    taut_frame housing_frame_a; /**< on the housing, of body_a's axis. Default: the origin, unturned */
    taut_frame housing_frame_b; /**< on the housing, of body_b's axis, likewise */
} taut_gear_joint_def;

/**
 * A pinion, body a, that turns in a housing, and a rack, body b, that slides there along x of its frames (1 row). All
 * else as for gears.
 */
typedef struct taut_rack_pinion_joint_def {
    uint32_t struct_size;
    float ratio;                /**< slide of b for an angle of a: the pinion's radius, magnitude in [1e-4, 1e4]
                                     [m/rad]. Default 1 */
    taut_joint_base base;       /**< frame_b: its position slides, its rotation is not looked at. compliance and
                                     damping: of the slide */
    taut_body housing;          /**< as of gears */
    taut_frame housing_frame_a; /**< as of gears */
    taut_frame housing_frame_b; /**< the rack slides along its x axis */
} taut_rack_pinion_joint_def;

/**
 * A rope from a point of body a over two sheaves of a housing to a point of body b (1 row): with distances d of the
 * points from their sheaves, d_a + ratio d_b <= length. It has no mass and no friction; its tension pulls body a, ratio
 * times that body b, and the housing bears both. Its axis 0 has the coordinate d_a + ratio d_b - length, limited above
 * at 0: slack is below, a drive winches. All places are the positions of frames.
 */
typedef struct taut_pulley_joint_def {
    uint32_t struct_size;
    uint32_t rigid;             /**< 1: it pushes too, and axis 0 is locked. Default 0 */
    taut_joint_base base;       /**< compliance and damping: of the rope. collide_connected: default 1 */
    taut_body housing;          /**< null: the world; no particle. At least one of the three must be dynamic or a
                                     particle, and no two the same */
    taut_frame housing_frame_a; /**< a's sheave on the housing. Default: the origin, unturned */
    taut_frame housing_frame_b; /**< b's sheave, likewise */
    float ratio;                /**< falls of rope on b's side for one on a's, [1e-4, 1e4]. Default 1 */
    float length;               /**< [m], 0 or [1e-4, 1e6]; 0: what it is at creation. Default 0 */
} taut_pulley_joint_def;

/** What acts along an axis, as of the last substep; zero before the first step. */
typedef struct taut_axis_forces {
    float total;         /**< of all below and of the lock, along the coordinate [N] */
    float stop;          /**< > 0: the lower stop pushes up; < 0: the upper one down [N] */
    float drive;         /**< [N] */
    float friction;      /**< [N] */
    int32_t active_stop; /**< -1: lower, 1: upper, 0: none pushes */
    uint32_t reserved;   /**< zero */
} taut_axis_forces;

/** The origin, unturned. */
TAUT_API void taut_frame_init(taut_frame* frame);
/** No drive: the defaults of its fields. */
TAUT_API void taut_drive_init(taut_drive* drive);
/** The defaults of its fields; defs of gears and pulleys differ from them, see taut_joint_base. */
TAUT_API void taut_joint_base_init(taut_joint_base* base);
/** A free axis. */
TAUT_API void taut_axis_def_init_sized(taut_axis_def* def, uint32_t size);
static inline void taut_axis_def_init(taut_axis_def* def) { taut_axis_def_init_sized(def, (uint32_t)sizeof(*def)); }
TAUT_API void taut_ball_joint_def_init_sized(taut_ball_joint_def* def, uint32_t size);
static inline void taut_ball_joint_def_init(taut_ball_joint_def* def) {
    taut_ball_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_distance_joint_def_init_sized(taut_distance_joint_def* def, uint32_t size);
static inline void taut_distance_joint_def_init(taut_distance_joint_def* def) {
    taut_distance_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_fixed_joint_def_init_sized(taut_fixed_joint_def* def, uint32_t size);
static inline void taut_fixed_joint_def_init(taut_fixed_joint_def* def) {
    taut_fixed_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_hinge_joint_def_init_sized(taut_hinge_joint_def* def, uint32_t size);
static inline void taut_hinge_joint_def_init(taut_hinge_joint_def* def) {
    taut_hinge_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_slider_joint_def_init_sized(taut_slider_joint_def* def, uint32_t size);
static inline void taut_slider_joint_def_init(taut_slider_joint_def* def) {
    taut_slider_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_cylindrical_joint_def_init_sized(taut_cylindrical_joint_def* def, uint32_t size);
static inline void taut_cylindrical_joint_def_init(taut_cylindrical_joint_def* def) {
    taut_cylindrical_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_universal_joint_def_init_sized(taut_universal_joint_def* def, uint32_t size);
static inline void taut_universal_joint_def_init(taut_universal_joint_def* def) {
    taut_universal_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_cone_twist_joint_def_init_sized(taut_cone_twist_joint_def* def, uint32_t size);
static inline void taut_cone_twist_joint_def_init(taut_cone_twist_joint_def* def) {
    taut_cone_twist_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_six_dof_joint_def_init_sized(taut_six_dof_joint_def* def, uint32_t size);
static inline void taut_six_dof_joint_def_init(taut_six_dof_joint_def* def) {
    taut_six_dof_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_wheel_joint_def_init_sized(taut_wheel_joint_def* def, uint32_t size);
static inline void taut_wheel_joint_def_init(taut_wheel_joint_def* def) {
    taut_wheel_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_gear_joint_def_init_sized(taut_gear_joint_def* def, uint32_t size);
static inline void taut_gear_joint_def_init(taut_gear_joint_def* def) {
    taut_gear_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_rack_pinion_joint_def_init_sized(taut_rack_pinion_joint_def* def, uint32_t size);
static inline void taut_rack_pinion_joint_def_init(taut_rack_pinion_joint_def* def) {
    taut_rack_pinion_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}
TAUT_API void taut_pulley_joint_def_init_sized(taut_pulley_joint_def* def, uint32_t size);
static inline void taut_pulley_joint_def_init(taut_pulley_joint_def* def) {
    taut_pulley_joint_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * The frames that a world point and direction have on two ends at their present poses: what a def's frame_a and frame_b
 * take so that the joint begins with every coordinate at 0. x is the axis; y is the world's x, y or z, whichever is
 * most square to the axis (the first of equals), made square to it.
 * @param body_a, body_b null: the world. @param pivot [m], within 1e7. @param axis not zero; normalised.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT, TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_joint_frames_from_world(taut_world world, taut_body body_a, taut_body body_b, taut_pos pivot,
                                                  taut_vec3 axis, taut_frame* frame_a, taut_frame* frame_b);
/**
 * The same from two directions of the world, so that y is given as well: of a wheel joint strut and axle, of a
 * universal joint its two axes.
 * @param axis_x, axis_y not zero and not parallel, at least .001 rad apart; x is axis_x normalised, y is axis_y made
 *        square to it.
 * @return as above.
 */
TAUT_API taut_result taut_joint_frames_from_two_axes(taut_world world, taut_body body_a, taut_body body_b,
                                                     taut_pos pivot, taut_vec3 axis_x, taut_vec3 axis_y,
                                                     taut_frame* frame_a, taut_frame* frame_b);

/**
 * Adds a joint.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (all ends fixed or two the same, anchor off a particle, a particle where none
 * may be, points of a distance joint closer than 1e-4 m, range), TAUT_STALE_HANDLE, TAUT_FOREIGN_HANDLE,
 *         TAUT_STRUCT_SIZE, TAUT_NULL_POINTER, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_add_ball_joint(taut_world world, const taut_ball_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_distance_joint(taut_world world, const taut_distance_joint_def* def,
                                                   taut_joint* out);
TAUT_API taut_result taut_world_add_fixed_joint(taut_world world, const taut_fixed_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_hinge_joint(taut_world world, const taut_hinge_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_slider_joint(taut_world world, const taut_slider_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_cylindrical_joint(taut_world world, const taut_cylindrical_joint_def* def,
                                                      taut_joint* out);
TAUT_API taut_result taut_world_add_universal_joint(taut_world world, const taut_universal_joint_def* def,
                                                    taut_joint* out);
TAUT_API taut_result taut_world_add_cone_twist_joint(taut_world world, const taut_cone_twist_joint_def* def,
                                                     taut_joint* out);
TAUT_API taut_result taut_world_add_six_dof_joint(taut_world world, const taut_six_dof_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_wheel_joint(taut_world world, const taut_wheel_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_gear_joint(taut_world world, const taut_gear_joint_def* def, taut_joint* out);
TAUT_API taut_result taut_world_add_rack_pinion_joint(taut_world world, const taut_rack_pinion_joint_def* def,
                                                      taut_joint* out);
TAUT_API taut_result taut_world_add_pulley_joint(taut_world world, const taut_pulley_joint_def* def, taut_joint* out);
/** Removes a joint. @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_joint_remove(taut_joint joint);
/** 1 if the handle names a live joint, else 0. */
TAUT_API int32_t taut_joint_is_valid(taut_joint joint);

/** Which joint it is. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_joint_get_kind(taut_joint joint, taut_joint_kind* out);
/** Number of the host's own. @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_joint_get_user_data(taut_joint joint, uint64_t* out);
TAUT_API taut_result taut_joint_set_user_data(taut_joint joint, uint64_t value);
/** Its ends; null: the world. Either pointer may be null. @return TAUT_OK; TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_joint_get_bodies(taut_joint joint, taut_body* body_a, taut_body* body_b);
/** World positions of the two anchors after the last step [m]. */
TAUT_API taut_result taut_joint_get_anchors(taut_joint joint, taut_pos* anchor_a, taut_pos* anchor_b);
/** Frames on the two ends, as in the defs; unturned for ball and distance joints. */
TAUT_API taut_result taut_joint_get_frames(taut_joint joint, taut_frame* frame_a, taut_frame* frame_b);

/** Of a gear, rack or pulley, the third end; null: the world, and for other kinds. */
TAUT_API taut_result taut_joint_get_housing(taut_joint joint, taut_body* out);
/** Frames on the housing, as in the defs; of a pulley its sheaves, unturned. TAUT_INVALID_ARGUMENT for a kind without
 *  housing. */
TAUT_API taut_result taut_joint_get_housing_frames(taut_joint joint, taut_frame* frame_a, taut_frame* frame_b);
/** Ratio of a gear [1], rack [m/rad] or pulley [1]; TAUT_INVALID_ARGUMENT for another kind. */
TAUT_API taut_result taut_joint_get_ratio(taut_joint joint, float* out);
/** Length of a distance joint or pulley [m]; TAUT_INVALID_ARGUMENT for another kind. */
TAUT_API taut_result taut_joint_get_length(taut_joint joint, float* out);

/** Force on end b in the last substep, world axes [N]; end a receives the opposite. Zero before the first step. */
TAUT_API taut_result taut_joint_get_force(taut_joint joint, taut_vec3* out);
/** Torque on end b about its anchor in the last substep, world axes [N m]; drives, stops and friction included. */
TAUT_API taut_result taut_joint_get_torque(taut_joint joint, taut_vec3* out);
/** Distance by which the joint is violated at the present poses [m]: gap of a ball joint, |length error| of a rod,
 *  overrun of stops; of what is locked or limited only. */
TAUT_API taut_result taut_joint_get_error(taut_joint joint, float* out);
/** The same of angles [rad], 0 for ball and distance joints; a locked angle counts by 4 tan(angle / 4), which
 *  is 1 % more at 40 degrees and 4 at half a turn; those of universal and six-dof joints as they are. */
TAUT_API taut_result taut_joint_get_angular_error(taut_joint joint, float* out);
/** Number of axes, by which the calls below index them. */
TAUT_API taut_result taut_joint_get_axis_count(taut_joint joint, uint32_t* out);
/** Coordinate of an axis [m or rad] and its rate [m/s or rad/s] at the present poses; either pointer may be null.
 *  TAUT_INVALID_ARGUMENT for an axis that the joint has not, here and below. */
TAUT_API taut_result taut_joint_get_coordinates(taut_joint joint, uint32_t axis, float* value, float* rate);
TAUT_API taut_result taut_joint_get_axis_forces_sized(taut_joint joint, uint32_t axis, taut_axis_forces* out,
                                                      uint32_t size);
static inline taut_result taut_joint_get_axis_forces(taut_joint joint, uint32_t axis, taut_axis_forces* out) {
    return taut_joint_get_axis_forces_sized(joint, axis, out, (uint32_t)sizeof(*out));
}

/** The axis as it is: stiffness and damping are those in force, frequency 0. For a distance joint, lower and upper
 *  count from `length`. */
TAUT_API taut_result taut_joint_get_axis_sized(taut_joint joint, uint32_t axis, taut_axis_def* out, uint32_t size);
static inline taut_result taut_joint_get_axis(taut_joint joint, uint32_t axis, taut_axis_def* out) {
    return taut_joint_get_axis_sized(joint, axis, out, (uint32_t)sizeof(*out));
}
/**
 * Changes an axis. New mode or stops forget what the axis carries from the last step; a new drive or friction keeps it.
 * @return as for adding a joint.
 */
TAUT_API taut_result taut_joint_set_axis(taut_joint joint, uint32_t axis, const taut_axis_def* def);
/** Changes target and speed of a drive alone; TAUT_INVALID_ARGUMENT for an axis without one. */
TAUT_API taut_result taut_joint_set_target(taut_joint joint, uint32_t axis, float target, float speed);
/** Changes compliance [m/N] and damping [N s/m] of locked positions, for a distance joint also of its stops; ranges as
 *  in the defs. TAUT_INVALID_ARGUMENT for gears, which hold angles alone. */
TAUT_API taut_result taut_joint_set_compliance(taut_joint joint, float compliance, float damping);
/** Changes compliance [rad/(N m)] and damping [N m s/rad] of locked angles; TAUT_INVALID_ARGUMENT for ball and distance
 *  joints and pulleys. */
TAUT_API taut_result taut_joint_set_angular_compliance(taut_joint joint, float compliance, float damping);
/** Changes what the joint breaks at [N], [N m], [0, 1e24]; 0: never. TAUT_INVALID_ARGUMENT for a force of gears and a
 *  torque of joints that hold no angles. See taut_joint_break_event. */
TAUT_API taut_result taut_joint_set_break(taut_joint joint, float force, float torque);
/** Changes the length of a distance joint or pulley [m], [1e-4, 1e6]; stops and drive move along. TAUT_INVALID_ARGUMENT
 *  for another kind. */
TAUT_API taut_result taut_joint_set_length(taut_joint joint, float length);
/** Changes the ratio of a gear or rack, which mesh anew: another gear is engaged. Ranges as in the defs;
 *  TAUT_INVALID_ARGUMENT for another kind. */
TAUT_API taut_result taut_joint_set_ratio(taut_joint joint, float ratio);
TAUT_API taut_result taut_joint_set_solve(taut_joint joint, taut_joint_solve solve);
/** Moves the joint on both ends. Ball and distance joints do not look at the rotations, which must be valid all the
 *  same. @return as for adding a joint. */
TAUT_API taut_result taut_joint_set_frames(taut_joint joint, const taut_frame* frame_a, const taut_frame* frame_b);
/** Moves a gear, rack or pulley on its housing, of a pulley its sheaves, whose rotations are not looked at.
 *  TAUT_INVALID_ARGUMENT for a kind without housing. @return as for adding a joint. */
TAUT_API taut_result taut_joint_set_housing_frames(taut_joint joint, const taut_frame* frame_a,
                                                   const taut_frame* frame_b);
/**
 * Switches a joint off (0) or on (1, as it comes). Off, it is as if it was not there: it carries nothing, and its
 * bodies collide. On again, it begins as one just added: where its bodies came apart it pulls them together at once, so
 * taut_joint_set_frames or taut_body_set_pose go before. A joint of a disabled body does not work either, whatever
 * this says.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT unless 0 or 1, TAUT_STALE_HANDLE, TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_joint_set_enabled(taut_joint joint, uint32_t enabled);
/** @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_joint_get_enabled(taut_joint joint, uint32_t* out);
/**
 * The joints of a world by slots.
 * @return TAUT_OK; TAUT_TOO_SMALL with the number needed in *count; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_get_joints(taut_world world, taut_joint* joints, uint32_t capacity, uint32_t* count);
/** Whether the two bodies collide, 0 or 1. */
TAUT_API taut_result taut_joint_set_collide_connected(taut_joint joint, uint32_t collide_connected);

#ifdef __cplusplus
}
#endif

#endif
