#include <algorithm>

#include "collision/narrowphase/surface.h"

namespace taut::collision {
namespace {

// What rises by less than this share of its distance is level, as edges that bend by less are flat.
constexpr float kLevel = 1e-3f;

bool rises(const Vec3f& step, const Vec3f& direction) {
    const float height = direction.dot(step);
    return height > 0 && height * height > kLevel * kLevel * step.squaredNorm();
}

}  // namespace

SurfaceView::SurfaceView(const Shape& shape, const Placement& at, const Placement& body)
    : surface_(*shape.surface), scale_(shape.size), mirrored_(shape.size.prod() < 0) {
    const Mat3f to_surface = at.rotation.transpose();
    body_ = {to_surface.cast<double>() * (body.position - at.position), to_surface * body.rotation};
    to_body_ = body_.rotation.transpose();
}

Vec3f SurfaceView::vertex(uint32_t i) const {
    const Vec3 p = surface_.vertex(i).cwiseProduct(scale_).cast<double>();
    return to_body_ * (p - body_.position).cast<float>();
}

SurfaceView::Triangle SurfaceView::triangle(uint32_t number) const {
    Triangle triangle{number, surface_.corners(number), {}, surface_.sharp[number]};
    if (mirrored_) {
        std::swap(triangle.corner[1], triangle.corner[2]);
        triangle.sharp = uint8_t((triangle.sharp & 2) | triangle.sharp >> 2 | (triangle.sharp & 1) << 2);
    }
    for (size_t i = 0; i < 3; ++i) triangle.at[i] = vertex(triangle.corner[i]);
    return triangle;
}

SurfaceView::Plane SurfaceView::plane(uint32_t number) const {
    const Corners corner = surface_.corners(number);
    Vec3 at[3];
    for (size_t i = 0; i < 3; ++i) at[i] = surface_.vertex(corner[i]).cwiseProduct(scale_).cast<double>();
    const Vec3 cross = (at[1] - at[0]).cross(at[2] - at[0]) * (mirrored_ ? -1.0 : 1.0), normal = cross.normalized();
    return {(to_body_.cast<double>() * normal).cast<float>(), float(normal.dot(at[0] - body_.position))};
}

bool SurfaceView::is_top_edge(const Triangle& triangle, int edge, const Vec3f& direction) const {
    const size_t from = size_t(edge), to = size_t(next_corner(edge)), opposite = size_t(next_corner(int(to)));
    if (rises(triangle.at[opposite] - triangle.at[from], direction)) return false;
    const uint32_t other = neighbour(triangle, edge);
    if (other == kNoTriangle) return true;
    const uint32_t third = third_corner(surface_.corners(other), triangle.corner[from], triangle.corner[to]);
    return !rises(vertex(third) - triangle.at[from], direction);
}

bool SurfaceView::is_top_vertex(uint32_t number, const Vec3f& at, const Vec3f& direction) const {
    RingRoom room;
    const std::span<const uint32_t> ring = surface_.ring(number, room);
    return std::none_of(ring.begin(), ring.end(), [&](uint32_t other) { return rises(vertex(other) - at, direction); });
}

uint32_t SurfaceView::edge_part(const Triangle& triangle, int edge) const {
    const int own = own_edge(edge);
    uint32_t least = 3 * triangle.number + uint32_t(own);
    const uint32_t other = surface_.neighbour(triangle.number, own);
    for (int e = 0; e < 3 && other != kNoTriangle; ++e) {
        if (surface_.neighbour(other, e) == triangle.number) least = std::min(least, 3 * other + uint32_t(e));
    }
    return kEdgePart | least;
}

}  // namespace taut::collision
