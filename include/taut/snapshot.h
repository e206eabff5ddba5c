/**
 * @file snapshot.h
 * Snapshots: the state of a world as bytes in a buffer of the host's, and back. What comes after a restoration is what
 * came after the saving, bit by bit: for rollback, for saved games and replays, for finding where two runs part.
 *
 * A snapshot holds all that later steps depend on: bodies, joints and attachments with their forces, cables, cloths,
 * solids, colliders, contacts, what sleeps, sensors, time left over, gravity and what else was set of the world. It is
 * restored into the world that it is of, in this process. Handles of bodies, colliders, joints, attachments, cables,
 * cloths and solids that lived at the saving live again, whatever was removed since, and name the same; what was added
 * since is gone. Who then adds the same once more gets the same handles, so those of what is gone are best forgotten.
 *
 * Not in it are shapes and meshes, which are large and do not change: those that colliders have in the snapshot must
 * still be there. Shapes that were added since stay. Host functions and what belongs to them (hooks, pre_solve) stay as
 * they are. Events that wait to be read are forgotten, as if they had been read; those of later steps are the same as
 * after the saving. taut_events.moved tells of motion in steps alone: poses after a restoration are to be read.
 */
#ifndef TAUT_SNAPSHOT_H
#define TAUT_SNAPSHOT_H

#include <taut/base.h>

#ifdef __cplusplus
extern "C" {
#endif

/**
 * Bytes of a snapshot of the world as it is now, exactly.
 * @return TAUT_OK; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_snapshot_size(taut_world world, uint64_t* bytes);
/**
 * Writes a snapshot. Of equal states, and so of one before and after a restoration, it has equal bytes.
 * @param buffer of capacity bytes at any alignment; what is beyond the snapshot stays as it is. @param bytes its size.
 * @return TAUT_OK; TAUT_TOO_SMALL with the size needed in *bytes; TAUT_NULL_POINTER, TAUT_STALE_HANDLE, TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_save(taut_world world, void* buffer, uint64_t capacity, uint64_t* bytes);
/**
 * Brings a world to the state of a snapshot of it. Takes memory only where the world had less in it since than then.
 * @param buffer as written. @param bytes its size, as taut_world_save told it.
 * @return TAUT_OK; TAUT_INVALID_ARGUMENT (no snapshot, or cut, or changed: it has a checksum, which finds what was
 *         damaged, not what was forged), TAUT_UNSUPPORTED (of another version of the library), TAUT_FOREIGN_HANDLE (of
 *         another world), TAUT_STALE_HANDLE (also where a shape is gone), TAUT_OUT_OF_MEMORY, TAUT_NULL_POINTER,
 *         TAUT_LOCKED.
 */
TAUT_API taut_result taut_world_restore(taut_world world, const void* buffer, uint64_t bytes);

#ifdef __cplusplus
}
#endif

#endif
