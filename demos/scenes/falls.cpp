// Soft and rigid figures that fall: on cloth, stairs, the ground, and each other.
#include <algorithm>
#include <cmath>

#include "builders.h"
#include "lattice.h"
#include "limbs.h"
#include "parts.h"
#include "pose.h"
#include "soft_files.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// Turns points about the middle of their box and moves that to a place.
void lay(std::vector<taut_pos>& points, taut_quat by, taut_pos at) {
    const Bounds box = box_about(points);
    const taut_pos from = middle(box.low, box.high);
    for (taut_pos& p : points) {
        const taut_pos out = rotated(by, minus(p, from));
        p = plus(at, out.x, out.y, out.z);
    }
}

struct PileMaterial {
    const char* label;
    taut_solid_material material;
    float young, poisson;
    uint32_t paint;
};

constexpr PileMaterial kPileMaterials[] = {
    {"neo-Hookean, 60 kPa, nu 0.45", TAUT_SOLID_NEO_HOOKEAN, 6e4f, 0.45f, 0x3D7EBF},
    {"fixed corotated, 200 kPa", TAUT_SOLID_FIXED_COROTATED, 2e5f, 0.4f, 0x4E9B58},
    {"corotated, 1 MPa", TAUT_SOLID_COROTATED, 1e6f, 0.3f, 0xC9463D},
    {"St-Venant-Kirchhoff, 2 MPa", TAUT_SOLID_ST_VENANT_KIRCHHOFF, 2e6f, 0.3f, 0xE3B23C}};

