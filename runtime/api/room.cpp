// How many objects a world may hold.
#include "api/access.h"

namespace taut {
namespace {

struct Limit {
    const char* field;  // of taut_world_def
    uint32_t most;      // 0: none
    const char* what;
};

taut_result room_in(const char* call, const IdPool& pool, size_t more, const Limit& limit) {
    if (pool.slots() + more >= kMaxSlots) return refuse(TAUT_LIMIT, "%s: too many %s", call, limit.what);
    if (limit.most == 0 || pool.count() + more <= limit.most) return TAUT_OK;
    return refuse(TAUT_LIMIT, "%s: %s of the world is %u, and %zu %s would be there", call, limit.field, limit.most,
                  pool.count() + more, limit.what);
}

}  // namespace

taut_result room_for_bodies(const char* call, const World& world, size_t more) {
    return room_in(call, world.nodes.ids, more, {"max_bodies", world.def.max_bodies, "bodies"});
}

taut_result room_for_colliders(const char* call, const World& world, size_t more) {
    return room_in(call, world.colliders.ids, more, {"max_colliders", world.def.max_colliders, "colliders"});
}

taut_result room_for_joints(const char* call, const World& world, size_t more) {
    return room_in(call, world.joints.ids, more, {"max_joints", world.def.max_joints, "joints"});
}

taut_result room_for_attachments(const char* call, const World& world, size_t more) {
    return room_in(call, world.attachments.ids, more, {"", 0, "attachments"});
}

}  // namespace taut
