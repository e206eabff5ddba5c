// A height field of hills with stairs of triangles in it, and a hundred mixed bodies that tumble down both.
#include <cmath>

#include "builders.h"
#include "parts.h"

namespace scenes {

namespace {

constexpr uint32_t kSamples = 61;
constexpr double kSpacing = 0.4, kHalf = 0.5 * (kSamples - 1) * kSpacing;  // [m]
constexpr double kAbove = 0.5;  // of the hills over the plane that is drawn [m]

// A bowl with ripples; x and z from its middle [m].
double height_of(double x, double z) {
    return 0.02 * (x * x + z * z) + 0.35 * std::sin(0.9 * x + 0.4) * std::cos(0.8 * z);
}

int hills_shape(Scene& scene) {
    Shape shape;
    shape.kind = ShapeKind::height_field;
    shape.rows = kSamples;
    shape.spacing = static_cast<float>(kSpacing);
    for (uint32_t row = 0; row < kSamples; ++row)
        for (uint32_t column = 0; column < kSamples; ++column)
            shape.heights.push_back(static_cast<float>(height_of(column * kSpacing - kHalf, row * kSpacing - kHalf)));
    return scene.add_shape(shape);
}

void add_quad(Shape& shape, taut_vec3 a, taut_vec3 b, taut_vec3 c, taut_vec3 d) {
    const auto first = static_cast<uint32_t>(shape.points.size());
    for (const taut_vec3& p : {a, b, c, d}) shape.points.push_back(p);
    for (uint32_t corner : {0, 1, 2, 0, 2, 3}) shape.indices.push_back(first + corner);
}

// Rise along -x from the origin; treads, risers and both sides down to the lowest.
int stairs_shape(Scene& scene) {
    constexpr int kSteps = 9;
    constexpr float kRun = 0.6f, kRise = 0.35f, kWidth = 3, kDown = -2;
    Shape shape;
    shape.kind = ShapeKind::mesh;
    for (int i = 0; i < kSteps; ++i) {
        const float x = -kRun * static_cast<float>(i), x2 = x - kRun;
        const float y = i == 0 ? kDown : kRise * static_cast<float>(i), y2 = kRise * static_cast<float>(i + 1);
        add_quad(shape, {x, y, 0}, {x, y2, 0}, {x, y2, kWidth}, {x, y, kWidth});
        add_quad(shape, {x, y2, 0}, {x2, y2, 0}, {x2, y2, kWidth}, {x, y2, kWidth});
        add_quad(shape, {x, kDown, kWidth}, {x, y2, kWidth}, {x2, y2, kWidth}, {x2, kDown, kWidth});
        add_quad(shape, {x, kDown, 0}, {x2, kDown, 0}, {x2, y2, 0}, {x, y2, 0});
    }
    const float back = -kRun * kSteps, top = kRise * kSteps;
    add_quad(shape, {back, kDown, 0}, {back, kDown, kWidth}, {back, top, kWidth}, {back, top, 0});
    return scene.add_shape(shape);
}

// A pyramid over a square, cut off above.
int stone_shape(Scene& scene) {
    Shape shape;
    shape.kind = ShapeKind::hull;
    for (float sign : {-1.0f, 1.0f})
        for (float other : {-1.0f, 1.0f}) {
            shape.points.push_back({0.32f * sign, -0.2f, 0.32f * other});
            shape.points.push_back({0.18f * sign, 0.22f, 0.18f * other});
        }
    return scene.add_shape(shape);
}

void add_static(Scene& scene, int shape, taut_pos position, Look look) {
    Body body;
    body.kind = TAUT_BODY_STATIC;
    body.shape = shape;
    body.position = position;
    body.look = look;
    scene.add_body(body);
}

}  // namespace

Scene build_terrain(double, double, const Options& options) {
    constexpr int kBodies = 100, kRow = 5;
    Scene scene = empty_scene();
    add_static(scene, hills_shape(scene), {-kHalf, kAbove, -kHalf}, Look::wood);
    add_static(scene, stairs_shape(scene), {-1.5, 0.2 + kAbove, -1.5}, Look::stone);
    const int shapes[] = {box_shape(scene, 0.3, 0.2, 0.25), sphere_shape(scene, 0.24), capsule_shape(scene, 0.15, 0.25),
                          stone_shape(scene)};
    const Look looks[] = {Look::crate, Look::steel, Look::paint, Look::brick};
    Random random(1);
    for (int i = 0; i < kBodies; ++i) {
        const int column = i % kRow, row = i / kRow % kRow, layer = i / (kRow * kRow);
        Body body = crate(shapes[i % 4], {-7.0 + 1.3 * column, 6.0 + 1.1 * layer, -2.2 + 1.1 * row}, 0, looks[i % 4]);
        body.rotation = turn(random.direction(), 3 * random.uniform());
        scene.roles.pile.push_back(scene.add_body(body));
    }
    perturb(scene, options.seed);
    scene.camera = {{3.0, 8.5, -13.5}, {-2.6, 2.0, 0}, 40};
    scene.stage = {{-12, 0, -12}, {12, 10, 12}};
    return scene;
}

}  // namespace scenes
