// Triangle meshes: repaired, joined over their edges and put into a tree of boxes.
#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/facets.h"
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

struct Mesh final : Surface {
    explicit Mesh(Memory& memory)
        : Surface(memory),
          vertices(memory),
          triangles(memory),
          neighbours(memory),
          ring_begin(memory),
          rings(memory),
          tree(memory) {}

    uint32_t slots() const override { return uint32_t(triangles.size()); }
    bool has(uint32_t) const override { return true; }
    Corners corners(uint32_t triangle) const override { return triangles[triangle]; }
    Vec3f vertex(uint32_t i) const override { return vertices[i]; }
    uint32_t neighbour(uint32_t triangle, int edge) const override { return neighbours[triangle][size_t(edge)]; }
    std::span<const uint32_t> ring(uint32_t i, RingRoom&) const override {
        return std::span(rings).subspan(ring_begin[i], ring_begin[i + 1] - ring_begin[i]);
    }
    void find(const Box& where, TriangleSink& found) const override { tree.find(where, found); }

    Array<Vec3f> vertices;
    Array<Corners> triangles;
    Array<Corners> neighbours;   // by triangle and edge
    Array<uint32_t> ring_begin;  // by vertex, into rings
    Array<uint32_t> rings;
    TriangleTree tree;
};

// Sorts points along an axis, those that are equal there as they came.
void sort_along(std::span<const Vec3f> points, int axis, std::span<Keyed> order, std::span<Keyed> spare) {
    for (Keyed& each : order) each.key = ordered_bits(points[each.number][axis]);
    sort_by_key(order, spare);
}

// Coordinates along one axis that differ by rounding become equal: each takes the least value within reach below it.
void snap(std::span<Vec3f> points, int axis, float reach, std::span<const Keyed> order) {
    float value = -std::numeric_limits<float>::infinity();
    for (const Keyed& each : order) {
        float& x = points[each.number][axis];
        if (!(x - value <= reach)) value = x;
        x = value;
    }
}

// Vertices at the same place but for rounding become one, so that triangles with corners of their own hang together:
// number[i] is that of given vertex i.
void weld(std::span<const Vec3f> given, Array<Vec3f>& vertices, Array<uint32_t>& number, Memory& memory) {
    Array<Vec3f> at(given.begin(), given.end(), memory);
    float largest = 0;
    for (Vec3f& p : at) {
        p += Vec3f::Zero();  // -0 becomes 0
        largest = std::max(largest, p.cwiseAbs().maxCoeff());
    }
    UnsetArray<Keyed> order(memory), spare(memory);
    order.resize(at.size());
    spare.resize(at.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i].number = i;
    for (int axis = 0; axis < 3; ++axis) {
        sort_along(at, axis, order, spare);
        snap(at, axis, kRounding * largest, order);
    }
    for (int axis = 2; axis >= 0; --axis) sort_along(at, axis, order, spare);  // by x, then y, then z
    number.resize(at.size());
    for (const Keyed& each : order) {
        const uint32_t i = each.number;
        if (vertices.empty() || vertices.back() != at[i]) vertices.push_back(at[i]);
        number[i] = uint32_t(vertices.size() - 1);
    }
}

bool has_area(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return (b - a).cross(c - a).norm() > kThinnest * longest;
}

