// Box or hull against a surface. Each triangle near the body is touched by its face, unless it has sharp edges and one
// of these, or a vertex, separates by clearly more. The points of a facet's triangles make one manifold.
#include <cmath>

#include "collision/narrowphase/core.h"
#include "collision/narrowphase/polytope_axes.h"
#include "collision/narrowphase/surface.h"

namespace taut::collision {
namespace {

// The least cosine between the outward direction of an edge's or vertex' contact and the triangle's normal.
constexpr float kLeastFacing = 0.02f;
// Lines of edges that meet, but beside the edges themselves, miss by more than this share of the body's size.
constexpr float kMiss = 1e-3f;
// Edges within 1e-3 rad of parallel have no axis of their own.
constexpr float kAcrossSine2 = 1e-6f;

class PolytopeSurface {
public:
    explicit PolytopeSurface(const Meeting& meeting)
        : meeting_(meeting), view_(meeting.view), storage_(meeting.body), body_(storage_.view()) {}

    void run() {
        const auto lowest = [&](const Vec3f& direction) { return -highest(body_, -direction); };
        for_facets(meeting_, body_.centre, lowest, [&](const Facet& facet) { touch(facet); });
    }

private:
    // What separates a triangle more than its face does: an edge and one of the body's, or a face of the body.
    struct Other {
        float separation = -1e30f;
        int face = -1;                // of the body; -1: edges
        int edge = 0, body_edge = 0;  // otherwise
        uint32_t part = 0;
        Vec3f outward = Vec3f::Zero();
    };

    void touch(const Facet& facet);
    void start(const Facet& facet);
    bool found_on(const SurfaceView::Triangle& triangle, Polygon& points);
    void take(const SurfaceView::Triangle& triangle, const Polygon& points);
    bool try_faces(const Facet& facet, const SurfaceView::Triangle& triangle, Other& best) const;
    bool try_edges(const Facet& facet, const SurfaceView::Triangle& triangle, int edge, Other& best) const;
    bool is_touched_otherwise(const Facet& facet, const SurfaceView::Triangle& triangle, const uint64_t& key,
                              float found);
    bool touch_other(const SurfaceView::Triangle& triangle, const uint64_t& key, const Other& other);
    uint32_t part_on_face(const SurfaceView::Triangle& triangle, const float (&height)[3], int lowest) const;

    const Meeting& meeting_;
    const SurfaceView& view_;
    const PolytopeOf storage_;
    const Polytope& body_;
    const Preference preference_{body_.outer_radius};

