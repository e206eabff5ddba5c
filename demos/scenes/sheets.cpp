// Sheets that meet balls, the ground, the wind and themselves.
#include <cmath>
#include <numbers>

#include "builders.h"
#include "parts.h"
#include "soft_meshes.h"

namespace scenes {

namespace {

// Turns pinned vertices about the line of x through a point, at an even rate, then holds them.
Motion twisted(int cloth, std::vector<uint32_t> vertices, double turns, double seconds, taut_pos pivot) {
    const double angle = 2 * std::numbers::pi * turns, rate = angle / seconds;
    Motion motion;
    motion.cloth = cloth;
    motion.vertices = std::move(vertices);
    motion.about = {1, 0, 0};
    motion.pivot = pivot;
    motion.track.keys = {{0, 0, rate}, {seconds, angle, rate}, {seconds + 1e-9, angle, 0}};
    return motion;
}

int fixed_ball(Scene& scene, double radius, taut_pos at, double friction, taut_body_kind kind) {
    Body ball = crate(sphere_shape(scene, radius), at, 0, Look::stone);
    ball.kind = kind;
    ball.friction = static_cast<float>(friction);
    return scene.add_body(ball);
}

}  // namespace

// A sheet falls on a fixed ball; r is the friction of everything.
Scene build_drape_sphere(double, double r, const Options& options) {
    constexpr int kSide = 60;
    constexpr double kRadius = 0.4, kFloorBelow = 0.9;  // the ball's top [m]
    Scene scene = soft_hall(kFloorBelow + 0.3);
    add_ground(scene);
    scene.bodies.back().friction = static_cast<float>(r);
    fixed_ball(scene, kRadius, {0, kFloorBelow - kRadius, 0}, r, TAUT_BODY_STATIC);
    Cloth cloth = sheet(kSide, kFloorBelow + 0.1);
    cloth.def.material.friction = static_cast<float>(r);
    cloth.def.self_collision = 1;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x3D7EBF;
    scene.add_cloth(std::move(cloth));
    scene.camera = {{1.7, 1.5, 2.5}, {0, 0.45, 0}, 40};
    perturb(scene, options.seed);
    return scene;
}

// A sheet of 100 x 100 falls on a ball that begins to turn (Francu 2016, figures 5.5 and 8.5).
Scene build_cloth_on_sphere(double, double, const Options& options) {
    constexpr int kSide = 100;
    constexpr double kRadius = 0.5, kTop = 1.2, kFriction = 0.5;
    Scene scene = soft_hall(kTop + 0.3);
    add_ground(scene);
    const taut_pos centre = {0, kTop - kRadius, 0};
    Motion spin;
    spin.body = fixed_ball(scene, kRadius, centre, kFriction, TAUT_BODY_KINEMATIC);
    spin.about = {0, 1, 0};
    spin.pivot = centre;
    spin.track.keys = {{2, 0, 0}, {3, 0.5, 1}};
    scene.motions.push_back(spin);
    Cloth cloth = sheet(kSide, kTop + 0.05);
    cloth.def.material.friction = static_cast<float>(kFriction);
    cloth.def.solve = TAUT_DEFORMABLE_SWEPT;
    cloth.def.self_collision = 1;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0xB8473A;
    scene.add_cloth(std::move(cloth));
    scene.camera = {{1.5, 1.7, 2.1}, {0, 0.7, 0}, 40};
    perturb(scene, options.seed);
    return scene;
}

// Both short edges of a sheet are turned against each other by two turns each.
Scene build_cloth_twist(double, double, const Options& options) {
    constexpr int kLong = 60, kShort = 30;
    constexpr double kLength = 1, kWidth = 0.5, kHeight = 1.2, kTurns = 2, kSeconds = 4;
    Scene scene = soft_hall(kHeight);
    Cloth cloth = grid_cloth(kLong, kShort, kLength, kWidth, kHeight);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = static_cast<float>(kSheetDensity);
    cloth.def.self_collision = 1;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0x4E9B58;
    std::vector<uint32_t> near, far;
    for (uint32_t k = 0; k < kShort; ++k) near.push_back(k), far.push_back((kLong - 1) * kShort + k);
    cloth.pinned = near;
    cloth.pinned.insert(cloth.pinned.end(), far.begin(), far.end());
    const int index = scene.add_cloth(std::move(cloth));
    scene.motions.push_back(twisted(index, near, kTurns, kSeconds, {0, kHeight, 0}));
    scene.motions.push_back(twisted(index, far, -kTurns, kSeconds, {0, kHeight, 0}));
    scene.camera = {{0.5, 1.6, 1.6}, {0, 1.15, 0}, 40};
    perturb(scene, options.seed);
    return scene;
}

// A sheet falls edge on and folds into a heap.
Scene build_cloth_fold(double, double, const Options& options) {
    constexpr int kSide = 40;
    constexpr double kWide = 1.2, kLean = 0.05;  // of its top [m]
    Scene scene = soft_hall(1.2);
    add_ground(scene);
    Cloth cloth = grid_cloth(kSide, kSide, kWide, kWide, 0);
    cloth.def.kind = TAUT_CLOTH_LINKS;
    cloth.def.area_density = static_cast<float>(kSheetDensity);
    cloth.def.thickness = 0.01f;
    for (taut_pos& p : cloth.points) {  // upright, its weft along x
        const double up = p.x + kWide / 2, t = up / kWide;
        p = {p.z, 0.05 + up, kLean * t + 0.006 * std::sin(9 * std::numbers::pi * t)};
    }
    cloth.def.self_collision = 1;
    cloth.look.colours = SoftColours::plain;
    cloth.look.paint = 0xE3B23C;
    scene.add_cloth(std::move(cloth));
    scene.camera = {{1.2, 1.0, 1.7}, {-0.1, 0.25, 0.15}, 42};
    scene.stage = {{-1.5, 0, -1.5}, {1.5, 1.6, 1.5}};
    perturb(scene, options.seed);
    return scene;
}

// A flag on a pole.
Scene build_flag_in_wind(double, double, const Options& options) {
    constexpr int kLong = 37, kTall = 25;
    constexpr double kLength = 1.8, kHeight = 1.2, kTop = 2.3;
    Scene scene = soft_hall(kTop);
    add_ground(scene);
    Cloth flag = grid_cloth(kLong, kTall, kLength, kHeight, 0);
    for (taut_pos& p : flag.points) p = {p.x + kLength / 2, kTop - kHeight / 2 - p.z, 0.04 * std::sin(4 * p.x)};
    flag.def.kind = TAUT_CLOTH_TRIANGLES;
    flag.def.area_density = 0.12f;
    flag.def.stretch_stiffness[0] = flag.def.stretch_stiffness[1] = 4000;
    flag.def.shear_stiffness = 800;
    flag.def.bending_stiffness = 2e-5f;
    flag.def.air_drag = 1.2f;
    flag.def.air_lift = 1;
    flag.def.self_collision = 1;
    flag.look.colours = SoftColours::plain;
    flag.look.paint = 0xC9463D;
    for (uint32_t k = 0; k < kTall; ++k) flag.pinned.push_back(k);
    scene.add_cloth(std::move(flag));
    scene.world.wind = {6, 0.3f, 2};
    add_static_box(scene, {-0.03, kTop / 2 + 0.05, 0}, 0.03, kTop / 2 + 0.05, 0.03, Look::steel);
    scene.camera = {{0.9, 1.8, 4.0}, {0.75, 1.4, 0}, 38};
    scene.stage = {{-1, 0, -2}, {3, 2.7, 2}};
    perturb(scene, options.seed);
    return scene;
}

}  // namespace scenes
