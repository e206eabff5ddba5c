// Sheets and beams for the tests of cloths and solids, made through the public C API.
#pragma once

#include <algorithm>
#include <map>
#include <vector>

#include "physics/lab.h"

namespace lab {

// n x m vertices in a level rectangle, two triangles a cell with alternating diagonals; vertex i m + k at x by i, z by
// k.
struct Sheet {
    Sheet(int rows, int columns, double length, double width, double height) : n(rows), m(columns) {
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < m; ++k) {
                points.push_back({length * i / (n - 1), height, width * k / (m - 1)});
                uv.push_back(static_cast<float>(points.back().x));
                uv.push_back(static_cast<float>(points.back().z));
            }
        for (int i = 0; i + 1 < n; ++i)
            for (int k = 0; k + 1 < m; ++k) {
                const uint32_t a = at(i, k), b = at(i, k + 1), c = at(i + 1, k), d = at(i + 1, k + 1);
                if ((i + k) % 2 == 0)
                    triangles.insert(triangles.end(), {a, b, d, a, d, c});
                else
                    triangles.insert(triangles.end(), {a, b, c, c, b, d});
            }
    }
    uint32_t at(int i, int k) const { return static_cast<uint32_t>(i * m + k); }
    taut_cloth_def def(taut_cloth_kind kind) const {
        taut_cloth_def out;
        taut_cloth_def_init(&out);
        out.kind = kind;
        out.points = points.data();
        out.point_count = static_cast<uint32_t>(points.size());
        out.triangles = triangles.data();
        out.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
        out.uv = uv.data();
        return out;
    }

    int n, m;
    std::vector<taut_pos> points;
    std::vector<uint32_t> triangles;
    std::vector<float> uv;
};

// A sphere about the origin, normals outward: an icosahedron, each triangle in four so many times.
struct Ball {
    Ball(double radius, int times) {
        const double a = (1 + std::sqrt(5.0)) / 2;
        std::vector<Vec> at = {{-1, a, 0},  {1, a, 0},  {-1, -a, 0}, {1, -a, 0}, {0, -1, a},  {0, 1, a},
                               {0, -1, -a}, {0, 1, -a}, {a, 0, -1},  {a, 0, 1},  {-a, 0, -1}, {-a, 0, 1}};
        triangles = {0, 11, 5,  0, 5,  1, 0, 1, 7, 0, 7,  10, 0, 10, 11, 1, 5, 9, 5, 11,
                     4, 11, 10, 2, 10, 7, 6, 7, 1, 8, 3,  9,  4, 3,  4,  2, 3, 2, 6, 3,
                     6, 8,  3,  8, 9,  4, 9, 5, 2, 4, 11, 6,  2, 10, 8,  6, 7, 9, 8, 1};
        for (; times > 0; --times) {
            std::map<std::pair<uint32_t, uint32_t>, uint32_t> middle;
            const auto between = [&](uint32_t i, uint32_t k) {
                const auto [found, made] = middle.insert({std::minmax(i, k), static_cast<uint32_t>(at.size())});
                if (made) at.push_back(unit(unit(at[i]) + unit(at[k])));
                return found->second;
            };
            std::vector<uint32_t> finer;
            for (size_t t = 0; t < triangles.size(); t += 3) {
                const uint32_t i = triangles[t], k = triangles[t + 1], l = triangles[t + 2];
                const uint32_t ik = between(i, k), kl = between(k, l), li = between(l, i);
                finer.insert(finer.end(), {i, ik, li, k, kl, ik, l, li, kl, ik, kl, li});
            }
            triangles = finer;
        }
        for (const Vec& x : at) points.push_back((radius * unit(x)).pos());
    }
    taut_cloth_def def() const {
        taut_cloth_def out;
        taut_cloth_def_init(&out);
        out.points = points.data();
        out.point_count = static_cast<uint32_t>(points.size());
        out.triangles = triangles.data();
        out.triangle_count = static_cast<uint32_t>(triangles.size() / 3);
        return out;
    }

    std::vector<taut_pos> points;
    std::vector<uint32_t> triangles;
};

inline taut_cloth add(const World& world, const taut_cloth_def& def) {
    taut_cloth out{};
    ok(taut_world_add_cloth(world.handle, &def, &out));
    return out;
}

