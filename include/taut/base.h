/**
 * @file base.h
 * Results, handles, version and host hooks of the Taut C API.
 *
 * Conventions that hold for every header of this folder:
 *  - SI units, radians, right-handed coordinates, no built-in up axis.
 *  - World positions are double (taut_pos); everything else is float.
 *  - A call that can fail returns taut_result and writes its results through its last pointers; a call
 *    that fails changes nothing. taut_last_error() then names function, field and value.
 *  - Every def starts with struct_size, which its _init function writes together with the defaults.
 *  - Programs of older headers run on newer libraries. A struct that a call takes or gives gains fields at its end
 *    alone: of a def with an older, smaller struct_size the rest takes its defaults, a larger one is refused; functions
 *    that write structs have a form ..._sized, which takes the size of the caller's struct, and which the other one,
 *    inline, calls with that of the header it stands in. What lies within other structs (poses, materials, filters,
 *    frames, drives, hooks) and records of events keep their size: what they would gain comes at the end of the struct
 *    that they lie in or are listed by.
 *  - No exception, abort or exit crosses this interface.
 *  - Calls round to nearest, keep denormals and do not trap, whatever floating-point environment their thread is in, so
 *    that results do not depend on it. Host functions that a call calls are in the same one; on return the thread has
 *    its own back, but for exception flags, which may be raised.
 */
#ifndef TAUT_BASE_H
#define TAUT_BASE_H

#include <stddef.h>
#include <stdint.h>

/* Before each function; a host that builds or loads the library in another way defines it itself. */
#ifndef TAUT_API
#if defined(_WIN32) || defined(SWIG) /* which knows no attributes */
#define TAUT_API
#else
#define TAUT_API __attribute__((visibility("default")))
#endif
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** Version of this header; before 1.0 a minor version may change the interface. */
#define TAUT_VERSION_MAJOR 0
#define TAUT_VERSION_MINOR 1
#define TAUT_VERSION_PATCH 0

/** Outcome of a call. Values are stable; new ones are appended. */
typedef enum taut_result {
    TAUT_OK = 0,
    TAUT_INVALID_ARGUMENT = 1, /**< a value is out of range or not finite; the text names field and value */
    TAUT_NULL_POINTER = 2,     /**< a required pointer is null */
    TAUT_STALE_HANDLE = 3,     /**< the handle is null, or what it named is gone */
    TAUT_FOREIGN_HANDLE = 4,   /**< the handle belongs to another world */
    TAUT_STRUCT_SIZE = 5, /**< struct_size is 0, or that of a header newer than the library: call the _init function */
    TAUT_LOCKED = 6,      /**< the world is inside a step (or a second thread is using it) */
    TAUT_TOO_SMALL = 7,   /**< the array is too small; *count holds the number needed */
    TAUT_OUT_OF_MEMORY = 8,
    TAUT_IN_USE = 9, /**< a shape that bodies still use, or a body of a cable, cloth or solid, cannot be removed */
    TAUT_LIMIT = 10, /**< a stated limit is reached (worlds, their contents, vertices of a hull) */
    TAUT_UNSUPPORTED = 11, /**< this machine or build lacks what is needed; the text says what */
    TAUT_RESULT_MAX = 0x7fffffff
} taut_result;

/** Short name of a result ("TAUT_OK"); "unknown" for other values. Thread safety: any thread. */
TAUT_API const char* taut_result_name(taut_result result);

/**
 * Text of the last refused call on the calling thread: function, field, value, expectation.
 * UTF-8, never null, valid until the next refused call on this thread; not cleared by success.
 * Thread safety: any thread; each thread has its own text.
 */
TAUT_API const char* taut_last_error(void);

/** Version of the linked library as major * 10000 + minor * 100 + patch. Thread safety: any thread. */
TAUT_API uint32_t taut_version(void);

