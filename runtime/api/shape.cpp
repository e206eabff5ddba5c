#include "api/shape_def.h"
#include "api/sized.h"

#include <cmath>

using namespace taut;

namespace {

// A plane's normal shorter than this has no direction worth keeping [1].
constexpr double kLeastNormal = 1e-6;

// Capsule, cylinder and cone: a radius and half a length along y.
template <class Def>
taut_result add_round(const char* call, collision::ShapeKind kind, taut_world world, const Def* given,
                      void (*init)(Def*), taut_shape* out) {
    Check check(call);
    Def def;
    if (!take_shape_def(check, given, init, def, out)) return check.result();
    check.number("radius", def.radius, kShapeSize).number("half_length", def.half_length, kShapeSize);
    if (!check) return check.result();
    return add_shape(check, world, {kind, Vec3f(def.radius, def.half_length, 0), nullptr}, out);
}

}  // namespace

void taut_plane_def_init_sized(taut_plane_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_plane_def& own) { init_shape_def(&own, {0, {0, 1, 0}}); });
}
void taut_box_def_init_sized(taut_box_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_box_def& own) { init_shape_def(&own, {0, {0.5f, 0.5f, 0.5f}}); });
}
void taut_sphere_def_init_sized(taut_sphere_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_sphere_def& own) { init_shape_def(&own, {0, 0.5f}); });
}
void taut_capsule_def_init_sized(taut_capsule_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_capsule_def& own) { init_shape_def(&own, {0, 0.25f, 0.5f}); });
}
void taut_hull_def_init_sized(taut_hull_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_hull_def& own) { init_shape_def(&own, {0, 0, nullptr}); });
}
void taut_cylinder_def_init_sized(taut_cylinder_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cylinder_def& own) { init_shape_def(&own, {0, 0.5f, 0.5f}); });
}
void taut_cone_def_init_sized(taut_cone_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_cone_def& own) { init_shape_def(&own, {0, 0.5f, 0.5f}); });
}
void taut_tapered_capsule_def_init_sized(taut_tapered_capsule_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_tapered_capsule_def& own) { init_shape_def(&own, {0, 0.3f, 0.2f, 0.5f}); });
}
void taut_scaled_hull_def_init_sized(taut_scaled_hull_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_scaled_hull_def& own) { init_shape_def(&own, {0, 0, {0}, {1, 1, 1}}); });
}

taut_result taut_world_add_plane(taut_world world, const taut_plane_def* given, taut_shape* out) {
    TAUT_RECORD(taut_world_add_plane, world, given, out);
    Check check(__func__);
    taut_plane_def def;
    if (!take_shape_def(check, given, taut_plane_def_init, def, out)) return check.result();
    if (!check.vector("normal", def.normal, kShapeCoordinate)) return check.result();
    const Vec3 normal = to_vec(def.normal);
    if (!check.require(normal.norm() >= kLeastNormal, "normal is 0, expected a direction")) return check.result();
    return add_shape(check, world, {collision::ShapeKind::plane, normal.normalized().cast<float>(), nullptr}, out);
}

taut_result taut_world_add_box(taut_world world, const taut_box_def* given, taut_shape* out) {
    TAUT_RECORD(taut_world_add_box, world, given, out);
    Check check(__func__);
    taut_box_def def;
    if (!take_shape_def(check, given, taut_box_def_init, def, out)) return check.result();
    if (!check.vector("half_extents", def.half_extents, kShapeSize)) return check.result();
    return add_shape(check, world, {collision::ShapeKind::box, to_vec(def.half_extents).cast<float>(), nullptr}, out);
}

taut_result taut_world_add_sphere(taut_world world, const taut_sphere_def* given, taut_shape* out) {
    TAUT_RECORD(taut_world_add_sphere, world, given, out);
    Check check(__func__);
    taut_sphere_def def;
    if (!take_shape_def(check, given, taut_sphere_def_init, def, out)) return check.result();
    if (!check.number("radius", def.radius, kShapeSize)) return check.result();
    return add_shape(check, world, {collision::ShapeKind::sphere, Vec3f(def.radius, 0, 0), nullptr}, out);
}

taut_result taut_world_add_capsule(taut_world world, const taut_capsule_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_capsule, world, def, out);
    return add_round(__func__, collision::ShapeKind::capsule, world, def, taut_capsule_def_init, out);
}

taut_result taut_world_add_cylinder(taut_world world, const taut_cylinder_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_cylinder, world, def, out);
    return add_round(__func__, collision::ShapeKind::cylinder, world, def, taut_cylinder_def_init, out);
}

