#include "api/shape_def.h"

using namespace taut;

namespace {

// A plane's normal shorter than this has no direction worth keeping [1].
constexpr double kLeastNormal = 1e-6;

}  // namespace

void taut_plane_def_init(taut_plane_def* def) { init_shape_def(def, {0, {0, 1, 0}}); }
void taut_box_def_init(taut_box_def* def) { init_shape_def(def, {0, {0.5f, 0.5f, 0.5f}}); }
void taut_sphere_def_init(taut_sphere_def* def) { init_shape_def(def, {0, 0.5f}); }
void taut_capsule_def_init(taut_capsule_def* def) { init_shape_def(def, {0, 0.25f, 0.5f}); }
void taut_hull_def_init(taut_hull_def* def) { init_shape_def(def, {0, 0, nullptr}); }

taut_result taut_world_add_plane(taut_world world, const taut_plane_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    if (!check.vector("normal", def->normal, kShapeCoordinate)) return check.result();
    const Vec3 normal = to_vec(def->normal);
    if (!check.require(normal.norm() >= kLeastNormal, "normal is 0, expected a direction")) return check.result();
    return add_shape(check, world, {collision::ShapeKind::plane, normal.normalized().cast<float>(), nullptr}, out);
}

taut_result taut_world_add_box(taut_world world, const taut_box_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    if (!check.vector("half_extents", def->half_extents, kShapeSize)) return check.result();
    return add_shape(check, world, {collision::ShapeKind::box, to_vec(def->half_extents).cast<float>(), nullptr}, out);
}

taut_result taut_world_add_sphere(taut_world world, const taut_sphere_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    if (!check.number("radius", def->radius, kShapeSize)) return check.result();
    return add_shape(check, world, {collision::ShapeKind::sphere, Vec3f(def->radius, 0, 0), nullptr}, out);
}

taut_result taut_world_add_capsule(taut_world world, const taut_capsule_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    check.number("radius", def->radius, kShapeSize).number("half_length", def->half_length, kShapeSize);
    if (!check) return check.result();
    const Vec3f size(def->radius, def->half_length, 0);
    return add_shape(check, world, {collision::ShapeKind::capsule, size, nullptr}, out);
}

taut_result taut_world_add_hull(taut_world world, const taut_hull_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    if (!check.count("point_count", def->point_count, 4, UINT32_MAX).pointer("points", def->points)) {
        return check.result();
    }
    for (uint32_t i = 0; i < def->point_count; ++i) {
        if (!check.vector("points", def->points[i], kShapeCoordinate)) return check.result();
    }
    return contain(check.call(), [&] {
        std::vector<Vec3f> points(def->point_count);
        for (uint32_t i = 0; i < def->point_count; ++i) points[i] = to_vec(def->points[i]).cast<float>();
        const char* reason = "";
        auto hull = collision::build_hull(points, TAUT_HULL_MAX_VERTICES, TAUT_SHAPE_MIN_SIZE, &reason);
        if (!hull) return refuse(TAUT_INVALID_ARGUMENT, "%s: points make no hull: %s", check.call(), reason);
        return add_shape(check, world, {collision::ShapeKind::hull, Vec3f::Zero(), std::move(hull)}, out);
    });
}

taut_result taut_shape_remove(taut_shape handle) {
    const char* call = __func__;
    return with(call, handle, Use::write, [&](World& world, uint32_t shape) {
        const uint32_t users = world.shapes.record[shape].users;
        if (users > 0) return refuse(TAUT_IN_USE, "%s: shape is used by %u bodies", call, users);
        world.shapes.remove(shape);
        return TAUT_OK;
    });
}

int32_t taut_shape_is_valid(taut_shape handle) { return is_valid(handle); }

taut_result taut_shape_mass_properties(taut_shape handle, float density, taut_mass_properties* out) {
    Check check(__func__);
    if (!check.number("density", density, kDensity).pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes.record[index].shape;
        check.require(shape.kind != collision::ShapeKind::plane, "shape is a plane, which has no volume")
            .require(shape.kind != collision::ShapeKind::surface,
                     "shape is a mesh or height field, which has no volume");
        if (!check) return check.result();
        const collision::MassProperties mass = collision::mass_properties(shape, density);
        *out = {static_cast<float>(mass.mass), to_vec3(mass.centre), to_sym3(mass.inertia)};
        return TAUT_OK;
    });
}
