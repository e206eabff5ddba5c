// Piles, pyramids and stacks of cubes.
#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

constexpr double kSide = 0.5;      // [m]
constexpr double kCubeMass = 125;  // density 1000 [kg]

void frame_stack(Scene& scene, double height) {
    scene.camera.target = {0, 0.5 * height, 0};
    double distance = 3.0 + 1.45 * height;
    scene.camera.eye = {0.55 * distance, 0.35 * height + 0.22 * distance, 0.83 * distance};
    scene.stage = {{-4, 0, -4}, {4, height + 1, 4}};
}

}  // namespace

Scene build_boxes2000(double, double, const Options& options) {
    constexpr int kCount = 2000, kRow = 14;
    constexpr double kSpacing = 0.68, kLayer = 0.8, kFirstLayer = 0.6, kMostTurn = 0.3;
    constexpr double kBin = 5.0, kWallHeight = 6.0, kWallThickness = 0.5;  // half width, ... [m]
    Scene scene = empty_scene();
    add_ground(scene);
    add_bin(scene, kBin, kWallHeight, kWallThickness);
    int cube = cube_shape(scene, kSide);
    Random random(1);
    for (int i = 0; i < kCount; ++i) {
        int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        double middle = 0.5 * (kRow - 1);
        Body body = crate(cube, {(column - middle) * kSpacing, kFirstLayer + layer * kLayer, (row - middle) * kSpacing},
                          kCubeMass);
        taut_vec3 axis = random.direction();
        body.rotation = turn(axis, kMostTurn * random.uniform());
        scene.roles.pile.push_back(scene.add_body(body));
    }
    scene.roles.bin = Bounds{{-kBin, 0, -kBin}, {kBin, 1e3, kBin}};
    perturb(scene, options.seed);
    scene.camera = {{10.5, 12.5, 14.0}, {0, 2.3, 0}, 40};
    scene.stage = {{-6, 0, -6}, {6, 10, 6}};
    return scene;
}

// A convex stone: points on a ball that is stretched along its axes.
int stone_shape(Scene& scene, Random& random) {
    const auto scaled = [&](float radius) { return radius * static_cast<float>(0.75 + 0.5 * random.uniform()); };
    const taut_vec3 axes = {scaled(0.3f), scaled(0.3f), scaled(0.3f)};
    Shape shape;
    shape.kind = ShapeKind::hull;
    const int points = 12 + static_cast<int>(5 * random.uniform());
    for (int i = 0; i < points; ++i) {
        const taut_vec3 d = random.direction();
        shape.points.push_back({axes.x * d.x, axes.y * d.y, axes.z * d.z});
    }
    return scene.add_shape(std::move(shape));
}

Scene build_hulls(double n, double, const Options& options) {
    constexpr int kRow = 10, kShapes = 100;
    constexpr double kSpacing = 0.8, kBin = 4.0, kWallHeight = 6.0, kWallThickness = 0.5, kMass = 80;  // [m], [kg]
    Scene scene = empty_scene();
    add_ground(scene);
    add_bin(scene, kBin, kWallHeight, kWallThickness);
    Random random(1);
    std::vector<int> shapes;
    for (int i = 0; i < kShapes; ++i) shapes.push_back(stone_shape(scene, random));
    for (int i = 0; i < static_cast<int>(n); ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        const double middle = 0.5 * (kRow - 1);
        Body body = crate(shapes[static_cast<size_t>(i % kShapes)],
                          {(column - middle) * kSpacing, 0.6 + layer * kSpacing, (row - middle) * kSpacing}, kMass,
                          Look::stone);
        body.rotation = turn(random.direction(), 3 * random.uniform());
        scene.roles.pile.push_back(scene.add_body(body));
    }
    scene.roles.bin = Bounds{{-kBin, 0, -kBin}, {kBin, 1e3, kBin}};
    perturb(scene, options.seed);
    scene.camera = {{8.5, 9.0, 11.0}, {0, 1.6, 0}, 40};
    scene.stage = {{-5, 0, -5}, {5, 9, 5}};
    return scene;
}

Scene build_pyramid(double n, double, const Options& options) {
    constexpr double kSpacing = 0.52;
    int base = static_cast<int>(n);
    Scene scene = empty_scene();
    add_ground(scene);
    int cube = cube_shape(scene, kSide);
    for (int row = 0; row < base; ++row)
        for (int column = 0; column < base - row; ++column) {
            double x = (column - 0.5 * (base - 1 - row)) * kSpacing;
            scene.roles.pile.push_back(scene.add_body(crate(cube, {x, kSide / 2 + row * kSide, 0}, kCubeMass)));
        }
    scene.roles.top_body = scene.roles.pile.back();
    perturb(scene, options.seed);
    double height = base * kSide;
    scene.camera = {{0.7 * height + 1, 0.62 * height + 1.2, 1.75 * height + 2}, {0, 0.48 * height, 0}, 40};
    scene.stage = {{-0.65 * height - 2, 0, -4}, {0.65 * height + 2, height + 1, 4}};
    return scene;
}

Scene build_stack(double n, double, const Options& options) {
    int count = static_cast<int>(n);
    Scene scene = empty_scene();
    add_ground(scene);
    int cube = cube_shape(scene, kSide);
    for (int i = 0; i < count; ++i)
        scene.roles.pile.push_back(scene.add_body(crate(cube, {0, kSide / 2 + i * kSide, 0}, kCubeMass)));
    scene.roles.top_body = scene.roles.pile.back();
    perturb(scene, options.seed);
    frame_stack(scene, count * kSide);
    return scene;
}

Scene build_heavy_on_light(double, double r, const Options& options) {
    constexpr int kLight = 10;
    Scene scene = empty_scene();
    add_ground(scene);
    int cube = cube_shape(scene, kSide);
    for (int i = 0; i <= kLight; ++i) {
        bool heavy = i == kLight;
        Body body = crate(cube, {0, kSide / 2 + i * kSide, 0}, heavy ? r : 1.0, heavy ? Look::steel : Look::crate);
        scene.roles.pile.push_back(scene.add_body(body));
    }
    scene.roles.top_body = scene.roles.pile.back();
    perturb(scene, options.seed);
    frame_stack(scene, (kLight + 1) * kSide);
    return scene;
}

Scene build_deep_start(double, double, const Options& options) {
    constexpr double kCube = 1.0, kDepth = 0.2;
    Scene scene = empty_scene();
    add_ground(scene);
    Body body = crate(cube_shape(scene, kCube), {0, kCube / 2 - kDepth, 0}, 0);
    scene.roles.pile.push_back(scene.add_body(body));
    perturb(scene, options.seed);
    frame_stack(scene, 1.5);
    return scene;
}

}  // namespace scenes
