#include "collision/narrowphase/polytope_axes.h"

#include <cmath>

namespace taut::collision {
namespace {

// Edges within 1e-3 rad of parallel have no axis of their own.
constexpr float kParallel = 1e-6f;

// Unit normal across an edge of a and a direction that points out of a; zero for parallel ones.
Vec3f edge_normal(const Polytope& a, const Edge& edge_a, const Vec3f& along_b) {
    const Vec3f along_a = a.direction(edge_a);
    const Vec3f cross = along_a.cross(along_b);
    const float squared = cross.squaredNorm();
    if (!(squared > kParallel * along_a.squaredNorm() * along_b.squaredNorm())) return Vec3f::Zero();
    const Vec3f out_of_a = a.faces[edge_a.left].normal + a.faces[edge_a.right].normal;
    const float scale = 1 / std::sqrt(squared);
    return cross * (cross.dot(out_of_a) < 0 ? -scale : scale);
}

constexpr int kLanes = (kMaxEdges + 3) / 4 * 4;

// Edges of one polytope in a's frame, coordinates side by side for the sweep over them.
struct EdgeLanes {
    int count = 0;  // a multiple of 4: filled up with zeros, which cross nothing
    uint8_t index[kLanes];
    alignas(16) float from[3][kLanes];
    alignas(16) float along[3][kLanes];  // from one end to the other
    alignas(16) float left[3][kLanes];   // normals of the two faces, those of b negated
    alignas(16) float right[3][kLanes];