// Triangles with the smallest corner first, those without area and second copies left out.
void take_triangles(std::span<const uint32_t> indices, const Array<uint32_t>& number, Mesh& mesh, Memory& memory) {
    const auto at = [&](uint32_t i) { return Vec3(mesh.vertices[i].cast<double>()); };
    Array<Corners> given(memory);
    given.reserve(indices.size() / 3);
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        Corners c = {number[indices[i]], number[indices[i + 1]], number[indices[i + 2]]};
        if (!has_area(at(c[0]), at(c[1]), at(c[2]))) {
            ++mesh.counts.without_area;
            continue;
        }
        std::rotate(c.begin(), std::min_element(c.begin(), c.end()), c.end());
        given.push_back(c);
    }
    Array<uint32_t> begin(memory), copy(memory), by_corner(memory);
    put_in_groups<uint32_t>(uint32_t(mesh.vertices.size()), begin, by_corner, [&](const auto& put) {
        for (uint32_t t = 0; t < given.size(); ++t) put(given[t][0], t);
    });
    const auto same = [&](uint32_t s, uint32_t t) { return given[s] == given[t]; };
    for (size_t v = 0; v + 1 < begin.size(); ++v) {
        const auto around = std::span(by_corner).subspan(begin[v], begin[v + 1] - begin[v]);
        std::ranges::sort(around,
                          [&](uint32_t s, uint32_t t) { return given[s] != given[t] ? given[s] < given[t] : s < t; });
        for (size_t i = 1; i < around.size(); ++i)
            if (same(around[i - 1], around[i])) copy.push_back(around[i]);
    }
    std::ranges::sort(copy);
    mesh.counts.duplicates = uint32_t(copy.size());
    mesh.triangles.reserve(given.size() - copy.size());
    auto next = copy.begin();
    for (uint32_t t = 0; t < given.size(); ++t) {
        if (next != copy.end() && *next == t)
            ++next;
        else
            mesh.triangles.push_back(given[t]);
    }
}

struct HalfEdge {
    uint32_t upper;  // of its two vertices
    uint32_t triangle;
    uint8_t edge;
    bool up;  // from lower to upper
};

// How far a body in front of a triangle can turn about one of its edges before it meets another triangle there: 0 to 4
// for a full turn (the angle's monotone 1 - cos, then 3 + cos). The other's back in the same place is a full turn.
double opening(const Mesh& mesh, const Array<Vec3>& normal, uint32_t lower, const HalfEdge& one,
               const HalfEdge& other) {
    const auto at = [&](uint32_t i) { return Vec3(mesh.vertices[i].cast<double>()); };
    const Vec3 along = (at(one.upper) - at(lower)).normalized();
    const auto inward = [&](const HalfEdge& edge) {
        const Vec3 p = at(third_corner(mesh.triangles[edge.triangle], lower, edge.upper)) - at(lower);
        return Vec3((p - along * along.dot(p)).normalized());
    };
    const Vec3 from = inward(one), to = inward(other);
    const double cosine = from.dot(to), sine = normal[one.triangle].dot(to);
    if (cosine > 0 && std::fabs(sine) < kBack) return 4;
    return sine > 0 ? 1 - cosine : 3 + cosine;
}

// The triangles that share an edge, of which a body meets each other one from each one's front.
void join_around(Mesh& mesh, const Array<Vec3>& normal, uint32_t lower, std::span<const HalfEdge> edges) {
    if (edges.size() == 2 && edges[0].up != edges[1].up &&
        normal[edges[0].triangle].dot(normal[edges[1].triangle]) > -0.5) {  // which do not lie back to back
        mesh.neighbours[edges[0].triangle][edges[0].edge] = edges[1].triangle;
        mesh.neighbours[edges[1].triangle][edges[1].edge] = edges[0].triangle;
        return;
    }
    edges = edges.first(std::min(edges.size(), kMostAround));
    for (const HalfEdge& one : edges) {
        double least = 4;
        for (const HalfEdge& other : edges) {
            if (&other == &one) continue;
            const double open = opening(mesh, normal, lower, one, other) + (one.up == other.up ? kBack : 0);
            if (open >= least) continue;
            least = open;
            mesh.neighbours[one.triangle][one.edge] = other.triangle;
        }
    }
}

