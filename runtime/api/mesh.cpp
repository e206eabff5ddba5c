// The part of shape.h about shapes that are built, and the triangles of those.
#include "api/shape_build.h"
#include "api/shape_def.h"
#include "api/sized.h"
#include "collision/distance_grid.h"

using namespace taut;

namespace {

constexpr Range kScale{-1000, 1000};
constexpr float kLeastScale = 1e-3f;

Check& check_surface(Check& check, const collision::Shape& shape) {
    return check.require(shape.kind == collision::ShapeKind::surface, "shape is neither a mesh nor a height field");
}

class PointsOut final : public collision::PointSink {
public:
    explicit PointsOut(taut_vec3* out) : out_(out) {}
    void take(const Vec3f& point) override { *out_++ = {point.x(), point.y(), point.z()}; }

private:
    taut_vec3* out_;
};

taut_result copy_triangles(Check& check, const collision::Shape& shape, taut_vec3* positions, uint32_t capacity,
                           uint32_t* count) {
    *count =
        3 * (shape.hull ? collision::hull_triangle_count(*shape.hull) : collision::surface_counts(shape).triangles);
    if (!positions || capacity < *count) {
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(),
                      positions ? capacity : 0, *count);
    }
    PointsOut points(positions);
    if (shape.hull)
        collision::hull_triangles(*shape.hull, points);
    else
        collision::surface_triangles(shape, points);
    return TAUT_OK;
}

template <class Def>
taut_result add_built(const char* call, taut_world handle, const Def* given, taut_shape* out) {
    Check check(call);
    Def def;
    if (!take_shape_def(check, given, init_def, def, out) || !check_build(check, def)) return check.result();
    return with_world(call, handle, Use::write, [&](World& world) {
        collision::Shape shape = build_shape(check, def, world.memory);
        return check ? insert_shape(check, world, std::move(shape), out) : check.result();
    });
}

}  // namespace

void taut_mesh_def_init_sized(taut_mesh_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_mesh_def& own) { init_shape_def(&own, {}); });
}
void taut_height_field_def_init_sized(taut_height_field_def* def, uint32_t size) {
    give_defaults(def, size, [](taut_height_field_def& own) { init_shape_def(&own, {0, 0, 0, 1, 1, 0, nullptr}); });
}

taut_result taut_world_add_hull(taut_world world, const taut_hull_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_hull, world, def, out);
    return add_built(__func__, world, def, out);
}
taut_result taut_world_add_mesh(taut_world world, const taut_mesh_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_mesh, world, def, out);
    return add_built(__func__, world, def, out);
}
taut_result taut_world_add_height_field(taut_world world, const taut_height_field_def* def, taut_shape* out) {
    TAUT_RECORD(taut_world_add_height_field, world, def, out);
    return add_built(__func__, world, def, out);
}

taut_result taut_shape_add_scaled(taut_shape mesh, taut_vec3 scale, taut_shape* out) {
    TAUT_RECORD(taut_shape_add_scaled, mesh, scale, out);
    Check check(__func__);
    check.pointer("out", out).vector("scale", scale, kScale);
    const Vec3f factor = to_vec(scale).cast<float>();
    check.require(factor.cwiseAbs().minCoeff() >= kLeastScale, "scale has a component below 1e-3 in size");
    if (!check) return check.result();
    return with(check.call(), mesh, Use::write, [&](World& world, uint32_t index) {
        collision::Shape shape = world.shapes[index].shape;
        if (!check_surface(check, shape)) return check.result();
        shape.size = shape.size.cwiseProduct(factor);
        shape.distance = nullptr;
        const collision::Box box = collision::bounds(shape, {Vec3::Zero(), Mat3f::Identity()});
        check.vector("scaled box", to_vec3(box.lo.cast<double>()), kShapeCoordinate)
            .vector("scaled box", to_vec3(box.hi.cast<double>()), kShapeCoordinate)
            .require(shape.size.cwiseAbs().minCoeff() >= kLeastScale, "scales together are below 1e-3 in size")
            .require(world.shapes.ids.slots() < Shapes::kInner, "too many shapes", TAUT_LIMIT);
        if (!check) return check.result();
        *out = world.shape_handle(world.shapes.add(std::move(shape)));
        return TAUT_OK;
    });
}

taut_result taut_shape_get_triangles(taut_shape handle, taut_vec3* positions, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes[index].shape;
        check.require(shape.hull || shape.surface, "shape is neither a hull nor a mesh nor a height field");
        if (!check) return check.result();
        return copy_triangles(check, shape, positions, capacity, count);
    });
}

taut_result taut_shape_sample_distance(taut_shape mesh, float cell_size) {
    TAUT_RECORD(taut_shape_sample_distance, mesh, cell_size);
    Check check(__func__);
    if (cell_size != 0) check.number("cell_size", cell_size, kShapeSize);
    if (!check) return check.result();
    return with(check.call(), mesh, Use::write, [&](World& world, uint32_t index) {
        collision::Shape& shape = world.shapes[index].shape;
        if (!check_surface(check, shape)) return check.result();
        const collision::Box& box = world.shapes[index].box;
        const char* reason = nullptr;
        auto grid = collision::sample_distance(
            shape, cell_size > 0 ? double(cell_size) : double((box.hi - box.lo).maxCoeff()) / 64, &reason,
            world.memory);
        if (!grid) return refuse(TAUT_UNSUPPORTED, "%s: %s", check.call(), reason);
        shape.distance = std::move(grid);
        return TAUT_OK;
    });
}

taut_result taut_shape_get_mesh_info_sized(taut_shape handle, taut_mesh_info* first, uint32_t size) {
    const RecordOut<taut_mesh_info> out(first, size);
    Check check("taut_shape_get_mesh_info");
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes[index].shape;
        if (!check_surface(check, shape)) return check.result();
        const collision::SurfaceCounts counts = collision::surface_counts(shape);
        *out = {counts.triangles, counts.facets, counts.without_area, counts.duplicates};
        return TAUT_OK;
    });
}