    Vec3f at(const float (&lanes)[3][kLanes], int k) const { return {lanes[0][k], lanes[1][k], lanes[2][k]}; }
    static void put(float (&lanes)[3][kLanes], int k, const Vec3f& v) {
        for (int i = 0; i < 3; ++i) lanes[i][k] = v[i];
    }
};

// The edges that reach up to the least height along direction; returns how many.
int edges_above(const Polytope& polytope, const Vec3f& direction, float least, uint8_t* index) {
    alignas(16) float reach[kMaxVertices];
    find_heights(polytope, direction, reach);
    int count = 0;
    for (size_t e = 0; e < polytope.edges.size(); ++e) {
        index[count] = uint8_t(e);
        count += std::max(reach[polytope.edges[e].from], reach[polytope.edges[e].to]) >= least;
    }
    return count;
}

// Those edges of b that reach down to the given height along normal.
void gather(const PolytopePair& pair, const Vec3f& normal, float height, EdgeLanes& lanes) {
    const Mat3f& r = pair.b_in_a.rotation;
    const int count =
        edges_above(pair.b, r.transpose() * -normal, normal.dot(pair.b_in_a.position) - height, lanes.index);
    lanes.count = (count + 3) / 4 * 4;
    for (int k = 0; k < count; ++k) {
        const Edge& edge = pair.b.edges[lanes.index[k]];
        lanes.put(lanes.from, k, pair.b_in_a * pair.b.vertices[edge.from]);
        lanes.put(lanes.along, k, r * pair.b.direction(edge));
        lanes.put(lanes.left, k, -(r * pair.b.faces[edge.left].normal));
        lanes.put(lanes.right, k, -(r * pair.b.faces[edge.right].normal));
    }
    for (int k = count; k < lanes.count; ++k) {
        lanes.put(lanes.along, k, Vec3f::Zero());
        lanes.put(lanes.left, k, Vec3f::Zero());
        lanes.put(lanes.right, k, Vec3f::Zero());
    }
}

// On the sphere of normals each edge is an arc between its faces' normals, part of the great circle across
// its direction. The arcs of a and of -b cross, so that the edges meet in a face of the Minkowski difference, if
// each arc's ends lie on both sides of the other's circle and the two arcs lie on one hemisphere (Gregorius, GDC
// 2013). hits[k] = 1 where they do; returns whether any does.
bool arcs_cross(const Vec3f& along, const Vec3f& left, const Vec3f& right, const EdgeLanes& b, int32_t* hits) {
    int32_t any = 0;
    for (int k = 0; k < b.count; ++k) {
        const float c = b.left[0][k] * along[0] + b.left[1][k] * along[1] + b.left[2][k] * along[2];
        const float d = b.right[0][k] * along[0] + b.right[1][k] * along[1] + b.right[2][k] * along[2];
        const float l = b.along[0][k] * left[0] + b.along[1][k] * left[1] + b.along[2][k] * left[2];
        const float r = b.along[0][k] * right[0] + b.along[1][k] * right[1] + b.along[2][k] * right[2];
        hits[k] = (c * d < 0) & (l * r < 0) & (c * r > 0);
        any |= hits[k];
    }
    return any != 0;
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

namespace {

// The face of one that separates most, its own distance taken from ask(face); the one that looks most towards the ball
// inside the other first, as a face can not separate by more than its distance from that ball.
template <class Ask>
Separation best_face(const Polytope& one, const Vec3f& centre, float radius, float margin, AxisKind kind, Ask&& ask) {
    float most[kMaxFaces];
    size_t first = 0;
    for (size_t i = 0; i < one.faces.size(); ++i) {
        most[i] = one.faces[i].normal.dot(centre) - one.faces[i].offset - radius;
        if (most[i] > most[first]) first = i;
    }
    const auto axis = [&](size_t i) {
        return kind == AxisKind::face_a ? Axis{kind, uint8_t(i), 0} : Axis{kind, 0, uint8_t(i)};
    };
    Separation best = {axis(first), ask(one.faces[first])};
    for (size_t i = 0; i < one.faces.size() && best.distance <= margin; ++i) {
        if (most[i] <= best.distance || i == first) continue;
        const float distance = ask(one.faces[i]);
        if (distance > best.distance) best = {axis(i), distance};
    }
    return best;
}

}  // namespace

Separation best_face_a(const PolytopePair& pair, float margin) {
    return best_face(pair.a, pair.b_in_a * pair.b.centre, pair.b.inner_radius, margin, AxisKind::face_a,
                     [&](const Face& face) { return pair.face_distance_a(face); });
}

Separation best_face_b(const PolytopePair& pair, float margin) {
    return best_face(pair.b, pair.a_in_b * pair.a.centre, pair.a.inner_radius, margin, AxisKind::face_b,
                     [&](const Face& face) { return pair.face_distance_b(face); });
}

// If an edge pair bears the least overlap d <= depth, its nearest points lie on the edges, d apart and both within
// the two polytopes' overlap along normal grown by d.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float margin) {
    const float top_of_a = highest(pair.a, normal);
    const float bottom_of_b =
        normal.dot(pair.b_in_a.position) - highest(pair.b, pair.b_in_a.rotation.transpose() * -normal);
    EdgeLanes lanes;
    gather(pair, normal, top_of_a + depth, lanes);
    uint8_t own[kMaxEdges];
    const int count = edges_above(pair.a, normal, bottom_of_b - depth, own);
    Separation best;
    int32_t hits[kLanes];
    for (int e = 0; e < count; ++e) {
        const Edge& edge = pair.a.edges[own[e]];
        const Vec3f along = pair.a.direction(edge);
        if (!arcs_cross(along, pair.a.faces[edge.left].normal, pair.a.faces[edge.right].normal, lanes, hits)) continue;
        for (int k = 0; k < lanes.count; ++k) {
            if (hits[k] == 0) continue;
            const Vec3f across = edge_normal(pair.a, edge, lanes.at(lanes.along, k));
            if (across.squaredNorm() == 0) continue;
            const float distance = across.dot(lanes.at(lanes.from, k) - pair.a.vertices[edge.from]);
            if (distance > best.distance) best = {{AxisKind::edges, own[e], lanes.index[k]}, distance};
            if (distance > margin) return best;
        }
    }
    return best;
}

}  // namespace taut::collision