    // Of the facet at hand.
    ReferencePlane plane_;
    bool mirrored_ = false;  // its triangles run clockwise seen along (u, v)
    int incident_number_ = 0;
    float slack_ = 0;  // of flush faces [m]; a body deep behind the plane would be pushed from where it is not
    Polygon incident_, points_;
};

// Tangents from the body's own axes turn with it, so that the same corners are chosen every frame.
void PolytopeSurface::start(const Facet& facet) {
    int k = 0;
    for (int i = 1; i < 3; ++i) {
        if (std::fabs(facet.normal[i]) < std::fabs(facet.normal[k]) - 1e-3f) k = i;
    }
    plane_.normal = facet.normal;
    plane_.u = (Vec3f::Unit(k) - facet.normal * facet.normal[k]).normalized();
    plane_.v = facet.normal.cross(plane_.u);
    plane_.offset = facet.offset;
    mirrored_ = facet.flipped;
    incident_number_ = face_against(body_, facet.normal);
    slack_ = facet.height < -preference_.slop ? 0.0f : flush_slack(body_.inner_radius);
    incident_.count = points_.count = 0;
    for (const int corner : body_.loop_of(body_.faces[size_t(incident_number_)])) {
        const Vec3f& p = body_.vertices[size_t(corner)];
        incident_.points[incident_.count] = {plane_.u.dot(p), plane_.v.dot(p), plane_.normal.dot(p) - plane_.offset,
                                             uint32_t(incident_.count)};
        ++incident_.count;
    }
}

// The incident face over the triangle, as far as it is within the margin.
bool PolytopeSurface::found_on(const SurfaceView::Triangle& triangle, Polygon& points) {
    std::array<Side, 3> sides;
    for (int e = 0; e < 3; ++e) {
        const Vec3f& from = triangle.at[e];
        const Vec3f along = (triangle.at[next_corner(e)] - from) * (mirrored_ ? -1.0f : 1.0f);
        const float x = plane_.v.dot(along), y = -plane_.u.dot(along);
        const float scale = 1 / std::sqrt(std::max(x * x + y * y, 1e-30f));
        sides[size_t(e)] = {x * scale, y * scale, (x * plane_.u.dot(from) + y * plane_.v.dot(from)) * scale};
    }
    points.count = incident_.count;
    std::copy(incident_.points, incident_.points + incident_.count, points.points);
    clip(points, sides, slack_);
    const auto end = std::remove_if(points.points, points.points + points.count,
                                    [&](const ClipPoint& p) { return p.z > meeting_.margin; });
    points.count = int(end - points.points);
    return points.count > 0;
}

// Into the facet's points, each corner of the body once; where a seam cuts an edge of the body is no corner.
void PolytopeSurface::take(const SurfaceView::Triangle& triangle, const Polygon& points) {
    const uint32_t facet = view_.surface().facet_of[triangle.number];
    const auto seam = [&](uint32_t line) {
        if (line < kSideLine) return false;
        const uint32_t other = view_.neighbour(triangle, int(line - kSideLine));
        return other != kNoTriangle && view_.surface().facet_of[other] == facet;
    };
    // A side's line is named by its edge.
    const auto name = [&](uint32_t line) {
        return line < kSideLine ? line : kSideLine + (3 * triangle.number + line - kSideLine) % kSideLine;
    };
    for (int i = 0; i < points.count; ++i) {
        const uint32_t first = points.points[i].id >> 7, second = points.points[i].id & 127;
        const bool border = (first >= kSideLine && !seam(first)) || (second >= kSideLine && !seam(second));
        if (!border && (seam(first) || seam(second))) continue;
        const uint32_t id = name(first) << 7 | name(second);
        const auto same = [id](const ClipPoint& p) { return p.id == id; };
        if (!border && std::any_of(points_.points, points_.points + points_.count, same)) continue;
        if (points_.count == kMaxClip) reduce(points_);
        points_.points[points_.count] = points.points[i];
        points_.points[points_.count++].id = id;
    }
}

// False if a face of the body alone is further away than the margin.
bool PolytopeSurface::try_faces(const Facet& facet, const SurfaceView::Triangle& triangle, Other& best) const {
    for (size_t f = 0; f < body_.faces.size(); ++f) {
        const Face& face = body_.faces[f];
        float height[3];
        int lowest = 0;
        for (int i = 0; i < 3; ++i) {
            height[i] = face.normal.dot(triangle.at[i]) - face.offset;
            if (height[i] < height[lowest]) lowest = i;
        }
        if (height[lowest] > meeting_.margin) return false;
        if (height[lowest] <= best.separation || -face.normal.dot(facet.normal) < kLeastFacing) continue;
        if (!view_.is_top_vertex(triangle.corner[size_t(lowest)], triangle.at[lowest], -face.normal)) continue;
        best = {height[lowest], int(f), 0, 0, part_on_face(triangle, height, lowest), -face.normal};
    }
    return true;
}

// The edge on which a face of the body lies, or the vertex.
uint32_t PolytopeSurface::part_on_face(const SurfaceView::Triangle& triangle, const float (&height)[3],
                                       int lowest) const {
    const int after = next_corner(lowest), before = next_corner(after);
    const int second = height[after] < height[before] ? after : before;
    if (height[second] > height[lowest] + preference_.slop) return kVertexPart | triangle.corner[size_t(lowest)];
    return view_.edge_part(triangle, second == after ? lowest : before);
}

// False if edges that face each other are further apart than the margin.
bool PolytopeSurface::try_edges(const Facet& facet, const SurfaceView::Triangle& triangle, int edge,
                                Other& best) const {
    const Vec3f from = triangle.at[edge], along = triangle.at[next_corner(edge)] - from;
    for (size_t e = 0; e < body_.edges.size(); ++e) {
        const Edge& own = body_.edges[e];
        const Vec3f direction = body_.direction(own);
        const Vec3f cross = along.cross(direction);
        const float squared = cross.squaredNorm();
        if (!(squared > kAcrossSine2 * along.squaredNorm() * direction.squaredNorm())) continue;
        const Vec3f outward = cross * ((cross.dot(facet.normal) < 0 ? -1 : 1) / std::sqrt(squared));
        // The body lies outward of its edge if the way in lies between the normals of the edge's faces.
        const Vec3f inward = -outward;
        if (body_.faces[own.left].normal.cross(inward).dot(direction) < 0) continue;
        if (inward.cross(body_.faces[own.right].normal).dot(direction) < 0) continue;
        const Segment body_edge = {body_.vertices[own.from], direction}, surface_edge = {from, along};
        // Of the whole triangle: edges that count as level may rise by the contact margin and more over a large one.
        float top = outward.dot(from);
        for (const Vec3f& corner : triangle.at) top = std::max(top, outward.dot(corner));
        const float separation = outward.dot(body_edge.from) - top;
        if (separation <= best.separation || outward.dot(facet.normal) < kLeastFacing) continue;
        if (!view_.is_top_edge(triangle, edge, outward)) continue;
        if (separation > meeting_.margin) return false;
        const SegmentPair nearest = nearest_points(body_edge, surface_edge);
        const Vec3f apart = body_edge.at(nearest.s) - surface_edge.at(nearest.t);
        if ((apart - outward * separation).norm() > kMiss * body_.outer_radius) continue;
        best = {separation, -1, edge, int(e), view_.edge_part(triangle, edge), outward};
    }
    return true;
}

// False if the body's face has nothing of the triangle over it after all.
bool PolytopeSurface::touch_other(const SurfaceView::Triangle& triangle, const uint64_t& key, const Other& other) {
    Touch touch{other.part, other.separation, -highest(body_, -other.outward), {&key, 1}, {}};
    Manifold& out = touch.manifold;
    out.normal = -other.outward;
    if (other.face < 0) {
        const Edge& own = body_.edges[size_t(other.body_edge)];
        const Segment body_edge = {body_.vertices[own.from], body_.direction(own)};
        const Vec3f& from = triangle.at[other.edge];
        const Segment surface_edge = {from, triangle.at[next_corner(other.edge)] - from};
        const SegmentPair nearest = nearest_points(body_edge, surface_edge);
        out.count = 1;
        out.points[0] = {0.5f * (body_edge.at(nearest.s) + surface_edge.at(nearest.t)), other.separation,
                         edge_feature(other.body_edge, 0)};
    } else {
        const Face& face = body_.faces[size_t(other.face)];
        Polygon polygon;
        polygon.count = 3;
        for (int i = 0; i < 3; ++i) {
            const Vec3f& p = triangle.at[i];
            polygon.points[i] = {face.u.dot(p), face.v.dot(p), face.normal.dot(p) - face.offset, uint32_t(i)};
        }
        clip(polygon, body_.sides_of(face), flush_slack(body_.inner_radius));
        add_points(polygon, {face.u, face.v, face.normal, face.offset}, face_base(false, other.face, 0),
                   meeting_.margin, out);
    }
    if (out.count == 0) return false;
    meeting_.touches.add(touch);
    return true;
}

// True if the triangle is apart from the body, or an edge or vertex of it was added as a part. found: the deepest point
// of its face.
bool PolytopeSurface::is_touched_otherwise(const Facet& facet, const SurfaceView::Triangle& triangle,
                                           const uint64_t& key, float found) {
    Other face, edges;
    if (!try_faces(facet, triangle, face)) return true;
    for (int e = 0; e < 3; ++e) {
        if ((triangle.sharp >> e & 1) && !try_edges(facet, triangle, e, edges)) return true;
    }
    const auto wins = [&](const Other& other) {
        return preference_.edge_wins(other.separation, facet.height, false) ||
               preference_.face_misses(found, other.separation, facet.height);
    };
    const bool edges_first = edges.separation > face.separation;
    for (const Other* other : {edges_first ? &edges : &face, edges_first ? &face : &edges}) {
        if (wins(*other) && touch_other(triangle, key, *other)) return true;
    }
    return false;
}

void PolytopeSurface::touch(const Facet& facet) {
    start(facet);
    Polygon found;
    for (const uint64_t& key : facet.triangles) {
        const SurfaceView::Triangle triangle = view_.triangle(uint32_t(key));
        const bool over = found_on(triangle, found);
        if (triangle.sharp != 0) {
            float lowest = 1e30f;
            for (int i = 0; i < found.count; ++i) lowest = std::min(lowest, found.points[i].z);
            const bool shallow = facet.height >= -preference_.slop && lowest <= facet.height + preference_.slop;
            if (!shallow && is_touched_otherwise(facet, triangle, key, lowest)) continue;
        }
        if (over) take(triangle, found);
    }
    if (points_.count == 0) return;
    Touch touch{facet.number + 1, 0, facet.height + facet.offset, facet.triangles, {}};
    touch.manifold.normal = -facet.normal;
    add_points(points_, plane_, face_base(false, 0, incident_number_), meeting_.margin, touch.manifold);
    touch.separation = deepest(touch.manifold);
    meeting_.touches.add(touch);
}

}  // namespace

void polytope_surface(const Meeting& meeting) { PolytopeSurface(meeting).run(); }

}  // namespace taut::collision
