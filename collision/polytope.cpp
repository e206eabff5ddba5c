#include "collision/polytope.h"

namespace taut::collision {
namespace {

// Vertex i lies at (+-hx, +-hy, +-hz), bits 0, 1, 2 of i set for plus.
// Corners of face 2 k + s counter-clockwise: its first in-plane axis is k + 1 if it looks along plus, else k + 2.
constexpr std::array<uint8_t, 24> box_loops() {
    std::array<uint8_t, 24> loops{};
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const int positive = face % 2;
        const int u = 1 << (positive ? (axis + 1) % 3 : (axis + 2) % 3);
        const int v = 1 << (positive ? (axis + 2) % 3 : (axis + 1) % 3);
        const int base = positive << axis;
        const int corners[4] = {base, base + u, base + u + v, base + v};
        for (int i = 0; i < 4; ++i) loops[size_t(4 * face + i)] = uint8_t(corners[i]);
    }
    return loops;
}

// Edge 4 k + i runs along +axis k; e_u x e_v = e_k says which of its faces is on the left.
constexpr std::array<Edge, 12> box_edges() {
    std::array<Edge, 12> edges{};
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        for (int i = 0; i < 4; ++i) {
            const int su = i & 1;
            const int sv = i >> 1;
            const int from = (su << u) + (sv << v);
            const uint8_t face_u = uint8_t(2 * u + su);
            const uint8_t face_v = uint8_t(2 * v + sv);
            const bool along = su == sv;
            edges[size_t(4 * axis + i)] = {uint8_t(from), uint8_t(from + (1 << axis)), along ? face_u : face_v,
                                           along ? face_v : face_u};
        }
    }
    return edges;
}

constexpr std::array<uint8_t, 24> kLoops = box_loops();
constexpr std::array<Edge, 12> kEdges = box_edges();

// All but the offsets, which are the half extents.
std::array<Face, 6> unit_faces() {
    std::array<Face, 6> faces;
    for (int face = 0; face < 6; ++face) {
        const int axis = face / 2;
        const int u = face % 2 ? (axis + 1) % 3 : (axis + 2) % 3;
        const int v = face % 2 ? (axis + 2) % 3 : (axis + 1) % 3;
        faces[size_t(face)] = {
            Vec3f::Unit(axis) * (face % 2 ? 1.0f : -1.0f), Vec3f::Unit(u), Vec3f::Unit(v), 1.0f, uint16_t(4 * face), 4};
    }
    return faces;
}

const std::array<Face, 6> kFaces = unit_faces();

}  // namespace

// Each edge of a vertex names two of its faces, and each of these once more on their other edge there.
void find_fans(std::span<const Edge> edges, std::span<Fan> fans, std::span<uint8_t> around) {
    uint16_t first = 0;
    for (size_t vertex = 0; vertex < fans.size(); ++vertex) {
        uint16_t count = 0;
        for (const Edge& edge : edges) {
            if (edge.from != vertex && edge.to != vertex) continue;
            for (const uint8_t face : {edge.left, edge.right}) {
                const auto begin = around.begin() + first, end = begin + count;
                if (std::find(begin, end, face) == end) around[size_t(first + count++)] = face;
            }
        }
        fans[vertex] = {first, count};
        first = uint16_t(first + count);
    }
}

namespace {

struct BoxFans {
    std::array<Fan, 8> fans;
    std::array<uint8_t, 24> around;

    BoxFans() { find_fans(kEdges, fans, around); }
};

const BoxFans kFans;

}  // namespace

int face_against(const Polytope& polytope, int vertex, const Vec3f& direction) {
    int best = 0;
    float most = 2;
    for (const uint8_t face : polytope.faces_around(vertex)) {
        const float dot = polytope.faces[face].normal.dot(direction);
        best = dot < most ? face : best;
        most = dot < most ? dot : most;
    }
    return best;
}

BoxPolytope::BoxPolytope(const Vec3f& half) : faces_(kFaces) {
    const float hx = half.x(), hy = half.y(), hz = half.z();
    vertices_ = {Vec3f(-hx, -hy, -hz), Vec3f(hx, -hy, -hz), Vec3f(-hx, hy, -hz), Vec3f(hx, hy, -hz),
                 Vec3f(-hx, -hy, hz),  Vec3f(hx, -hy, hz),  Vec3f(-hx, hy, hz),  Vec3f(hx, hy, hz)};
    using Pack = Eigen::Array4f;
    const Pack x(-hx, hx, -hx, hx), y(-hy, -hy, hy, hy), z = Pack::Constant(hz);
    const auto put = [](FloatLanes& lanes, const Pack& first, const Pack& second, float last) {
        const Pack rest = Pack::Constant(last);
        const Pack* const packs[kLanes / 4] = {&first, &second, &rest, &rest};
        for (int k = 0; k < kLanes / 4; ++k) Eigen::Map<Pack, Eigen::Aligned16>{lanes.of + 4 * k} = *packs[k];
    };
    put(corners_[0], x, x, hx);
    put(corners_[1], y, y, hy);
    put(corners_[2], -z, z, hz);
    for (int axis = 0; axis < 3; ++axis) {
        const float p = half[(axis + 1) % 3];
        const float q = half[(axis + 2) % 3];
        Side* minus = &sides_[size_t(8 * axis)];
        Side* plus = minus + 4;
        faces_[size_t(2 * axis)].offset = faces_[size_t(2 * axis + 1)].offset = half[axis];
        minus[0] = {0, -1, p};
        minus[1] = {1, 0, q};
        minus[2] = {0, 1, p};
        minus[3] = {-1, 0, q};
        plus[0] = {0, -1, q};
        plus[1] = {1, 0, p};
        plus[2] = {0, 1, q};
        plus[3] = {-1, 0, p};
    }
    const Pack zero = Pack::Zero();
    put(planes_[0], {-1, 1, 0, 0}, zero, 0);
    put(planes_[1], {0, 0, -1, 1}, zero, 0);
    put(planes_[2], zero, {-1, 1, 1, 1}, 1);
    put(planes_[3], {hx, hx, hy, hy}, z, hz);
    view_ = {vertices_,
             faces_,
             kLoops,
             sides_,
             kEdges,
             kFans.fans,
             kFans.around,
             {corners_[0].of, kLanes},
             {planes_[0].of, kLanes},
             Vec3f::Zero(),
             half.minCoeff(),
             half.norm()};
}

}  // namespace taut::collision
