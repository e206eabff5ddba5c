#include "soft_files.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "builders.h"
#include "lattice.h"
#include "parts.h"
#include "soft_meshes.h"
#include "tet_file.h"

namespace scenes {

namespace {

constexpr int kFigureCubes = 740;  // 3700 tetrahedra

std::string ending_of(const std::string& path) {
    std::string ending = std::filesystem::path(path).extension().string();
    for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return ending;
}

}  // namespace

Solid solid_from_file(const std::string& path, int cubes) {
    const std::string ending = ending_of(path);
    if (ending == ".obj") {
        Solid solid = fill_surface(read_surface(path), cubes, path);
        solid.source = path;
        return solid;
    }
    if (ending != ".node" && ending != ".ele" && ending != ".msh")
        throw BadFile(path + ": a solid is read from .obj, .node and .ele, or .msh");
    CellMesh mesh = ending == ".msh" ? read_gmsh(path) : read_tetgen(path);
    Solid solid;
    taut_solid_def_init(&solid.def);
    solid.points = std::move(mesh.points);
    solid.cells = std::move(mesh.cells);
    solid.def.corners = mesh.corners;
    solid.source = path;
    return solid;
}

Solid figure(const std::string& path) {
    if (!path.empty()) return solid_from_file(path, kFigureCubes);
    if (const char* folder = std::getenv("TAUT_DATA")) {
        const std::filesystem::path file = std::filesystem::path(folder) / "armadillo_4k.node";
        if (std::filesystem::exists(file)) return solid_from_file(file.string(), kFigureCubes);
    }
    return fill_surface(figure_surface(), kFigureCubes, "the figure made here");
}

Solid creature(const std::string& path, const char* in_data, std::span<const FigureLimb> limbs, int cubes) {
    if (!path.empty()) return solid_from_file(path, cubes);
    if (const char* folder = std::getenv("TAUT_DATA")) {
        const std::filesystem::path file = std::filesystem::path(folder) / in_data;
        if (std::filesystem::exists(file)) return solid_from_file(file.string(), cubes);
    }
    constexpr double kFine = 0.03;  // [m]
    return fill_surface(surface_of_limbs(limbs, lattice_about(limbs, kFine)), cubes, "the figure made here");
}

// A cloth of a file: laid over a ball where it is flat enough to lie, dropped on the ground beside it anyhow.
Scene build_cloth_file(double, double, const Options& options) {
    constexpr double kSize = 1.5, kBall = 0.35;  // largest side [m]
    Scene scene = empty_scene();
    add_ground(scene);
    Surface surface = read_surface(options.mesh);
    const Bounds box = box_about(surface.points);
    const double side = std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
    if (!(side > 0)) throw BadFile(options.mesh + ": all vertices lie in one place");
    Cloth cloth;
    taut_cloth_def_init(&cloth.def);
    for (const taut_pos& p : surface.points)
        cloth.points.push_back({kSize / side * (p.x - (box.low.x + box.high.x) / 2),
                                2 * kBall + 0.05 + kSize / side * (p.y - box.low.y),
                                kSize / side * (p.z - (box.low.z + box.high.z) / 2)});
    cloth.triangles = std::move(surface.triangles);
    cloth.uv = std::move(surface.uv);
    cloth.source = options.mesh;
    cloth.look.colours = SoftColours::strain;
    scene.add_cloth(std::move(cloth));
    Body ball = crate(sphere_shape(scene, kBall), {0, kBall, 0}, 0, Look::stone);
    ball.kind = TAUT_BODY_STATIC;
    scene.add_body(ball);
    scene.camera = {{1.8, 1.6, 3.0}, {0, 0.6, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, 2.6, 2}};
    perturb(scene, options.seed);
    return scene;
}

// A solid of a file, a metre along its longest side, falls on stairs.
Scene build_solid_file(double, double, const Options& options) {
    constexpr double kSize = 1;
    constexpr int kCubes = 500;
    Scene scene = empty_scene();
    add_ground(scene);
    Solid solid = solid_from_file(options.mesh, kCubes);
    const Bounds box = box_about(solid.points);
    const double side = std::max({box.high.x - box.low.x, box.high.y - box.low.y, box.high.z - box.low.z});
    if (!(side > 0)) throw BadFile(options.mesh + ": all vertices lie in one place");
    stand_up(solid.points, kSize * (box.high.y - box.low.y) / side, 0.6);
    solid.def.young_modulus = 2e5f;
    solid.def.poisson_ratio = 0.45f;
    solid.look = {SoftColours::stress, 2e4, 0, ""};
    scene.add_solid(std::move(solid));
    add_static_box(scene, {-0.25, 0.1, 0}, 0.25, 0.1, 0.8, Look::stone);
    scene.camera = {{1.5, 1.2, 2.8}, {0, 0.55, 0}, 38};
    scene.stage = {{-2, 0, -2}, {2, 2, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