taut_result taut_world_add_cone(taut_world world, const taut_cone_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_cone, world, def, out);
    return add_round(__func__, collision::ShapeKind::cone, world, def, taut_cone_def_init, out);
}

taut_result taut_world_add_tapered_capsule(taut_world world, const taut_tapered_capsule_def* given, taut_shape* out) {
    TAUT_RECORD(taut_world_add_tapered_capsule, world, given, out);
    Check check(__func__);
    taut_tapered_capsule_def def;
    if (!take_shape_def(check, given, taut_tapered_capsule_def_init, def, out)) return check.result();
    check.number("bottom_radius", def.bottom_radius, kShapeSize).number("top_radius", def.top_radius, kShapeSize);
    check.number("half_length", def.half_length, kShapeSize);
    // A relative 1e-4 leaves the side's normal a cosine above rounding.
    check.require(std::fabs(def.bottom_radius - def.top_radius) < 2 * def.half_length * (1 - 1e-4f),
                  "bottom_radius and top_radius differ by 2 half_length or more: one ball is inside the other");
    if (!check) return check.result();
    const Vec3f size(def.bottom_radius, def.half_length, def.top_radius);
    return add_shape(check, world, {collision::ShapeKind::tapered_capsule, size, nullptr}, out);
}

taut_result taut_world_add_scaled_hull(taut_world handle, const taut_scaled_hull_def* given, taut_shape* out) {
    TAUT_RECORD(taut_world_add_scaled_hull, handle, given, out);
    Check check(__func__);
    taut_scaled_hull_def def;
    if (!take_shape_def(check, given, taut_scaled_hull_def_init, def, out)) return check.result();
    check.zero("reserved", def.reserved);
    const taut_vec3 sizes = {std::fabs(def.scale.x), std::fabs(def.scale.y), std::fabs(def.scale.z)};
    if (!check.vector("scale", sizes, kShapeScale)) return check.result();
    return with_world(check.call(), handle, Use::write, [&](World& world) {
        uint32_t index = 0;
        const taut_result found = find_shape(check.call(), "hull", world, def.hull, index);
        if (found != TAUT_OK) return found;
        const collision::Shape& source = world.shapes[index].shape;
        if (!check.require(source.kind == collision::ShapeKind::hull, "hull is a shape of another kind")) {
            return check.result();
        }
        const Vec3f factors = to_vec(def.scale).cast<float>();
        for (const Vec3f& vertex : collision::hull_vertices(*source.hull)) {
            const bool fits = (vertex.cwiseProduct(factors).cwiseAbs().array() <= TAUT_SHAPE_MAX_SIZE).all();
            if (!check.require(fits, "scale takes a point beyond TAUT_SHAPE_MAX_SIZE")) return check.result();
        }
        const char* reason = "";
        auto hull = collision::scale_hull(*source.hull, factors, TAUT_SHAPE_MIN_SIZE, &reason, world.memory);
        if (!hull) return refuse(TAUT_INVALID_ARGUMENT, "%s: scale leaves no hull: %s", check.call(), reason);
        return insert_shape(check, world, {collision::ShapeKind::hull, Vec3f::Zero(), std::move(hull)}, out);
    });
}

taut_result taut_shape_remove(taut_shape handle) {
    TAUT_RECORD(taut_shape_remove, handle);
    const char* call = __func__;
    return with(call, handle, Use::write, [&](World& world, uint32_t shape) {
        const uint32_t users = world.shapes[shape].users;
        if (users > 0) return refuse(TAUT_IN_USE, "%s: shape is used by %u bodies", call, users);
        world.shapes.remove(shape);
        return TAUT_OK;
    });
}

int32_t taut_shape_is_valid(taut_shape handle) { return is_valid(handle); }

taut_result taut_shape_get_mass_properties_sized(taut_shape handle, float density, taut_mass_properties* first,
                                                 uint32_t size) {
    const RecordOut<taut_mass_properties> out(first, size);
    Check check("taut_shape_get_mass_properties");
    if (!check.number("density", density, kDensity).pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes[index].shape;
        check.require(shape.kind != collision::ShapeKind::plane, "shape is a plane, which has no volume")
            .require(shape.kind != collision::ShapeKind::surface,
                     "shape is a mesh or height field, which has no volume");
        if (!check) return check.result();
        const collision::MassProperties mass = collision::mass_properties(shape, density);
        *out = {static_cast<float>(mass.mass), to_vec3(mass.centre), to_sym3(mass.inertia)};
        return TAUT_OK;
    });
}
