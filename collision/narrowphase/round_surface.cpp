// Sphere or capsule against a surface: its axis against faces, where it lies over them, and against sharp edges and
// vertices, where these are nearest.
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/rounds.h"
#include "collision/narrowphase/stretch.h"

namespace taut::collision {
namespace {

// An axis over the seam of two triangles is over both: room as a share of the radius.
constexpr float kSeam = 1e-3f;
// The least cosine between the outward direction of an edge's or vertex' contact and the triangle's normal.
constexpr float kFront = 1e-3f;

struct Round {
    Segment axis;
    float radius;

    float lowest(const Vec3f& direction) const {
        return std::min(direction.dot(axis.from), direction.dot(axis.at(1))) - radius;
    }
};

// Midway between plane and surface below the axis' point t.
void add_point(const Round& round, const Facet& facet, float t, float margin, uint32_t feature, Manifold& out) {
    const Vec3f p = round.axis.at(t);
    const float height = facet.normal.dot(p) - facet.offset;
    if (height - round.radius > margin) return;
    out.points[out.count++] = {p - facet.normal * (0.5f * (height + round.radius)), height - round.radius, feature};
}

void touch_face(const Round& round, const Facet& facet, const Stretch& stretch, const Meeting& meeting) {
    Touch touch{facet.number + 1, 0, facet.height + facet.offset, facet.triangles, {}};
    touch.manifold.normal = -facet.normal;
    const bool one = (stretch.leave - stretch.enter) * round.axis.step.norm() < 0.1f * round.radius;
    add_point(round, facet, stretch.enter, meeting.margin, 1, touch.manifold);
    if (!one) add_point(round, facet, stretch.leave, meeting.margin, 2, touch.manifold);
    if (touch.manifold.count == 0) return;
    touch.separation = deepest(touch.manifold);
    meeting.touches.add(touch);
}

// The edge, or its end, if it is nearest to the axis from outside.
void touch_edge(const Round& round, const Facet& facet, const SurfaceView::Triangle& triangle, int e,
                const Meeting& meeting) {
    const size_t ends[2] = {size_t(e), size_t(next_corner(e))};
    const Segment edge = {triangle.at[ends[0]], triangle.at[ends[1]] - triangle.at[ends[0]]};
    const SegmentPair nearest = nearest_points(round.axis, edge);
    const Vec3f at = edge.at(nearest.t);
    const Vec3f apart = round.axis.at(nearest.s) - at;
    const float distance = apart.norm();
    if (distance - round.radius > meeting.margin || distance < 1e-4f * round.radius) return;
    const Vec3f out = apart / distance;
    if (out.dot(facet.normal) < kFront) return;
    const bool inside = nearest.t > 0 && nearest.t < 1;
    const size_t end = ends[nearest.t > 0.5f];
    if (inside ? !meeting.view.is_top_edge(triangle, e, out)
               : !meeting.view.is_top_vertex(triangle.corner[end], at, out))
        return;
    Touch touch{inside ? meeting.view.edge_part(triangle, e) : kVertexPart | triangle.corner[end],
                distance - round.radius,
                out.dot(round.axis.at(nearest.s)) - round.radius,
                {},
                {}};
    touch_rounds({round.axis, edge, round.radius, 0}, meeting.margin, touch.manifold);
    if (touch.manifold.count > 0) meeting.touches.add(touch);
}

}  // namespace

void round_surface(const Meeting& meeting) {
    const Round round = {round_axis(meeting.body), round_radius(meeting.body)};
    const auto lowest = [&](const Vec3f& direction) { return round.lowest(direction); };
    for_facets(meeting, Vec3f::Zero(), lowest, [&](const Facet& facet) {
        Stretch stretch;
        for (const uint64_t key : facet.triangles) {
            const SurfaceView::Triangle triangle = meeting.view.triangle(uint32_t(key));
            stretch.join(round.axis, kSeam * round.radius, facet, triangle);
            for (int e = 0; e < 3; ++e) {
                if (triangle.sharp >> e & 1) touch_edge(round, facet, triangle, e, meeting);
            }
        }
        if (!stretch.is_empty()) touch_face(round, facet, stretch, meeting);
    });
}

}  // namespace taut::collision
