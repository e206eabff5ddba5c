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
    void turn(float (&lanes)[3][kLanes], const Mat3f& r, const Vec3f& shift) const {
        for (int k = 0; k < count; ++k) {
            const float x = lanes[0][k], y = lanes[1][k], z = lanes[2][k];
            lanes[0][k] = r(0, 0) * x + r(0, 1) * y + r(0, 2) * z + shift[0];
            lanes[1][k] = r(1, 0) * x + r(1, 1) * y + r(1, 2) * z + shift[1];
            lanes[2][k] = r(2, 0) * x + r(2, 1) * y + r(2, 2) * z + shift[2];
        }
    }
};

// The vertices of one polytope along a direction of its frame.
struct Heights {
    alignas(16) float of[kMaxVertices];
    float top;

    Heights(const Polytope& polytope, const Vec3f& direction) : top(find_heights(polytope, direction, of)) {}
};

// The edges that reach up to the least height; returns how many.
int edges_above(const Polytope& polytope, const Heights& heights, float least, uint8_t* index) {
    int count = 0;
    for (size_t e = 0; e < polytope.edges.size(); ++e) {
        index[count] = uint8_t(e);
        count += std::max(heights.of[polytope.edges[e].from], heights.of[polytope.edges[e].to]) >= least;
    }
    return count;
}

