// Height fields: a grid of heights along y, two triangles a cell, found by dividing. Sample (row, column) lies at
// (column * spacing_x, height, row * spacing_z); not-a-number is a hole, which takes the triangles around it.
#include <algorithm>
#include <cmath>

#include "collision/facets.h"
#include "collision/surface.h"

namespace taut::collision {
namespace {

// Of cell (r, c), number 2 (r (columns - 1) + c) is the triangle at its sample (r, c), the next the one at
// (r + 1, c + 1); they share the diagonal from (r + 1, c) to (r, c + 1).
struct HeightField final : Surface {
    HeightField(const HeightGrid& grid, Memory& memory)
        : Surface(memory),
          rows(grid.rows),
          columns(grid.columns),
          spacing_x(grid.spacing_x),
          spacing_z(grid.spacing_z),
          heights(grid.heights.begin(), grid.heights.end(), memory) {
        holes = std::ranges::any_of(heights, [](float height) { return std::isnan(height); });
    }

    uint32_t slots() const override { return 2 * (rows - 1) * (columns - 1); }
    bool has(uint32_t triangle) const override {
        if (!holes) return true;
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

    uint32_t rows, columns;
    float spacing_x, spacing_z;  // [m]
    Array<float> heights;        // row by row [m]
    bool holes;
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

// The facets of a field, row by row of cells: each triangle's plane is found once.
class FieldFacets {
public:
    FieldFacets(HeightField& field, Memory& memory)
        : field_(field), width_(field.columns - 1), facets_(field, memory), above_(memory), here_(memory) {}

    void find() {
        if (!field_.holes) {
            const auto [lo, hi] = std::ranges::minmax(field_.heights);
            const Vec3f last = at(field_.rows - 1, width_);
            field_.box = {Vec3f(0, lo, 0), Vec3f(last.x(), hi, last.z())};
        }
        above_.resize(2 * size_t{width_});
        here_.resize(2 * size_t{width_});
        for (uint32_t row = 0; row + 1 < field_.rows; ++row) {
            for (uint32_t column = 0; column < width_; ++column) add(row, column);
            for (uint32_t column = 0; column < width_; ++column) look_around(row, column);
            std::swap(above_, here_);
        }
        for (uint32_t column = 0; column < width_; ++column)  // the last row's edges
            if (there(above_[2 * column + 1])) facets_.end(number(field_.rows - 2, column) + 1, 2);
        facets_.find();
    }

private:
    uint32_t number(uint32_t row, uint32_t column) const { return 2 * (row * width_ + column); }
    Vec3f at(uint32_t row, uint32_t column) const {
        return {float(column) * field_.spacing_x, field_.heights[size_t{row} * field_.columns + column],
                float(row) * field_.spacing_z};
    }
    static Box around(Box box, const std::array<Vec3f, 3>& corners) {
        for (const Vec3f& corner : corners) box = {box.lo.cwiseMin(corner), box.hi.cwiseMax(corner)};
        return box;
    }
    static bool there(const FacetPlane& plane) { return plane.area > 0; }  // not a hole

    void add(uint32_t row, uint32_t column) {
        const Vec3f near = at(row, column), right = at(row, column + 1), down = at(row + 1, column),
                    far = at(row + 1, column + 1);
        const bool diagonal = !std::isnan(right.y()) && !std::isnan(down.y());
        const uint32_t cell = number(row, column);
        FacetPlane* const planes = &here_[2 * size_t{column}];
        planes[0].area = planes[1].area = 0;
        const auto take = [&](uint32_t which, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
            planes[which] = plane_through(a.cast<double>(), b.cast<double>(), c.cast<double>());
            facets_.add(cell + which, planes[which]);
            if (field_.holes) field_.box = around(field_.box, {a, b, c});
        };
        if (diagonal && !std::isnan(near.y())) take(0, near, down, right);
        if (diagonal && !std::isnan(far.y())) take(1, far, right, down);
    }

    // One triangle and another, across an edge of either, with the corners that lie off it.
    void join(uint32_t one, const FacetPlane* plane, uint32_t other, const FacetPlane* plane_of_other, int edge,
              const Vec3f& off_one, const Vec3f& off_other) {
        const bool is_one = plane && there(*plane), is_other = plane_of_other && there(*plane_of_other);
        if (is_one && is_other) {
            facets_.look_across(one, edge, *plane, *plane_of_other, off_other);
            facets_.look_across(other, edge, *plane_of_other, *plane, off_one);
        } else if (is_one) {
            facets_.end(one, edge);
        } else if (is_other) {
            facets_.end(other, edge);
        }
    }

    // The edges of a cell on its diagonal, to the cell before it in its row, and to the row above.
    void look_around(uint32_t row, uint32_t column) {
        const uint32_t cell = number(row, column);
        const FacetPlane* const own = &here_[2 * size_t{column}];
        const Vec3f right = at(row, column + 1), down = at(row + 1, column);
        join(cell, own, cell + 1, own + 1, 1, at(row, column), at(row + 1, column + 1));
        const bool first = column == 0, top = row == 0;
        join(cell, own, cell - 1, first ? nullptr : own - 1, 0, right, first ? right : at(row + 1, column - 1));
        join(cell, own, cell + 1 - 2 * width_, top ? nullptr : &above_[2 * size_t{column} + 1], 2, down,
             top ? down : at(row - 1, column + 1));
        if (column + 1 == width_ && there(own[1])) facets_.end(cell + 1, 0);
    }

    HeightField& field_;
    const uint32_t width_;
    Facets<HeightField> facets_;
    UnsetArray<FacetPlane> above_, here_;  // two a cell
};

}  // namespace

std::shared_ptr<const Surface> build_height_field(const HeightGrid& grid, Memory& memory) {
    auto field = std::allocate_shared<HeightField>(HostAllocator<HeightField>(memory), grid, memory);
    field->box = {Vec3f::Constant(1e30f), Vec3f::Constant(-1e30f)};
    FieldFacets(*field, memory).find();
    return field->seed_of.empty() ? nullptr : field;
}

}  // namespace taut::collision