// Figures fall on each other crosswise, each fifth of them rigid, with crates between them.
Scene soft_pile(int figures, const Options& options) {
    constexpr int kCubes = 120, kMaterials = 4, kRow = 3;
    constexpr double kTall = 0.8, kDensity = 1000;
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    const Solid one = options.mesh.empty() ? fill_surface(figure_surface(), kCubes, "the figure made here")
                                           : solid_from_file(options.mesh, kCubes);
    const RigidFigure rigid(scene, armadillo_limbs(), kTall, kDensity);
    const int box = cube_shape(scene, 0.28);
    for (int i = 0; i < figures; ++i) {
        const int layer = i / kRow, place = i % kRow;
        const double round = 2.0944 * place + 0.7 * layer;
        const taut_pos at = {0.42 * std::cos(round), 0.45 + 0.75 * layer + 0.06 * place, 0.42 * std::sin(round)};
        const taut_quat by = times(turn({0, 1, 0}, 1.1 * i), turn({1, 0, 0}, i % 2 == 0 ? 1.2 : -1.3));
        if (i % (kMaterials + 1) == kMaterials) {
            scene.roles.pile.push_back(scene.add_body(rigid.at(at, by, Look::steel)));
            continue;
        }
        const PileMaterial& kind = kPileMaterials[i % (kMaterials + 1)];
        Solid solid = one;
        stand_up(solid.points, kTall, 0);
        lay(solid.points, by, at);
        solid.def.material = kind.material;
        solid.def.young_modulus = kind.young;
        solid.def.poisson_ratio = kind.poisson;
        solid.def.density = static_cast<float>(kDensity);
        solid.def.self_collision = 1;
        solid.def.solve = TAUT_DEFORMABLE_AUTO;
        solid.look.paint = kind.paint;
        if (i < kMaterials) solid.look.label = kind.label;
        scene.add_solid(std::move(solid));
    }
    const double top = 0.9 + 0.75 * ((figures + kRow - 1) / kRow);
    for (int i = 0; i < 6; ++i) {
        const double round = 1.0472 * i;
        Body body = crate(box, {0.35 * std::cos(round), top + 0.35 * (i % 2), 0.35 * std::sin(round)}, 10);
        body.rotation = turn({0, 1, 0}, 0.8 * i);
        scene.roles.pile.push_back(scene.add_body(body));
    }
    scene.camera = {{1.8, 1.3, 2.6}, {0, 0.45, 0}, 42};
    scene.stage = {{-3, 0, -3}, {3, top + 1, 3}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace

// Rigid bunnies fall on a sheet held by its corners (Francu 2016, figure 8.1).
Scene build_bunnies_on_cloth(double, double, const Options& options) {
    constexpr int kSide = 30, kBunnies = 8;
    constexpr double kHeight = 1.5, kWide = 1.9, kTall = 0.32;
    Scene scene = soft_hall(kHeight);
    add_ground(scene);
    Cloth cloth = grid_cloth(kSide, kSide, kWide, kWide, kHeight);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = 0.4f;
    cloth.def.self_collision = 1;
    sag(cloth, kWide, 0.6);
    cloth.pinned = {0, kSide - 1, kSide * (kSide - 1), kSide * kSide - 1};
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x3D7EBF;
    scene.add_cloth(std::move(cloth));
    const RigidFigure bunny(scene, bunny_limbs(), kTall, 300);
    constexpr Look kLooks[] = {Look::wood, Look::skin, Look::stone, Look::paint};
    Random random(1);
    for (int i = 0; i < kBunnies; ++i) {
        const double round = 2.4 * i, out = 0.28;
        const taut_vec3 axis = random.direction();
        const taut_quat by = turn(axis, 0.6 * random.uniform() + 0.2 * i);
        scene.roles.pile.push_back(scene.add_body(
            bunny.at({out * std::cos(round), kHeight + 0.1 + 0.4 * i, out * std::sin(round)}, by, kLooks[i % 4])));
    }
    scene.camera = {{1.9, 2.2, 2.8}, {0, 1.15, 0}, 40};
    scene.stage = {{-2, 0, -2}, {2, 5, 2}};
    perturb(scene, options.seed);
    return scene;
}

// A soft dragon falls on stairs among rigid boxes (Francu 2016, figure 8.2).
Scene build_dragon_on_stairs(double, double, const Options& options) {
    constexpr int kCubes = 420, kSteps = 5;
    constexpr double kRun = 0.55, kRise = 0.25, kHalfWidth = 1.3;
    Scene scene = soft_hall(2);
    add_ground(scene);
    for (int i = 0; i < kSteps; ++i) {
        const double half = 0.5 * kRise * (kSteps - i);
        add_static_box(scene, {0, half, (i - 0.5 * kSteps) * kRun}, kHalfWidth, half, kRun / 2, Look::stone);
    }
    Solid dragon = creature(options.mesh, "dragon_100k.obj", dragon_limbs(), kCubes);
    stand_up(dragon.points, 1.1, kRise * kSteps + 0.35);
    for (taut_pos& p : dragon.points) p.z -= 0.5;
    dragon.def.young_modulus = 2e5f;
    dragon.def.poisson_ratio = 0.45f;
    dragon.def.density = 500;
    dragon.def.solve = TAUT_DEFORMABLE_AUTO;
    dragon.look.paint = 0x4E9B58;
    dragon.velocities.assign(dragon.points.size(), {0, 0, 0.7f});
    scene.add_solid(std::move(dragon));
    const int box = cube_shape(scene, 0.26);
    for (int i = 0; i < 9; ++i) {
        const int step = 1 + i / 3;
        const taut_pos at = {-0.6 + 0.6 * (i % 3), kRise * (kSteps - step) + 0.13, (step - 0.5 * kSteps) * kRun};
        scene.roles.pile.push_back(scene.add_body(crate(box, at, 6)));
    }
    scene.camera = {{3.9, 2.4, 3.9}, {0, 0.6, 0.5}, 42};
    scene.stage = {{-3, 0, -3}, {3, 3, 4}};
    perturb(scene, options.seed);
    return scene;
}

// A soft cow falls on the ground (Francu 2016, figure 5.8).
Scene build_cow_falls(double, double, const Options& options) {
    constexpr int kCubes = 300;
    constexpr double kYoung = 4e5;
    Scene scene = soft_hall(1.6);
    add_ground(scene);
    Solid cow = creature(options.mesh, "cow.obj", cow_limbs(), kCubes);
    stand_up(cow.points, 1.2, 0.5);
    cow.def.young_modulus = static_cast<float>(kYoung);
    cow.def.poisson_ratio = 0.45f;
    cow.def.density = 900;
    cow.def.solve = TAUT_DEFORMABLE_AUTO;
    cow.def.self_collision = 1;
    cow.look = {SoftColours::stress, 0.25 * kYoung, 0, ""};
    scene.add_solid(std::move(cow));
    scene.camera = {{2.6, 1.3, 1.7}, {0, 0.6, 0}, 40};
    scene.stage = {{-2.5, 0, -2.5}, {2.5, 2.5, 2.5}};
    perturb(scene, options.seed);
    return scene;
}

// A soft ring falls on its edge and closes on itself (Gast and Schroeder 2014, figure 6).
Scene build_torus_self(double, double, const Options& options) {
    constexpr int kRound = 48, kAbout = 20, kCubes = 700;
    constexpr double kRing = 0.42, kTube = 0.13, kTau = 6.283185307179586;
    Scene scene = soft_hall(1.4);
    add_ground(scene);
    Surface surface;
    for (int i = 0; i < kRound; ++i)
        for (int k = 0; k < kAbout; ++k) {
            const double u = kTau * i / kRound, v = kTau * k / kAbout, r = kRing + kTube * std::cos(v);
            surface.points.push_back({r * std::cos(u), 1.0 + r * std::sin(u), kTube * std::sin(v)});
            const auto at = [&](int a, int b) {
                return static_cast<uint32_t>((i + a) % kRound * kAbout + (k + b) % kAbout);
            };
            surface.triangles.insert(surface.triangles.end(),
                                     {at(0, 0), at(1, 0), at(1, 1), at(0, 0), at(1, 1), at(0, 1)});
        }
    Solid ring = fill_surface(surface, kCubes, "the ring made here");
    ring.def.young_modulus = 3e4f;
    ring.def.poisson_ratio = 0.4f;
    ring.def.solve = TAUT_DEFORMABLE_AUTO;
    ring.def.self_collision = 1;
    ring.look.paint = 0xE3B23C;
    scene.add_solid(std::move(ring));
    scene.camera = {{1.5, 1.0, 2.6}, {0, 0.5, 0}, 38};
    scene.stage = {{-1.5, 0, -1.5}, {1.5, 2, 1.5}};
    perturb(scene, options.seed);
    return scene;
}

Scene build_soft_pile(double, double, const Options& options) { return soft_pile(5, options); }

// n figures.
Scene build_soft_pile_n(double n, double, const Options& options) { return soft_pile(static_cast<int>(n), options); }

}  // namespace scenes
