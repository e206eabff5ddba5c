// Surfaces for the tests, made here: grids, floors of voxels, stairs and height fields.
#pragma once

#include <array>

#include "physics/lab.h"

namespace lab {

struct Triangles {
    std::vector<taut_vec3> vertices;
    std::vector<uint32_t> indices;

    // Corners counter-clockwise as seen from the front, with vertices of their own.
    void add(const Vec& a, const Vec& b, const Vec& c) {
        for (const Vec& p : {a, b, c}) {
            indices.push_back(static_cast<uint32_t>(vertices.size()));
            vertices.push_back(p.narrow());
        }
    }
    void add_quad(const Vec& a, const Vec& b, const Vec& c, const Vec& d, bool other_diagonal = false) {
        if (other_diagonal) {
            add(a, b, d);
            add(b, c, d);
        } else {
            add(a, b, c);
            add(a, c, d);
        }
    }
    // All six sides.
    void add_box(const Vec& lo, const Vec& hi) {
        const std::array<Vec, 8> p = {Vec(lo.x, lo.y, lo.z), Vec(hi.x, lo.y, lo.z), Vec(lo.x, hi.y, lo.z),
                                      Vec(hi.x, hi.y, lo.z), Vec(lo.x, lo.y, hi.z), Vec(hi.x, lo.y, hi.z),
                                      Vec(lo.x, hi.y, hi.z), Vec(hi.x, hi.y, hi.z)};
        constexpr int kSides[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                      {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
        for (const auto& s : kSides)
            add_quad(p[static_cast<size_t>(s[0])], p[static_cast<size_t>(s[1])], p[static_cast<size_t>(s[2])],
                     p[static_cast<size_t>(s[3])]);
    }
};

// A flat floor at y = 0 from (0, 0) to (length, width), with the diagonals of a checkerboard.
inline Triangles grid(double length, double width, double cell) {
    Triangles out;
    const int nx = static_cast<int>(std::lround(length / cell)), nz = static_cast<int>(std::lround(width / cell));
    for (int i = 0; i < nx; ++i)
        for (int k = 0; k < nz; ++k) {
            const double x = i * cell, z = k * cell, x2 = (i + 1) * cell, z2 = (k + 1) * cell;
            out.add_quad({x, 0, z}, {x, 0, z2}, {x2, 0, z2}, {x2, 0, z}, (i + k) % 2 != 0);
        }
    return out;
}

// Cubes side by side, with the sides between them: their tops are the floor at y = 0.
inline Triangles voxels(double length, double width, double cell) {
    Triangles out;
    const int nx = static_cast<int>(std::lround(length / cell)), nz = static_cast<int>(std::lround(width / cell));
    for (int i = 0; i < nx; ++i)
        for (int k = 0; k < nz; ++k) out.add_box({i * cell, -cell, k * cell}, {(i + 1) * cell, 0, (k + 1) * cell});
    return out;
}

// Steps that rise along x by `rise` every `run`, the first at x = 0; a floor before them.
inline Triangles stairs(int steps, double run, double rise, double width) {
    Triangles out;
    out.add_quad({-4, 0, 0}, {-4, 0, width}, {0, 0, width}, {0, 0, 0});
    for (int i = 0; i < steps; ++i) {
        const double x = i * run, y = i * rise, x2 = x + run, y2 = y + rise;
        out.add_quad({x, y, 0}, {x, y, width}, {x, y2, width}, {x, y2, 0});
        out.add_quad({x, y2, 0}, {x, y2, width}, {x2, y2, width}, {x2, y2, 0});
    }
    return out;
}

inline taut_shape mesh(const World& world, const Triangles& triangles, bool two_sided = false) {
    taut_mesh_def d;
    taut_mesh_def_init(&d);
    d.vertices = triangles.vertices.data();
    d.vertex_count = static_cast<uint32_t>(triangles.vertices.size());
    d.indices = triangles.indices.data();
    d.triangle_count = static_cast<uint32_t>(triangles.indices.size() / 3);
    d.two_sided = two_sided;
    taut_shape out{};
    ok(taut_world_add_mesh(world.handle, &d, &out));
    return out;
}

// height(x, z) sampled over rows along z and columns along x.
inline taut_shape height_field(const World& world, uint32_t rows, uint32_t columns, double spacing,
                               const std::function<double(double, double)>& height) {
    std::vector<float> heights;
    for (uint32_t r = 0; r < rows; ++r)
        for (uint32_t c = 0; c < columns; ++c) heights.push_back(static_cast<float>(height(c * spacing, r * spacing)));
    taut_height_field_def d;
    taut_height_field_def_init(&d);
    d.rows = rows;
    d.columns = columns;
    d.row_spacing = d.column_spacing = static_cast<float>(spacing);
    d.heights = heights.data();
    taut_shape out{};
    ok(taut_world_add_height_field(world.handle, &d, &out));
    return out;
}

inline taut_shape hull(const World& world, const std::vector<taut_vec3>& points) {
    taut_hull_def d;
    taut_hull_def_init(&d);
    d.points = points.data();
    d.point_count = static_cast<uint32_t>(points.size());
    taut_shape out{};
    ok(taut_world_add_hull(world.handle, &d, &out));
    return out;
}

// Flat below, eight-sided: a curling stone.
inline taut_shape stone(const World& world) {
    std::vector<taut_vec3> points;
    for (int i = 0; i < 8; ++i) {
        const double angle = kPi / 4 * i;
        points.push_back(Vec(0.3 * std::cos(angle), -0.2, 0.3 * std::sin(angle)).narrow());
        points.push_back(Vec(0.4 * std::cos(angle), 0.2, 0.4 * std::sin(angle)).narrow());
    }
    return hull(world, points);
}

}  // namespace lab
