// Convex polytopes as the narrowphase sees them: one view for hulls (built once) and boxes (built on the stack).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include "base/math.h"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace taut::collision {

// Euler's formula bounds faces and edges: f <= 2 v - 4, e <= 3 v - 6.
constexpr int kMaxVertices = 64;
constexpr int kMaxFaces = 2 * kMaxVertices - 4;
constexpr int kMaxEdges = 3 * kMaxVertices - 6;

// Four vertices side by side; the last pack repeats its last vertex.
struct VertexPack {
    Eigen::Array4f x, y, z;
};

// A point p of a face has the plane coordinates (u . p, v . p) and the height normal . p - offset.
struct Face {
    Vec3f normal, u, v;     // right-handed, unit
    float offset;           // [m]
    uint16_t first, count;  // corners, counter-clockwise from outside, in loops and sides
};

// Four faces' planes side by side; the last pack repeats its last face.
struct PlanePack {
    Eigen::Array4f x, y, z, offset;
};
constexpr int kMaxPlanePacks = (kMaxFaces + 3) / 4;

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
    std::span<const VertexPack> packs;
    std::span<const Face> faces;
    std::span<const PlanePack> planes;  // of the faces
    std::span<const uint8_t> loops;     // vertex indices
    std::span<const Side> sides;        // parallel to loops
    std::span<const Edge> edges;
    std::span<const Fan> fans;        // of the vertices
    std::span<const uint8_t> around;  // face numbers, twice as many as edges
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

inline Eigen::Array4f heights(const VertexPack& pack, const Vec3f& direction) {
    return pack.x * direction.x() + pack.y * direction.y() + pack.z * direction.z();
}

// direction . v of all vertices into an aligned array of kMaxVertices; returns the most.
inline float find_heights(const Polytope& polytope, const Vec3f& direction, float* height) {
    Eigen::Array4f best = heights(polytope.packs[0], direction);
    for (const VertexPack& pack : polytope.packs) {
        const Eigen::Array4f four = heights(pack, direction);
        Eigen::Map<Eigen::Array4f, Eigen::Aligned16>{height} = four;
        best = best.max(four);
        height += 4;
    }
    return best.maxCoeff();
}

// max over vertices of direction . v
inline float highest(const Polytope& polytope, const Vec3f& direction) {
    Eigen::Array4f best = heights(polytope.packs[0], direction);
    for (size_t i = 1; i < polytope.packs.size(); ++i) best = best.max(heights(polytope.packs[i], direction));
    return best.maxCoeff();
}

// normal . p - offset of four faces.
inline Eigen::Array4f heights_over(const PlanePack& pack, const Vec3f& p) {
    return pack.x * p.x() + pack.y * p.y() + pack.z * p.z() - pack.offset;
}

// Largest height of a point over a face: how far outside it is; negative inside, where it is the way to the nearest
// face.
inline float outside(const Polytope& polytope, const Vec3f& p) {
    Eigen::Array4f most = heights_over(polytope.planes[0], p);
    for (size_t i = 1; i < polytope.planes.size(); ++i) most = most.max(heights_over(polytope.planes[i], p));
    return most.maxCoeff();
}

// Of four numbers, a bit for each that holds.
#if defined(__SSE2__)
inline unsigned equal_bits(const float* four, float x) {
    return unsigned(_mm_movemask_ps(_mm_cmpeq_ps(_mm_load_ps(four), _mm_set1_ps(x))));
}
#else
inline unsigned equal_bits(const float* four, float x) {
    unsigned bits = 0;
    for (int i = 0; i < 4; ++i) bits |= unsigned(four[i] == x) << i;
    return bits;
}
#endif

// Index of the first of `count` values that equals x, the last index if none does. Aligned, room for whole packs of 4.
// Looks at 64 at a time, for where the first lies would be mispredicted.
inline int first_equal(const float* values, int count, float x) {
    for (int begin = 0; begin < count; begin += 64) {
        uint64_t bits = 0;
        const int end = std::min(count - begin, 64);
        for (int i = 0; i < end; i += 4) bits |= uint64_t(equal_bits(values + begin + i, x)) << i;
        if (bits != 0) return std::min(begin + std::countr_zero(bits), count - 1);
    }
    return count - 1;
}

// Index of the vertex furthest along direction; the first of equals.
inline int support(const Polytope& polytope, const Vec3f& direction) {
    alignas(16) float height[kMaxVertices];
    const float top = find_heights(polytope, direction, height);
    return first_equal(height, int(polytope.vertices.size()), top);
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
    std::array<VertexPack, 2> packs_;
    std::array<Face, 6> faces_;
    std::array<PlanePack, 2> planes_;
    std::array<Side, 24> sides_;
    Polytope view_;
};

}  // namespace taut::collision
