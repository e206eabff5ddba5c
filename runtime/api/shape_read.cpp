// Reading shapes back: kind, defs, bounds.
#include <taut/shape.h>

#include "api/sized.h"

using namespace taut;

namespace {

using collision::Shape;
using collision::ShapeKind;

// fill(shape's size) gives the def.
template <class Def, class Fill>
taut_result read_def(const char* call, ShapeKind kind, const char* refusal, taut_shape handle, Def* out, Fill&& fill) {
    Check check(call);
    if (!check.pointer("out", out)) return check.result();
    if (!check.struct_size(out->struct_size, sizeof *out, alignof(Def))) return check.result();
    return with(call, handle, Use::read, [&](const World& world, uint32_t index) {
        const Shape& shape = world.shapes[index].shape;
        if (!check.require(shape.kind == kind, refusal)) return check.result();
        give_def(fill(shape.size), out);
        return TAUT_OK;
    });
}

taut_vec3 vec3(const Vec3f& v) { return {v.x(), v.y(), v.z()}; }

}  // namespace

// The kinds of the interface are those of the collision room, by the same numbers.
static_assert(int(ShapeKind::plane) == TAUT_SHAPE_PLANE && int(ShapeKind::box) == TAUT_SHAPE_BOX &&
              int(ShapeKind::sphere) == TAUT_SHAPE_SPHERE && int(ShapeKind::capsule) == TAUT_SHAPE_CAPSULE &&
              int(ShapeKind::hull) == TAUT_SHAPE_HULL && int(ShapeKind::cylinder) == TAUT_SHAPE_CYLINDER &&
              int(ShapeKind::cone) == TAUT_SHAPE_CONE &&
              int(ShapeKind::tapered_capsule) == TAUT_SHAPE_TAPERED_CAPSULE &&
              int(ShapeKind::surface) == TAUT_SHAPE_SURFACE && collision::kShapeKinds == TAUT_SHAPE_SURFACE + 1);

taut_result taut_shape_get_kind(taut_shape handle, taut_shape_kind* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        *out = static_cast<taut_shape_kind>(world.shapes[index].shape.kind);
        return TAUT_OK;
    });
}

taut_result taut_shape_get_plane(taut_shape handle, taut_plane_def* out) {
    return read_def(__func__, ShapeKind::plane, "shape is not a plane", handle, out, [](const Vec3f& size) {
        return taut_plane_def{sizeof(taut_plane_def), vec3(size)};
    });
}

taut_result taut_shape_get_box(taut_shape handle, taut_box_def* out) {
    return read_def(__func__, ShapeKind::box, "shape is not a box", handle, out, [](const Vec3f& size) {
        return taut_box_def{sizeof(taut_box_def), vec3(size)};
    });
}

taut_result taut_shape_get_sphere(taut_shape handle, taut_sphere_def* out) {
    return read_def(__func__, ShapeKind::sphere, "shape is not a sphere", handle, out, [](const Vec3f& size) {
        return taut_sphere_def{sizeof(taut_sphere_def), size.x()};
    });
}

taut_result taut_shape_get_capsule(taut_shape handle, taut_capsule_def* out) {
    return read_def(__func__, ShapeKind::capsule, "shape is not a capsule", handle, out, [](const Vec3f& size) {
        return taut_capsule_def{sizeof(taut_capsule_def), size.x(), size.y()};
    });
}

taut_result taut_shape_get_cylinder(taut_shape handle, taut_cylinder_def* out) {
    return read_def(__func__, ShapeKind::cylinder, "shape is not a cylinder", handle, out, [](const Vec3f& size) {
        return taut_cylinder_def{sizeof(taut_cylinder_def), size.x(), size.y()};
    });
}

taut_result taut_shape_get_cone(taut_shape handle, taut_cone_def* out) {
    return read_def(__func__, ShapeKind::cone, "shape is not a cone", handle, out, [](const Vec3f& size) {
        return taut_cone_def{sizeof(taut_cone_def), size.x(), size.y()};
    });
}

taut_result taut_shape_get_tapered_capsule(taut_shape handle, taut_tapered_capsule_def* out) {
    return read_def(__func__, ShapeKind::tapered_capsule, "shape is not a tapered capsule", handle, out,
                    [](const Vec3f& size) {
                        return taut_tapered_capsule_def{sizeof(taut_tapered_capsule_def), size.x(), size.z(), size.y()};
                    });
}

taut_result taut_shape_get_bounds(taut_shape handle, taut_vec3* low, taut_vec3* high) {
    Check check(__func__);
    if (!check.pointer("low", low).pointer("high", high)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const Shape& shape = world.shapes[index].shape;
        if (!check.require(shape.kind != ShapeKind::plane, "shape is a plane, which has no bounds")) {
            return check.result();
        }
        const collision::Box box = collision::bounds(shape, {Vec3::Zero(), Mat3f::Identity()});
        *low = vec3(box.lo);
        *high = vec3(box.hi);
        return TAUT_OK;
    });
}
