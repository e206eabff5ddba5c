#include <taut/snapshot.h>

#include "api/access.h"
#include "snapshot/snapshot.h"

using namespace taut;

taut_result taut_world_snapshot_size(taut_world handle, uint64_t* bytes) {
    Check check(__func__);
    if (!check.pointer("bytes", bytes)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        *bytes = snapshot_size(world);
        return TAUT_OK;
    });
}

taut_result taut_world_save(taut_world handle, void* buffer, uint64_t capacity, uint64_t* bytes) {
    TAUT_RECORD(taut_world_save, handle, buffer, capacity, bytes);
    Check check(__func__);
    if (!check.pointer("bytes", bytes)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        const uint64_t needed = snapshot_size(world);
        if (needed > capacity) {
            *bytes = needed;
            return refuse(TAUT_TOO_SMALL, "%s: capacity is %llu, expected at least %llu", check.call(),
                          static_cast<unsigned long long>(capacity), static_cast<unsigned long long>(needed));
        }
        if (!check.pointer("buffer", buffer)) return check.result();
        save(world, {static_cast<std::byte*>(buffer), needed});
        *bytes = needed;
        return TAUT_OK;
    });
}

taut_result taut_world_restore(taut_world handle, const void* buffer, uint64_t bytes) {
    TAUT_RECORD(taut_world_restore, handle, buffer, bytes);
    Check check(__func__);
    if (!check.pointer("buffer", buffer)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        return restore(check.call(), world, {static_cast<const std::byte*>(buffer), bytes});
    });
}
