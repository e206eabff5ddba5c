// Building hulls: refuse what has no volume, choose at most max_vertices points, hand the surface over.
#include "collision/hull.h"

#include <algorithm>
#include <cmath>

#include <LinearMath/btConvexHullComputer.h>

#include "collision/collide.h"

namespace taut::collision {
namespace {

// btConvexHullComputer rounds to 1/10216 of the points' extent on each axis: faces closer to one plane than that
// (with some room) are one face, and points closer to the surface than that are on it.
constexpr double kRelativeTolerance = 2e-4;

bool before(const Vec3f& a, const Vec3f& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
}

// Corner loops over chosen's indices into points.
Loops surface_of(const std::vector<Vec3f>& points, const std::vector<int>& chosen) {
    std::vector<Vec3f> input;
    for (const int i : chosen) input.push_back(points[size_t(i)]);
    btConvexHullComputer computer;
    computer.compute(input[0].data(), int(sizeof(Vec3f)), int(input.size()), 0, 0);
    Loops loops;
    for (int f = 0; f < computer.faces.size(); ++f) {
        const auto* first = &computer.edges[computer.faces[f]];
        const auto* edge = first;
        std::vector<int> loop;
        do {
            loop.push_back(chosen[size_t(computer.original_vertex_index[edge->getSourceVertex()])]);
            edge = edge->getNextEdgeOfFace();
        } while (edge != first);
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    return loops;
}

std::vector<int> corners_of(const Loops& loops) {
    std::vector<int> corners;
    for (const auto& loop : loops) corners.insert(corners.end(), loop.begin(), loop.end());
    std::sort(corners.begin(), corners.end());
    corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
    return corners;
}

// The point where measure is largest, the first of equals.
template <class Measure>
int furthest(const std::vector<Vec3f>& points, Measure measure) {
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
    std::vector<int> corners;
    double height = 0;  // of the fourth corner above the first three [m]
};

// Four points that span as much as greedily possible; a reason if they are thinner than thickness.
const char* find_simplex(const std::vector<Vec3f>& points, double thickness, Simplex& simplex) {
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

// How far p lies outside the surface.
double height_above(const std::vector<std::pair<Vec3, double>>& planes, const Vec3& p) {
    double most = -1e30;
    for (const auto& [normal, offset] : planes) most = std::max(most, normal.dot(p) - offset);
    return most;
}

// Adds the point furthest outside until max_vertices are chosen or the rest lies within tolerance.
Loops reduce(const std::vector<Vec3f>& points, const std::vector<int>& corners, std::vector<int> chosen,
             size_t max_vertices, double tolerance) {
    while (true) {
        Loops surface = surface_of(points, chosen);
        if (chosen.size() >= max_vertices) return surface;
        std::vector<std::pair<Vec3, double>> planes;
        for (const auto& loop : surface) {
            const Vec3 a = points[size_t(loop[0])].cast<double>();
            const Vec3 normal = (points[size_t(loop[1])].cast<double>() - a)
                                    .cross(points[size_t(loop[2])].cast<double>() - a)
                                    .normalized();
            planes.emplace_back(normal, normal.dot(a));
        }
        int best = -1;
        double most = tolerance;
        for (const int i : corners) {
            const double height = height_above(planes, points[size_t(i)].cast<double>());
            if (height > most && !std::binary_search(chosen.begin(), chosen.end(), i)) {
                most = height;
                best = i;
            }
        }
        if (best < 0) return surface;
        chosen.insert(std::lower_bound(chosen.begin(), chosen.end(), best), best);
    }
}

// Least extent along a face normal [m].
double thickness_of(const Hull& hull) {
    double least = 1e30;
    for (const Face& face : hull.faces) {
        least = std::min(least, double(face.offset + highest(hull.view(), -face.normal)));
    }
    return least;
}

}  // namespace

std::shared_ptr<const Hull> build_hull(std::span<const Vec3f> given, int max_vertices, float thickness,
                                       const char** reason) {
    const auto refuse = [&](const char* why) {
        if (reason) *reason = why;
        return nullptr;
    };
    if (given.size() < 4) return refuse("fewer than 4 points");
    if (max_vertices < 4) return refuse("fewer than 4 vertices allowed");
    for (const Vec3f& p : given) {
        if (!p.allFinite()) return refuse("a point is not finite");
    }
    std::vector<Vec3f> points(given.begin(), given.end());
    for (Vec3f& p : points) p += Vec3f::Zero();  // -0 becomes 0, so that equal points are one
    std::sort(points.begin(), points.end(), before);
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
    const double tolerance = kRelativeTolerance * double((hi - lo).maxCoeff());

    std::vector<int> all(points.size());
    for (size_t i = 0; i < all.size(); ++i) all[i] = int(i);
    Loops surface = surface_of(points, all);
    std::vector<int> corners = corners_of(surface);
    const size_t most = size_t(std::min(max_vertices, kMaxVertices));
    if (corners.size() > most) {
        surface = reduce(points, corners, simplex.corners, most, tolerance);
        corners = corners_of(surface);
    }
    std::vector<Vec3f> kept;
    for (const int corner : corners) kept.push_back(points[size_t(corner)]);
    for (auto& loop : surface) {
        for (int& corner : loop) {
            corner = int(std::lower_bound(corners.begin(), corners.end(), corner) - corners.begin());
        }
    }
    std::shared_ptr<const Hull> hull;
    // Flat hulls merge less, lest a rim vanish: a hull is thicker than 1/24 of the simplex' height. A merge that does
    // not close is undone: every polygon is a face then.
    for (const double merge : {std::min(tolerance, 0.02 * simplex.height), -1.0}) {
        hull = hull_of_surface(kept, surface, merge);
        if (hull) break;
    }
    if (!hull) return refuse("points are too close to one another for their size");
    if (!(thickness_of(*hull) >= double(thickness))) return refuse("hull is thinner than allowed");
    return hull;
}

std::shared_ptr<const Hull> scale_hull(const Hull& hull, const Vec3f& factors, float thickness, const char** reason) {
    const auto refuse = [&](const char* why) {
        if (reason) *reason = why;
        return nullptr;
    };
    // Sorted again: factors below zero turn the order around.
    std::vector<Vec3f> points;
    for (const Vec3f& v : hull.vertices) points.push_back(v.cwiseProduct(factors) + Vec3f::Zero());
    std::vector<int> order(points.size());
    for (size_t i = 0; i < order.size(); ++i) order[i] = int(i);
    std::sort(order.begin(), order.end(), [&](int i, int j) { return before(points[size_t(i)], points[size_t(j)]); });
    std::vector<int> place(points.size());
    std::vector<Vec3f> sorted;
    for (size_t i = 0; i < order.size(); ++i) {
        place[size_t(order[i])] = int(i);
        sorted.push_back(points[size_t(order[i])]);
    }
    // An odd number of mirrors turns counter-clockwise loops around.
    const bool mirrored = factors.prod() < 0;
    Loops loops;
    for (const Face& face : hull.faces) {
        std::vector<int> loop;
        for (const uint8_t corner : hull.view().loop_of(face)) loop.push_back(place[corner]);
        if (mirrored) std::reverse(loop.begin(), loop.end());
        std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
        loops.push_back(std::move(loop));
    }
    std::sort(loops.begin(), loops.end());
    auto scaled = hull_of_surface(sorted, loops, -1.0);  // no merging: flat faces stay flat
    if (!scaled) return refuse("points are too close to one another for their size");
    if (!(thickness_of(*scaled) >= double(thickness))) return refuse("hull is thinner than allowed");
    return scaled;
}

std::span<const Vec3f> hull_vertices(const Hull& hull) { return hull.vertices; }

void hull_triangles(const Hull& hull, std::vector<uint32_t>& indices) {
    indices.clear();
    const Polytope& polytope = hull.view();
    for (const Face& face : polytope.faces) {
        const auto loop = polytope.loop_of(face);
        for (size_t i = 2; i < loop.size(); ++i) indices.insert(indices.end(), {loop[0], loop[i - 1], loop[i]});
    }
}

}  // namespace taut::collision
