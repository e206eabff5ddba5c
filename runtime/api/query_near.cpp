// What overlaps, and how far things are apart.
#include "api/query_parts.h"
#include "api/sized.h"

using namespace taut;

namespace {

template <class Query>
taut_result collect_overlaps(Check& check, const Sight& sight, const Query& query, taut_collider* colliders,
                             uint32_t capacity, uint32_t* count) {
    return collect(check, "colliders", RecordOut(colliders, sizeof *colliders), capacity, count,
                   [&](Sink<taut_collider>& sink) { all_overlaps(sight, query, sink); });
}

}  // namespace

// ---------------------------------------------------------------- overlaps

taut_result taut_world_overlap_shape(taut_world world, taut_shape handle, const taut_pose* pose,
                                     const taut_query_filter* filter, taut_collider* colliders, uint32_t capacity,
                                     uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("pose", pose).pointer("count", count)) return check.result();
    if (!check.pose("pose.position", "pose.rotation", *pose)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), handle, shape);
        if (found != TAUT_OK) return found;
        return collect_overlaps(check, sight, ShapeQuery{*shape, to_placement(*pose)}, colliders, capacity, count);
    });
}

taut_result taut_world_overlap_point(taut_world world, taut_pos point, const taut_query_filter* filter,
                                     taut_collider* colliders, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count).vector("point", point, kPosition)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        return collect_overlaps(check, sight, PointQuery{to_vec(point)}, colliders, capacity, count);
    });
}

taut_result taut_world_overlap_box(taut_world world, taut_pos low, taut_pos high, const taut_query_filter* filter,
                                   taut_collider* colliders, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    check.pointer("count", count).vector("low", low, kPosition).vector("high", high, kPosition);
    if (!check.require(low.x <= high.x && low.y <= high.y && low.z <= high.z, "low is above high"))
        return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const BoxQuery query = {0.5 * (to_vec(low) + to_vec(high)), 0.5 * (to_vec(high) - to_vec(low))};
        return collect_overlaps(check, sight, query, colliders, capacity, count);
    });
}

taut_result taut_collider_overlap_shape(taut_collider collider, taut_shape handle, const taut_pose* pose,
                                        int32_t* out) {
    Check check(__func__);
    if (!check.pointer("pose", pose).pointer("out", out)) return check.result();
    if (!check.pose("pose.position", "pose.rotation", *pose)) return check.result();
    return with(check.call(), collider, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, world, handle, shape);
        if (found != TAUT_OK) return found;
        *out = is_met(world, index, ShapeQuery{*shape, to_placement(*pose)});
        return TAUT_OK;
    });
}

taut_result taut_collider_overlap_point(taut_collider collider, taut_pos point, int32_t* out) {
    Check check(__func__);
    if (!check.pointer("out", out).vector("point", point, kPosition)) return check.result();
    return with(check.call(), collider, Use::read, [&](const World& world, uint32_t index) {
        *out = is_met(world, index, PointQuery{to_vec(point)});
        return TAUT_OK;
    });
}

// ---------------------------------------------------------------- distances

taut_result taut_collider_closest_point_sized(taut_collider collider, taut_pos point, taut_distance* first,
                                              uint32_t size) {
    const RecordOut<taut_distance> out(first, size);
    Check check("taut_collider_closest_point");
    if (!check.pointer("out", out).vector("point", point, kPosition)) return check.result();
    return with(check.call(), collider, Use::read, [&](const World& world, uint32_t index) {
        *out = distance_to_point(world, to_vec(point), index);
        return TAUT_OK;
    });
}

taut_result taut_collider_distance_sized(taut_collider a, taut_collider b, taut_distance* first, uint32_t size) {
    const RecordOut<taut_distance> out(first, size);
    Check check("taut_collider_distance");
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), a, Use::read, [&](const World& world, uint32_t index) {
        uint32_t other = 0;
        const taut_result found = find_collider(check.call(), "b", world, b, other);
        if (found != TAUT_OK) return found;
        const auto is_convex = [&](uint32_t c) {
            const collision::ShapeKind kind = world.shapes[world.colliders.record[c].shape].shape.kind;
            return kind != collision::ShapeKind::plane && kind != collision::ShapeKind::surface;
        };
        check.require(is_convex(index) || is_convex(other), "both are planes, meshes or height fields");
        if (!check) return check.result();
        *out = distance_between(world, index, other);
        return TAUT_OK;
    });
}

taut_result taut_world_nearest_collider_sized(taut_world world, taut_shape handle, const taut_pose* pose,
                                              float max_distance, const taut_query_filter* filter, taut_distance* first,
                                              uint32_t size) {
    const RecordOut<taut_distance> out(first, size);
    Check check("taut_world_nearest_collider");
    if (!check.pointer("pose", pose).pointer("out", out)) return check.result();
    check.pose("pose.position", "pose.rotation", *pose).number("max_distance", max_distance, kQueryDistance);
    if (!check) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), handle, shape);
        if (found != TAUT_OK) return found;
        *out = nearest(sight, {*shape, to_placement(*pose)}, max_distance);
        return TAUT_OK;
    });
}
