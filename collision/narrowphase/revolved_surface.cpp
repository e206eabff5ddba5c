// Cylinder, cone or tapered capsule against a surface: the line of its side, or its cap, over faces, and all of it
// against sharp edges and vertices, where these are nearest. Exact: no polytope stands in for what is round.
#include <algorithm>
#include <bit>
#include <cmath>

#include "collision/narrowphase/face_contact.h"
#include "collision/narrowphase/stretch.h"
#include "collision/narrowphase/surface.h"

namespace taut::collision {
namespace {

// A line over the seam of two triangles is over both: room as a share of the inner radius.
constexpr float kRimSeam = 1e-3f;
// The least cosine between the outward direction of an edge's or vertex' contact and the triangle's normal.
constexpr float kRimFront = 1e-3f;
// An edge meets the body as a capsule this thin, in parts of the body's inner radius, which is taken off again.
constexpr float kThin = 0.01f;

class RevolvedSurface {
public:
    explicit RevolvedSurface(const Meeting& meeting)
        : meeting_(meeting), view_(meeting.view), body_(meeting.body), inner_(inner_radius(meeting.body)) {}

    void run() {
        const auto lowest = [&](const Vec3f& direction) { return this->lowest(direction); };
        for_facets(meeting_, Vec3f::Zero(), lowest, [&](const Facet& facet) { touch(facet); });
    }

private:
    float lowest(const Vec3f& direction) const {
        const Vec3 d = direction.cast<double>();
        return float(d.dot(furthest_point(body_.shape(), -d)));
    }
    void touch(const Facet& facet);
    void touch_by_line(const Facet& facet, const Segment& line);
    void touch_by_cap(const Facet& facet);
    void take(const Facet& facet, const SurfaceView::Triangle& triangle, const Polygon& found, Polygon& points) const;
    bool is_across(const Vec3f& normal, const Vec3f& from, const Vec3f& along, const Vec3f& opposite) const;
    bool may_touch_edge(const Facet& facet, const SurfaceView::Triangle& triangle, int e) const;
    void touch_edge(const Facet& facet, const SurfaceView::Triangle& triangle, int e);
    Manifold meet_edge(const Segment& edge, const SegmentPair& nearest) const;
    void add_face(const Facet& facet, Touch& touch);

    const Meeting& meeting_;
    const SurfaceView& view_;
    const Solid body_;
    const float inner_;  // [m]
};

void RevolvedSurface::add_face(const Facet& facet, Touch& touch) {
    touch.manifold.normal = -facet.normal;
    if (touch.manifold.count == 0) return;
    touch.separation = deepest(touch.manifold);
    meeting_.touches.add(touch);
}

void RevolvedSurface::touch_by_line(const Facet& facet, const Segment& line) {
    Stretch stretch;
    for (const uint64_t key : facet.triangles)
        stretch.join(line, kRimSeam * inner_, facet, view_.triangle(uint32_t(key)));
    if (stretch.is_empty()) return;
    Touch touch{facet.number + 1, 0, facet.height + facet.offset, facet.triangles, {}};
    Manifold& out = touch.manifold;
    const auto add = [&](float t, uint32_t feature) {
        const Vec3f p = line.at(t);
        const float height = facet.normal.dot(p) - facet.offset;
        if (height <= meeting_.margin) out.points[out.count++] = {p - facet.normal * (0.5f * height), height, feature};
    };
    add(stretch.enter, 1);
    if ((stretch.leave - stretch.enter) * line.step.norm() > 0.1f * inner_) add(stretch.leave, 2);
    add_face(facet, touch);
}

// A triangle as a flat face.
struct TriangleFace {
    Vec3f corners[3];
    Side sides[3];
    static constexpr uint8_t kLoop[3] = {0, 1, 2};

