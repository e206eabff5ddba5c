// What stands out of a shape: points at which it may touch what is flat before any of its edges does.
#include <algorithm>
#include <array>
#include <numbers>

#include "collision/narrowphase/core.h"
#include "collision/surface.h"

namespace taut::collision {
namespace {

constexpr uint32_t kRimCorners = 16;  // corners of a circle: the chord between two is 2 % of its radius within it

class CornerList {
public:
    CornerList(const Box& near, Array<Corner>& out) : near_(near), out_(out) {}

    void add(const Vec3f& at, float radius, uint32_t number) {
        const bool within =
            ((at.array() + radius >= near_.lo.array()) && (at.array() - radius <= near_.hi.array())).all();
        if (within) out_.push_back({at, radius, number});
    }
    void add_rim(float radius, float height, uint32_t first) {
        for (uint32_t k = 0; k < kRimCorners; ++k) {
            const SineCosine turn = sine_cosine(2 * std::numbers::pi * k / kRimCorners);
            add({radius * static_cast<float>(turn.cosine), height, radius * static_cast<float>(turn.sine)}, 0,
                first + k);
        }
    }

private:
    const Box& near_;
    Array<Corner>& out_;
};

// Vertices at sharp edges, each once.
void list_surface_corners(const Shape& shape, const Box& near, Array<Corner>& out) {
    struct Vertices final : TriangleSink {
        Vertices(const Surface& of, const Vec3f& by, Array<Corner>& list) : surface(of), scale(by), corners(list) {}
        void take(uint32_t triangle) override {
            const Corners corner = surface.corners(triangle);
            for (int e = 0; e < 3; ++e) {
                if (!(surface.sharp[triangle] >> e & 1)) continue;
                for (const uint32_t vertex : {corner[size_t(e)], corner[size_t(next_corner(e))]})
                    corners.push_back({surface.vertex(vertex).cwiseProduct(scale), 0, vertex});
            }
        }
        const Surface& surface;
        Vec3f scale;
        Array<Corner>& corners;
    };
    Vertices vertices(*shape.surface, shape.size, out);
    const Vec3f p = near.lo.cwiseQuotient(shape.size), q = near.hi.cwiseQuotient(shape.size);
    shape.surface->find({p.cwiseMin(q), p.cwiseMax(q)}, vertices);
    std::sort(out.begin(), out.end(), [](const Corner& a, const Corner& b) { return a.number < b.number; });
    const auto same = [](const Corner& a, const Corner& b) { return a.number == b.number; };
    out.erase(std::unique(out.begin(), out.end(), same), out.end());
}

// ---------------------------------------------------------------- one function a kind

void list_no_corners(const Shape&, const Box&, Array<Corner>&) {}

void list_box_corners(const Shape& shape, const Box& near, Array<Corner>& out) {
    CornerList list(near, out);
    const auto corners = box_corners(shape.size);
    for (uint32_t i = 0; i < corners.size(); ++i) list.add(corners[i], 0, i);
}

void list_sphere_corner(const Shape& shape, const Box& near, Array<Corner>& out) {
    CornerList(near, out).add(Vec3f::Zero(), shape.size.x(), 0);
}

// radius: of the upper end.
void list_ends(const Shape& shape, float radius, const Box& near, Array<Corner>& out) {
    CornerList list(near, out);
    list.add({0, -shape.size.y(), 0}, shape.size.x(), 0);
    list.add({0, shape.size.y(), 0}, radius, 1);
}
void list_capsule_ends(const Shape& shape, const Box& near, Array<Corner>& out) {
    list_ends(shape, shape.size.x(), near, out);
}
void list_tapered_ends(const Shape& shape, const Box& near, Array<Corner>& out) {
    list_ends(shape, shape.size.z(), near, out);
}

void list_hull_corners(const Shape& shape, const Box& near, Array<Corner>& out) {
    CornerList list(near, out);
    for (uint32_t i = 0; i < shape.hull->vertices.size(); ++i) list.add(shape.hull->vertices[i], 0, i);
}

void list_cylinder_rims(const Shape& shape, const Box& near, Array<Corner>& out) {
    CornerList list(near, out);
    list.add_rim(shape.size.x(), -shape.size.y(), 0);
    list.add_rim(shape.size.x(), shape.size.y(), kRimCorners);
}

void list_cone_rim(const Shape& shape, const Box& near, Array<Corner>& out) {
    CornerList list(near, out);
    list.add_rim(shape.size.x(), -shape.size.y(), 0);
    list.add({0, shape.size.y(), 0}, 0, kRimCorners);
}

// In the order of ShapeKind.
constexpr std::array<void (*)(const Shape&, const Box&, Array<Corner>&), kShapeKinds> kCornersOf = {
    list_no_corners,    list_box_corners, list_sphere_corner, list_capsule_ends,   list_hull_corners,
    list_cylinder_rims, list_cone_rim,    list_tapered_ends,  list_surface_corners};

}  // namespace

void list_corners(const Shape& shape, const Box& near, Array<Corner>& out) {
    out.clear();
    kCornersOf[size_t(shape.kind)](shape, near, out);
}

}  // namespace taut::collision
