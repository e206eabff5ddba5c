// Bodies of every kind of shape in one heap.
#include <array>

#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

// A gem: two pyramids on a square; a scaled hull mirrors it on its side.
std::vector<taut_vec3> gem_points() {
    std::vector<taut_vec3> points = {{0, 0.3f, 0}, {0, -0.2f, 0}};
    for (float x : {-0.2f, 0.2f})
        for (float z : {-0.2f, 0.2f}) points.push_back({x, 0, z});
    return points;
}

int round_shape(Scene& scene, ShapeKind kind, float radius, float half_length, float top_radius = 0) {
    Shape shape;
    shape.kind = kind;
    shape.radius = radius;
    shape.top_radius = top_radius;
    shape.half_length = half_length;
    return scene.add_shape(std::move(shape));
}

int gem_shape(Scene& scene) {
    Shape gem;
    gem.kind = ShapeKind::hull;
    gem.points = gem_points();
    return scene.add_shape(std::move(gem));
}

int scaled_shape(Scene& scene, int hull, taut_vec3 scale) {
    Shape shape;
    shape.kind = ShapeKind::scaled_hull;
    shape.hull = hull;
    shape.scale = scale;
    return scene.add_shape(std::move(shape));
}

}  // namespace

Scene build_shapes(double n, double, const Options& options) {
    constexpr int kRow = 5;
    constexpr double kSpacing = 0.72, kHalfBin = 2.1, kWall = 2.2;  // [m]
    Scene scene = empty_scene();
    add_ground(scene);
    add_bin(scene, kHalfBin, kWall, 0.3);
    const int gem = gem_shape(scene);
    const std::array<int, 10> shapes = {round_shape(scene, ShapeKind::cylinder, 0.22f, 0.18f),
                                        round_shape(scene, ShapeKind::cone, 0.25f, 0.22f),
                                        round_shape(scene, ShapeKind::tapered_capsule, 0.2f, 0.16f, 0.1f),
                                        box_shape(scene, 0.2, 0.15, 0.25),
                                        gem,
                                        round_shape(scene, ShapeKind::cylinder, 0.1f, 0.3f),
                                        scaled_shape(scene, gem, {1.4f, -0.8f, 0.9f}),
                                        sphere_shape(scene, 0.2),
                                        round_shape(scene, ShapeKind::cylinder, 0.28f, 0.05f),
                                        capsule_shape(scene, 0.13, 0.17)};
    Random random(1);
    for (int i = 0; i < static_cast<int>(n); ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1);
        Body body = crate(shapes[static_cast<size_t>(i) % shapes.size()],
                          {(column - middle) * kSpacing, 0.5 + layer * kSpacing, (row - middle) * kSpacing}, 0);
        const taut_vec3 axis = random.direction();
        body.rotation = turn(axis, 3 * random.uniform());
        scene.roles.pile.push_back(scene.add_body(body));
    }
    scene.roles.bin = Bounds{{-kHalfBin, 0, -kHalfBin}, {kHalfBin, 1e3, kHalfBin}};
    perturb(scene, options.seed);
    scene.camera = {{4.6, 5.0, 6.2}, {0, 0.8, 0}, 38};
    scene.stage = {{-3, 0, -3}, {3, 7, 3}};
    return scene;
}

}  // namespace scenes
