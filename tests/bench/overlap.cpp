#include "overlap.h"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>
#include <vector>

#include "vector.h"

namespace bench {

namespace {

using scenes::Shape;
using scenes::ShapeKind;

std::array<Vec, 3> axes_of(const Placed& p) {
    return {rotate(p.rotation, {1, 0, 0}), rotate(p.rotation, {0, 1, 0}), rotate(p.rotation, {0, 0, 1})};
}

// Half the width of a box along a unit direction.
double half_width(const Vec& half, const std::array<Vec, 3>& axes, Vec direction) {
    return half.x * std::fabs(dot(axes[0], direction)) + half.y * std::fabs(dot(axes[1], direction)) +
           half.z * std::fabs(dot(axes[2], direction));
}

// Largest reach of a shape along a unit direction, from its origin.
double reach(const Placed& p, Vec direction) {
    const Shape& shape = *p.shape;
    const double radius = shape.radius, half_length = shape.half_length;
    const double up = dot(rotate(p.rotation, {0, 1, 0}), direction);    // along the shape's y axis
    const double rim = radius * std::sqrt(std::max(1 - up * up, 0.0));  // of a circle across it
    switch (shape.kind) {
        case ShapeKind::box:
            return half_width(of(shape.half_extents), axes_of(p), direction);
        case ShapeKind::sphere:
            return radius;
        case ShapeKind::capsule:
            return radius + half_length * std::fabs(up);
        case ShapeKind::hull: {
            double most = -std::numeric_limits<double>::infinity();
            for (const taut_vec3& point : shape.points)
                most = std::max(most, dot(rotate(p.rotation, of(point)), direction));
            return most;
        }
        case ShapeKind::cylinder:
            return half_length * std::fabs(up) + rim;
        case ShapeKind::cone:
            return std::max(half_length * up, rim - half_length * up);
        case ShapeKind::tapered_capsule:
            return std::max(radius - half_length * up, static_cast<double>(shape.top_radius) + half_length * up);
        case ShapeKind::plane:
        case ShapeKind::scaled_hull:
        case ShapeKind::mesh:
        case ShapeKind::height_field:
            break;
    }
    throw std::invalid_argument("no exact overlap for this pair of shapes");
}

double plane_depth(const Placed& plane, const Placed& other) {
    Vec normal = rotate(plane.rotation, of(plane.shape->normal));
    normal = normal * (1 / length(normal));
    double height = dot(normal, of(other.position) - of(plane.position));
    return reach(other, normal * -1) - height;
}

double sphere_depth(const Placed& a, const Placed& b) {
    return static_cast<double>(a.shape->radius) + static_cast<double>(b.shape->radius) -
           length(of(b.position) - of(a.position));
}

double box_sphere_depth(const Placed& box, const Placed& sphere) {
    Vec centre = rotate_back(box.rotation, of(sphere.position) - of(box.position)), half = of(box.shape->half_extents);
    Vec beyond = {std::fabs(centre.x) - half.x, std::fabs(centre.y) - half.y, std::fabs(centre.z) - half.z};
    Vec outside = {std::max(beyond.x, 0.0), std::max(beyond.y, 0.0), std::max(beyond.z, 0.0)};
    double distance = length(outside) + std::min(std::max({beyond.x, beyond.y, beyond.z}), 0.0);
    return static_cast<double>(sphere.shape->radius) - distance;
}

// Separating axes: two boxes overlap by the least overlap of their shadows on the 15 possible directions.
double box_depth(const Placed& a, const Placed& b) {
    constexpr double kParallel = 1e-6;  // edges whose cross product is shorter give no direction of their own
    std::array<Vec, 3> axes_a = axes_of(a), axes_b = axes_of(b);
    Vec half_a = of(a.shape->half_extents), half_b = of(b.shape->half_extents),
        offset = of(b.position) - of(a.position);
    double least = std::numeric_limits<double>::infinity();
    auto try_axis = [&](Vec axis) {
        least = std::min(
            least, half_width(half_a, axes_a, axis) + half_width(half_b, axes_b, axis) - std::fabs(dot(axis, offset)));
    };
    for (const Vec& axis : axes_a) try_axis(axis);
    for (const Vec& axis : axes_b) try_axis(axis);
    for (const Vec& u : axes_a)
        for (const Vec& v : axes_b) {
            Vec axis = cross(u, v);
            double size = length(axis);
            if (size > kParallel) try_axis(axis * (1 / size));
        }
    return least;
}

bool is_polytope(const Shape& shape) { return shape.kind == ShapeKind::box || shape.kind == ShapeKind::hull; }

// Directions in which a box or hull may part from another: out of its faces, and along its edges. Of a hull, all
// triangles of its points that have no point outside; two in one plane give the same.
struct Directions {
    std::vector<Vec> normals, edges;
};

Directions directions_of(const Placed& p) {
    Directions out;
    if (p.shape->kind == ShapeKind::box) {
        for (const Vec& axis : axes_of(p)) {
            out.edges.push_back(axis);
            out.normals.insert(out.normals.end(), {axis, axis * -1});
        }
        return out;
    }
    constexpr double kFlat = 1e-7;  // [m]
    std::vector<Vec> points;
    for (const taut_vec3& point : p.shape->points) points.push_back(rotate(p.rotation, of(point)));
    std::set<std::pair<size_t, size_t>> edges;
    for (size_t i = 0; i < points.size(); ++i)
        for (size_t j = i + 1; j < points.size(); ++j)
            for (size_t k = j + 1; k < points.size(); ++k) {
                Vec normal = cross(points[j] - points[i], points[k] - points[i]);
                const double area = length(normal);
                if (!(area > kFlat * kFlat)) continue;
                normal = normal * (1 / area);
                double above = 0, below = 0;
                for (const Vec& point : points) {
                    above = std::max(above, dot(normal, point - points[i]));
                    below = std::min(below, dot(normal, point - points[i]));
                }
                if (above > kFlat && below < -kFlat) continue;
                out.normals.push_back(above > kFlat ? normal * -1 : normal);
                edges.insert({{i, j}, {i, k}, {j, k}});
            }
    for (const auto& [i, j] : edges) out.edges.push_back((points[j] - points[i]) * (1 / length(points[j] - points[i])));
    return out;
}

// Separating axes of boxes and hulls: exact.
double polytope_depth(const Placed& a, const Placed& b) {
    constexpr double kParallel = 1e-6;
    const Vec offset = of(b.position) - of(a.position);
    const Directions of_a = directions_of(a), of_b = directions_of(b);
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&](Vec n) { least = std::min(least, reach(a, n) + reach(b, n * -1) - dot(n, offset)); };
    for (const Vec& n : of_a.normals) attempt(n);
    for (const Vec& n : of_b.normals) attempt(n * -1);
    if (least <= 0) return least;
    for (const Vec& u : of_a.edges)
        for (const Vec& v : of_b.edges) {
            const Vec axis = cross(u, v);
            const double size = length(axis);
            if (!(size > kParallel)) continue;
            attempt(axis * (1 / size));
            attempt(axis * (-1 / size));
        }
    return least;
}

// Any two convex shapes: the least overlap of their shadows over the normals of flat faces and over directions all
// round, then ever closer about the best.
double searched_depth(const Placed& a, const Placed& b) {
    constexpr int kAllRound = 400, kNearby = 12, kRefinements = 14;
    const Vec offset = of(b.position) - of(a.position);
    const auto depth = [&](Vec n) { return reach(a, n) + reach(b, n * -1) - dot(n, offset); };
    Vec best = {1, 0, 0};
    double least = std::numeric_limits<double>::infinity();
    const auto attempt = [&](Vec n) {
        const double d = depth(n);
        if (d < least) least = d, best = n;
    };
    if (is_polytope(*a.shape))
        for (const Vec& n : directions_of(a).normals) attempt(n);
    if (is_polytope(*b.shape))
        for (const Vec& n : directions_of(b).normals) attempt(n * -1);
    for (int i = 0; i < kAllRound; ++i) {  // a spiral from pole to pole, evenly dense
        const double y = 1 - (2 * i + 1.0) / kAllRound, r = std::sqrt(1 - y * y), angle = 2.399963229728653 * i;
        attempt({r * std::cos(angle), y, r * std::sin(angle)});
    }
    double width = 0.12;  // [rad], of the spiral's gaps
    for (int k = 0; k < kRefinements; ++k, width *= 0.6) {
        const Vec from = best, helper = std::fabs(from.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
        const Vec side = cross(from, helper), u = side * (1 / length(side)), v = cross(from, u);
        for (int i = 0; i < kNearby; ++i) {
            const double angle = 2 * 3.14159265358979323846 * i / kNearby;
            const Vec n = from + u * (width * std::cos(angle)) + v * (width * std::sin(angle));
            attempt(n * (1 / length(n)));
        }
    }
    return least;
}

}  // namespace

double overlap_depth(const Placed& a, const Placed& b) {
    ShapeKind ka = a.shape->kind, kb = b.shape->kind;
    if (ka == ShapeKind::plane) return plane_depth(a, b);
    if (kb == ShapeKind::plane) return plane_depth(b, a);
    if (ka == ShapeKind::box && kb == ShapeKind::box) return box_depth(a, b);
    if (ka == ShapeKind::sphere && kb == ShapeKind::sphere) return sphere_depth(a, b);
    if (ka == ShapeKind::box && kb == ShapeKind::sphere) return box_sphere_depth(a, b);
    if (ka == ShapeKind::sphere && kb == ShapeKind::box) return box_sphere_depth(b, a);
    if (is_polytope(*a.shape) && is_polytope(*b.shape)) return polytope_depth(a, b);
    return searched_depth(a, b);
}

double bounding_radius(const Shape& shape) {
    switch (shape.kind) {
        case ShapeKind::plane:
        case ShapeKind::mesh:
        case ShapeKind::height_field:
            return std::numeric_limits<double>::infinity();
        case ShapeKind::box:
            return length(of(shape.half_extents));
        case ShapeKind::sphere:
            return shape.radius;
        case ShapeKind::capsule:
        case ShapeKind::cylinder:
        case ShapeKind::cone:
            return static_cast<double>(shape.radius) + static_cast<double>(shape.half_length);
        case ShapeKind::tapered_capsule:
            return static_cast<double>(std::max(shape.radius, shape.top_radius) + shape.half_length);
        case ShapeKind::scaled_hull:
            throw std::invalid_argument("a scaled hull has no radius of its own");
        case ShapeKind::hull:
            break;
    }
    double most = 0;
    for (const taut_vec3& point : shape.points) most = std::max(most, length(of(point)));
    return most;
}

}  // namespace bench
