// Cloths and solids.
#include <cmath>

#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

constexpr double kSheet = 1.5;                // side of a sheet [m]
constexpr float kSheetDensity = 0.2f;         // [kg/m^2]
constexpr double kGravity = 9.81;             // [m/s^2]
constexpr double kBeamSink = 0.026;           // of a beam's tip by theory [m]
constexpr double kBeam[3] = {0.5, 0.1, 0.1};  // [m]
constexpr int kBeamNodes[3] = {21, 5, 5};

// n x n vertices in a level square about the origin, two triangles a cell with alternating diagonals; vertex
// i n + k at x by i, z by k. Of links that hardly stretch or shear, without bending.
Cloth sheet(int n, double height) {
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = kSheetDensity;
    const double spacing = kSheet / (n - 1);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            cloth.points.push_back({spacing * i - kSheet / 2, height, spacing * k - kSheet / 2});
            cloth.uv.insert(cloth.uv.end(), {static_cast<float>(spacing * i), static_cast<float>(spacing * k)});
        }
    const auto at = [n](int i, int k) { return static_cast<uint32_t>(i * n + k); };
    for (int i = 0; i + 1 < n; ++i)
        for (int k = 0; k + 1 < n; ++k) {
            const uint32_t a = at(i, k), b = at(i, k + 1), c = at(i + 1, k), d = at(i + 1, k + 1);
            if ((i + k) % 2 == 0)
                cloth.triangles.insert(cloth.triangles.end(), {a, b, d, a, d, c});
            else
                cloth.triangles.insert(cloth.triangles.end(), {a, b, c, c, b, d});
        }
    cloth.colours = SoftColours::strain;
    return cloth;
}

Scene hall(double height) {
    Scene scene = empty_scene();
    scene.camera = {{1.6, height + 0.4, 3.2}, {0, height - 0.5, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, height + 0.5, 2}};
    return scene;
}

// Box of cells with five tetrahedra each, mirrored from cell to cell.
Solid box_of_tets(const double (&size)[3], const int (&nodes)[3], taut_pos corner) {
    Solid solid;
    taut_solid_def_init(&solid.def);
    const auto at = [&](int i, int j, int k) { return static_cast<uint32_t>((i * nodes[1] + j) * nodes[2] + k); };
    for (int i = 0; i < nodes[0]; ++i)
        for (int j = 0; j < nodes[1]; ++j)
            for (int k = 0; k < nodes[2]; ++k)
                solid.points.push_back({corner.x + size[0] * i / (nodes[0] - 1),
                                        corner.y + size[1] * j / (nodes[1] - 1),
                                        corner.z + size[2] * k / (nodes[2] - 1)});
    // Corner b of a cell is at (b & 1, b >> 1 & 1, b >> 2).
    static constexpr int kEven[5][4] = {{0, 5, 3, 6}, {1, 3, 0, 5}, {2, 6, 0, 3}, {4, 5, 0, 6}, {7, 6, 3, 5}};
    for (int i = 0; i + 1 < nodes[0]; ++i)
        for (int j = 0; j + 1 < nodes[1]; ++j)
            for (int k = 0; k + 1 < nodes[2]; ++k) {
                const bool odd = (i + j + k) % 2 != 0;
                for (const auto& tet : kEven) {
                    uint32_t vertex[4];
                    for (int n = 0; n < 4; ++n) {
                        const int b = odd ? tet[n] ^ 1 : tet[n];
                        vertex[n] = at(i + (b & 1), j + (b >> 1 & 1), k + (b >> 2));
                    }
                    if (odd) std::swap(vertex[2], vertex[3]);  // mirrored
                    solid.cells.insert(solid.cells.end(), vertex, vertex + 4);
                }
            }
    return solid;
}

}  // namespace

Scene build_cloth_hang(double n, double, const Options&) {
    constexpr double kHeight = 2.2;
    Scene scene = hall(kHeight);
    const int side = std::max(2, static_cast<int>(n));
    Cloth cloth = sheet(side, kHeight);
    cloth.def.filter.mask = 0;
    cloth.pinned = {0, static_cast<uint32_t>(side - 1)};
    scene.add_cloth(cloth);
    return scene;
}

// A box of r times the sheet's mass falls on its middle.
Scene build_cloth_load(double, double r, const Options&) {
    constexpr double kHeight = 1.8, kBox = 0.4;
    constexpr int kSide = 30;
    Scene scene = hall(kHeight);
    add_ground(scene);
    Cloth cloth = sheet(kSide, kHeight);
    cloth.pinned = {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1};
    scene.add_cloth(cloth);
    Body box = crate(cube_shape(scene, kBox), {0, kHeight + 0.1 + kBox / 2, 0},
                     r * kSheet * kSheet * static_cast<double>(kSheetDensity));
    scene.add_body(box);
    return scene;
}

// Gravity such that the tip sinks by 26 mm by q L^4 / (8 E I) + q L^2 / (2 kappa G A), kappa = 5/6.
Scene build_beam(double n, double r, const Options&) {
    const double young = 1e6 * r, poisson = 0.01 * n, height = 1;
    Scene scene = hall(height + 0.6);
    Solid beam = box_of_tets(kBeam, kBeamNodes, {-kBeam[0] / 2, height, -kBeam[2] / 2});
    beam.def.material = TAUT_SOLID_ST_VENANT_KIRCHHOFF;
    beam.def.young_modulus = static_cast<float>(young);
    beam.def.poisson_ratio = static_cast<float>(poisson);
    beam.def.filter.mask = 0;
    for (uint32_t v = 0; v < static_cast<uint32_t>(kBeamNodes[1] * kBeamNodes[2]); ++v) beam.pinned.push_back(v);
    const double length = kBeam[0], area = kBeam[1] * kBeam[2], inertia = kBeam[2] * std::pow(kBeam[1], 3) / 12;
    const double shear = young / (2 * (1 + poisson));
    const double load =
        kBeamSink / (std::pow(length, 4) / (8 * young * inertia) + length * length / (2 * 5.0 / 6 * shear * area));
    scene.world.gravity = {0, static_cast<float>(-load / (static_cast<double>(beam.def.density) * area)), 0};
    scene.add_solid(beam);
    scene.camera = {{0.4, height + 0.3, 1}, {0, height, 0}, 40};
    return scene;
}

// n cubes of r Pa dropped beside each other: vertices do not meet the faces of other solids.
Scene build_solid_drop(double n, double r, const Options&) {
    constexpr double kCube[3] = {0.4, 0.4, 0.4};
    constexpr int kNodes[3] = {5, 5, 5};
    Scene scene = hall(1.4);
    add_ground(scene);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        Solid cube = box_of_tets(kCube, kNodes, {-0.8 + 0.6 * i, 0.3 + 0.2 * i, -0.2});
        cube.def.young_modulus = static_cast<float>(r);
        cube.def.poisson_ratio = 0.45f;
        scene.add_solid(cube);
    }
    return scene;
}

}  // namespace scenes
