// Building hulls: refuse what has no volume, choose at most max_vertices points, hand the surface over.
#include "collision/hull.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "collision/collide.h"
#include "collision/quickhull.h"

namespace taut::collision {
namespace {

// Faces closer to one plane than this part of the points' extent are one face, and points half as close to the surface
// are on it.
constexpr double kRelativeTolerance = 2e-4;

bool corner_before(const Vec3f& a, const Vec3f& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// The point where measure is largest, the first of equals.
template <class Measure>
int furthest(std::span<const Vec3f> points, Measure measure) {
    int best = 0;
    double most = -1;
    for (size_t i = 0; i < points.size(); ++i) {
        const double d = measure(Vec3(points[i].cast<double>()));
        if (d > most) {
            most = d;
            best = int(i);
        }
    }
    return best;
}

struct Simplex {
    std::array<int, 4> corners;
    double height = 0;  // of the fourth corner above the first three [m]
};

// Four points that span as much as greedily possible; a reason if they are thinner than thickness.
const char* find_simplex(std::span<const Vec3f> points, double thickness, Simplex& simplex) {
    const auto at = [&](int i) { return Vec3(points[size_t(i)].cast<double>()); };
    const Vec3 a = at(0);
    const int second = furthest(points, [&](const Vec3& p) { return (p - a).norm(); });
    const Vec3 b = at(second);
    if (!((b - a).norm() >= thickness)) return "points lie in one place";
    const Vec3 along = (b - a).normalized();
    const int third = furthest(points, [&](const Vec3& p) { return along.cross(p - a).norm(); });
    const Vec3 c = at(third);
    const Vec3 normal = along.cross(c - a);
    if (!(normal.norm() >= thickness)) return "points lie on one line";
    const Vec3 up = normal.normalized();
    const int fourth = furthest(points, [&](const Vec3& p) { return std::fabs(up.dot(p - a)); });
    simplex.height = std::fabs(up.dot(at(fourth) - a));
    if (!(simplex.height >= thickness)) return "points lie in one plane";
    simplex.corners = {0, second, third, fourth};
    std::sort(simplex.corners.begin(), simplex.corners.end());
    return nullptr;
}

// The points that are corners, in their order; the loops name those from then on.
Array<Vec3f> keep_corners(std::span<const Vec3f> points, Loops& loops, Memory& memory) {
    Array<int> corners(memory);
    for (const auto& loop : loops) corners.insert(corners.end(), loop.begin(), loop.end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    for (auto& loop : loops) {
        for (int& corner : loop)
            corner = int(std::lower_bound(corners.begin(), corners.end(), corner) - corners.begin());
    }
    Array<Vec3f> kept(memory);
    kept.reserve(corners.size());
    for (const int corner : corners) kept.push_back(points[size_t(corner)]);
    return kept;
}

// Whether its extent along each face normal is at least thickness [m], and a ball fits in by more than rounding.
bool is_thick(const Hull& hull, float thickness) {
    return hull.inner_radius > 0 && std::all_of(hull.faces.begin(), hull.faces.end(), [&](const Face& face) {
               return face.offset + highest(hull.view(), -face.normal) >= thickness;
           });
}

}  // namespace

std::shared_ptr<const Hull> build_hull(std::span<const Vec3f> given, int max_vertices, float thickness,
                                       const char** reason, Memory& memory) {
    const auto refuse = [&](const char* why) {
        if (reason) *reason = why;
        return nullptr;
    };
    if (given.size() < 4) return refuse("fewer than 4 points");
    if (max_vertices < 4) return refuse("fewer than 4 vertices allowed");
    for (const Vec3f& p : given) {
        if (!p.allFinite()) return refuse("a point is not finite");
    }
    Array<Vec3f> points(given.begin(), given.end(), memory);
    for (Vec3f& p : points) p += Vec3f::Zero();  // -0 becomes 0, so that equal points are one
    std::sort(points.begin(), points.end(), corner_before);
    points.erase(std::unique(points.begin(), points.end()), points.end());
    if (points.size() < 4) return refuse("fewer than 4 distinct points");

    Simplex simplex;
    if (const char* why = find_simplex(points, thickness, simplex)) return refuse(why);
    Vec3f lo = points[0];
    Vec3f hi = points[0];
    for (const Vec3f& p : points) {
        lo = lo.cwiseMin(p);
        hi = hi.cwiseMax(p);
    }
    // Flat hulls merge less, lest a rim vanish: a hull is thicker than 1/24 of the simplex' height.
    const double extent = double((hi - lo).maxCoeff());
    const double tolerance = std::min(kRelativeTolerance * extent, 0.02 * simplex.height);
    const size_t most = size_t(std::min(max_vertices, kMaxVertices));
    Loops surface = quickhull(points, simplex.corners, most, 0.5 * tolerance, memory);
    const Array<Vec3f> corners = keep_corners(points, surface, memory);
    std::shared_ptr<const Hull> hull;
    // A merge that does not close is undone: every triangle is a face then.
    for (const double merge : {tolerance, -1.0}) {
        hull = hull_of_surface(corners, surface, merge, memory);
        if (hull) break;
    }
    if (!hull) return refuse("points are too close to one another for their size");
    if (!is_thick(*hull, thickness)) return refuse("hull is thinner than allowed");
    return hull;
}

std::shared_ptr<const Hull> scale_hull(const Hull& hull, const Vec3f& factors, float thickness, const char** reason,
                                       Memory& memory) {
    const auto refuse = [&](const char* why) {
        if (reason) *reason = why;
        return nullptr;
    };
    // Sorted again: factors below zero turn the order around.
    Array<Vec3f> points(memory);
    for (const Vec3f& v : hull.vertices) points.push_back(v.cwiseProduct(factors) + Vec3f::Zero());
    Array<int> order(points.size(), 0, memory);
    for (size_t i = 0; i < order.size(); ++i) order[i] = int(i);
    std::sort(order.begin(), order.end(),
              [&](int i, int j) { return corner_before(points[size_t(i)], points[size_t(j)]); });
    Array<int> place(points.size(), 0, memory);
    Array<Vec3f> sorted(memory);
    for (size_t i = 0; i < order.size(); ++i) {
        place[size_t(order[i])] = int(i);
        sorted.push_back(points[size_t(order[i])]);
    }
    // An odd number of mirrors turns counter-clockwise loops around.
    const bool mirrored = factors.prod() < 0;
    Loops loops(memory);
    for (const Face& face : hull.faces) {
        Loop loop(memory);
        for (const uint8_t corner : hull.view().loop_of(face)) loop.push_back(place[corner]);
        if (mirrored) std::reverse(loop.begin(), loop.end());
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    auto scaled = hull_of_surface(sorted, loops, -1.0, memory);  // no merging: flat faces stay flat
    if (!scaled) return refuse("points are too close to one another for their size");
    if (!is_thick(*scaled, thickness)) return refuse("hull is thinner than allowed");
    return scaled;
}

std::span<const Vec3f> hull_vertices(const Hull& hull) { return hull.vertices; }

uint32_t hull_triangle_count(const Hull& hull) {
    return uint32_t(hull.loops.size() - 2 * hull.faces.size());  // corners of a face less two
}

void hull_triangles(const Hull& hull, PointSink& points) {
    for (const Face& face : hull.faces) {
        const auto loop = hull.loop_of(face);
        for (size_t i = 2; i < loop.size(); ++i)
            for (const uint8_t corner : {loop[0], loop[i - 1], loop[i]}) points.take(hull.vertices[corner]);
    }
}

}  // namespace taut::collision
