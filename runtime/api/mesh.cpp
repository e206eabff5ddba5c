// The part of shape.h about surfaces of triangles, and the triangles of shapes that have some.
#include <cmath>

#include "api/shape_def.h"
#include "collision/distance_grid.h"

using namespace taut;

namespace {

constexpr Range kScale{-1000, 1000};
constexpr float kLeastScale = 1e-3f;

Check& check_surface(Check& check, const collision::Shape& shape) {
    return check.require(shape.kind == collision::ShapeKind::surface, "shape is neither a mesh nor a height field");
}

void triangles_of(const collision::Shape& shape, std::vector<Vec3f>& points) {
    if (shape.kind == collision::ShapeKind::surface) return collision::surface_triangles(shape, points);
    std::vector<uint32_t> corners;
    collision::hull_triangles(*shape.hull, corners);
    const std::span<const Vec3f> vertices = collision::hull_vertices(*shape.hull);
    for (const uint32_t corner : corners) points.push_back(vertices[corner]);
}

taut_result copy_triangles(Check& check, const collision::Shape& shape, taut_vec3* positions, uint32_t capacity,
                           uint32_t* count) {
    std::vector<Vec3f> points;
    triangles_of(shape, points);
    *count = static_cast<uint32_t>(points.size());
    if (!positions || capacity < points.size()) {
        return refuse(TAUT_TOO_SMALL, "%s: capacity is %u, expected at least %u", check.call(),
                      positions ? capacity : 0, *count);
    }
    for (const Vec3f& p : points) *positions++ = {p.x(), p.y(), p.z()};
    return TAUT_OK;
}

}  // namespace

void taut_mesh_def_init(taut_mesh_def* def) { init_shape_def(def, {}); }
void taut_height_field_def_init(taut_height_field_def* def) { init_shape_def(def, {0, 0, 0, 1, 1, 0, nullptr}); }

taut_result taut_world_add_mesh(taut_world world, const taut_mesh_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    check.count("vertex_count", def->vertex_count, 3, UINT32_MAX)
        .count("triangle_count", def->triangle_count, 1, TAUT_MESH_MAX_TRIANGLES)
        .pointer("vertices", def->vertices)
        .pointer("indices", def->indices)
        .boolean("two_sided", def->two_sided);
    for (uint32_t i = 0; check && i < def->vertex_count; ++i)
        check.vector("vertices", def->vertices[i], kShapeCoordinate);
    for (uint32_t i = 0; check && i < 3 * def->triangle_count; ++i)
        check.count("indices", def->indices[i], 0, def->vertex_count - 1);
    if (!check) return check.result();
    return contain(check.call(), [&] {
        std::vector<Vec3f> vertices(def->vertex_count);
        for (uint32_t i = 0; i < def->vertex_count; ++i) vertices[i] = to_vec(def->vertices[i]).cast<float>();
        auto mesh = collision::build_mesh(vertices, {def->indices, 3 * size_t{def->triangle_count}}, def->two_sided);
        if (!check.require(mesh != nullptr, "no triangle has an area")) return check.result();
        return add_shape(check, world, {collision::ShapeKind::surface, Vec3f::Ones(), nullptr, std::move(mesh)}, out);
    });
}

taut_result taut_world_add_height_field(taut_world world, const taut_height_field_def* def, taut_shape* out) {
    Check check(__func__);
    if (!check_shape_def(check, def, out)) return check.result();
    check.count("rows", def->rows, 2, TAUT_HEIGHT_FIELD_MAX_SIDE)
        .count("columns", def->columns, 2, TAUT_HEIGHT_FIELD_MAX_SIDE)
        .number("row_spacing", def->row_spacing, kShapeSize)
        .number("column_spacing", def->column_spacing, kShapeSize)
        .zero("reserved", def->reserved)
        .pointer("heights", def->heights);
    if (!check) return check.result();
    check.number("(rows - 1) * row_spacing", static_cast<float>(def->rows - 1) * def->row_spacing, kShapeSize)
        .number("(columns - 1) * column_spacing", static_cast<float>(def->columns - 1) * def->column_spacing,
                kShapeSize);
    const size_t count = size_t{def->rows} * def->columns;
    for (size_t i = 0; check && i < count; ++i)
        if (!std::isnan(def->heights[i])) check.number("heights", def->heights[i], kShapeCoordinate);
    if (!check) return check.result();
    return contain(check.call(), [&] {
        auto field = collision::build_height_field(
            {def->rows, def->columns, def->column_spacing, def->row_spacing, {def->heights, count}});
        if (!check.require(field != nullptr, "heights have holes everywhere")) return check.result();
        return add_shape(check, world, {collision::ShapeKind::surface, Vec3f::Ones(), nullptr, std::move(field)}, out);
    });
}

taut_result taut_shape_add_scaled(taut_shape mesh, taut_vec3 scale, taut_shape* out) {
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

taut_result taut_shape_hull_triangles(taut_shape handle, taut_vec3* positions, uint32_t capacity, uint32_t* count) {
    Check check(__func__);
    if (!check.pointer("count", count)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes[index].shape;
        if (!check.require(shape.kind == collision::ShapeKind::hull, "shape is not a hull")) return check.result();
        return copy_triangles(check, shape, positions, capacity, count);
    });
}

taut_result taut_shape_triangles(taut_shape handle, taut_vec3* positions, uint32_t capacity, uint32_t* count) {
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
    Check check(__func__);
    if (cell_size != 0) check.number("cell_size", cell_size, kShapeSize);
    if (!check) return check.result();
    return with(check.call(), mesh, Use::write, [&](World& world, uint32_t index) {
        collision::Shape& shape = world.shapes[index].shape;
        if (!check_surface(check, shape)) return check.result();
        const collision::Box& box = world.shapes[index].box;
        const char* reason = nullptr;
        auto grid = collision::sample_distance(
            shape, cell_size > 0 ? double(cell_size) : double((box.hi - box.lo).maxCoeff()) / 64, &reason);
        if (!grid) return refuse(TAUT_UNSUPPORTED, "%s: %s", check.call(), reason);
        shape.distance = std::move(grid);
        return TAUT_OK;
    });
}

taut_result taut_shape_get_mesh_info(taut_shape handle, taut_mesh_info* out) {
    Check check(__func__);
    if (!check.pointer("out", out)) return check.result();
    return with(check.call(), handle, Use::read, [&](const World& world, uint32_t index) {
        const collision::Shape& shape = world.shapes[index].shape;
        if (!check_surface(check, shape)) return check.result();
        const collision::SurfaceCounts counts = collision::surface_counts(shape);
        *out = {counts.triangles, counts.facets, counts.without_area, counts.duplicates};
        return TAUT_OK;
    });
}
