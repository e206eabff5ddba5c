// Triangles of cloths and solids.
#include "api/query_parts.h"
#include "api/sized.h"
#include "queries/surfaces.h"

using namespace taut;

taut_result taut_world_cast_ray_surface_sized(taut_world world, const taut_ray* ray, const taut_query_filter* filter,
                                              taut_surface_hit* first, uint32_t size) {
    const RecordOut<taut_surface_hit> out(first, size);
    Check check("taut_world_cast_ray_surface");
    if (!check.pointer("ray", ray).pointer("out", out) || !check_ray(check, *ray)) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        *out = first_surface(sight, {to_vec(ray->origin), to_vec(ray->translation)});
        return TAUT_OK;
    });
}

taut_result taut_world_closest_surface_sized(taut_world world, taut_pos point, float max_distance,
                                             const taut_query_filter* filter, taut_surface_hit* first, uint32_t size) {
    const RecordOut<taut_surface_hit> out(first, size);
    Check check("taut_world_closest_surface");
    check.pointer("out", out).vector("point", point, kPosition).number("max_distance", max_distance, kQueryDistance);
    if (!check) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        *out = nearest_surface(sight, to_vec(point), max_distance);
        return TAUT_OK;
    });
}

taut_result taut_world_overlap_surfaces_sized(taut_world world, taut_pos point, float radius,
                                              const taut_query_filter* filter, taut_surface_hit* first,
                                              uint32_t capacity, uint32_t* count, uint32_t size) {
    const RecordOut<taut_surface_hit> hits(first, size);
    Check check("taut_world_overlap_surfaces");
    check.pointer("count", count).vector("point", point, kPosition).number("radius", radius, kQueryDistance);
    if (!check) return check.result();
    return ask(check, world, filter, [&](const Sight& sight) {
        return collect(check, "hits", hits, capacity, count,
                       [&](Sink<taut_surface_hit>& sink) { all_surfaces(sight, to_vec(point), radius, sink); });
    });
}
