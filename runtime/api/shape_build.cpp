#include "api/shape_build.h"

#include <cmath>

namespace taut {
namespace {

Array<Vec3f> points_of(const taut_vec3* points, uint32_t count, Memory& memory) {
    Array<Vec3f> out(memory);
    out.reserve(count);
    for (uint32_t i = 0; i < count; ++i) out.emplace_back(points[i].x, points[i].y, points[i].z);
    return out;
}

void check_points(Check& check, const char* field, const taut_vec3* points, uint32_t count) {
    for (uint32_t i = 0; check && i < count; ++i) check.vector(field, points[i], kShapeCoordinate);
}

collision::Shape surface_of(std::shared_ptr<const collision::Surface> surface) {
    return {collision::ShapeKind::surface, Vec3f::Ones(), nullptr, std::move(surface)};
}

}  // namespace

bool check_build(Check& check, const taut_hull_def& def) {
    check.count("point_count", def.point_count, 4, UINT32_MAX).pointer("points", def.points);
    check_points(check, "points", def.points, def.point_count);
    return static_cast<bool>(check);
}

collision::Shape build_shape(Check& check, const taut_hull_def& def, Memory& memory) {
    const char* reason = "";
    auto hull = collision::build_hull(points_of(def.points, def.point_count, memory), TAUT_HULL_MAX_VERTICES,
                                      TAUT_SHAPE_MIN_SIZE, &reason, memory);
    if (!hull) check.refuse_with("points make no hull", reason);
    return {collision::ShapeKind::hull, Vec3f::Zero(), std::move(hull)};
}

bool check_build(Check& check, const taut_mesh_def& def) {
    check.count("vertex_count", def.vertex_count, 3, UINT32_MAX)
        .count("triangle_count", def.triangle_count, 1, TAUT_MESH_MAX_TRIANGLES)
        .pointer("vertices", def.vertices)
        .pointer("indices", def.indices)
        .boolean("two_sided", def.two_sided);
    check_points(check, "vertices", def.vertices, def.vertex_count);
    for (uint32_t i = 0; check && i < 3 * def.triangle_count; ++i)
        check.count("indices", def.indices[i], 0, def.vertex_count - 1);
    return static_cast<bool>(check);
}

collision::Shape build_shape(Check& check, const taut_mesh_def& def, Memory& memory) {
    auto mesh = collision::build_mesh(points_of(def.vertices, def.vertex_count, memory),
                                      {def.indices, 3 * size_t{def.triangle_count}}, def.two_sided != 0, memory);
    check.require(mesh != nullptr, "no triangle has an area");
    return surface_of(std::move(mesh));
}

bool check_build(Check& check, const taut_height_field_def& def) {
    check.count("rows", def.rows, 2, TAUT_HEIGHT_FIELD_MAX_SIDE)
        .count("columns", def.columns, 2, TAUT_HEIGHT_FIELD_MAX_SIDE)
        .number("row_spacing", def.row_spacing, kShapeSize)
        .number("column_spacing", def.column_spacing, kShapeSize)
        .zero("reserved", def.reserved)
        .pointer("heights", def.heights);
    if (!check) return false;
    check.number("(rows - 1) * row_spacing", static_cast<float>(def.rows - 1) * def.row_spacing, kShapeSize)
        .number("(columns - 1) * column_spacing", static_cast<float>(def.columns - 1) * def.column_spacing, kShapeSize);
    const size_t count = size_t{def.rows} * def.columns;
    for (size_t i = 0; check && i < count; ++i)
        if (!std::isnan(def.heights[i])) check.number("heights", def.heights[i], kShapeCoordinate);
    return static_cast<bool>(check);
}

collision::Shape build_shape(Check& check, const taut_height_field_def& def, Memory& memory) {
    auto field = collision::build_height_field(
        {def.rows, def.columns, def.column_spacing, def.row_spacing, {def.heights, size_t{def.rows} * def.columns}},
        memory);
    check.require(field != nullptr, "heights have holes everywhere");
    return surface_of(std::move(field));
}

}  // namespace taut
