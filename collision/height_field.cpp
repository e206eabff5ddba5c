// Height fields: a grid of heights along y, two triangles a cell, found by dividing. Sample (row, column) lies at
// (column * spacing_x, height, row * spacing_z); not-a-number is a hole, which takes the triangles around it.
#include <algorithm>
#include <cmath>

#include "collision/surface.h"
#include "collision/triangle_tree.h"

namespace taut::collision {
namespace {

// Of cell (r, c), number 2 (r (columns - 1) + c) is the triangle at its sample (r, c), the next the one at
// (r + 1, c + 1); they share the diagonal from (r + 1, c) to (r, c + 1).
struct HeightField : Surface {
    uint32_t slots() const override { return 2 * (rows - 1) * (columns - 1); }
    bool has(uint32_t triangle) const override {
        const Corners c = corners(triangle);
        return !std::isnan(heights[c[0]]) && !std::isnan(heights[c[1]]) && !std::isnan(heights[c[2]]);
    }
    Corners corners(uint32_t triangle) const override {
        const uint32_t cell = triangle / 2;
        const uint32_t near = cell / (columns - 1) * columns + cell % (columns - 1), far = near + columns + 1;
        if (triangle % 2) return {far, near + 1, near + columns};
        return {near, near + columns, near + 1};
    }
    Vec3f vertex(uint32_t i) const override {
        return {float(i % columns) * spacing_x, heights[i], float(i / columns) * spacing_z};
    }
    uint32_t neighbour(uint32_t triangle, int edge) const override;
    std::span<const uint32_t> ring(uint32_t vertex, RingRoom& room) const override;
    void find(const Box& where, TriangleSink& found) const override;

    uint32_t rows = 0, columns = 0;
    float spacing_x = 1, spacing_z = 1;  // [m]
    std::vector<float> heights;          // row by row [m]
};

// Edge 0 lies on a line of one column, edge 1 on the diagonal, edge 2 on a line of one row.
uint32_t HeightField::neighbour(uint32_t triangle, int edge) const {
    const uint32_t width = columns - 1, row = triangle / 2 / width, column = triangle / 2 % width;
    const bool far = triangle % 2;
    uint32_t other = triangle ^ 1u;
    if (edge == 0) {
        if (far ? column + 1 == width : column == 0) return kNoTriangle;
        other += far ? 2 : -2u;
    } else if (edge == 2) {
        if (far ? row + 2 == rows : row == 0) return kNoTriangle;
        other += far ? 2 * width : -2u * width;
    }
    return has(other) ? other : kNoTriangle;
}

std::span<const uint32_t> HeightField::ring(uint32_t vertex, RingRoom& room) const {
    const int row = int(vertex / columns), column = int(vertex % columns);
    constexpr int kSteps[6][2] = {{-1, 0}, {-1, 1}, {0, -1}, {0, 1}, {1, -1}, {1, 0}};
    size_t count = 0;
    for (const auto& [down, right] : kSteps) {
        const int r = row + down, c = column + right;
        if (r < 0 || c < 0 || r >= int(rows) || c >= int(columns)) continue;
        const uint32_t other = uint32_t(r) * columns + uint32_t(c);
        if (!std::isnan(heights[other])) room[count++] = other;
    }
    return std::span(room).first(count);
}

// Lines from..to of a grid that an interval meets; false if it lies beside the grid.
bool cells(float lo, float hi, float spacing, uint32_t lines, uint32_t& from, uint32_t& to) {
    const float last = float(lines - 2);
    const float first = std::floor(lo / spacing), end = std::floor(hi / spacing);
    if (!(end >= 0 && first <= last)) return false;
    from = uint32_t(std::max(first, 0.0f));
    to = uint32_t(std::min(end, last));
    return true;
}

void HeightField::find(const Box& where, TriangleSink& found) const {
    uint32_t row = 0, last_row = 0, first = 0, last = 0;
    if (!cells(where.lo.z(), where.hi.z(), spacing_z, rows, row, last_row)) return;
    if (!cells(where.lo.x(), where.hi.x(), spacing_x, columns, first, last)) return;
    for (; row <= last_row; ++row) {
        for (uint32_t column = first; column <= last; ++column) {
            const uint32_t cell = 2 * (row * (columns - 1) + column);
            for (const uint32_t triangle : {cell, cell + 1}) {
                if (facet_of[triangle] == kNoTriangle) continue;
                const Corners c = corners(triangle);
                const float lo = std::min({heights[c[0]], heights[c[1]], heights[c[2]]});
                const float hi = std::max({heights[c[0]], heights[c[1]], heights[c[2]]});
                if (lo <= where.hi.y() && where.lo.y() <= hi) found.take(triangle);
            }
        }
    }
}

}  // namespace

std::shared_ptr<const Surface> build_height_field(const HeightGrid& grid) {
    auto field = std::make_shared<HeightField>();
    field->rows = grid.rows;
    field->columns = grid.columns;
    field->spacing_x = grid.spacing_x;
    field->spacing_z = grid.spacing_z;
    field->heights.assign(grid.heights.begin(), grid.heights.end());
    find_facets(*field);
    return field->seed_of.empty() ? nullptr : field;
}

}  // namespace taut::collision
