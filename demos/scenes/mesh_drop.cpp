// Convex hulls of a mesh file's pieces, poured down stairs.
#include <algorithm>

#include "builders.h"
#include "obj_file.h"
#include "parts.h"

namespace scenes {

namespace {

constexpr double kSize = 0.6;       // largest side of a body [m]
constexpr double kThinnest = 1e-3;  // of kSize; flatter pieces have no volume

Shape hull_of(const ObjPiece& piece, const std::string& path) {
    Shape shape;
    shape.kind = ShapeKind::hull;
    shape.source = path + ":" + std::to_string(piece.line) + ": piece '" + piece.name + "'";
    taut_vec3 low = piece.points.front(), high = low;
    for (const taut_vec3& p : piece.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    taut_vec3 side = {high.x - low.x, high.y - low.y, high.z - low.z};
    float largest = std::max({side.x, side.y, side.z});
    if (piece.points.size() < 4 || !(largest > 0) || std::min({side.x, side.y, side.z}) < kThinnest * largest)
        throw BadFile(shape.source + " is flat or has fewer than four points: no volume, so no body");
    auto scale = static_cast<float>(kSize / largest);
    for (const taut_vec3& p : piece.points)
        shape.points.push_back({(p.x - 0.5f * (low.x + high.x)) * scale, (p.y - 0.5f * (low.y + high.y)) * scale,
                                (p.z - 0.5f * (low.z + high.z)) * scale});
    return shape;
}

}  // namespace

Scene build_mesh_drop(double, double, const Options& options) {
    constexpr int kBodies = 200, kSteps = 8;
    constexpr double kRun = 0.9, kRise = 0.4, kHalfWidth = 3;  // of the stairs [m]
    Scene scene = empty_scene();
    std::vector<int> hulls;
    for (const ObjPiece& piece : read_obj(options.mesh)) hulls.push_back(scene.add_shape(hull_of(piece, options.mesh)));
    add_ground(scene);
    for (int i = 0; i < kSteps; ++i) {
        double half_height = 0.5 * kRise * (kSteps - i);
        add_static_box(scene, {(i - 0.5 * kSteps) * kRun, half_height, 0}, kRun / 2, half_height, kHalfWidth,
                       Look::stone);
    }
    Random random(1);
    for (int i = 0; i < kBodies; ++i) {
        int column = i % 5, row = i / 5 % 5, layer = i / 25;
        Body body =
            crate(hulls[static_cast<size_t>(i) % hulls.size()],
                  {-0.45 * kSteps * kRun + column * 0.75, kRise * kSteps + 0.8 + layer * 0.75, (row - 2) * 0.85}, 0);
        taut_vec3 axis = random.direction();
        body.rotation = turn(axis, 3 * random.uniform());
        body.linear_velocity = {1.0f, 0, 0};
        scene.roles.pile.push_back(scene.add_body(body));
    }
    perturb(scene, options.seed);
    scene.camera = {{10.5, 7.8, 11.5}, {0.6, 1.9, 0}, 38};
    scene.stage = {{-6, 0, -7}, {10, 10, 7}};
    return scene;
}

}  // namespace scenes
