#include "soft_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "parts.h"

namespace scenes {

Cloth grid_cloth(int rows, int columns, double length, double width, double height) {
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    for (int i = 0; i < rows; ++i)
        for (int k = 0; k < columns; ++k) {
            const double u = length * i / (rows - 1), v = width * k / (columns - 1);
            cloth.points.push_back({u - length / 2, height, v - width / 2});
            cloth.uv.insert(cloth.uv.end(), {static_cast<float>(u), static_cast<float>(v)});
        }
    const auto at = [columns](int i, int k) { return static_cast<uint32_t>(i * columns + k); };
    for (int i = 0; i + 1 < rows; ++i)
        for (int k = 0; k + 1 < columns; ++k) {
            const uint32_t a = at(i, k), b = at(i, k + 1), c = at(i + 1, k), d = at(i + 1, k + 1);
            if ((i + k) % 2 == 0)
                cloth.triangles.insert(cloth.triangles.end(), {a, b, d, a, d, c});
            else
                cloth.triangles.insert(cloth.triangles.end(), {a, b, c, c, b, d});
        }
    cloth.look.colours = SoftColours::strain;
    return cloth;
}

void sag(Cloth& cloth, double length, double half_angle) {
    const double radius = length / (2 * half_angle);
    cloth.rest = cloth.points;
    for (taut_pos& p : cloth.points) {
        const double angle = p.x / radius;
        p.x = radius * std::sin(angle);
        p.y -= radius * (std::cos(angle) - std::cos(half_angle));
    }
}

Cloth sheet(int n, double height) {
    Cloth cloth = grid_cloth(n, n, kSheetSide, kSheetSide, height);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = static_cast<float>(kSheetDensity);
    return cloth;
}

void add_five_tets(const uint32_t (&corner)[8], bool odd, std::vector<uint32_t>& cells) {
    static constexpr int kEven[5][4] = {{0, 5, 3, 6}, {1, 3, 0, 5}, {2, 6, 0, 3}, {4, 5, 0, 6}, {7, 6, 3, 5}};
    for (const auto& tet : kEven) {
        uint32_t vertex[4];
        for (int n = 0; n < 4; ++n) vertex[n] = corner[odd ? tet[n] ^ 1 : tet[n]];
        if (odd) std::swap(vertex[2], vertex[3]);  // mirrored
        cells.insert(cells.end(), vertex, vertex + 4);
    }
}

Scene soft_hall(double height) {
    Scene scene = empty_scene();
    scene.camera = {{1.6, height + 0.4, 3.2}, {0, height - 0.5, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, height + 0.5, 2}};
    return scene;
}

namespace {

Solid box_of_points(const double (&size)[3], const int (&nodes)[3], taut_pos corner) {
    Solid solid;
    taut_solid_def_init(&solid.def);
    for (int i = 0; i < nodes[0]; ++i)
        for (int j = 0; j < nodes[1]; ++j)
            for (int k = 0; k < nodes[2]; ++k)
                solid.points.push_back({corner.x + size[0] * i / (nodes[0] - 1),
                                        corner.y + size[1] * j / (nodes[1] - 1),
                                        corner.z + size[2] * k / (nodes[2] - 1)});
    return solid;
}

template <class Add>
void for_cells(const int (&nodes)[3], Add&& add) {
    for (int i = 0; i + 1 < nodes[0]; ++i)
        for (int j = 0; j + 1 < nodes[1]; ++j)
            for (int k = 0; k + 1 < nodes[2]; ++k) {
                uint32_t corner[8];
                for (int b = 0; b < 8; ++b) corner[b] = box_vertex(nodes, i + (b & 1), j + (b >> 1 & 1), k + (b >> 2));
                add(corner, (i + j + k) % 2 != 0);
            }
}

}  // namespace

Solid box_of_tets(const double (&size)[3], const int (&nodes)[3], taut_pos corner) {
    Solid solid = box_of_points(size, nodes, corner);
    for_cells(nodes, [&](const uint32_t(&corners)[8], bool odd) { add_five_tets(corners, odd, solid.cells); });
    return solid;
}

Solid ball_of_tets(double radius, int n, taut_pos centre) {
    Solid solid = box_of_tets({2, 2, 2}, {n, n, n}, {-1, -1, -1});
    for (taut_pos& p : solid.points) {
        const double most = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
        const double length = std::hypot(p.x, p.y, p.z);
        // On its shell, from a cube in the middle to a sphere.
        const double part = length > 0 ? radius * ((1 - most) / std::sqrt(3) + most * most / length) : 0;
        p = {centre.x + part * p.x, centre.y + part * p.y, centre.z + part * p.z};
    }
    return solid;
}

Solid ring_of_tets(double ring, double tube, int around, int across, taut_pos centre) {
    constexpr double kTau = 6.283185307179586;
    Solid solid;
    taut_solid_def_init(&solid.def);
    for (int i = 0; i < around; ++i)
        for (int j = 0; j < across; ++j)
            for (int k = 0; k < across; ++k) {
                const double a = 2.0 * j / (across - 1) - 1, b = 2.0 * k / (across - 1) - 1, turn = kTau * i / around;
                // Shells of a square become circles towards the outside, as those of the ball.
                const double most = std::max(std::abs(a), std::abs(b)), length = std::hypot(a, b);
                const double part = length > 0 ? tube * ((1 - most) / std::sqrt(2) + most * most / length) : 0;
                const double r = ring + part * a;
                solid.points.push_back(
                    {centre.x + r * std::cos(turn), centre.y + r * std::sin(turn), centre.z + part * b});
            }
    for (int i = 0; i < around; ++i)
        for (int j = 0; j + 1 < across; ++j)
            for (int k = 0; k + 1 < across; ++k) {
                uint32_t corner[8];
                for (int b = 0; b < 8; ++b)
                    corner[b] = static_cast<uint32_t>((((i + (b & 1)) % around) * across + j + (b >> 1 & 1)) * across +
                                                      k + (b >> 2));
                std::swap(corner[1], corner[2]), std::swap(corner[5], corner[6]);  // radial, around, along z
                add_five_tets(corner, (i + j + k) % 2 != 0, solid.cells);
            }
    return solid;
}

Solid box_of_hexahedra(const double (&size)[3], const int (&nodes)[3], taut_pos corner) {
    static constexpr int kRound[8] = {0, 4, 5, 1, 2, 6, 7, 3};
    Solid solid = box_of_points(size, nodes, corner);
    solid.def.corners = 8;
    for_cells(nodes, [&](const uint32_t(&corners)[8], bool) {
        for (const int b : kRound) solid.cells.push_back(corners[b]);
    });
    return solid;
}

Bounds box_about(const std::vector<taut_pos>& points) {
    Bounds box{points.front(), points.front()};
    for (const taut_pos& p : points) {
        box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y), std::min(box.low.z, p.z)};
        box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y), std::max(box.high.z, p.z)};
    }
    return box;
}

