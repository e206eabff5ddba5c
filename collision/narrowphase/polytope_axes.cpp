#include "collision/narrowphase/polytope_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace taut::collision {
namespace {

// On the sphere of normals each edge is an arc between its faces' normals, part of the great circle across
// its direction. The arcs of a and of -b cross, so that the edges meet in a face of the Minkowski difference, if
// each arc's ends lie on both sides of the other's circle and the two arcs lie on one hemisphere (Gregorius, GDC
// 2013).
bool arcs_cross(const PolytopePair& pair, const Edge& edge_a, const Edge& edge_b) {
    const Mat3f& rotation = pair.b_in_a.rotation;
    const Vec3f along_a = pair.a.direction(edge_a), along_b = rotation * pair.b.direction(edge_b);
    const float c = -(rotation * pair.b.faces[edge_b.left].normal).dot(along_a);
    const float d = -(rotation * pair.b.faces[edge_b.right].normal).dot(along_a);
    const float l = along_b.dot(pair.a.faces[edge_a.left].normal);
    const float r = along_b.dot(pair.a.faces[edge_a.right].normal);
    return c * d < 0 && l * r < 0 && c * r > 0;
}

// How far the two are apart at most, negative, by a point of both: balls about it lie in each.
float most_apart(const PolytopePair& pair, const Vec3f& p) {
    const float on_a = outside(pair.a, p), on_b = outside(pair.b, pair.a_in_b * p);
    return on_a <= 0 && on_b <= 0 ? on_a + on_b : std::numeric_limits<float>::infinity();
}

}  // namespace

Vec3f PolytopePair::normal(Axis axis) const {
    if (axis.kind == AxisKind::face_a) return a.faces[axis.i].normal;
    if (axis.kind == AxisKind::face_b) return b_in_a.rotation * -b.faces[axis.j].normal;
    return edge_normal(a, a.edges[axis.i], b_in_a.rotation * b.direction(b.edges[axis.j]));
}

bool PolytopePair::valid(Axis axis) const {
    if (axis.kind == AxisKind::edges) return axis.i < a.edges.size() && axis.j < b.edges.size();
    return axis.kind != AxisKind::none && axis.i < a.faces.size() && axis.j < b.faces.size();
}

PolytopePair::EdgePair PolytopePair::edges(Axis axis) const {
    const Edge& edge_a = a.edges[axis.i];
    const Edge& edge_b = b.edges[axis.j];
    return {{a.vertices[edge_a.from], a.direction(edge_a)},
            {b_in_a * b.vertices[edge_b.from], b_in_a.rotation * b.direction(edge_b)}};
}

bool edges_decide(const PolytopePair& pair, Axis axis, float ask) {
    if (!arcs_cross(pair, pair.a.edges[axis.i], pair.b.edges[axis.j])) return false;
    const Vec3f normal = pair.normal(axis);
    if (normal.squaredNorm() == 0) return false;
    const auto [on_a, on_b] = pair.edges(axis);
    const SegmentPair nearest = nearest_points(on_a, on_b);
    const Vec3f p = on_a.at(nearest.s), q = on_b.at(nearest.t);
    const float separation = normal.dot(on_b.from - on_a.from), most = separation + ask;
    if (separation > 0) return (q - p).squaredNorm() <= most * most;
    return most_apart(pair, 0.5f * (p + q)) <= most;
}

FaceBeside face_beside(const PolytopePair& pair, Axis axis, const Vec3f& normal) {
    const Vec3f against = pair.b_in_a.rotation.transpose() * -normal;
    const Edge& edge_a = pair.a.edges[axis.i];
    const Edge& edge_b = pair.b.edges[axis.j];
    FaceBeside best;
    const auto look = [&](Axis face, float along) {
        if (along > best.along) best = {face, along};
    };
    for (const uint8_t i : {edge_a.left, edge_a.right})
        look({AxisKind::face_a, i, 0}, pair.a.faces[i].normal.dot(normal));
    for (const uint8_t j : {edge_b.left, edge_b.right})
        look({AxisKind::face_b, 0, j}, pair.b.faces[j].normal.dot(against));
    return best;
}

namespace {

// The face of one that separates most from the other, which lies at a pose; those with the largest bounds first.
FaceFound best_face(const Polytope& one, const Polytope& other, const Pose& pose, float least, float margin) {
    FaceSearch search;
    search.planes = one.planes;
    search.faces = uint32_t(one.faces.size());
    search.corners = other.corners;
    const Vec3f centre = pose * other.centre;
    for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) search.rotation[i][j] = pose.rotation(i, j);
        search.position[i] = pose.position[i];
        search.centre[i] = centre[i];
    }
    search.radius = other.inner_radius;
    search.least = least;
    search.margin = margin;
    return lane_kernels().best_face(search);
}

}  // namespace

Separation best_face_a(const PolytopePair& pair, float margin) {
    const FaceFound found = best_face(pair.a, pair.b, pair.b_in_a, -1e30f, margin);
    return {{AxisKind::face_a, uint8_t(found.face), 0}, found.distance, int(found.corner)};
}

Separation best_face_b(const PolytopePair& pair, float least, float margin) {
    const FaceFound found = best_face(pair.b, pair.a, pair.a_in_b, least, margin);
    return {{AxisKind::face_b, 0, uint8_t(found.face)}, found.distance, int(found.corner)};
}

}  // namespace taut::collision
