// Convex polytopes as the narrowphase sees them: one view for hulls (built once) and boxes (built on the stack).
#pragma once

#include <algorithm>
#include <array>
#include <span>

#include "base/math.h"
#include "collision/lane_kernels.h"

namespace taut::collision {

// Euler's formula bounds faces and edges: f <= 2 v - 4, e <= 3 v - 6.
constexpr int kMaxVertices = 64;
constexpr int kMaxFaces = 2 * kMaxVertices - 4;
constexpr int kMaxEdges = 3 * kMaxVertices - 6;

struct alignas(64) FloatLanes {
    float of[kLanes];
};

// A point p of a face has the plane coordinates (u . p, v . p) and the height normal . p - offset.
struct Face {
    Vec3f normal, u, v;     // right-handed, unit
    float offset;           // [m]
    uint16_t first, count;  // corners, counter-clockwise from outside, in loops and sides
};

// The edge of a face that starts at the same place of loops: inside is x px + y py <= offset, (x, y) unit.
struct Side {
    float x, y, offset;
};

// The faces around a vertex, in Polytope::around.
struct Fan {
    uint16_t first, count;
};

// Runs from -> to counter-clockwise around the left face, hence along normal(left) x normal(right).
struct Edge {
    uint8_t from, to, left, right;
};

struct Polytope {
    std::span<const Vec3f> vertices;
    std::span<const Face> faces;
    std::span<const uint8_t> loops;  // vertex indices
    std::span<const Side> sides;     // parallel to loops
    std::span<const Edge> edges;
    std::span<const Fan> fans;        // of the vertices
    std::span<const uint8_t> around;  // face numbers, twice as many as edges
    Columns corners;                  // x, y, z of the vertices
    Columns planes;                   // x, y, z of the faces' normals, their offsets
    Vec3f centre = Vec3f::Zero();
    float inner_radius = 0;  // of a ball about the centre that lies inside [m]
    float outer_radius = 0;  // of a ball about the centre that holds all vertices [m]

    std::span<const Side> sides_of(const Face& face) const { return sides.subspan(face.first, face.count); }
    std::span<const uint8_t> loop_of(const Face& face) const { return loops.subspan(face.first, face.count); }
    std::span<const uint8_t> faces_around(int vertex) const {
        const Fan& fan = fans[size_t(vertex)];
        return around.subspan(fan.first, fan.count);
    }
    Vec3f direction(const Edge& edge) const { return vertices[edge.to] - vertices[edge.from]; }
};

// max over vertices of direction . v
inline float highest(const Polytope& polytope, const Vec3f& direction) {
    return lane_kernels().highest(polytope.corners, direction.data());
}

// Largest height of a point over a face: how far outside it is; negative inside, where it is the way to the nearest
// face.
inline float outside(const Polytope& polytope, const Vec3f& p) {
    return lane_kernels().outside(polytope.planes, p.data());
}

// Index of the vertex furthest along direction; the first of equals.
inline int support(const Polytope& polytope, const Vec3f& direction) {
    return int(lane_kernels().support(polytope.corners, direction.data()));
}

// Fills fans, one a vertex, and around.
void find_fans(std::span<const Edge> edges, std::span<Fan> fans, std::span<uint8_t> around);

// Of the faces around a vertex, the one that looks most against the direction.
int face_against(const Polytope& polytope, int vertex, const Vec3f& direction);
// The same around the vertex deepest against the direction.
inline int face_against(const Polytope& polytope, const Vec3f& direction) {
    return face_against(polytope, support(polytope, -direction), direction);
}

// A box spelled out as a polytope; face 2 k + s looks along +axis k if s = 1, else -axis k.
class BoxPolytope {
public:
    explicit BoxPolytope(const Vec3f& half_extents);
    BoxPolytope(const BoxPolytope&) = delete;
    BoxPolytope& operator=(const BoxPolytope&) = delete;
    const Polytope& view() const { return view_; }

private:
    std::array<Vec3f, 8> vertices_;
    std::array<Face, 6> faces_;
    std::array<Side, 24> sides_;
    FloatLanes corners_[3], planes_[4];
    Polytope view_;
};

}  // namespace taut::collision