Solid without_mesh(Solid solid) {
    static constexpr uint32_t kTet[4][4] = {{1, 2, 3, 3}, {0, 3, 2, 2}, {0, 1, 3, 3}, {0, 2, 1, 1}};
    static constexpr uint32_t kHex[6][4] = {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                            {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    const bool tets = solid.def.corners == 4;
    std::map<std::array<uint32_t, 4>, std::pair<std::array<uint32_t, 4>, int>> faces;  // sorted: as it goes round, seen
    for (size_t c = 0; c < solid.cells.size(); c += solid.def.corners)
        for (uint32_t f = 0; f < (tets ? 4u : 6u); ++f) {
            std::array<uint32_t, 4> face{}, sorted;
            for (size_t k = 0; k < 4; ++k) face[k] = solid.cells[c + (tets ? kTet : kHex)[f][k]];
            sorted = face;
            std::sort(sorted.begin(), sorted.end());
            auto& seen = faces[sorted];
            seen.first = face;
            ++seen.second;
        }
    for (const auto& [sorted, seen] : faces) {
        if (seen.second > 1) continue;
        const auto& v = seen.first;
        solid.triangles.insert(solid.triangles.end(), {v[0], v[1], v[2]});
        if (!tets) solid.triangles.insert(solid.triangles.end(), {v[0], v[2], v[3]});
    }
    solid.cells.clear();
    solid.def.corners = TAUT_SOLID_MESHLESS;
    return solid;
}

void stand_up(std::vector<taut_pos>& points, double tall, double height) {
    const Bounds box = box_about(points);
    const double scale = tall / (box.high.y - box.low.y);
    for (taut_pos& p : points)
        p = {scale * (p.x - (box.low.x + box.high.x) / 2), height + scale * (p.y - box.low.y),
             scale * (p.z - (box.low.z + box.high.z) / 2)};
}

}  // namespace scenes
