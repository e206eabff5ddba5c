#include "api/query_parts.h"
#include "api/sized.h"

namespace taut {
namespace {

constexpr double kShortest = 1e-6;  // way [m]

}  // namespace

Check& check_translation(Check& check, const taut_vec3& translation) {
    check.bounded("translation", translation, kPosition);
    return check.require(to_vec(translation).norm() >= kShortest, "translation is shorter than 1e-6");
}

Check& check_ray(Check& check, const taut_ray& ray) {
    check.vector("origin", ray.origin, kPosition);
    return check_translation(check, ray.translation).zero("reserved", ray.reserved);
}

Check& check_filter(Check& check, const taut_query_filter& filter) {
    check.within("filter.")
        .count("kinds", filter.kinds, 0, TAUT_QUERY_ALL_KINDS | TAUT_QUERY_SENSOR)
        .count("ignored_body_count", filter.ignored_body_count, 0, TAUT_QUERY_MAX_IGNORED)
        .count("ignored_collider_count", filter.ignored_collider_count, 0, TAUT_QUERY_MAX_IGNORED);
    if (filter.ignored_body_count > 0) check.pointer("ignored_bodies", filter.ignored_bodies);
    if (filter.ignored_collider_count > 0) check.pointer("ignored_colliders", filter.ignored_colliders);
    return check.within("");
}

taut_result find_ignored(const char* call, const World& world, const taut_query_filter& filter) {
    uint32_t unused = 0;
    taut_result found = TAUT_OK;
    for (uint32_t i = 0; i < filter.ignored_body_count && found == TAUT_OK; ++i)
        found = find_body(call, "filter.ignored_bodies", world, filter.ignored_bodies[i], unused);
    for (uint32_t i = 0; i < filter.ignored_collider_count && found == TAUT_OK; ++i)
        found = find_collider(call, "filter.ignored_colliders", world, filter.ignored_colliders[i], unused);
    return found;
}

taut_result find_convex(Check& check, const World& world, taut_shape handle, const collision::Shape*& out) {
    uint32_t index = 0;
    const taut_result found = find_shape(check.call(), "shape", world, handle, index);
    if (found != TAUT_OK) return found;
    out = &world.shapes[index].shape;
    return check.require(out->kind != collision::ShapeKind::plane, "shape is a plane")
        .require(out->kind != collision::ShapeKind::surface, "shape is a mesh or height field")
        .result();
}

collision::Placement to_placement(const taut_pose& pose) {
    return {to_vec(pose.position), to_quat(pose.rotation).toRotationMatrix().cast<float>()};
}

}  // namespace taut

using namespace taut;

void taut_query_filter_init_sized(taut_query_filter* filter, uint32_t size) {
    give_defaults(filter, size, [](taut_query_filter& own) {
        own = {};
        own.struct_size = sizeof own;
        own.kinds = TAUT_QUERY_ALL_KINDS;
        own.category = own.mask = UINT64_MAX;
    });
}