/** A world. Zero is null. */
typedef struct taut_world {
    uint64_t bits;
} taut_world;
/** A rigid body or a particle: a node of the one system. Zero is null; where a joint takes it, null means the world. */
typedef struct taut_body {
    uint64_t bits;
} taut_body;
/** A collision shape owned by a world and shared by its bodies. Zero is null. */
typedef struct taut_shape {
    uint64_t bits;
} taut_shape;
/** A shape built ahead, which any number of worlds share. Zero is null. */
typedef struct taut_baked {
    uint64_t bits;
} taut_baked;
/** A shape on a body, at a place of its own: what collides. Zero is null. */
typedef struct taut_collider {
    uint64_t bits;
} taut_collider;
/** A joint. Zero is null. */
typedef struct taut_joint {
    uint64_t bits;
} taut_joint;

/** A cable. Zero is null. */
typedef struct taut_cable {
    uint64_t bits;
} taut_cable;

/** A cloth. Zero is null. */
typedef struct taut_cloth {
    uint64_t bits;
} taut_cloth;
/** A deformable solid. Zero is null. */
typedef struct taut_solid {
    uint64_t bits;
} taut_solid;

/** An attachment between points of bodies, cables, cloths and solids. Zero is null. */
typedef struct taut_attachment {
    uint64_t bits;
} taut_attachment;

/** Severity of a log line. */
typedef enum taut_log_level {
    TAUT_LOG_INFO = 0,
    TAUT_LOG_WARNING = 1,
    TAUT_LOG_ERROR = 2,
    TAUT_LOG_LEVEL_MAX = 0x7fffffff
} taut_log_level;

/** Receives a log line (UTF-8, no newline), on the thread that called the API: what a step could not do as asked. */
typedef void (*taut_log_fn)(taut_log_level level, const char* text, void* user_data);

/** Allocates size bytes at alignment (a power of two, at most 64). Null means out of memory. */
typedef void* (*taut_allocate_fn)(size_t size, size_t alignment, void* user_data);
/** Frees what taut_allocate_fn returned, with the same size and alignment. */
typedef void (*taut_free_fn)(void* pointer, size_t size, size_t alignment, void* user_data);

/** Helps with a step until it ends; returns at once where there is nothing to do. The range does not matter. */
typedef void (*taut_task_fn)(uint32_t begin, uint32_t end, uint32_t worker, void* task_data);
/**
 * Hands task(range) over [0, count) to the host's workers in ranges of at least grain; returns a token for finish.
 * Called at most once a step, on the thread that steps, when there is work to share. A worker that starts late or never
 * delays nothing but itself: the stepping thread does what nobody takes. Where it throws, it has handed out nothing,
 * and the step goes on without help.
 */
typedef void* (*taut_enqueue_task_fn)(taut_task_fn task, uint32_t count, uint32_t grain, void* task_data,
                                      void* user_data);
/** Waits until every range of the token has run, at the end of the step. */
typedef void (*taut_finish_task_fn)(void* token, void* user_data);

/**
 * Host hooks of one world. Any pair may be null: log lines are dropped, memory comes from the C runtime, the step runs
 * on the calling thread and on those that the world's def asks for. Memory and log hooks are called on the thread that
 * calls the API.
 */
typedef struct taut_hooks {
    taut_log_fn log;                   /**< told what a step could not do as asked */
    void* log_user_data;               /**< passed to it */
    taut_allocate_fn allocate;         /**< allocate and free: both or neither */
    taut_free_fn free;                 /**< gives back what allocate gave */
    void* memory_user_data;            /**< passed to both */
    taut_enqueue_task_fn enqueue_task; /**< enqueue_task and finish_task: both or neither */
    taut_finish_task_fn finish_task;   /**< waits for them */
    void* task_user_data;              /**< passed to both */
    uint32_t worker_count;             /**< workers of the host's task system that may help, [0, 63]; 0 without one */
    uint32_t reserved;                 /**< zero */
} taut_hooks;

/** None of them. Nothing where hooks is null. Thread safety: any thread. */
TAUT_API void taut_hooks_init(taut_hooks* hooks);

#ifdef __cplusplus
}
#endif

#endif