// Those edges of b whose heights reach up to the least.
void gather(const PolytopePair& pair, const Heights& heights, float least, EdgeLanes& lanes) {
    const int count = edges_above(pair.b, heights, least, lanes.index);
    lanes.count = (count + 3) / 4 * 4;
    for (int k = 0; k < count; ++k) {
        const Edge& edge = pair.b.edges[lanes.index[k]];
        lanes.put(lanes.from, k, pair.b.vertices[edge.from]);
        lanes.put(lanes.along, k, pair.b.direction(edge));
        lanes.put(lanes.left, k, pair.b.faces[edge.left].normal);
        lanes.put(lanes.right, k, pair.b.faces[edge.right].normal);
    }
    for (int k = count; k < lanes.count; ++k)
        for (auto* each : {&lanes.from, &lanes.along, &lanes.left, &lanes.right}) lanes.put(*each, k, Vec3f::Zero());
    const Mat3f& r = pair.b_in_a.rotation;
    lanes.turn(lanes.from, r, pair.b_in_a.position);
    lanes.turn(lanes.along, r, Vec3f::Zero());
    lanes.turn(lanes.left, -r, Vec3f::Zero());
    lanes.turn(lanes.right, -r, Vec3f::Zero());
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

// The same of one pair of edges.
bool arcs_cross(const PolytopePair& pair, const Edge& edge_a, const Edge& edge_b) {
    const Mat3f& rotation = pair.b_in_a.rotation;
    const Vec3f along_a = pair.a.direction(edge_a), along_b = rotation * pair.b.direction(edge_b);
    const float c = -(rotation * pair.b.faces[edge_b.left].normal).dot(along_a);
    const float d = -(rotation * pair.b.faces[edge_b.right].normal).dot(along_a);
    const float l = along_b.dot(pair.a.faces[edge_a.left].normal);
    const float r = along_b.dot(pair.a.faces[edge_a.right].normal);
    return c * d < 0 && l * r < 0 && c * r > 0;
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
    const float separation = normal.dot(on_b.from - on_a.from);
    const float most = separation + ask;
    return most > 0 && (on_b.at(nearest.t) - on_a.at(nearest.s)).squaredNorm() <= most * most;
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

// How far every face separates at most, as the other polytope is known so far: no face separates by more than its
// distance from a point of the other.
class FaceBounds {
public:
    // The other holds a ball.
    FaceBounds(const Polytope& one, const Vec3f& centre, float radius) : one_(one) {
        Eigen::Array4f most = Eigen::Array4f::Constant(kAsked);
        for (size_t k = 0; k < one.planes.size(); ++k) {
            pack(k) = heights_over(one.planes[k], centre) - radius;
            most = most.max(pack(k));
        }
        largest_ = most.maxCoeff();
        std::fill(most_ + one.faces.size(), most_ + 4 * one.planes.size(), kAsked);
    }
    float largest() const { return largest_; }
    // The face with the largest bound, which is asked no more.
    size_t take_largest() {
        const int face = first_equal(most_, int(one_.faces.size()), largest_);
        most_[face] = kAsked;
        return size_t(face);
    }
    // The other holds a point.
    void lower(const Vec3f& point) {
        Eigen::Array4f most = Eigen::Array4f::Constant(kAsked);
        for (size_t k = 0; k < one_.planes.size(); ++k) {
            pack(k) = pack(k).min(heights_over(one_.planes[k], point));
            most = most.max(pack(k));
        }
        largest_ = most.maxCoeff();
    }

private:
    static constexpr float kAsked = -1e30f;

    Eigen::Map<Eigen::Array4f, Eigen::Aligned16> pack(size_t k) {
        return Eigen::Map<Eigen::Array4f, Eigen::Aligned16>{most_ + 4 * k};
    }

    const Polytope& one_;
    float largest_;
    alignas(16) float most_[4 * kMaxPlanePacks];
};

// The face of one that separates most from the other, which lies at a pose; those with the largest bounds first.
Separation best_face(const Polytope& one, const Polytope& other, const Pose& pose, float margin, AxisKind kind) {
    FaceBounds bounds(one, pose * other.centre, other.inner_radius);
    Separation best;
    while (bounds.largest() > best.distance) {
        const size_t i = bounds.take_largest();
        const Face& face = one.faces[i];
        const int vertex = support(other, pose.rotation.transpose() * -face.normal);
        const Vec3f nearest = pose * other.vertices[size_t(vertex)];
        const float distance = face.normal.dot(nearest) - face.offset;
        if (distance > best.distance)
            best = {kind == AxisKind::face_a ? Axis{kind, uint8_t(i), 0} : Axis{kind, 0, uint8_t(i)}, distance, vertex};
        if (distance > margin) break;
        bounds.lower(nearest);
    }
    return best;
}

}  // namespace

Separation best_face_a(const PolytopePair& pair, float margin) {
    return best_face(pair.a, pair.b, pair.b_in_a, margin, AxisKind::face_a);
}

Separation best_face_b(const PolytopePair& pair, float margin) {
    return best_face(pair.b, pair.a, pair.a_in_b, margin, AxisKind::face_b);
}

// If an edge pair bears the least overlap d <= depth, its nearest points lie on the edges, d apart and both within
// the two polytopes' overlap along normal grown by d.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float margin) {
    const Heights up_a(pair.a, normal);
    const Heights down_b(pair.b, pair.b_in_a.rotation.transpose() * -normal);
    const float middle = normal.dot(pair.b_in_a.position);
    EdgeLanes lanes;
    gather(pair, down_b, middle - up_a.top - depth, lanes);
    uint8_t own[kMaxEdges];
    const int count = edges_above(pair.a, up_a, middle - down_b.top - depth, own);
    Separation best;
    alignas(16) int32_t hits[kLanes];
    uint8_t hit[kLanes + 1];
    for (int e = 0; e < count; ++e) {
        const Edge& edge = pair.a.edges[own[e]];
        const Vec3f along = pair.a.direction(edge);
        if (!arcs_cross(along, pair.a.faces[edge.left].normal, pair.a.faces[edge.right].normal, lanes, hits)) continue;
        int found = 0;
        for (int k = 0; k < lanes.count; ++k) {  // without branches, which would be mispredicted
            hit[found] = uint8_t(k);
            found += hits[k];
        }
        for (int i = 0; i < found; ++i) {
            const int k = hit[i];
            const Vec3f across = edge_normal(pair.a, edge, lanes.at(lanes.along, k));
            if (across.squaredNorm() == 0) continue;
            const float distance = across.dot(lanes.at(lanes.from, k) - pair.a.vertices[edge.from]);
            if (distance > best.distance) best = {{AxisKind::edges, own[e], lanes.index[k]}, distance, 0};
            if (distance > margin) return best;
        }
    }
    return best;
}

}  // namespace taut::collision
