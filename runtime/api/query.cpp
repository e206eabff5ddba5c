#include <taut/query.h>

#include <cstdio>

#include "api/access.h"
#include "queries/queries.h"

using namespace taut;

namespace {

// ---------------------------------------------------------------- check

constexpr double kShortest = 1e-6;  // way [m]

Check& check_translation(Check& check, const taut_vec3& translation) {
    check.bounded("translation", translation, kPosition);
    return check.require(to_vec(translation).norm() >= kShortest, "translation is shorter than 1e-6");
}

Check& check_ray(Check& check, const taut_ray& ray) {
    check.vector("origin", ray.origin, kPosition);
    return check_translation(check, ray.translation).zero("reserved", ray.reserved);
}

Check& check_cast(Check& check, const taut_shape_cast& cast) {
    check.pose("pose.position", "pose.rotation", cast.pose);
    return check_translation(check, cast.translation).zero("reserved", cast.reserved);
}

// Each of an array, named by its index where there are more.
template <class Entry, class CheckEntry>
Check& check_each(Check& check, const char* name, const Entry* entries, uint32_t count, CheckEntry&& check_entry) {
    char scope[32];
    for (uint32_t i = 0; i < count && check; ++i) {
        std::snprintf(scope, sizeof scope, "%s[%u].", name, i);
        check_entry(check.within(scope), entries[i]);
    }
    return check.within("");
}

Check& check_filter(Check& check, const taut_query_filter& filter) {
    check.within("filter.")
        .struct_size(filter.struct_size, sizeof filter)
        .count("kinds", filter.kinds, 0, TAUT_QUERY_ALL_KINDS)
        .count("ignored_body_count", filter.ignored_body_count, 0, TAUT_QUERY_MAX_IGNORED)
        .count("ignored_collider_count", filter.ignored_collider_count, 0, TAUT_QUERY_MAX_IGNORED);
    if (filter.ignored_body_count > 0) check.pointer("ignored_bodies", filter.ignored_bodies);
    if (filter.ignored_collider_count > 0) check.pointer("ignored_colliders", filter.ignored_colliders);
    return check.within("");
}

// ---------------------------------------------------------------- find

taut_result find_ignored(const char* call, const World& world, const taut_query_filter& filter) {
    uint32_t unused = 0;
    taut_result found = TAUT_OK;
    for (uint32_t i = 0; i < filter.ignored_body_count && found == TAUT_OK; ++i)
        found = find_body(call, "filter.ignored_bodies", world, filter.ignored_bodies[i], unused);
    for (uint32_t i = 0; i < filter.ignored_collider_count && found == TAUT_OK; ++i)
        found = find_collider(call, "filter.ignored_colliders", world, filter.ignored_colliders[i], unused);
    return found;
}

// The shape that a query takes along.
taut_result find_convex(Check& check, const World& world, taut_shape handle, const collision::Shape*& out) {
    uint32_t index = 0;
    const taut_result found = find_shape(check.call(), "shape", world, handle, index);
    if (found != TAUT_OK) return found;
    out = &world.shapes.record[index].shape;
    return check.require(out->kind != collision::ShapeKind::plane, "shape is a plane")
        .require(out->kind != collision::ShapeKind::surface, "shape is a mesh or height field")
        .result();
}

collision::Placement to_placement(const taut_pose& pose) {
    return {to_vec(pose.position), to_quat(pose.rotation).toRotationMatrix().cast<float>()};
}

RayQuery to_query(const taut_ray& ray) { return {to_vec(ray.origin), to_vec(ray.translation)}; }

CastQuery to_query(const taut_shape_cast& cast, const collision::Shape& shape) {
    return {shape, to_placement(cast.pose), to_vec(cast.translation)};
}

// act(Sight) with the arguments checked, the world held and the filter, null for all, resolved.
template <class Act>
taut_result ask(Check& check, taut_world handle, const taut_query_filter* filter, Act&& act) {
    taut_query_filter all;
    taut_query_filter_init(&all);
    const taut_query_filter& used = filter ? *filter : all;
    if (!check_filter(check, used)) return check.result();
    return with_world(check.call(), handle, Use::read, [&](const World& world) {
        const taut_result found = find_ignored(check.call(), world, used);
        return found == TAUT_OK ? act(Sight(world, used)) : found;
    });
}

// ---------------------------------------------------------------- answers into an array

bool before(const taut_query_hit& a, const taut_query_hit& b) {
    return a.fraction < b.fraction || (a.fraction == b.fraction && a.collider.bits < b.collider.bits);
}
// By slot, which the upper bits of a handle are.
bool before(const taut_collider& a, const taut_collider& b) { return a.bits < b.bits; }

// Keeps as many as there is room for, and counts all.
template <class Item>
struct Shelf final : Sink<Item> {
    Shelf(Item* array, uint32_t most) : items(array), room(most) {}
    void take(const Item& item) override {
        if (count < room) items[count] = item;
        ++count;
    }
    Item* items;
    uint32_t room;
    uint32_t count = 0;
};

// The answers of gather(Sink&), sorted, into an array that is written only if it holds all. They wait on the stack; if
// they are too many for that, gather runs again.
template <class Item, class Gather>
taut_result collect(Check& check, const char* field, Item* out, uint32_t capacity, uint32_t* count, Gather&& gather) {
    constexpr uint32_t kFew = 64;
    Item few[kFew];
    Shelf<Item> found(few, kFew);
    gather(found);
    *count = found.count;
    if (found.count > capacity) {
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(), capacity, found.count);
    }
    if (found.count == 0) return TAUT_OK;
    if (!check.pointer(field, out)) return check.result();
    if (found.count <= kFew) {
        std::copy(few, few + found.count, out);
    } else {
        Shelf<Item> again(out, found.count);
        gather(again);
        *count = std::min(found.count, again.count);  // a host's accept may have changed its mind
    }
    std::sort(out, out + *count, [](const Item& a, const Item& b) { return before(a, b); });
    return TAUT_OK;
}

