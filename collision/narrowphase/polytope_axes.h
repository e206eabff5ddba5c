// Separating axes of two polytopes, all in a's frame.
#pragma once

#include <cmath>

#include "collision/narrowphase/kernel.h"
#include "collision/narrowphase/segment.h"
#include "collision/polytope.h"

namespace taut::collision {

enum class AxisKind : uint8_t { none, face_a, face_b, edges };

// Names an axis by the features it comes from; i and j are face or edge numbers.
struct Axis {
    AxisKind kind = AxisKind::none;
    // face_a: the axis of face i of a; face_b: of face j of b, and once they touch the other number is the face that
    // lies against it; edges: i of a, j of b
    uint8_t i = 0, j = 0;

    bool operator==(const Axis&) const = default;
};

struct Separation {
    Axis axis;
    float distance = -1e30f;  // negative is overlap [m]
    int nearest = 0;          // of a face: the other polytope's vertex
};

struct PolytopePair {
    const Polytope& a;
    const Polytope& b;
    Pose b_in_a, a_in_b;

    PolytopePair(const Polytope& pa, const Polytope& pb, const Pose& pose)
        : a(pa), b(pb), b_in_a(pose), a_in_b{pose.rotation.transpose(), pose.rotation.transpose() * -pose.position} {}

    // The unit axis from a to b, a's frame.
    Vec3f normal(Axis axis) const;
    bool valid(Axis axis) const;
    // The edges of an axis between edges, a's frame.
    struct EdgePair {
        Segment a, b;
    };
    EdgePair edges(Axis axis) const;
    float size() const { return std::min(a.outer_radius, b.outer_radius); }
};

// Whether no axis separates by ask more than a pair of edges: they meet in a face of the Minkowski difference, and none
// separates by more than two points of the polytopes are apart; nor, where they overlap, by less than balls do that lie
// in each about the same point.
bool edges_decide(const PolytopePair& pair, Axis axis, float ask);

// The face next to either of two edges that looks most along the edges' normal, and the cosine to it.
struct FaceBeside {
    Axis axis;
    float along = -1;
};
FaceBeside face_beside(const PolytopePair& pair, Axis axis, const Vec3f& normal);

// The face of a that separates most, and likewise of b; stops at the first beyond margin. Of b: none, or any, where
// none separates by more than least.
Separation best_face_a(const PolytopePair& pair, float margin);
Separation best_face_b(const PolytopePair& pair, float least, float margin);

// The pair of edges that separates most, among those that could bear less than depth of overlap: edges on the
// far sides, as seen along the unit normal (a to b), can not. None, or any, where none separates by least.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float least);

constexpr float kParallel = 1e-6f;  // edges within 1e-3 rad of parallel have no axis of their own: squared

// Unit normal across an edge of a and a direction that points out of a; zero for parallel ones.
inline Vec3f edge_normal(const Polytope& a, const Edge& edge_a, const Vec3f& along_b) {
    const Vec3f along_a = a.direction(edge_a);
    const Vec3f cross = along_a.cross(along_b);
    const float squared = cross.squaredNorm();
    const Vec3f out_of_a = a.faces[edge_a.left].normal + a.faces[edge_a.right].normal;
    const float scale =
        squared > kParallel * along_a.squaredNorm() * along_b.squaredNorm() ? 1 / std::sqrt(squared) : 0;
    return cross * (cross.dot(out_of_a) < 0 ? -scale : scale);
}

}  // namespace taut::collision
