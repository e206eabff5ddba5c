// Convex hulls of a mesh file's pieces, poured down stairs; a closed mesh of one piece falls as the hulls that it is
// decomposed into.
#include <algorithm>
#include <optional>

#include "builders.h"
#include "obj_file.h"
#include "parts.h"
#include "taut_world.h"

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

// Corners of a hull that is baked [m].
std::vector<taut_vec3> corners_of(taut_world world, taut_baked part) {
    taut_shape shape;
    uint32_t count = 0;
    check(taut_world_add_baked(world, part, &shape), "a part of a mesh");
    taut_shape_get_triangles(shape, nullptr, 0, &count);
    std::vector<taut_vec3> corners(count);
    check(taut_shape_get_triangles(shape, corners.data(), count, &count), "a part of a mesh");
    return corners;
}

// A body of a closed mesh, with its mass and inertia; none of one that is open or convex.
std::optional<Body> body_of_surface(Scene& scene, const std::string& path) {
    constexpr uint32_t kMostParts = 16;
    constexpr float kDensity = 1000;  // [kg/m^3]
    const Surface surface = read_surface(path);
    taut_pos low = surface.points.front(), high = low;
    for (const taut_pos& p : surface.points) {
        low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
        high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    }
    const double scale = kSize / std::max({high.x - low.x, high.y - low.y, high.z - low.z});
    std::vector<taut_vec3> points;
    for (const taut_pos& p : surface.points)
        points.push_back({static_cast<float>((p.x - 0.5 * (low.x + high.x)) * scale),
                          static_cast<float>((p.y - 0.5 * (low.y + high.y)) * scale),
                          static_cast<float>((p.z - 0.5 * (low.z + high.z)) * scale)});
    taut_decomposition_def def;
    taut_decomposition_def_init(&def);
    def.vertices = points.data();
    def.vertex_count = static_cast<uint32_t>(points.size());
    def.indices = surface.triangles.data();
    def.triangle_count = static_cast<uint32_t>(surface.triangles.size() / 3);
    def.max_parts = kMostParts;
    def.tolerance = static_cast<float>(kSize / 25);
    taut_baked parts[kMostParts];
    uint32_t count = 0;
    taut_decomposition_info info;
    if (taut_bake_decomposition(&def, nullptr, parts, kMostParts, &count, &info) != TAUT_OK) return std::nullopt;
    taut_world_def world_def;
    taut_world_def_init(&world_def);
    taut_world world;
    check(taut_world_create(&world_def, &world), "a world for parts");
    Body body;
    for (uint32_t i = 0; i < count; ++i) {
        Shape hull;
        hull.kind = ShapeKind::hull;
        hull.points = corners_of(world, parts[i]);
        hull.source = path + ": part " + std::to_string(i) + " of its decomposition";
        const int shape = scene.add_shape(hull);
        if (i == 0)
            body.shape = shape;
        else
            body.parts.push_back({shape, {}, {0, 0, 0, 1}});
        check(taut_baked_release(parts[i]), "a part of a mesh");
    }
    check(taut_world_destroy(world), "a world for parts");
    if (count == 1) return std::nullopt;
    const taut_sym3& inertia = info.solid.inertia;
    body.mass = kDensity * info.solid.mass;
    body.centre_of_mass = info.solid.centre_of_mass;
    body.inertia = {kDensity * inertia.xx, kDensity * inertia.yy, kDensity * inertia.zz,
                    kDensity * inertia.xy, kDensity * inertia.xz, kDensity * inertia.yz};
    return body;
}

}  // namespace

Scene build_mesh_drop(double, double, const Options& options) {
    constexpr int kBodies = 200, kSteps = 8;
    constexpr double kRun = 0.9, kRise = 0.4, kHalfWidth = 3;  // of the stairs [m]
    Scene scene = empty_scene();
    std::vector<Body> bodies;
    const std::vector<ObjPiece> pieces = read_obj(options.mesh);
    if (const auto whole = pieces.size() == 1 ? body_of_surface(scene, options.mesh) : std::nullopt)
        bodies.push_back(*whole);
    else
        for (const ObjPiece& piece : pieces)
            bodies.push_back(crate(scene.add_shape(hull_of(piece, options.mesh)), {}, 0));
    add_ground(scene);
    for (int i = 0; i < kSteps; ++i) {
        double half_height = 0.5 * kRise * (kSteps - i);
        add_static_box(scene, {(i - 0.5 * kSteps) * kRun, half_height, 0}, kRun / 2, half_height, kHalfWidth,
                       Look::stone);
    }
    Random random(1);
    for (int i = 0; i < kBodies; ++i) {
        int column = i % 5, row = i / 5 % 5, layer = i / 25;
        Body body = bodies[static_cast<size_t>(i) % bodies.size()];
        body.position = {-0.45 * kSteps * kRun + column * 0.75, kRise * kSteps + 0.8 + layer * 0.75, (row - 2) * 0.85};
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
