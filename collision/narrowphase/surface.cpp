// Convex bodies on surfaces: the triangles near the body by facets, a kernel for the body's kind, and the choice among
// the parts that it finds.
#include "collision/narrowphase/surface.h"

#include <algorithm>

namespace taut::collision {
namespace {

// A part is in another's shadow only if it is deeper by this much, and an edge lies in a face's plane within it [m].
constexpr float kClearly = 0.0025f;
// Faces are wall and floor to one another if they meet at more than 45 degrees: cosine between the normals.
constexpr float kWall = 0.7f;

// By the body's kind; planes and surfaces meet no surface.
constexpr SurfaceKernel kKernels[kShapeKinds] = {nullptr,          polytope_surface, round_surface,
                                                 round_surface,    polytope_surface, revolved_surface,
                                                 revolved_surface, revolved_surface};

// The triangles that the body's box, grown by the margin, meets; by facet.
void find_near(const SurfaceView& view, const Shape& body, float margin, Parts& parts) {
    const Box reach = bounds(body, view.body());
    const Vec3f p = (reach.lo.array() - margin).matrix().cwiseQuotient(view.scale());
    const Vec3f q = (reach.hi.array() + margin).matrix().cwiseQuotient(view.scale());
    parts.near.clear();
    parts.order.clear();
    struct Append final : TriangleSink {
        explicit Append(Array<uint32_t>& list) : triangles(list) {}
        void take(uint32_t triangle) override { triangles.push_back(triangle); }
        Array<uint32_t>& triangles;
    };
    Append near(parts.near);
    view.surface().find({p.cwiseMin(q), p.cwiseMax(q)}, near);
    for (const uint32_t t : parts.near) parts.order.push_back(uint64_t(view.surface().facet_of[t]) << 32 | t);
    std::sort(parts.order.begin(), parts.order.end());
}

// The first point, which lies midway, on the surface itself.
Vec3f on_surface(const Manifold& manifold) {
    const ContactPoint& point = manifold.points[0];
    return point.position + manifold.normal * (0.5f * point.separation);
}

// An edge or vertex at a face that is touched as deep: there the face is what the body meets first. This holds for
// seams of which the surface does not know that they are, as well.
bool is_at_face(const Touch& touch, const Touch& face) {
    if (!is_face(face.part) || face.separation > touch.separation) return false;
    const float height = face.manifold.normal.dot(on_surface(touch.manifold) - on_surface(face.manifold));
    return std::fabs(height) < kClearly;
}

// How far the body is from one part's triangles along another part's normal.
float apart_along(const SurfaceView& view, const Touch& part, const Touch& of) {
    const Vec3f out = -part.manifold.normal;
    float top = -1e30f;
    for (const uint64_t key : of.triangles) {
        for (const uint32_t corner : view.surface().corners(uint32_t(key)))
            top = std::max(top, out.dot(view.vertex(corner)));
    }
    return part.lowest - top;
}

// A deep part whose triangles the body leaves sooner by a shallower part's normal than by their own.
bool is_left_through(const SurfaceView& view, const Touch& deep, const Touch& part) {
    return deep.separation < -kClearly && part.separation > deep.separation + kClearly && !deep.triangles.empty() &&
           apart_along(view, part, deep) > deep.separation + kClearly;
}

// A wall that ends at the floor, seen from the floor: the body is past it, or will be once it is out of the floor.
bool is_below(const SurfaceView& view, const Touch& wall, const Touch& floor) {
    return &wall != &floor && is_face(floor.part) && wall.manifold.normal.dot(floor.manifold.normal) < kWall &&
           apart_along(view, floor, wall) > std::min(floor.separation, 0.0f) - kClearly;
}

}  // namespace

void Touches::add(const Touch& touch) {
    const auto end = touches_.begin() + count_;
    if (std::any_of(touches_.begin(), end, [&](const Touch& t) { return t.part == touch.part; })) return;
    if (count_ < kMostTouches) {
        touches_[size_t(count_++)] = touch;
        return;
    }
    const auto shallowest = std::max_element(
        touches_.begin(), end, [](const Touch& a, const Touch& b) { return a.separation < b.separation; });
    if (touch.separation < shallowest->separation) *shallowest = touch;
}

void choose_parts(const SurfaceView& view, std::span<Touch> touches, Array<PartManifold>& chosen) {
    // Shallow ones first: they shadow the deep ones.
    std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) {
        return a.separation != b.separation ? a.separation > b.separation : a.part < b.part;
    });
    const Touch* kept[kMostTouches];
    size_t count = 0;
    for (const Touch& touch : touches) {
        const auto left = [&](const Touch* shallower) { return is_left_through(view, touch, *shallower); };
        if (std::none_of(kept, kept + count, left)) kept[count++] = &touch;
    }
    // Walls and seams at the faces that are left; what goes shadows nothing any more.
    for (size_t i = 0; i < count;) {
        const Touch& touch = *kept[i];
        const auto at = [&](const Touch* face) {
            return is_face(touch.part) ? is_below(view, touch, *face) : is_at_face(touch, *face);
        };
        if (std::any_of(kept, kept + count, at)) {
            std::copy(kept + i + 1, kept + count, kept + i);
            --count;
        } else {
            ++i;
        }
    }
    const size_t first = count > size_t(kMaxParts) ? count - size_t(kMaxParts) : 0;
    for (size_t i = first; i < count; ++i) chosen.push_back({kept[i]->part, kept[i]->manifold});
    std::sort(chosen.begin(), chosen.end(), [](const auto& p, const auto& q) { return p.part < q.part; });
}

void collide_parts(const Shape& a, const Placement& at_a, const Shape& b, const Placement& at_b, float margin,
                   Parts& parts) {
    parts.found.clear();
    const bool first = has_parts(a);
    const Shape& shape = first ? a : b;
    const Shape& body = first ? b : a;
    const Placement &at = first ? at_a : at_b, &at_body = first ? at_b : at_a;
    const SurfaceKernel kernel = kKernels[size_t(body.kind)];
    if (!kernel) return;
    const SurfaceView view(shape, at, at_body);
    find_near(view, body, margin, parts);
    if (parts.order.empty()) return;
    Touches touches;
    kernel({body, view, parts.order, margin, touches});
    choose_parts(view, touches.list(), parts.found);

    // To world axes, from a to b, relative to a's origin.
    const Vec3f from_a = first ? Vec3f((at_b.position - at_a.position).cast<float>()) : Vec3f::Zero();
    for (PartManifold& part : parts.found) {
        const Vec3f normal = at_body.rotation * part.manifold.normal;
        part.manifold.normal = first ? Vec3f(-normal) : normal;
        for (int i = 0; i < part.manifold.count; ++i) {
            Vec3f& p = part.manifold.points[i].position;
            p = from_a + at_body.rotation * p;
        }
    }
}

}  // namespace taut::collision