// Across each edge, of the triangles that share it, the one that a body in front meets first; of two in one place the
// one that looks to the same side.
void join(Mesh& mesh, Memory& memory) {
    Array<Vec3> normal(memory);
    normal.reserve(mesh.slots());
    for (const Corners& c : mesh.triangles) {
        const Vec3 a = mesh.vertices[c[0]].cast<double>();
        normal.push_back((mesh.vertices[c[1]].cast<double>() - a).cross(mesh.vertices[c[2]].cast<double>() - a));
        normal.back().normalize();
    }
    Array<uint32_t> begin(memory);
    Array<HalfEdge> edges(memory);
    put_in_groups<HalfEdge>(uint32_t(mesh.vertices.size()), begin, edges, [&](const auto& put) {
        for (uint32_t t = 0; t < mesh.slots(); ++t) {
            const Corners& c = mesh.triangles[t];
            for (int e = 0; e < 3; ++e) {
                const uint32_t from = c[size_t(e)], to = c[size_t(next_corner(e))];
                put(std::min(from, to), HalfEdge{std::max(from, to), t, uint8_t(e), from < to});
            }
        }
    });
    mesh.neighbours.assign(mesh.triangles.size(), {kNoTriangle, kNoTriangle, kNoTriangle});
    for (uint32_t lower = 0; lower + 1 < begin.size(); ++lower) {
        const auto around = std::span(edges).subspan(begin[lower], begin[lower + 1] - begin[lower]);
        std::ranges::sort(around, [](const HalfEdge& a, const HalfEdge& b) {
            return a.upper != b.upper ? a.upper < b.upper : a.triangle < b.triangle;
        });
        for (size_t first = 0, end = 0; first < around.size(); first = end) {
            while (end < around.size() && around[end].upper == around[first].upper) ++end;
            join_around(mesh, normal, lower, around.subspan(first, end - first));
        }
    }
}

void link_vertices(Mesh& mesh, Memory& memory) {
    Array<uint32_t> begin(memory), links(memory);
    put_in_groups<uint32_t>(uint32_t(mesh.vertices.size()), begin, links, [&](const auto& put) {
        for (const Corners& c : mesh.triangles)
            for (int e = 0; e < 3; ++e) {
                const uint32_t from = c[size_t(e)], to = c[size_t(next_corner(e))];
                put(from, to);
                put(to, from);
            }
    });
    mesh.ring_begin.reserve(mesh.vertices.size() + 1);
    mesh.ring_begin.push_back(0);
    mesh.rings.reserve(links.size() / 2 + mesh.vertices.size());
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
        const auto to = std::span(links).subspan(begin[v], begin[v + 1] - begin[v]);
        std::ranges::sort(to);
        mesh.rings.insert(mesh.rings.end(), to.begin(), std::ranges::unique(to).begin());
        mesh.ring_begin.push_back(uint32_t(mesh.rings.size()));
    }
}

void find_facets(Mesh& mesh, Memory& memory) {
    const auto at = [&](uint32_t i) { return Vec3(mesh.vertices[i].cast<double>()); };
    const auto plane = [&](const Corners& c) { return plane_through(at(c[0]), at(c[1]), at(c[2])); };
    Facets<Mesh> facets(mesh, memory);
    mesh.box = {Vec3f::Constant(1e30f), Vec3f::Constant(-1e30f)};
    for (uint32_t t = 0; t < mesh.slots(); ++t) {
        const Corners& c = mesh.triangles[t];
        const FacetPlane own = plane(c);
        facets.add(t, own);
        for (int e = 0; e < 3; ++e) {
            mesh.box.lo = mesh.box.lo.cwiseMin(mesh.vertices[c[size_t(e)]]);
            mesh.box.hi = mesh.box.hi.cwiseMax(mesh.vertices[c[size_t(e)]]);
            const uint32_t other = mesh.neighbours[t][size_t(e)];
            if (other == kNoTriangle) {
                facets.end(t, e);
                continue;
            }
            const Corners& o = mesh.triangles[other];
            const uint32_t opposite = third_corner(o, c[size_t(e)], c[size_t(next_corner(e))]);
            facets.look_across(t, e, own, plane(o), mesh.vertices[opposite]);
        }
    }
    facets.find();
}

}  // namespace

std::shared_ptr<const Surface> build_mesh(std::span<const Vec3f> vertices, std::span<const uint32_t> indices,
                                          bool two_sided, Memory& memory) {
    auto mesh = std::allocate_shared<Mesh>(HostAllocator<Mesh>(memory), memory);
    mesh->two_sided = two_sided;
    {
        Array<uint32_t> number(memory);
        weld(vertices, mesh->vertices, number, memory);
        take_triangles(indices, number, *mesh, memory);
    }
    if (mesh->triangles.empty()) return nullptr;
    join(*mesh, memory);
    link_vertices(*mesh, memory);
    find_facets(*mesh, memory);
    mesh->tree.build(*mesh, memory);
    return mesh;
}

}  // namespace taut::collision
