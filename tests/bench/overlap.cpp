#include "overlap.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>

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
    switch (shape.kind) {
        case ShapeKind::box:
            return half_width(of(shape.half_extents), axes_of(p), direction);
        case ShapeKind::sphere:
            return shape.radius;
        case ShapeKind::capsule:
            return static_cast<double>(shape.radius) +
                   static_cast<double>(shape.half_length) * std::fabs(dot(rotate(p.rotation, {0, 1, 0}), direction));
        case ShapeKind::hull: {
            double most = -std::numeric_limits<double>::infinity();
            for (const taut_vec3& point : shape.points)
                most = std::max(most, dot(rotate(p.rotation, of(point)), direction));
            return most;
        }
        case ShapeKind::plane:
        case ShapeKind::cylinder:
        case ShapeKind::cone:
        case ShapeKind::tapered_capsule:
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

}  // namespace

double overlap_depth(const Placed& a, const Placed& b) {
    ShapeKind ka = a.shape->kind, kb = b.shape->kind;
    if (ka == ShapeKind::plane) return plane_depth(a, b);
    if (kb == ShapeKind::plane) return plane_depth(b, a);
    if (ka == ShapeKind::box && kb == ShapeKind::box) return box_depth(a, b);
    if (ka == ShapeKind::sphere && kb == ShapeKind::sphere) return sphere_depth(a, b);
    if (ka == ShapeKind::box && kb == ShapeKind::sphere) return box_sphere_depth(a, b);
    if (ka == ShapeKind::sphere && kb == ShapeKind::box) return box_sphere_depth(b, a);
    throw std::invalid_argument("no exact overlap for this pair of shapes");
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
