// Granular matter: particles with a radius and friction, poured into a heap.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

namespace {

constexpr double kGrainRadius = 0.05, kGrainMass = 1;  // [m, kg]

Body grain_at(int shape, taut_pos at, float friction) {
    Body grain = crate(shape, at, kGrainMass, Look::particle);
    grain.kind = TAUT_BODY_PARTICLE;
    grain.friction = friction;
    grain.grain = true;
    return grain;
}

}  // namespace

// R is the friction of the grains. They do not turn, so that even round ones heap up.
Scene build_grains(double n, double r, const Options& options) {
    constexpr double kBed = 3.2, kBump = 2.2 * kGrainRadius;  // [m]
    constexpr int kRow = 4;                                   // of the column that is poured
    Scene scene = empty_scene();
    add_ground(scene);
    const int ball = sphere_shape(scene, kGrainRadius);
    const auto friction = static_cast<float>(r);
    // A bed of grains held fast.
    for (double x = -kBed / 2; x <= kBed / 2; x += kBump)
        for (double z = -kBed / 2; z <= kBed / 2; z += kBump) {
            Body bump = crate(ball, {x, 0, z}, 0, Look::stone);
            bump.kind = TAUT_BODY_STATIC;
            bump.friction = friction;
            scene.add_body(bump);
        }
    Random random(1);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        // A loose column, out of line enough to scatter as it lands.
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1), beside = 3 * kGrainRadius, above = 2.6 * kGrainRadius;
        const taut_vec3 jitter = random.in_cube(0.45 * kGrainRadius);
        const taut_pos at =
            plus({(column - middle) * beside, 4 * kGrainRadius + layer * above, (row - middle) * beside}, jitter.x,
                 0.4 * jitter.y, jitter.z);
        scene.roles.pile.push_back(scene.add_body(grain_at(ball, at, friction)));
    }
    perturb(scene, options.seed);
    scene.camera = {{2.6, 1.7, 3.2}, {0, 0.35, 0}, 38};
    scene.stage = {{-2, 0, -2}, {2, 8, 2}};
    return scene;
}

// A lattice of grains, each a centimetre out of its place, falls into a box of 2 x 2 m.
Scene build_grains_box(double n, double, const Options& options) {
    constexpr double kHalf = 1, kJitter = 0.01, kSpacing = 2.4 * kGrainRadius;  // [m]
    constexpr int kRow = 16;
    Scene scene = empty_scene();
    add_ground(scene);
    const int count = static_cast<int>(n), layers = (count + kRow * kRow - 1) / (kRow * kRow);
    const double tall = 2 * kGrainRadius + layers * kSpacing;
    add_bin(scene, kHalf, tall, 0.5);
    scene.roles.bin = Bounds{{-kHalf, -0.5, -kHalf}, {kHalf, 2 * tall, kHalf}};
    const int ball = sphere_shape(scene, kGrainRadius);
    Random random(1);
    for (int i = 0; i < count; ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1);
        const taut_vec3 jitter = random.in_cube(kJitter);
        const taut_pos at =
            plus({(column - middle) * kSpacing, 2 * kGrainRadius + layer * kSpacing, (row - middle) * kSpacing},
                 jitter.x, jitter.y, jitter.z);
        scene.roles.pile.push_back(scene.add_body(grain_at(ball, at, 0.5f)));
    }
    perturb(scene, options.seed);
    scene.camera = {{2.6, 0.7 * tall + 1.5, 3.2}, {0, 0.3 * tall, 0}, 42};
    scene.stage = {{-2, 0, -2}, {2, tall + 1, 2}};
    return scene;
}

}  // namespace scenes
