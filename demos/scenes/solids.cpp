// Deformable solids: a beam, cubes, and a figure that falls.
#include <cmath>

#include "builders.h"
#include "lattice.h"
#include "parts.h"
#include "soft_files.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr double kBeamSink = 0.026;           // of a beam's tip by theory [m]
constexpr double kBeam[3] = {0.5, 0.1, 0.1};  // [m]
constexpr int kBeamNodes[3] = {21, 5, 5};

}  // namespace

// Gravity such that the tip sinks by 26 mm by q L^4 / (8 E I) + q L^2 / (2 kappa G A), kappa = 5/6.
Scene build_beam(double n, double r, const Options& options) {
    const double young = 1e6 * r, poisson = 0.01 * n, height = 1;
    Scene scene = soft_hall(height + 0.6);
    Solid beam = box_of_tets(kBeam, kBeamNodes, {-kBeam[0] / 2, height, -kBeam[2] / 2});
    beam.def.material = TAUT_SOLID_ST_VENANT_KIRCHHOFF;
    beam.def.young_modulus = static_cast<float>(young);
    beam.def.poisson_ratio = static_cast<float>(poisson);
    beam.def.filter.mask = 0;
    for (int j = 0; j < kBeamNodes[1]; ++j)
        for (int k = 0; k < kBeamNodes[2]; ++k) {
            beam.pinned.push_back(box_vertex(kBeamNodes, 0, j, k));
            scene.roles.tip.push_back(box_vertex(kBeamNodes, kBeamNodes[0] - 1, j, k));
        }
    scene.roles.tip_sink = kBeamSink;
    const double length = kBeam[0], area = kBeam[1] * kBeam[2], inertia = kBeam[2] * std::pow(kBeam[1], 3) / 12;
    const double shear = young / (2 * (1 + poisson));
    const double per_bending = std::pow(length, 4) / (8 * young * inertia),
                 per_shear = length * length / (2 * 5.0 / 6 * shear * area);
    const double load = kBeamSink / (per_bending + per_shear);
    scene.world.gravity = {0, static_cast<float>(-load / (static_cast<double>(beam.def.density) * area)), 0};
    beam.look = {SoftColours::stress, load * length * length / 2 * kBeam[1] / 2 / inertia, 0, ""};
    scene.add_solid(std::move(beam));
    // What theory says of the middle line, beside the beam: with xi = x/L,
    // q L^4 (6 xi^2 - 4 xi^3 + xi^4) / (24 E I) + q L^2 (2 xi - xi^2) / (2 kappa G A).
    Curve curve;
    for (int i = 0; i <= 40; ++i) {
        const double xi = i / 40.0;
        const double sink = load * (per_bending * (6 * xi * xi - 4 * xi * xi * xi + xi * xi * xi * xi) / 3 +
                                    per_shear * (2 * xi - xi * xi));
        curve.points.push_back({length * (xi - 0.5), height + kBeam[1] / 2 - sink, kBeam[2] / 2 + 0.012});
    }
    scene.curves.push_back(std::move(curve));
    scene.camera = {{0.25, height + 0.2, 0.95}, {0, height + 0.03, 0}, 40};
    perturb(scene, options.seed);
    return scene;
}

// n cubes of r Pa dropped beside each other: vertices do not meet the faces of other solids.
Scene build_solid_drop(double n, double r, const Options& options) {
    constexpr double kCube[3] = {0.4, 0.4, 0.4};
    constexpr int kNodes[3] = {5, 5, 5};
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        Solid cube = box_of_tets(kCube, kNodes, {-0.8 + 0.6 * i, 0.3 + 0.2 * i, -0.2});
        cube.def.young_modulus = static_cast<float>(r);
        cube.def.poisson_ratio = 0.45f;
        scene.add_solid(std::move(cube));
    }
    perturb(scene, options.seed);
    return scene;
}

// A figure a metre tall, of r Pa, falls by half a metre on the ground.
Scene build_armadillo(double, double r, const Options& options) {
    Scene scene = soft_hall(1.2);
    add_ground(scene);
    Solid solid = figure(options.mesh);
    stand_up(solid.points, 1, 0.5);
    solid.def.young_modulus = static_cast<float>(r);
    solid.def.poisson_ratio = 0.45f;
    solid.def.density = 1000;
    solid.look = {SoftColours::stress, 0.2 * r, 0, ""};
    scene.add_solid(std::move(solid));
    scene.camera = {{1.3, 1.0, 2.6}, {0, 0.55, 0}, 38};
    perturb(scene, options.seed);
    return scene;
}

// The same figure four times, each of another material, the last of its points alone (Tournier et al. 2015, figure 6
// right).
Scene build_armadillos(double, double, const Options& options) {
    constexpr int kCubes = 260;
    struct Kind {
        const char* label;
        taut_solid_material material;
        float young, poisson;
        uint32_t paint;
        bool meshless = false;
    };
    constexpr Kind kKinds[] = {
        {"neo-Hookean, 60 kPa, nu 0.47", TAUT_SOLID_NEO_HOOKEAN, 6e4f, 0.47f, 0x3D7EBF},
        {"fixed corotated, 200 kPa", TAUT_SOLID_FIXED_COROTATED, 2e5f, 0.4f, 0x4E9B58},
        {"corotated, 1 MPa", TAUT_SOLID_COROTATED, 1e6f, 0.3f, 0xC9463D},
        {"St-Venant-Kirchhoff, 1 MPa, meshless", TAUT_SOLID_ST_VENANT_KIRCHHOFF, 1e6f, 0.3f, 0xE3B23C, true}};
    Scene scene = soft_hall(1.2);
    add_ground(scene);
    const Solid one = options.mesh.empty() ? fill_surface(figure_surface(), kCubes, "the figure made here")
                                           : solid_from_file(options.mesh, kCubes);
    double x = -1.35;
    for (const Kind& kind : kKinds) {
        Solid solid = kind.meshless ? without_mesh(one) : one;
        stand_up(solid.points, 1, 0.7);
        for (taut_pos& p : solid.points) p = {x + p.x, p.y, p.z};
        solid.def.material = kind.material;
        solid.def.young_modulus = kind.young;
        solid.def.poisson_ratio = kind.poisson;
        solid.look.paint = kind.paint;
        solid.look.label = kind.label;
        scene.add_solid(std::move(solid));
        add_static_box(scene, {x, 0.1, -0.3}, 0.3, 0.1, 0.12, Look::stone);
        x += 0.9;
    }
    scene.camera = {{1.0, 1.5, 3.9}, {0.1, 0.5, 0}, 38};
    scene.stage = {{-2.5, 0, -2}, {2.5, 2, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
