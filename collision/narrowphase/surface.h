// A convex body against a surface, facet by facet, in the body's frame. Outward is from the surface to the body.
#pragma once

#include <array>
#include <span>

#include "collision/manifold.h"
#include "collision/surface.h"

namespace taut::collision {

// The surface as the body sees it: differences in double, so that a body far from the surface's origin loses nothing.
class SurfaceView {
public:
    SurfaceView(const Shape& shape, const Placement& at, const Placement& body);

    struct Triangle {
        uint32_t number;
        Corners corner;  // vertex numbers
        Vec3f at[3];     // [m]
        uint8_t sharp;   // bit e: edge e
    };

    const Surface& surface() const { return surface_; }
    const Placement& body() const { return body_; }  // in the surface's frame
    Vec3f scale() const { return scale_; }
    Vec3f vertex(uint32_t i) const;
    Triangle triangle(uint32_t number) const;
    // Of a triangle that may lie far from the body; in double, lest a facet tilts and sinks with its distance.
    struct Plane {
        Vec3f normal;  // outward, unit
        float offset;  // [m]
    };
    Plane plane(uint32_t triangle) const;

    // Whether nothing of the surface around an edge of the triangle, or around a vertex at a place, reaches further
    // along the unit direction than that itself.
    bool is_top_edge(const Triangle& triangle, int edge, const Vec3f& direction) const;
    bool is_top_vertex(uint32_t vertex, const Vec3f& at, const Vec3f& direction) const;

    uint32_t neighbour(const Triangle& triangle, int edge) const {
        return surface_.neighbour(triangle.number, own_edge(edge));
    }
    uint32_t edge_part(const Triangle& triangle, int edge) const;

private:
    // Of the surface's edge; a mirrored surface has its corners the other way round.
    int own_edge(int edge) const { return mirrored_ ? 2 - edge : edge; }

    const Surface& surface_;
    Vec3f scale_;
    bool mirrored_;
    Placement body_;
    Mat3f to_body_;
};

struct Facet {
    uint32_t number;
    std::span<const uint64_t> triangles;  // those near the body, in the lower half
    Vec3f normal;                         // outward, of its seed
    float offset;
    float height;  // least height of the body above its plane [m]
    bool flipped;  // met from behind, on a two-sided surface
};

// Numbers of parts: facet + 1; of edges the smaller 3 * triangle + edge of its two; of vertices their number.
constexpr uint32_t kEdgePart = 1u << 30, kVertexPart = 2u << 30;
inline bool is_face(uint32_t part) { return part < kEdgePart; }

// One part before the choice among them.
struct Touch {
    uint32_t part;
    float separation;                     // of the deepest point [m]
    float lowest;                         // of the body along the outward normal [m]
    std::span<const uint64_t> triangles;  // that it is on; round bodies: none for edges and vertices
    Manifold manifold;                    // normal from the body to the surface
};

constexpr int kMostTouches = 128;  // later ones displace the shallowest

class Touches {
public:
    std::span<Touch> list() { return std::span(touches_).first(size_t(count_)); }
    // Of an edge or vertex that two triangles find, the first counts.
    void add(const Touch& touch);

private:
    int count_ = 0;
    std::array<Touch, kMostTouches> touches_;
};

// What a kernel works on; it adds all parts closer than margin.
struct Meeting {
    const Shape& body;
    const SurfaceView& view;
    std::span<const uint64_t> order;  // facet << 32 | triangle, of the triangles near the body
    float margin;
    Touches& touches;
};
using SurfaceKernel = void (*)(const Meeting& meeting);

void polytope_surface(const Meeting& meeting);  // box or hull
void round_surface(const Meeting& meeting);     // sphere or capsule
void revolved_surface(const Meeting& meeting);  // cylinder, cone or tapered capsule

// Calls act(facet) for each facet that the body meets from the front and within the margin. lowest(direction): the
// least of direction . p over the body; centre: its middle.
template <class Lowest, class Act>
void for_facets(const Meeting& meeting, const Vec3f& centre, Lowest&& lowest, Act&& act) {
    const Surface& surface = meeting.view.surface();
    for (size_t begin = 0, end = 0; begin < meeting.order.size(); begin = end) {
        Facet facet;
        facet.number = uint32_t(meeting.order[begin] >> 32);
        while (end < meeting.order.size() && uint32_t(meeting.order[end] >> 32) == facet.number) ++end;
        facet.triangles = meeting.order.subspan(begin, end - begin);
        const SurfaceView::Plane plane = meeting.view.plane(surface.seed_of[facet.number]);
        facet.flipped = surface.two_sided && plane.normal.dot(centre) < plane.offset;
        facet.normal = facet.flipped ? Vec3f(-plane.normal) : plane.normal;
        facet.offset = facet.flipped ? -plane.offset : plane.offset;
        facet.height = lowest(facet.normal) - facet.offset;
        if (facet.height > meeting.margin) continue;
        // By more than half of the body's reach behind it, whatever counts as the middle: a cone's is next to its base.
        const auto is_behind = [&](float middle) { return middle < -0.5f * (middle - facet.height); };
        if (is_behind(facet.normal.dot(centre) - facet.offset)) {
            const float top = -lowest(-facet.normal) - facet.offset;
            if (is_behind(0.5f * (top + facet.height))) continue;
        }
        act(facet);
    }
}

// Keeps the parts that no other accounts for, the deepest of them, sorted by part.
void choose_parts(const SurfaceView& view, std::span<Touch> touches, Array<PartManifold>& chosen);

}  // namespace taut::collision