template <class Query>
taut_result collect_overlaps(Check& check, const Sight& sight, const Query& query, taut_collider* colliders,
                             uint32_t capacity, uint32_t* count) {
    return collect(check, "colliders", colliders, capacity, count,
                   [&](Sink<taut_collider>& sink) { all_overlaps(sight, query, sink); });
}

template <class Query>
taut_result collect_hits(Check& check, const Sight& sight, const Query& query, taut_query_hit* hits, uint32_t capacity,
                         uint32_t* count) {
    return collect(check, "hits", hits, capacity, count,
                   [&](Sink<taut_query_hit>& sink) { all_hits(sight, query, sink); });
}

}  // namespace

void taut_query_filter_init(taut_query_filter* filter) {
    if (!filter) return;
    *filter = {};
    filter->struct_size = sizeof *filter;
    filter->kinds = TAUT_QUERY_ALL_KINDS;
    filter->category = filter->mask = UINT64_MAX;
}

// ---------------------------------------------------------------- rays

taut_result taut_world_cast_ray(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                taut_query_hit* out) {
    Check check(__func__);
    if (!check.pointer("ray", ray).pointer("out", out) || !check_ray(check, *ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        *out = first_hit(sight, to_query(*ray));
        return TAUT_OK;
    });
}

taut_result taut_world_cast_ray_all(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                    taut_query_hit* hits, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("ray", ray).pointer("count", count) || !check_ray(check, *ray)) return check.result();
    return ask(check, world, filter,
               [&](const Sight& sight) { return collect_hits(check, sight, to_query(*ray), hits, capacity, count); });
}

taut_result taut_world_cast_ray_any(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                    int32_t* out) {
    Check check(__func__);
    if (!check.pointer("ray", ray).pointer("out", out) || !check_ray(check, *ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        *out = any_hit(sight, to_query(*ray));
        return TAUT_OK;
    });
}

taut_result taut_world_cast_rays(taut_world world, const taut_ray* rays, uint32_t count,
                                 const taut_query_filter* filter, taut_query_hit* hits) {
    Check check(__func__);
    if (count > 0 && !check.pointer("rays", rays).pointer("hits", hits)) return check.result();
    if (!check_each(check, "rays", rays, count, check_ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        for (uint32_t i = 0; i < count; ++i) hits[i] = first_hit(sight, to_query(rays[i]));
        return TAUT_OK;
    });
}

// ---------------------------------------------------------------- shapes on their way

taut_result taut_world_cast_shape(taut_world world, const taut_shape_cast* cast, const taut_query_filter* filter,
                                  taut_query_hit* out) {
    Check check(__func__);
    if (!check.pointer("cast", cast).pointer("out", out) || !check_cast(check, *cast)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), cast->shape, shape);
        if (found != TAUT_OK) return found;
        *out = first_hit(sight, to_query(*cast, *shape));
        return TAUT_OK;
    });
}

taut_result taut_world_cast_shape_all(taut_world world, const taut_shape_cast* cast, const taut_query_filter* filter,
                                      taut_query_hit* hits, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("cast", cast).pointer("count", count) || !check_cast(check, *cast)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), cast->shape, shape);
        if (found != TAUT_OK) return found;
        return collect_hits(check, sight, to_query(*cast, *shape), hits, capacity, count);
    });
}

taut_result taut_world_cast_shapes(taut_world world, const taut_shape_cast* casts, uint32_t count,
                                   const taut_query_filter* filter, taut_query_hit* hits) {
    Check check(__func__);
    if (count > 0 && !check.pointer("casts", casts).pointer("hits", hits)) return check.result();
    if (!check_each(check, "casts", casts, count, check_cast)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        for (uint32_t i = 0; i < count; ++i) {  // nothing is written unless all shapes are good
            const taut_result found = find_convex(check, sight.world(), casts[i].shape, shape);
            if (found != TAUT_OK) return found;
        }
        for (uint32_t i = 0; i < count; ++i) {
            find_convex(check, sight.world(), casts[i].shape, shape);
            hits[i] = first_hit(sight, to_query(casts[i], *shape));
        }
        return TAUT_OK;
    });
}

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

// ---------------------------------------------------------------- distances

taut_result taut_collider_closest_point(taut_collider collider, taut_pos point, taut_distance* out) {
    Check check(__func__);
    if (!check.pointer("out", out).vector("point", point, kPosition)) return check.result();
    return with(check.call(), collider, Use::read, [&](const World& world, uint32_t index) {
        *out = distance_to_point(world, to_vec(point), index);
        return TAUT_OK;
    });
}

taut_result taut_collider_distance(taut_collider a, taut_collider b, taut_distance* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), a, Use::read, [&](const World& world, uint32_t index) {
        uint32_t other = 0;
        const taut_result found = find_collider(check.call(), "b", world, b, other);
        if (found != TAUT_OK) return found;
        const auto is_convex = [&](uint32_t c) {
            const collision::ShapeKind kind = world.shapes.record[world.colliders.record[c].shape].shape.kind;
            return kind != collision::ShapeKind::plane && kind != collision::ShapeKind::surface;
        };
        check.require(is_convex(index) || is_convex(other), "both are planes, meshes or height fields");
        if (!check) return check.result();
        *out = distance_between(world, index, other);
        return TAUT_OK;
    });
}

taut_result taut_world_nearest_collider(taut_world world, taut_shape handle, const taut_pose* pose, float max_distance,
                                        const taut_query_filter* filter, taut_distance* out) {
    Check check(__func__);
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
