// Separating axes of two polytopes, all in a's frame.
#pragma once

#include "collision/narrowphase/kernel.h"
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
    float size() const { return std::min(a.outer_radius, b.outer_radius); }

    float face_distance_a(const Face& face) const {
        return face.normal.dot(b_in_a.position) - highest(b, b_in_a.rotation.transpose() * -face.normal) - face.offset;
    }
    float face_distance_b(const Face& face) const {
        return face.normal.dot(a_in_b.position) - highest(a, b_in_a.rotation * -face.normal) - face.offset;
    }
};

// The face of a that separates most, and likewise of b; stops at the first beyond margin.
Separation best_face_a(const PolytopePair& pair, float margin);
Separation best_face_b(const PolytopePair& pair, float margin);

// The pair of edges that separates most, among those that could bear less than depth of overlap: edges on the
// far sides, as seen along the unit normal (a to b), can not.
Separation best_edges(const PolytopePair& pair, const Vec3f& normal, float depth, float margin);

}  // namespace taut::collision
