// A body's frame, where its points go, and the box about it.
#include <taut/body.h>

#include "api/access.h"
#include "queries/queries.h"

using namespace taut;

namespace {

// act(nodes, node) with the frame to write into.
template <class Out, class Act>
taut_result look(Check& check, taut_body handle, Out* out, Act&& act) {
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        *out = act(world.nodes, node);
        return TAUT_OK;
    });
}

constexpr Range kVector{-1e30, 1e30};

}  // namespace

taut_result taut_body_get_world_point(taut_body handle, taut_vec3 local, taut_pos* out) {
    Check check(__func__);
    return look(check.vector("local", local, kPosition), handle, out, [&](const Nodes& nodes, uint32_t node) {
        return to_pos(nodes.origin(node) + nodes.motion[node].q * to_vec(local));
    });
}

taut_result taut_body_get_local_point(taut_body handle, taut_pos point, taut_vec3* out) {
    Check check(__func__);
    return look(check.vector("point", point, kPosition), handle, out, [&](const Nodes& nodes, uint32_t node) {
        return to_vec3(nodes.motion[node].q.conjugate() * (to_vec(point) - nodes.origin(node)));
    });
}

taut_result taut_body_get_world_vector(taut_body handle, taut_vec3 local, taut_vec3* out) {
    Check check(__func__);
    return look(check.vector("local", local, kVector), handle, out,
                [&](const Nodes& nodes, uint32_t node) { return to_vec3(nodes.motion[node].q * to_vec(local)); });
}

taut_result taut_body_get_local_vector(taut_body handle, taut_vec3 vector, taut_vec3* out) {
    Check check(__func__);
    return look(check.vector("vector", vector, kVector), handle, out, [&](const Nodes& nodes, uint32_t node) {
        return to_vec3(nodes.motion[node].q.conjugate() * to_vec(vector));
    });
}

taut_result taut_body_get_point_velocity(taut_body handle, taut_pos point, taut_vec3* out) {
    Check check(__func__);
    return look(check.vector("point", point, kPosition), handle, out, [&](const Nodes& nodes, uint32_t node) {
        const NodeMotion& m = nodes.motion[node];
        return to_vec3(m.v + m.w.cross(to_vec(point) - m.x));
    });
}

taut_result taut_body_get_bounds(taut_body handle, taut_pos* low, taut_pos* high) {
    Check check(__func__);
    if (!check.pointer("low", low).pointer("high", high)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t node) {
        const uint32_t first = world.nodes.info[node].collider;
        if (!check.require(first != kNone, "body has no collider")) return check.result();
        Bounds all = bounds_of(world, first);
        for_colliders(world.nodes, world.colliders, node, [&](uint32_t c) {
            const Bounds one = bounds_of(world, c);
            all.low = all.low.cwiseMin(one.low);
            all.high = all.high.cwiseMax(one.high);
        });
        *low = to_pos(all.low);
        *high = to_pos(all.high);
        return TAUT_OK;
    });
}
