// What a world, and a body, has of a kind, by slots.
#include <taut/body.h>
#include <taut/joint.h>
#include <taut/shape.h>

#include "api/access.h"

using namespace taut;

namespace {

// What for_each(act(handle)) names, into a host's array that is written only if it holds all.
template <class Handle, class ForEach>
taut_result give_list(Check& check, const char* name, Handle* out, uint32_t capacity, uint32_t* count,
                      ForEach&& for_each) {
    uint32_t needed = 0;
    for_each([&](Handle) { ++needed; });
    *count = needed;
    if (needed > capacity)
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, needed);
    if (needed > 0 && !check.pointer(name, out)) return check.result();
    for_each([&](Handle handle) { *out++ = handle; });
    return TAUT_OK;
}

// Those that the host knows, by act(slot).
template <class Act>
void for_own_joints(const Joints& joints, Act&& act) {
    for (uint32_t slot = 0; slot < joints.ids.slots(); ++slot)
        if (joints.ids.live(slot) && !joints.record[slot].inner) act(slot);
}

}  // namespace

taut_result taut_world_get_bodies(taut_world handle, taut_body* bodies, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        return give_list(check, "bodies", bodies, capacity, count, [&](auto&& act) {
            for (uint32_t node = 0; node < world.nodes.slots(); ++node)
                if (world.nodes.ids.live(node)) act(world.body_handle(node));
        });
    });
}

taut_result taut_world_get_joints(taut_world handle, taut_joint* joints, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        return give_list(check, "joints", joints, capacity, count, [&](auto&& act) {
            for_own_joints(world.joints, [&](uint32_t joint) { act(world.joint_handle(joint)); });
        });
    });
}

taut_result taut_world_get_shapes(taut_world handle, taut_shape* shapes, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        return give_list(check, "shapes", shapes, capacity, count, [&](auto&& act) {
            for (uint32_t shape = 0; shape < world.shapes.ids.slots(); ++shape)
                if (world.shapes.ids.live(shape)) act(world.shape_handle(shape));
        });
    });
}

taut_result taut_body_get_joints(taut_body handle, taut_joint* joints, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        return give_list(check, "joints", joints, capacity, count, [&](auto&& act) {
            for_own_joints(world.joints, [&](uint32_t joint) {
                if (ends_on(world.joints.record[joint], node)) act(world.joint_handle(joint));
            });
        });
    });
}
