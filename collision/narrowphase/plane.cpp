// Box, sphere, capsule or hull against a plane: the lowest points of its core, less the radius.
#include <array>

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
    store.points = box_corners(shape.size);
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

constexpr Core (*kCores[])(const Shape&, CoreStore&) = {nullptr, box_core, sphere_core, capsule_core, hull_core};

}  // namespace

float core_plane(const Pair& pair, Manifold& out) {
    // Height of a's origin in double: a plane's own origin may be kilometres away.
    const Vec3f up = pair.at_b.rotation * pair.b.size;
    const float height = float(up.cast<double>().dot(pair.at_a.position - pair.at_b.position));
    const Vec3f up_in_a = pair.at_a.rotation.transpose() * up;

    CoreStore store;
    const Core core = kCores[size_t(pair.a.kind)](pair.a, store);
    return touch_plane(core.points, core.radius, up_in_a, height, pair.wanted, out);
}

}  // namespace taut::collision
