// Triangle meshes: repaired, joined over their edges and put into a tree of boxes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/surface.h"
#include "collision/triangle_tree.h"

namespace taut::collision {
namespace {

// Thinner triangles, as a share of their longest edge, have no normal worth keeping.
constexpr double kThinnest = 1e-5;
// Coordinates that differ by less are the same, as a share of the largest: a few roundings of single precision.
constexpr float kRounding = 5e-7f;
// Triangles at an edge within this angle are in one place [rad].
constexpr double kBack = 1e-3;
// Of more triangles at one edge the later ones end there.
constexpr size_t kMostAround = 16;

bool before(const Vec3f& a, const Vec3f& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

struct Mesh : Surface {
    uint32_t slots() const override { return uint32_t(triangles.size()); }
    bool has(uint32_t) const override { return true; }
    Corners corners(uint32_t triangle) const override { return triangles[triangle]; }
    Vec3f vertex(uint32_t i) const override { return vertices[i]; }
    uint32_t neighbour(uint32_t triangle, int edge) const override { return neighbours[triangle][size_t(edge)]; }
    std::span<const uint32_t> ring(uint32_t i, RingRoom&) const override {
        return std::span(rings).subspan(ring_begin[i], ring_begin[i + 1] - ring_begin[i]);
    }
    void find(const Box& where, TriangleSink& found) const override { tree.find(where, found); }

    std::vector<Vec3f> vertices;
    std::vector<Corners> triangles;
    std::vector<Corners> neighbours;   // by triangle and edge
    std::vector<uint32_t> ring_begin;  // by vertex, into rings
    std::vector<uint32_t> rings;
    TriangleTree tree;
};

// Coordinates along one axis that differ by rounding become equal: each takes the least value within reach below it.
void snap(std::vector<Vec3f>& points, int axis, float reach) {
    std::vector<uint32_t> order(points.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t(i);
    std::sort(order.begin(), order.end(), [&](uint32_t i, uint32_t k) {
        return points[i][axis] != points[k][axis] ? points[i][axis] < points[k][axis] : i < k;
    });
    float value = -std::numeric_limits<float>::infinity();
    for (const uint32_t i : order) {
        float& x = points[i][axis];
        if (!(x - value <= reach)) value = x;
        x = value;
    }
}

// Vertices at the same place but for rounding become one, so that triangles with corners of their own hang together.
std::vector<uint32_t> weld(std::span<const Vec3f> given, std::vector<Vec3f>& vertices) {
    std::vector<Vec3f> at(given.begin(), given.end());
    float largest = 0;
    for (Vec3f& p : at) {
        p += Vec3f::Zero();  // -0 becomes 0
        largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    for (int axis = 0; axis < 3; ++axis) snap(at, axis, kRounding * largest);
    std::vector<uint32_t> order(at.size()), number(at.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = uint32_t(i);
    std::sort(order.begin(), order.end(),
              [&](uint32_t i, uint32_t k) { return at[i] != at[k] ? before(at[i], at[k]) : i < k; });
    for (const uint32_t i : order) {
        if (vertices.empty() || vertices.back() != at[i]) vertices.push_back(at[i]);
        number[i] = uint32_t(vertices.size() - 1);
    }
    return number;
}

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() > kThinnest * longest;
}

// Triangles with the smallest corner first, those without area and second copies left out.
void take_triangles(std::span<const uint32_t> indices, const std::vector<uint32_t>& number, Mesh& mesh) {
    const auto at = [&](uint32_t i) { return Vec3(mesh.vertices[i].cast<double>()); };
    std::vector<std::pair<Corners, uint32_t>> sorted;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        Corners c = {number[indices[i]], number[indices[i + 1]], number[indices[i + 2]]};
        if (!has_area(at(c[0]), at(c[1]), at(c[2]))) {
            ++mesh.counts.without_area;
            continue;
        }
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        sorted.emplace_back(c, uint32_t(i / 3));
    }
    std::sort(sorted.begin(), sorted.end());
    const auto last =
        std::unique(sorted.begin(), sorted.end(), [](const auto& s, const auto& t) { return s.first == t.first; });
    mesh.counts.duplicates = uint32_t(sorted.end() - last);
    sorted.erase(last, sorted.end());
    std::sort(sorted.begin(), sorted.end(), [](const auto& s, const auto& t) { return s.second < t.second; });
    for (const auto& [corners, place] : sorted) mesh.triangles.push_back(corners);
}

struct HalfEdge {
    uint32_t lower, upper;  // vertices
    uint32_t triangle;
    uint8_t edge;
    bool up;  // from lower to upper

    auto ends() const { return std::pair(lower, upper); }
};

// How far a body in front of a triangle can turn about one of its edges before it meets another triangle there: 0 to 4
// for a full turn (the angle's monotone 1 - cos, then 3 + cos). The other's back in the same place is a full turn.
double opening(const Mesh& mesh, const std::vector<Vec3>& normal, const HalfEdge& one, const HalfEdge& other) {
    const auto at = [&](uint32_t i) { return Vec3(mesh.vertices[i].cast<double>()); };
    const Vec3 along = (at(one.upper) - at(one.lower)).normalized();
    const auto inward = [&](const HalfEdge& edge) {
        const Vec3 p = at(third_corner(mesh.triangles[edge.triangle], edge.lower, edge.upper)) - at(edge.lower);
        return Vec3((p - along * along.dot(p)).normalized());
    };
    const Vec3 from = inward(one), to = inward(other);
    const double cosine = from.dot(to), sine = normal[one.triangle].dot(to);
    if (cosine > 0 && std::fabs(sine) < kBack) return 4;
    return sine > 0 ? 1 - cosine : 3 + cosine;
}

// Across each edge, of the triangles that share it, the one that a body in front meets first; of two in one place the
// one that looks to the same side.
void join(Mesh& mesh) {
    std::vector<HalfEdge> edges;
    std::vector<Vec3> normal;
    for (uint32_t t = 0; t < mesh.slots(); ++t) {
        const Corners& c = mesh.triangles[t];
        for (int e = 0; e < 3; ++e) {
            const uint32_t from = c[size_t(e)], to = c[size_t(next_corner(e))];
            edges.push_back({std::min(from, to), std::max(from, to), t, uint8_t(e), from < to});
        }
        const Vec3 a = mesh.vertices[c[0]].cast<double>();
        normal.push_back((mesh.vertices[c[1]].cast<double>() - a).cross(mesh.vertices[c[2]].cast<double>() - a));
        normal.back().normalize();
    }
    std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
        return a.ends() != b.ends() ? a.ends() < b.ends() : a.triangle < b.triangle;
    });
    mesh.neighbours.assign(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
    for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
        while (end < edges.size() && edges[end].ends() == edges[begin].ends()) ++end;
        const size_t last = std::min(end, begin + kMostAround);
        for (size_t i = begin; i < last; ++i) {
            double least = 4;
            for (size_t k = begin; k < last; ++k) {
                if (k == i) continue;
                const double open =
                    opening(mesh, normal, edges[i], edges[k]) + (edges[i].up == edges[k].up ? kBack : 0);
                if (open >= least) continue;
                least = open;
                mesh.neighbours[edges[i].triangle][edges[i].edge] = edges[k].triangle;
            }
        }
    }
}

void link_vertices(Mesh& mesh) {
    std::vector<std::pair<uint32_t, uint32_t>> links;
    for (const Corners& c : mesh.triangles) {
        for (int e = 0; e < 3; ++e) {
            const uint32_t from = c[size_t(e)], to = c[size_t(next_corner(e))];
            links.emplace_back(from, to);
            links.emplace_back(to, from);
        }
    }
    std::sort(links.begin(), links.end());
    links.erase(std::unique(links.begin(), links.end()), links.end());
    mesh.ring_begin.assign(mesh.vertices.size() + 1, 0);
    for (const auto& [from, to] : links) {
        ++mesh.ring_begin[from + 1];
        mesh.rings.push_back(to);
    }
    for (size_t i = 0; i < mesh.vertices.size(); ++i) mesh.ring_begin[i + 1] += mesh.ring_begin[i];
}

}  // namespace

std::shared_ptr<const Surface> build_mesh(std::span<const Vec3f> vertices, std::span<const uint32_t> indices,
                                          bool two_sided) {
    auto mesh = std::make_shared<Mesh>();
    mesh->two_sided = two_sided;
    take_triangles(indices, weld(vertices, mesh->vertices), *mesh);
    if (mesh->triangles.empty()) return nullptr;
    join(*mesh);
    link_vertices(*mesh);
    find_facets(*mesh);
    mesh->tree.build(*mesh);
    return mesh;
}

}  // namespace taut::collision