    TriangleFace(const Facet& facet, const SurfaceView::Triangle& triangle, const Vec3f& u, const Vec3f& v) {
        for (int i = 0; i < 3; ++i) corners[i] = triangle.at[facet.flipped ? 2 - i : i];
        for (int i = 0; i < 3; ++i) {
            const Vec3f along = corners[next_corner(i)] - corners[i];
            const float x = v.dot(along), y = -u.dot(along), scale = 1 / std::sqrt(std::max(x * x + y * y, 1e-30f));
            sides[i] = {x * scale, y * scale, (x * u.dot(corners[i]) + y * v.dot(corners[i])) * scale};
        }
    }
    // Of its triangle.
    static int edge_of(const Facet& facet, int side) { return facet.flipped ? (side == 2 ? 2 : 1 - side) : side; }
    static int corner_of(const Facet& facet, int corner) { return facet.flipped ? 2 - corner : corner; }
};

// Into the facet's points, each point of the rim once. Where a seam of the facet cuts the rim, or ends, is no point.
void RevolvedSurface::take(const Facet& facet, const SurfaceView::Triangle& triangle, const Polygon& found,
                           Polygon& points) const {
    const auto is_seam = [&](int edge) {
        const uint32_t other = view_.neighbour(triangle, edge);
        return other != kNoTriangle && view_.surface().facet_of[other] == facet.number;
    };
    for (int i = 0; i < found.count; ++i) {
        ClipPoint point = found.points[i];
        if (is_corner_of_face(point.id)) {
            const int corner = TriangleFace::corner_of(facet, int(point.id));
            if (is_seam(corner) && is_seam(corner == 0 ? 2 : corner - 1)) continue;
            point.id = (3 * triangle.number + uint32_t(corner)) % kFaceCorners;
        } else if (is_crossing(point.id)) {
            const int edge = TriangleFace::edge_of(facet, side_of_crossing(point.id));
            if (is_seam(edge)) continue;
            point.id =
                kFaceCorners + (2 * (3 * triangle.number + uint32_t(edge)) + (point.id & 1)) % (2 * kFaceCorners);
        } else {
            const auto same = [&](const ClipPoint& p) { return p.id == point.id; };
            if (std::any_of(points.points, points.points + points.count, same)) continue;
        }
        if (points.count == kMaxClip) reduce(points);
        points.points[points.count++] = point;
    }
}

void RevolvedSurface::touch_by_cap(const Facet& facet) {
    FlatFace face;
    face.normal = facet.normal;
    face.offset = facet.offset;
    face.u = facet.normal.unitOrthogonal();
    face.v = facet.normal.cross(face.u);
    face.loop = TriangleFace::kLoop;
    Polygon points;
    for (const uint64_t key : facet.triangles) {
        const SurfaceView::Triangle triangle = view_.triangle(uint32_t(key));
        const TriangleFace of(facet, triangle, face.u, face.v);
        face.sides = of.sides;
        face.vertices = of.corners;
        Polygon found;
        common_points(face, body_, {Mat3f::Identity(), Vec3f::Zero()}, flush_slack(inner_), found);
        take(facet, triangle, found, points);
    }
    if (points.count == 0) return;
    Touch touch{facet.number + 1, 0, facet.height + facet.offset, facet.triangles, {}};
    add_points(points, {face.u, face.v, face.normal, face.offset}, 0, meeting_.margin, touch.manifold);
    add_face(facet, touch);
}

// Whether the lowest point over a triangle's plane lies beyond its edge, which opposite is on this side of.
bool RevolvedSurface::is_across(const Vec3f& normal, const Vec3f& from, const Vec3f& along,
                                const Vec3f& opposite) const {
    const Vec3f lowest = furthest_point(body_.shape(), -normal.cast<double>()).cast<float>(), side = opposite - from;
    const Vec3f inward = side - along * (along.dot(side) / along.squaredNorm());
    return inward.dot(lowest - from) <= kRimSeam * inner_ * inward.norm();
}

// The separation along n, the least of n . p over the body, falls from a face's normal towards the other's where the
// lowest point lies over the face: it is largest between the two only if that lies across the edge from both.
bool RevolvedSurface::may_touch_edge(const Facet& facet, const SurfaceView::Triangle& triangle, int e) const {
    const size_t to = size_t(next_corner(e)), opposite = size_t(next_corner(int(to)));
    const Vec3f &from = triangle.at[e], along = triangle.at[to] - from;
    if (!is_across(facet.normal, from, along, triangle.at[opposite])) return false;
    const uint32_t other = view_.neighbour(triangle, e);
    if (other == kNoTriangle) return true;
    const Corners corners = view_.surface().corners(other);
    const Vec3f third = view_.vertex(third_corner(corners, triangle.corner[size_t(e)], triangle.corner[to]));
    const Vec3f normal = (third - from).cross(along).normalized();
    return is_across(facet.flipped ? Vec3f(-normal) : normal, from, along, third);
}

// The body against an edge that is as thin as kThin, which then is taken off; normal from the body to it.
Manifold RevolvedSurface::meet_edge(const Segment& edge, const SegmentPair& nearest) const {
    const float length = edge.step.norm(), thin = kThin * inner_;
    const Shape capsule{ShapeKind::capsule, Vec3f(thin, 0.5f * length, 0), nullptr};
    Placement at{edge.at(0.5f).cast<double>(), Mat3f::Identity()};
    at.rotation.col(1) = edge.step / length;
    at.rotation.col(0) = at.rotation.col(1).unitOrthogonal();
    at.rotation.col(2) = at.rotation.col(0).cross(at.rotation.col(1));
    const Vec3f way = edge.at(nearest.t) - centre_line(body_.shape()).at(nearest.s);
    const float distance = way.norm();
    PairCache cache;
    for (int i = 0; i < 3 && distance > 1e-3f * inner_; ++i)
        cache.words[i] = std::bit_cast<uint32_t>(way[i] / distance);
    Manifold out;
    const Placement own{Vec3::Zero(), Mat3f::Identity()};
    convex_convex({body_.shape(), capsule, own, at, {at.rotation, edge.at(0.5f)}, meeting_.margin, cache}, out);
    for (int i = 0; i < out.count; ++i) {
        out.points[i].position += out.normal * (0.5f * thin);
        out.points[i].separation += thin;
    }
    return out;
}

// The edge, or its end, if it is nearest to the body from outside.
void RevolvedSurface::touch_edge(const Facet& facet, const SurfaceView::Triangle& triangle, int e) {
    const size_t ends[2] = {size_t(e), size_t(next_corner(e))};
    const Segment edge = {triangle.at[ends[0]], triangle.at[ends[1]] - triangle.at[ends[0]]};
    const Segment axis = centre_line(body_.shape());
    const SegmentPair nearest = nearest_points(axis, edge);
    const Vec3f& size = body_.shape().size;
    if ((axis.at(nearest.s) - edge.at(nearest.t)).norm() > std::max(size.x(), size.z()) + meeting_.margin) return;
    const Manifold found = meet_edge(edge, nearest);
    if (found.count == 0) return;
    const ContactPoint& point =
        *std::min_element(found.points, found.points + found.count,
                          [](const ContactPoint& p, const ContactPoint& q) { return p.separation < q.separation; });
    if (point.separation > meeting_.margin) return;
    const Vec3f out = -found.normal;
    if (out.dot(facet.normal) < kRimFront) return;
    const float t = edge.nearest(point.position);
    const bool inside = t > 0 && t < 1;
    const size_t end = ends[t > 0.5f];
    if (inside ? !view_.is_top_edge(triangle, e, out)
               : !view_.is_top_vertex(triangle.corner[end], triangle.at[end], out))
        return;
    meeting_.touches.add({inside ? view_.edge_part(triangle, e) : kVertexPart | triangle.corner[end],
                          point.separation,
                          lowest(out),
                          {},
                          found});
}

void RevolvedSurface::touch(const Facet& facet) {
    const Feature feature = body_.feature_along(-facet.normal);
    if (feature.face < 0)
        touch_by_line(facet, feature.line);
    else
        touch_by_cap(facet);
    for (const uint64_t key : facet.triangles) {
        const SurfaceView::Triangle triangle = view_.triangle(uint32_t(key));
        for (int e = 0; e < 3; ++e)
            if ((triangle.sharp >> e & 1) && may_touch_edge(facet, triangle, e)) touch_edge(facet, triangle, e);
    }
}

}  // namespace

void revolved_surface(const Meeting& meeting) { RevolvedSurface(meeting).run(); }

}  // namespace taut::collision
