#include "models/soft_points.h"

#include <algorithm>

namespace taut {
namespace {

// Of a hexahedron, as shape_functions.h orders its corners: one within, four at every other corner.
constexpr uint32_t kTetsOfHex[5][4] = {{0, 2, 7, 5}, {0, 1, 2, 5}, {0, 2, 3, 7}, {0, 5, 7, 4}, {2, 7, 5, 6}};
constexpr uint32_t kTet[1][4] = {{0, 1, 2, 3}};

// Nearest to `to` of a segment: how far along it.
double along_segment(const Vec3& from, const Vec3& end, const Vec3& to) {
    const Vec3 d = end - from;
    const double squared = d.squaredNorm();
    return squared > 0 ? std::clamp((to - from).dot(d) / squared, 0.0, 1.0) : 0;
}

template <int N>
double squared_distance(const Vec3 (&x)[N], const double (&weight)[N], const Vec3& to) {
    Vec3 at = Vec3::Zero();
    for (int n = 0; n < N; ++n) at += weight[n] * (x[n] - to);
    return at.squaredNorm();
}

void offer(const SoftPoint& point, SoftPoint& best) {
    if (best.element == kNone || point.squared < best.squared) best = point;
}

void offer_triangle(const World& world, const Soft& soft, uint32_t t, const Vec3& to, SoftPoint& best) {
    SoftPoint point;
    point.element = t;
    point.count = 3;
    Vec3 x[3];
    double weight[3];
    for (uint32_t n = 0; n < 3; ++n) {
        point.node[n] = soft.node[soft.triangle[3 * size_t{t} + n]];
        x[n] = world.nodes.motion[point.node[n]].x;
    }
    nearest_of_triangle(x, to, weight);
    std::copy_n(weight, 3, point.weight);
    point.squared = squared_distance(x, weight, to);
    offer(point, best);
}

void offer_vertex(const World& world, const Soft& soft, uint32_t v, const Vec3& to, SoftPoint& best) {
    SoftPoint point;
    point.element = v;
    point.count = 1;
    point.node[0] = soft.node[v];
    point.weight[0] = 1;
    point.squared = (vertex_of(world, soft, v) - to).squaredNorm();
    offer(point, best);
}

}  // namespace

// In its plane, else on the nearest of its edges.
void nearest_of_triangle(const Vec3 (&x)[3], const Vec3& to, double (&weight)[3]) {
    const Vec3 a = x[1] - x[0], b = x[2] - x[0], normal = a.cross(b), from = to - x[0];
    const double area = normal.squaredNorm();
    if (area > 0) {
        weight[1] = from.cross(b).dot(normal) / area;
        weight[2] = a.cross(from).dot(normal) / area;
        weight[0] = 1 - weight[1] - weight[2];
        if (weight[0] >= 0 && weight[1] >= 0 && weight[2] >= 0) return;
    }
    double best = -1;
    for (int n = 0; n < 3; ++n) {
        const int m = (n + 1) % 3;
        double on[3] = {};
        on[m] = along_segment(x[n], x[m], to);
        on[n] = 1 - on[m];
        const double squared = squared_distance(x, on, to);
        if (best >= 0 && squared >= best) continue;
        best = squared;
        std::copy_n(on, 3, weight);
    }
}

// Within, else on the nearest of its faces.
void nearest_of_tetrahedron(const Vec3 (&x)[4], const Vec3& to, double (&weight)[4]) {
    Mat3 edges;
    for (int n = 0; n < 3; ++n) edges.col(n) = x[n + 1] - x[0];
    const double volume = edges.determinant();
    if (volume != 0) {
        const Vec3 from = to - x[0];
        weight[1] = from.dot(edges.col(1).cross(edges.col(2))) / volume;
        weight[2] = from.dot(edges.col(2).cross(edges.col(0))) / volume;
        weight[3] = from.dot(edges.col(0).cross(edges.col(1))) / volume;
        weight[0] = 1 - weight[1] - weight[2] - weight[3];
        if (std::all_of(weight, weight + 4, [](double w) { return w >= 0; })) return;
    }
    double best = -1;
    for (int out = 0; out < 4; ++out) {
        Vec3 face[3];
        double on[3];
        for (int n = 0; n < 3; ++n) face[n] = x[(out + 1 + n) % 4];
        nearest_of_triangle(face, to, on);
        const double squared = squared_distance(face, on, to);
        if (best >= 0 && squared >= best) continue;
        best = squared;
        weight[out] = 0;
        for (int n = 0; n < 3; ++n) weight[(out + 1 + n) % 4] = on[n];
    }
}

SoftPoint nearest_point(const World& world, const Soft& soft, const Vec3& to) {
    SoftPoint best;
    const bool meshless = is_meshless(world, soft);
    if (soft.kind == SoftKind::cloth || (meshless && soft.triangles() > 0)) {
        for (uint32_t t = 0; t < soft.triangles(); ++t) offer_triangle(world, soft, t, to, best);
        return best;
    }
    if (meshless) {
        for (uint32_t v = 0; v < soft.vertices(); ++v) offer_vertex(world, soft, v, to, best);
        return best;
    }
    const ElementSet& set = world.elements.set[soft.sets[0].set];
    const bool hex = set.type->row.nodes == 8;
    for (uint32_t cell = 0; cell < cells_of(world, soft); ++cell) {
        const auto nodes = set.nodes_of(cell * soft.cell_points);
        for (const auto& tet : std::span(hex ? kTetsOfHex : kTet, hex ? 5 : 1)) {
            SoftPoint point;
            point.element = cell;
            point.count = 4;
            Vec3 x[4];
            for (uint32_t n = 0; n < 4; ++n) {
                point.node[n] = nodes[tet[n]];
                x[n] = world.nodes.motion[point.node[n]].x;
            }
            nearest_of_tetrahedron(x, to, point.weight);
            point.squared = squared_distance(x, point.weight, to);
            offer(point, best);
        }
    }
    return best;
}

}  // namespace taut
