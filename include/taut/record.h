/**
 * @file record.h
 * Recordings: all calls that change a world, from its creation on, as bytes that the host stores, and worlds that play
 * them again, on any number of threads and in another process, and find where they part. A bug report is one file;
 * taut-replay plays it.
 *
 * A recording holds the world's def, and of each call that changes the world the function's name, its arguments, the
 * content of arrays, the result and the handles given; of refused calls too. A call is written before it is done, so
 * that one which never comes back is in the file. Calls that only read are not in it. Characters and vehicles change
 * the world by other calls, and those are recorded. Restorations name the snapshot that they restore by the call that
 * took it. The answers of a pre_solve function are recorded in their order; a replay asks nobody.
 *
 * Not replayed, as nothing came of them: calls that ran out of memory, or came while the world was in a step. Not
 * replayable, and refused by name: a restoration of a snapshot from before the recording, a baked shape whose def was
 * not kept, and what a second thread changed in the midst of another's call.
 *
 * A world that is not recorded pays one look at a number in each call that would be written.
 */
#ifndef TAUT_RECORD_H
#define TAUT_RECORD_H

#include <taut/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/** Takes size bytes of a recording, which follow those of the last call. Called on the thread that calls the world,
 *  also before a call is done. Returns 1; after anything else, what it throws, or a call from inside that changes the
 *  world, the recording ends there, with a warning to the log. */
typedef int32_t (*taut_record_fn)(const void* bytes, uint64_t size, void* user_data);

/** When a recording holds the hash of the world's state, by which a replay tells where it parts. */
typedef enum taut_record_hashes {
    TAUT_RECORD_HASH_NONE = 0,  /**< never: results and handles are compared alone */
    TAUT_RECORD_HASH_STEPS = 1, /**< after each call that steps, relaxes or restores */
    TAUT_RECORD_HASH_CALLS = 2, /**< after each call: slow where much is added */
    TAUT_RECORD_HASHES_MAX = 0x7fffffff
} taut_record_hashes;

/** How a world is recorded. */
typedef struct taut_record_def {
    uint32_t struct_size;
    taut_record_hashes hashes; /**< default TAUT_RECORD_HASH_STEPS */
    taut_record_fn write;      /**< not null */
    void* user_data;           /**< of write. Default null */
} taut_record_def;

TAUT_API void taut_record_def_init_sized(taut_record_def* def, uint32_t size);
static inline void taut_record_def_init(taut_record_def* def) {
    taut_record_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Records a world from here on, until taut_world_end_recording or the world's end. It must be as created: no call but
 * readings, refused ones included, has come before. Memory for it comes from the world's allocator, and is not counted
 * in taut_world_get_bytes.
 * Thread safety: one thread at a time per world.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (a world that calls have changed, or that is recorded already),
 *         TAUT_UNSUPPORTED (write did not take the head), TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_STALE_HANDLE,
 *         TAUT_LOCKED, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_world_record(taut_world world, const taut_record_def* def);
/** Ends the recording, so that a replay knows it whole.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (the world is not recorded), TAUT_STALE_HANDLE, TAUT_LOCKED. */
TAUT_API taut_result taut_world_end_recording(taut_world world);
/**
 * Whether shapes baked from here on keep their defs, so that recordings of worlds which they are added to can hold
 * them: 0, as it is at first, or 1. It costs the memory of the def, of the baked shape's allocator.
 * Thread safety: any thread.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT.
 */
TAUT_API taut_result taut_bake_keep_defs(uint32_t keep);

/** How a world plays a recording. */
typedef struct taut_replay_def {
    uint32_t struct_size;
    uint32_t threads;  /**< as in taut_world_def. Default 1 */
    const void* bytes; /**< the recording; they stay as they are while the world lives */
    uint64_t size;     /**< of it */
    taut_hooks hooks;  /**< of the world. Default: none */
} taut_replay_def;

/** What became of a replay. */
typedef enum taut_replay_status {
    TAUT_REPLAY_STEPPED = 0, /**< it went on, up to and with the next call that steps, relaxes or restores */
    TAUT_REPLAY_ENDED = 1,   /**< the recording is at its end; it has no more such calls */
    TAUT_REPLAY_DIFFERS = 2, /**< a call came out otherwise than it is recorded; it does not go on */
    TAUT_REPLAY_STATUS_MAX = 0x7fffffff
} taut_replay_status;

/** Where a replay is. */
typedef struct taut_replay_state {
    taut_replay_status status; /**< whether it goes on */
    uint32_t whole;            /**< 1 at the end of a recording that was ended; 0: it is cut, or its process died */
    uint64_t call;             /**< number of the last call played, from 1; 0: none */
    uint64_t frame;            /**< of calls that step, relax or restore, likewise */
    uint64_t offset;           /**< of that call in the recording [bytes] */
    const char* function;      /**< its name, null: none. Valid as long as the library */
    const char* difference;    /**< what differs, null: nothing. Likewise */
    uint64_t expected;         /**< what is recorded: a result, a handle's or hash's bits */
    uint64_t found;            /**< what came out */
} taut_replay_state;

TAUT_API void taut_replay_def_init_sized(taut_replay_def* def, uint32_t size);
static inline void taut_replay_def_init(taut_replay_def* def) {
    taut_replay_def_init_sized(def, (uint32_t)sizeof(*def));
}

/**
 * Creates a world that plays a recording: as its world was created, and nothing played yet. It may be read, asked and
 * drawn like any other, also recorded; other calls that change it make it part from its recording. Handles in it are
 * those of the recorded world but for the bits of the world.
 * Thread safety: any thread.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (no recording, or one that is damaged in its first part; threads),
 *         TAUT_UNSUPPORTED (of another version of the format, of a newer library, with calls that this one has not),
 *         TAUT_NULL_POINTER, TAUT_STRUCT_SIZE, TAUT_LIMIT, TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_replay_open(const taut_replay_def* def, taut_world* out);
/**
 * Plays on. After TAUT_REPLAY_ENDED and TAUT_REPLAY_DIFFERS, and after a call that was not replayable or damaged, it
 * stays where it is and says the same again.
 * Thread safety: one thread at a time per world.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (the world plays no recording; the recording is damaged: where and how is
 *         told), TAUT_UNSUPPORTED (not replayable, and why), TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED,
 *         TAUT_OUT_OF_MEMORY.
 */
TAUT_API taut_result taut_replay_next_sized(taut_world world, taut_replay_state* out, uint32_t size);
static inline taut_result taut_replay_next(taut_world world, taut_replay_state* out) {
    return taut_replay_next_sized(world, out, (uint32_t)sizeof(*out));
}

#ifdef __cplusplus
}
#endif

#endif
