// Box, sphere, capsule or hull against a plane: the lowest points of its core, less the radius.
#include <array>
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/kernel.h"

namespace taut::collision {
namespace {

// The points that can touch a plane, and the radius they are grown by.
struct Core {
    std::span<const Vec3f> points;
    float radius;
};

struct CoreStore {
    std::array<Vec3f, 8> points;
};

Core box_core(const Shape& shape, CoreStore& store) {
    for (int i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k) store.points[size_t(i)][k] = i >> k & 1 ? shape.size[k] : -shape.size[k];
    }
    return {store.points, 0};
}

Core sphere_core(const Shape& shape, CoreStore& store) {
    store.points[0] = Vec3f::Zero();
    return {std::span(store.points).first(1), shape.size.x()};
}

Core capsule_core(const Shape& shape, CoreStore& store) {
    store.points[0] = Vec3f(0, -shape.size.y(), 0);
    store.points[1] = Vec3f(0, shape.size.y(), 0);
    return {std::span(store.points).first(2), shape.size.x()};
}

Core hull_core(const Shape& shape, CoreStore&) { return {shape.hull->vertices, 0}; }

// Of all corners within the margin none takes the place of one that it lies above by more than 35 degrees, as the top
// of a thin plate would that of its bottom: add_points' diagonals are sqrt 2 long.
constexpr float kSlope = 2;

constexpr Core (*kCores[])(const Shape&, CoreStore&) = {nullptr, box_core, sphere_core, capsule_core, hull_core};

}  // namespace

float core_plane(const Pair& pair, Manifold& out) {
    // Height of a's origin in double: a plane's own origin may be kilometres away.
    const Vec3f up = pair.at_b.rotation * pair.b.size;
    const float height = float(up.cast<double>().dot(pair.at_a.position - pair.at_b.position));
    const Vec3f up_in_a = pair.at_a.rotation.transpose() * up;

    CoreStore store;
    const Core core = kCores[size_t(pair.a.kind)](pair.a, store);
    // Tangents from a's own axes turn with it, so that the same corners are chosen every frame.
    int k = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(up_in_a[i]) < std::fabs(up_in_a[k]) - 1e-3f) k = i;
    }
    ReferencePlane plane;
    plane.normal = up_in_a;
    plane.u = (Vec3f::Unit(k) - up_in_a * up_in_a[k]).normalized();
    plane.v = up_in_a.cross(plane.u);
    plane.offset = -height;
    Polygon polygon;
    float least = 1e30f;
    for (size_t i = 0; i < core.points.size(); ++i) {
        const Vec3f& p = core.points[i];
        const float z = up_in_a.dot(p) + height - core.radius;
        least = std::min(least, z);
        if (z > pair.margin) continue;
        polygon.points[polygon.count++] = {plane.u.dot(p), plane.v.dot(p), z, uint32_t(i)};
    }
    if (polygon.count == 0) return least;
    add_points(polygon, plane, 0, pair.margin, out, kSlope);
    out.normal = -up_in_a;
    return 0;
}

}  // namespace taut::collision
