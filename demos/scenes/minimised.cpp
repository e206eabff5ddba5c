// Solids stepped once a film frame by minimisation (Gast and Schroeder 2014).
#include <algorithm>

#include "builders.h"
#include "parts.h"
#include "random.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

constexpr double kCube = 1;              // side [m]
constexpr double kFilmFrame = 1.0 / 24;  // [s]

Scene film_hall(double height) {
    Scene scene = soft_hall(height);
    scene.world.solver = TAUT_SOLVER_MINIMISATION;
    scene.world.time_step = static_cast<float>(kFilmFrame);
    scene.world.substeps = 1;
    scene.world.gravity = {0, 0, 0};
    return scene;
}

Solid soft_cube(int nodes, double young, taut_pos corner) {
    const double size[3] = {kCube, kCube, kCube};
    Solid solid = box_of_tets(size, {nodes, nodes, nodes}, corner);
    solid.def.material = TAUT_SOLID_FIXED_COROTATED;
    solid.def.young_modulus = static_cast<float>(young);
    solid.def.poisson_ratio = 0.45f;
    solid.def.density = 1000;
    solid.def.filter.mask = 0;
    return solid;
}

}  // namespace

// Its vertices are anywhere within its box, or all in the middle. Swept: neo-Hookean, in steps of real time.
Scene build_tangled_cube(double n, double r, const Options& options) {
    Scene scene = film_hall(1.8);
    const taut_pos corner{-kCube / 2, 0.5, -kCube / 2};
    Solid solid = soft_cube(std::max(2, static_cast<int>(n)), r, corner);
    solid.rest = solid.points;
    Random random(options.seed + 1);
    for (taut_pos& p : solid.points) {
        const auto part = [&] { return options.from_point ? 0.5 : random.uniform(); };
        const double x = part(), y = part(), z = part();
        p = {corner.x + kCube * x, corner.y + kCube * y, corner.z + kCube * z};
    }
    if (options.swept) {  // beside minimisation: real time's solver and material, at its steps
        const taut_world_def usual = empty_scene().world;
        scene.world.solver = usual.solver;
        scene.world.time_step = usual.time_step;
        scene.world.substeps = usual.substeps;
        solid.def.material = TAUT_SOLID_NEO_HOOKEAN;
    }
    solid.look = {SoftColours::stress, r, 0, ""};
    scene.add_solid(std::move(solid));
    return scene;
}

// Two sides are led apart to twice its length in a second; a second later they are back in two frames from a push
// towards each other.
Scene build_cube_stretch(double n, double r, const Options& options) {
    constexpr double kApart = 0.5, kPulse = 0.3, kStretched = 1, kPushed = 2;  // of each side [m]; [s]
    Scene scene = film_hall(1.8);
    const int side_nodes = std::max(2, static_cast<int>(n)), nodes[3] = {side_nodes, side_nodes, side_nodes};
    Solid solid = soft_cube(nodes[0], r, {-kCube / 2, 0.5, -kCube / 2});
    for (const int side : {-1, 1}) {
        Motion motion;
        motion.solid = 0;
        motion.along = {static_cast<float>(side), 0, 0};
        motion.track.keys = {{0, 0, 0},
                             {kStretched, kApart, 0},
                             {kPushed, kApart, 0},
                             {kPushed + kFilmFrame, kApart - kPulse, 0},
                             {kPushed + 2 * kFilmFrame, kApart, 0}};
        for (int j = 0; j < nodes[1]; ++j)
            for (int k = 0; k < nodes[2]; ++k)
                motion.vertices.push_back(box_vertex(nodes, side < 0 ? 0 : nodes[0] - 1, j, k));
        solid.pinned.insert(solid.pinned.end(), motion.vertices.begin(), motion.vertices.end());
        scene.motions.push_back(std::move(motion));
    }
    solid.look = {SoftColours::stress, r, 0, ""};
    scene.add_solid(std::move(solid));
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
