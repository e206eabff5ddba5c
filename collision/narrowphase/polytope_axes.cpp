#include "collision/narrowphase/polytope_axes.h"

#include <cmath>

namespace taut::collision {
namespace {

// Edges within 1e-3 rad of parallel have no axis of their own.
constexpr float kParallel = 1e-6f;

// Unit normal across both edges that points out of a; zero for parallel edges.
Vec3f edge_normal(const PolytopePair& pair, const Edge& edge_a, const Edge& edge_b) {
    const Vec3f along_a = pair.a.direction(edge_a);
    const Vec3f along_b = pair.b_in_a.rotation * pair.b.direction(edge_b);
    const Vec3f cross = along_a.cross(along_b);
    const float squared = cross.squaredNorm();
    if (!(squared > kParallel * along_a.squaredNorm() * along_b.squaredNorm())) return Vec3f::Zero();
    const Vec3f out_of_a = pair.a.faces[edge_a.left].normal + pair.a.faces[edge_a.right].normal;
    const float scale = 1 / std::sqrt(squared);
    return cross * (cross.dot(out_of_a) < 0 ? -scale : scale);
}

// Edges of one polytope in a's frame, coordinates side by side for the sweep over them.
struct EdgeLanes {
    int count = 0;
    uint8_t index[kMaxEdges];
    alignas(16) float along[3][kMaxEdges + 2];  // direction
    alignas(16) float left[3][kMaxEdges + 2];   // normals of the two faces, those of b negated
    alignas(16) float right[3][kMaxEdges + 2];
};

// Those edges of b that reach down to the given height along normal.
void gather(const PolytopePair& pair, const Vec3f& normal, float height, EdgeLanes& lanes) {
    const Mat3f& r = pair.b_in_a.rotation;
    const Vec3f down = r.transpose() * normal;
    const float limit = height - normal.dot(pair.b_in_a.position);
    float reach[kMaxVertices];
    for (size_t i = 0; i < pair.b.vertices.size(); ++i) reach[i] = down.dot(pair.b.vertices[i]);
    Vec3f against[kMaxFaces];
    for (size_t i = 0; i < pair.b.faces.size(); ++i) against[i] = -(r * pair.b.faces[i].normal);
    for (size_t e = 0; e < pair.b.edges.size(); ++e) {
        const Edge& edge = pair.b.edges[e];
        if (std::min(reach[edge.from], reach[edge.to]) > limit) continue;
        const Vec3f along = r * pair.b.direction(edge);
        for (int k = 0; k < 3; ++k) {
            lanes.along[k][lanes.count] = along[k];
            lanes.left[k][lanes.count] = against[edge.left][k];
            lanes.right[k][lanes.count] = against[edge.right][k];
        }
        lanes.index[lanes.count++] = uint8_t(e);
    }
}

// On the sphere of normals each edge is an arc between its faces' normals, part of the great circle across
// its direction. The arcs of a and of -b cross, so that the edges meet in a face of the Minkowski difference, if
// each arc's ends lie on both sides of the other's circle and the two arcs lie on one hemisphere (Gregorius, GDC
// 2013). hits[k] = 1 where they do; returns whether any does.
bool arcs_cross(const Vec3f& along, const Vec3f& left, const Vec3f& right, const EdgeLanes& b, float* hits) {
    float any = 0;
    for (int k = 0; k < b.count; ++k) {
        const float c = b.left[0][k] * along[0] + b.left[1][k] * along[1] + b.left[2][k] * along[2];
        const float d = b.right[0][k] * along[0] + b.right[1][k] * along[1] + b.right[2][k] * along[2];
        const float l = b.along[0][k] * left[0] + b.along[1][k] * left[1] + b.along[2][k] * left[2];
        const float r = b.along[0][k] * right[0] + b.along[1][k] * right[1] + b.along[2][k] * right[2];
        const bool crosses = (c * d < 0) & (l * r < 0) & (c * r > 0);
        hits[k] = crosses ? 1.0f : 0.0f;
        any += hits[k];
    }
    return any > 0;
}

}  // namespace

Vec3f PolytopePair::normal(Axis axis) const {
    if (axis.kind == AxisKind::face_a) return a.faces[axis.i].normal;
    if (axis.kind == AxisKind::face_b) return b_in_a.rotation * -b.faces[axis.j].normal;
    return edge_normal(*this, a.edges[axis.i], b.edges[axis.j]);
}

float PolytopePair::distance(Axis axis) const {
    if (axis.kind == AxisKind::face_a) return face_distance_a(a.faces[axis.i]);
    if (axis.kind == AxisKind::face_b) return face_distance_b(b.faces[axis.j]);
    const Vec3f n = normal(axis);
    return n.dot(b_in_a.position) - highest(b, b_in_a.rotation.transpose() * -n) - highest(a, n);
}

bool PolytopePair::valid(Axis axis) const {
    if (axis.kind == AxisKind::face_a) return axis.i < a.faces.size();
    if (axis.kind == AxisKind::face_b) return axis.j < b.faces.size();
    return axis.kind == AxisKind::edges && axis.i < a.edges.size() && axis.j < b.edges.size();
}

// A face can not separate by more than its distance from the ball inside the other polytope.
Separation best_face_a(const PolytopePair& pair, float margin) {
    Separation best;
    const Vec3f centre = pair.b_in_a * pair.b.centre;
    for (size_t i = 0; i < pair.a.faces.size(); ++i) {
        const Face& face = pair.a.faces[i];
        if (face.normal.dot(centre) - face.offset - pair.b.inner_radius <= best.distance) continue;
        const float distance = pair.face_distance_a(face);
        if (distance > best.distance) best = {{AxisKind::face_a, uint8_t(i), 0}, distance};
        if (distance > margin) break;
    }
    return best;
}

Separation best_face_b(const PolytopePair& pair, float margin) {
    Separation best;
    const Vec3f centre = pair.a_in_b * pair.a.centre;
    for (size_t i = 0; i < pair.b.faces.size(); ++i) {
        const Face& face = pair.b.faces[i];
        if (face.normal.dot(centre) - face.offset - pair.a.inner_radius <= best.distance) continue;
        const float distance = pair.face_distance_b(face);
        if (distance > best.distance) best = {{AxisKind::face_b, 0, uint8_t(i)}, distance};
        if (distance > margin) break;
    }
    return best;
}

// If an edge pair bears the least overlap d <= depth, its nearest points lie on the edges, d apart and both within
// the two polytopes' overlap along normal grown by d.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float margin) {
    const float top_of_a = highest(pair.a, normal);
    const float bottom_of_b =
        normal.dot(pair.b_in_a.position) - highest(pair.b, pair.b_in_a.rotation.transpose() * -normal);
    EdgeLanes lanes;
    gather(pair, normal, top_of_a + depth, lanes);
    float reach[kMaxVertices];
    for (size_t i = 0; i < pair.a.vertices.size(); ++i) reach[i] = normal.dot(pair.a.vertices[i]);
    Separation best;
    float hits[kMaxEdges];
    for (size_t e = 0; e < pair.a.edges.size(); ++e) {
        const Edge& edge = pair.a.edges[e];
        if (std::max(reach[edge.from], reach[edge.to]) < bottom_of_b - depth) continue;
        const Vec3f along = pair.a.direction(edge);
        if (!arcs_cross(along, pair.a.faces[edge.left].normal, pair.a.faces[edge.right].normal, lanes, hits)) continue;
        for (int k = 0; k < lanes.count; ++k) {
            if (hits[k] == 0) continue;
            const Edge& edge_b = pair.b.edges[lanes.index[k]];
            const Vec3f across = edge_normal(pair, edge, edge_b);
            if (across.squaredNorm() == 0) continue;
            const Vec3f apart = pair.b_in_a * pair.b.vertices[edge_b.from] - pair.a.vertices[edge.from];
            const float distance = across.dot(apart);
            if (distance > best.distance) best = {{AxisKind::edges, uint8_t(e), lanes.index[k]}, distance};
            if (distance > margin) return best;
        }
    }
    return best;
}

int incident_face(const Polytope& polytope, const Vec3f& reference_normal) {
    const int vertex = support(polytope, -reference_normal);
    int best = 0;
    float most = 2;
    for (const Edge& edge : polytope.edges) {
        if (edge.from != vertex && edge.to != vertex) continue;
        for (const int face : {int(edge.left), int(edge.right)}) {
            const float dot = polytope.faces[size_t(face)].normal.dot(reference_normal);
            if (dot < most) {
                most = dot;
                best = face;
            }
        }
    }
    return best;
}

}  // namespace taut::collision
