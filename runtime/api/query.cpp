// Rays and shapes on their way.
#include <cstdio>

#include "api/query_parts.h"
#include "api/sized.h"

using namespace taut;

namespace {

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

RayQuery to_query(const taut_ray& ray) { return {to_vec(ray.origin), to_vec(ray.translation)}; }

CastQuery to_query(const taut_shape_cast& cast, const collision::Shape& shape) {
    return {shape, to_placement(cast.pose), to_vec(cast.translation)};
}

template <class Query>
taut_result collect_hits(Check& check, const Sight& sight, const Query& query, const RecordOut<taut_query_hit>& hits,
                         uint32_t capacity, uint32_t* count) {
    return collect(check, "hits", hits, capacity, count,
                   [&](Sink<taut_query_hit>& sink) { all_hits(sight, query, sink); });
}

}  // namespace

// ---------------------------------------------------------------- rays

taut_result taut_world_cast_ray_sized(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                      taut_query_hit* first, uint32_t size) {
    const RecordOut<taut_query_hit> out(first, size);
    Check check("taut_world_cast_ray");
    if (!check.pointer("ray", ray).pointer("out", out) || !check_ray(check, *ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        *out = first_hit(sight, to_query(*ray));
        return TAUT_OK;
    });
}

taut_result taut_world_cast_ray_all_sized(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                          taut_query_hit* first, uint32_t capacity, uint32_t* count, uint32_t size) {
    const RecordOut<taut_query_hit> hits(first, size);
    Check check("taut_world_cast_ray_all");
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

taut_result taut_world_cast_rays_sized(taut_world world, const taut_ray* rays, uint32_t count,
                                       const taut_query_filter* filter, taut_query_hit* first, uint32_t size) {
    const RecordOut<taut_query_hit> hits(first, size);
    Check check("taut_world_cast_rays");
    if (count > 0 && !check.pointer("rays", rays).pointer("hits", hits)) return check.result();
    if (!check_each(check, "rays", rays, count, check_ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        for (uint32_t i = 0; i < count; ++i) hits[i] = first_hit(sight, to_query(rays[i]));
        return TAUT_OK;
    });
}

taut_result taut_collider_cast_ray_sized(taut_collider collider, const taut_ray* ray, taut_query_hit* first,
                                         uint32_t size) {
    const RecordOut<taut_query_hit> out(first, size);
    Check check("taut_collider_cast_ray");
    if (!check.pointer("ray", ray).pointer("out", out) || !check_ray(check, *ray)) return check.result();
    return with(check.call(), collider, Use::read, [&](const World& world, uint32_t index) {
        *out = hit_on(world, index, to_query(*ray));
        return TAUT_OK;
    });
}

// ---------------------------------------------------------------- shapes on their way

taut_result taut_world_cast_shape_sized(taut_world world, const taut_shape_cast* cast, const taut_query_filter* filter,
                                        taut_query_hit* first, uint32_t size) {
    const RecordOut<taut_query_hit> out(first, size);
    Check check("taut_world_cast_shape");
    if (!check.pointer("cast", cast).pointer("out", out) || !check_cast(check, *cast)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), cast->shape, shape);
        if (found != TAUT_OK) return found;
        *out = first_hit(sight, to_query(*cast, *shape));
        return TAUT_OK;
    });
}

taut_result taut_world_cast_shape_all_sized(taut_world world, const taut_shape_cast* cast,
                                            const taut_query_filter* filter, taut_query_hit* first, uint32_t capacity,
                                            uint32_t* count, uint32_t size) {
    const RecordOut<taut_query_hit> hits(first, size);
    Check check("taut_world_cast_shape_all");
    if (!check.pointer("cast", cast).pointer("count", count) || !check_cast(check, *cast)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        const collision::Shape* shape = nullptr;
        const taut_result found = find_convex(check, sight.world(), cast->shape, shape);
        if (found != TAUT_OK) return found;
        return collect_hits(check, sight, to_query(*cast, *shape), hits, capacity, count);
    });
}

taut_result taut_world_cast_shapes_sized(taut_world world, const taut_shape_cast* casts, uint32_t count,
                                         const taut_query_filter* filter, taut_query_hit* first, uint32_t size) {
    const RecordOut<taut_query_hit> hits(first, size);
    Check check("taut_world_cast_shapes");
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
