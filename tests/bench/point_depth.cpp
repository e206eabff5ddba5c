#include "point_depth.h"

#include <algorithm>
#include <limits>

#include "overlap.h"

namespace bench {

using scenes::Shape;
using scenes::ShapeKind;

PointDepth::PointDepth(const Shape& shape, std::span<const Shape> among)
    : kind_(shape.kind), radius_(shape.radius), top_radius_(shape.top_radius), half_length_(shape.half_length) {
    switch (kind_) {
        case ShapeKind::plane: {
            const Vec normal = of(shape.normal);
            planes_ = {{normal * (1 / length(normal)), 0}};
            break;
        }
        case ShapeKind::box: {
            const Vec half = of(shape.half_extents);
            for (const double side : {-1.0, 1.0})
                planes_.insert(planes_.end(), {{{side, 0, 0}, half.x}, {{0, side, 0}, half.y}, {{0, 0, side}, half.z}});
            break;
        }
        case ShapeKind::hull:
            add_hull(shape.points, {1, 1, 1});
            return;
        case ShapeKind::scaled_hull:
            add_hull(among[static_cast<size_t>(shape.hull)].points, of(shape.scale));
            return;
        case ShapeKind::mesh:
        case ShapeKind::height_field:
            return;
        case ShapeKind::sphere:
        case ShapeKind::capsule:
        case ShapeKind::cylinder:
        case ShapeKind::cone:
        case ShapeKind::tapered_capsule:
            break;
    }
    reach_ = bounding_radius(shape);
}

// Planes through three points that have no point beyond them.
void PointDepth::add_hull(std::span<const taut_vec3> points, Vec scale) {
    constexpr double kFlat = 1e-7;  // of the hull's reach
    std::vector<Vec> at;
    for (const taut_vec3& p : points) {
        const Vec v = of(p);
        at.push_back({v.x * scale.x, v.y * scale.y, v.z * scale.z});
        reach_ = std::max(reach_, length(at.back()));
    }
    const double flat = kFlat * reach_;
    for (size_t i = 0; i < at.size(); ++i)
        for (size_t j = i + 1; j < at.size(); ++j)
            for (size_t k = j + 1; k < at.size(); ++k) {
                Vec normal = cross(at[j] - at[i], at[k] - at[i]);
                const double area = length(normal);
                if (!(area > flat * reach_)) continue;
                normal = normal * (1 / area);
                double above = 0, below = 0;
                for (const Vec& p : at) {
                    above = std::max(above, dot(normal, p - at[i]));
                    below = std::min(below, dot(normal, p - at[i]));
                }
                if (above > flat && below < -flat) continue;
                if (above > flat) normal = normal * -1;
                planes_.push_back({normal, dot(normal, at[i])});
            }
}

double PointDepth::at(Vec p) const {
    const double across = std::hypot(p.x, p.z);
    switch (kind_) {
        case ShapeKind::plane:
        case ShapeKind::box:
        case ShapeKind::hull:
        case ShapeKind::scaled_hull: {
            double depth = std::numeric_limits<double>::infinity();
            for (const Plane& plane : planes_) depth = std::min(depth, plane.offset - dot(plane.normal, p));
            return depth;
        }
        case ShapeKind::sphere:
            return radius_ - length(p);
        case ShapeKind::capsule:
            return radius_ - std::hypot(across, std::max(std::fabs(p.y) - half_length_, 0.0));
        case ShapeKind::cylinder:
            return std::min(radius_ - across, half_length_ - std::fabs(p.y));
        case ShapeKind::cone: {  // base below, tip above
            const double side = std::hypot(2 * half_length_, radius_);
            return std::min(p.y + half_length_, (radius_ * (half_length_ - p.y) - 2 * half_length_ * across) / side);
        }
        case ShapeKind::tapered_capsule: {
            // The union of balls between the two: the nearest one's centre is off the foot of the point by the taper.
            const double slope = (radius_ - top_radius_) / (2 * half_length_);
            const double lean = slope / std::sqrt(1 - slope * slope);
            const double y = std::clamp(p.y - across * lean, -half_length_, half_length_);
            return radius_ - slope * (y + half_length_) - std::hypot(across, p.y - y);
        }
        case ShapeKind::mesh:
        case ShapeKind::height_field:
            break;
    }
    return -std::numeric_limits<double>::infinity();
}

}  // namespace bench
