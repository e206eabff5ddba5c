#include "collision/narrowphase/simplex.h"

#include <algorithm>

namespace taut::collision {
namespace {

// Which points bear the nearest point, with what weights.
struct Bearing {
    int count = 0;
    int index[3] = {};
    double weights[3] = {};
    Vec3 nearest = Vec3::Zero();
};

Bearing on_point(const Simplex& s, int i) { return {1, {i}, {1}, s.points[i].at}; }

Bearing on_edge(const Simplex& s, int i, int j, double t) {
    const Vec3& a = s.points[i].at;
    return {2, {i, j}, {1 - t, t}, a + t * (s.points[j].at - a)};
}

Bearing of_edge(const Simplex& s, int i, int j) {
    const Vec3& a = s.points[i].at;
    const Vec3 ab = s.points[j].at - a;
    const double along = -a.dot(ab);
    const double squared = ab.squaredNorm();
    if (along <= 0) return on_point(s, i);
    if (along >= squared) return on_point(s, j);
    return on_edge(s, i, j, along / squared);
}

// The regions of a triangle's plane (Ericson, Real-Time Collision Detection, 5.1.5), for the origin.
Bearing of_triangle(const Simplex& s, int i, int j, int k) {
    const Vec3 &a = s.points[i].at, &b = s.points[j].at, &c = s.points[k].at;
    const Vec3 ab = b - a, ac = c - a;
    const double d1 = -ab.dot(a), d2 = -ac.dot(a);
    if (d1 <= 0 && d2 <= 0) return on_point(s, i);
    const double d3 = -ab.dot(b), d4 = -ac.dot(b);
    if (d3 >= 0 && d4 <= d3) return on_point(s, j);
    const double on_c = d1 * d4 - d3 * d2;
    if (on_c <= 0 && d1 >= 0 && d3 <= 0) return on_edge(s, i, j, d1 / (d1 - d3));
    const double d5 = -ab.dot(c), d6 = -ac.dot(c);
    if (d6 >= 0 && d5 <= d6) return on_point(s, k);
    const double on_b = d5 * d2 - d1 * d6;
    if (on_b <= 0 && d2 >= 0 && d6 <= 0) return on_edge(s, i, k, d2 / (d2 - d6));
    const double on_a = d3 * d6 - d5 * d4;
    if (on_a <= 0 && d4 >= d3 && d5 >= d6) return on_edge(s, j, k, (d4 - d3) / (d4 - d3 + d5 - d6));
    const double sum = on_a + on_b + on_c;
    const Vec3 normal = ab.cross(ac);
    const double squared = normal.squaredNorm();
    if (!(sum > 0) || !(squared > 0)) return of_edge(s, i, j);  // no area
    Bearing inside = {3, {i, j, k}, {on_a / sum, on_b / sum, on_c / sum}, normal * (normal.dot(a) / squared)};
    return inside;
}

// The nearest of the sides that see the origin; count 0 if none does.
Bearing of_tetrahedron(const Simplex& s) {
    constexpr int kSides[4][4] = {{0, 1, 2, 3}, {0, 3, 1, 2}, {0, 2, 3, 1}, {1, 3, 2, 0}};
    Bearing best;
    double least = 1e300;
    for (const auto& [i, j, k, opposite] : kSides) {
        const Vec3& a = s.points[i].at;
        const Vec3 normal = (s.points[j].at - a).cross(s.points[k].at - a);
        const double inward = normal.dot(s.points[opposite].at - a);
        const double origin = -normal.dot(a);
        if (origin * inward > 0) continue;  // a flat tetrahedron sees it from every side
        const Bearing side = of_triangle(s, i, j, k);
        const double squared = side.nearest.squaredNorm();
        if (squared < least) {
            least = squared;
            best = side;
        }
    }
    return best;
}

}  // namespace

bool Simplex::reduce(Vec3& nearest) {
    Bearing bearing = count == 1   ? on_point(*this, 0)
                      : count == 2 ? of_edge(*this, 0, 1)
                      : count == 3 ? of_triangle(*this, 0, 1, 2)
                                   : of_tetrahedron(*this);
    if (bearing.count == 0) return false;
    DifferencePoint kept[3];
    for (int i = 0; i < bearing.count; ++i) kept[i] = points[bearing.index[i]];
    std::copy(kept, kept + bearing.count, points);
    std::copy(bearing.weights, bearing.weights + bearing.count, weights);
    count = bearing.count;
    nearest = bearing.nearest;
    return true;
}

Vec3 Simplex::on_a() const {
    Vec3 sum = Vec3::Zero();
    for (int i = 0; i < count; ++i) sum += weights[i] * points[i].on_a;
    return sum;
}

}  // namespace taut::collision
