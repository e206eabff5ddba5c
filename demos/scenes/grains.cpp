// Granular matter: particles with a radius and friction, poured into a heap.
#include "builders.h"
#include "parts.h"
#include "pose.h"

namespace scenes {

// R is the friction of the grains. They do not turn, so that even round ones heap up.
Scene build_grains(double n, double r, const Options& options) {
    constexpr double kRadius = 0.05, kMass = 1, kBed = 3.2, kBump = 2.2 * kRadius;  // [m, kg]
    constexpr int kRow = 8;                                                         // of the column that is poured
    Scene scene = empty_scene();
    add_ground(scene);
    const int ball = sphere_shape(scene, kRadius);
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
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1), spacing = 2.1 * kRadius;
        const taut_vec3 jitter = random.in_cube(0.04 * kRadius);
        Body grain = crate(ball,
                           plus({(column - middle) * spacing, 3 * kRadius + layer * spacing, (row - middle) * spacing},
                                jitter.x, jitter.y, jitter.z),
                           kMass, Look::particle);
        grain.kind = TAUT_BODY_PARTICLE;
        grain.friction = friction;
        scene.roles.pile.push_back(scene.add_body(grain));
    }
    perturb(scene, options.seed);
    scene.camera = {{2.6, 1.7, 3.2}, {0, 0.35, 0}, 38};
    scene.stage = {{-2, 0, -2}, {2, 8, 2}};
    return scene;
}

}  // namespace scenes