inline std::vector<Vec> points_of(taut_cloth cloth) {
    uint32_t count = 0;
    taut_cloth_get_points(cloth, nullptr, 0, &count);
    std::vector<taut_pos> raw(count);
    ok(taut_cloth_get_points(cloth, raw.data(), count, &count));
    return {raw.begin(), raw.end()};
}
inline std::vector<Vec> points_of(taut_solid solid) {
    uint32_t count = 0;
    taut_solid_get_points(solid, nullptr, 0, &count);
    std::vector<taut_pos> raw(count);
    ok(taut_solid_get_points(solid, raw.data(), count, &count));
    return {raw.begin(), raw.end()};
}
inline std::vector<taut_body> bodies_of(taut_cloth cloth) {
    uint32_t count = 0;
    taut_cloth_get_bodies(cloth, nullptr, 0, &count);
    std::vector<taut_body> out(count);
    ok(taut_cloth_get_bodies(cloth, out.data(), count, &count));
    return out;
}

inline std::vector<taut_body> bodies_of(taut_solid solid) {
    uint32_t count = 0;
    taut_solid_get_bodies(solid, nullptr, 0, &count);
    std::vector<taut_body> out(count);
    ok(taut_solid_get_bodies(solid, out.data(), count, &count));
    return out;
}
inline Vec momentum_of(const std::vector<taut_body>& bodies) {
    Vec sum;
    for (const taut_body body : bodies) sum += mass_of(body).mass * velocity(body);
    return sum;
}
inline void set_velocities(const std::vector<taut_body>& bodies, const Vec& v) {
    for (const taut_body body : bodies) ok(taut_body_set_velocity(body, v.narrow(), {}));
}

// A box along x from 0, held at x = 0, of cells with five tetrahedra each or of hexahedra.
struct Beam {
    Beam(const Vec& size, int nx, int ny, int nz, bool hexahedra) : extent(size), n{nx, ny, nz}, hex(hexahedra) {
        for (int i = 0; i < nx; ++i)
            for (int j = 0; j < ny; ++j)
                for (int k = 0; k < nz; ++k)
                    points.push_back({size.x * i / (nx - 1), size.y * j / (ny - 1), size.z * k / (nz - 1)});
        static constexpr int kTets[5][4] = {{0, 5, 3, 6}, {1, 3, 0, 5}, {2, 6, 0, 3}, {4, 5, 0, 6}, {7, 6, 3, 5}};
        static constexpr int kHex[8] = {0, 4, 5, 1, 2, 6, 7, 3};
        for (int i = 0; i + 1 < nx; ++i)
            for (int j = 0; j + 1 < ny; ++j)
                for (int k = 0; k + 1 < nz; ++k) {
                    const auto corner = [&](int b) { return at(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2)); };
                    if (hex) {
                        for (const int b : kHex) cells.push_back(corner(b));
                        continue;
                    }
                    const bool odd = (i + j + k) % 2 != 0;
                    for (const auto& tet : kTets) {
                        uint32_t vertex[4];
                        for (int v = 0; v < 4; ++v) vertex[v] = corner(odd ? tet[v] ^ 1 : tet[v]);
                        if (odd) std::swap(vertex[2], vertex[3]);
                        cells.insert(cells.end(), vertex, vertex + 4);
                    }
                }
    }
    uint32_t at(int i, int j, int k) const { return static_cast<uint32_t>((i * n[1] + j) * n[2] + k); }
    taut_solid_def def(taut_solid_material material, double young, double poisson) const {
        taut_solid_def out;
        taut_solid_def_init(&out);
        out.material = material;
        out.points = points.data();
        out.point_count = static_cast<uint32_t>(points.size());
        out.cells = cells.data();
        out.corners = hex ? 8 : 4;
        out.cell_count = static_cast<uint32_t>(cells.size()) / out.corners;
        out.young_modulus = static_cast<float>(young);
        out.poisson_ratio = static_cast<float>(poisson);
        return out;
    }
    void hold(taut_solid solid) const {
        for (uint32_t v = 0; v < static_cast<uint32_t>(n[1] * n[2]); ++v) ok(taut_solid_pin(solid, v, 1));
    }

    Vec extent;
    int n[3];
    bool hex;
    std::vector<taut_pos> points;
    std::vector<uint32_t> cells;
};

inline taut_solid add(const World& world, const taut_solid_def& def) {
    taut_solid out{};
    ok(taut_world_add_solid(world.handle, &def, &out));
    return out;
}

}  // namespace lab
