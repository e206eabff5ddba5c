// Rays by the stretch of their line inside a solid, one function a kind.
#include <array>
#include <cmath>

#include "collision/collide.h"
#include "collision/hull.h"
#include "collision/queries/interval.h"
#include "collision/queries/surface.h"
#include "collision/revolution.h"

namespace taut::collision {
namespace {

Interval plane_interval(const Shape& shape, const UnitLine& line) {
    return of_half_space(line, shape.size.cast<double>().normalized(), 0);
}

// Slab by slab; the normal is of the side that is crossed last on the way in.
Interval box_interval(const Shape& shape, const UnitLine& line) {
    Interval out;
    int axis = 0;
    for (int i = 0; i < 3; ++i) {
        const double half = shape.size[i], from = line.from[i], along = line.along[i];
        if (along == 0) {
            if (std::fabs(from) > half) return nowhere();
            continue;
        }
        const double middle = -from / along, reach = half / std::fabs(along);
        if (middle - reach > out.enter) axis = i;
        out.enter = std::max(out.enter, middle - reach);
        out.exit = std::min(out.exit, middle + reach);
    }
    out.normal[axis] = line.along[axis] > 0 ? -1 : 1;
    return out;
}

Interval sphere_interval(const Shape& shape, const UnitLine& line) {
    return of_ball(line, Vec3::Zero(), double(shape.size.x()));
}

// Two balls and what is between the circles where the side touches them. The normal comes from the point of the axis
// that the side's normal passes through, or from the end beyond which that would be.
Interval balls_interval(const UnitLine& line, double half, double low, double high, const TaperedSide& side) {
    const Interval ends = hull_of(of_ball(line, Vec3(0, -half, 0), low), of_ball(line, Vec3(0, half, 0), high));
    Interval out = hull_of(ends, of_frustum(line, side.from, side.to, side.from_radius, side.to_radius));
    if (out.empty()) return out;
    const Vec3 p = line.at(out.enter);
    const double across = std::sqrt(p.x() * p.x() + p.z() * p.z());
    const double y = std::clamp(p.y() - across * side.sine / side.cosine, -half, half);
    out.normal = (p - Vec3(0, y, 0)).normalized();
    return out;
}

Interval capsule_interval(const Shape& shape, const UnitLine& line) {
    const double radius = shape.size.x(), half = shape.size.y();
    return balls_interval(line, half, radius, radius, {-half, half, radius, radius, 0, 1});
}

Interval tapered_capsule_interval(const Shape& shape, const UnitLine& line) {
    const Vec3 size = shape.size.cast<double>();
    return balls_interval(line, size.y(), size.x(), size.z(), tapered_side(shape));
}

Interval cylinder_interval(const Shape& shape, const UnitLine& line) {
    const double radius = shape.size.x(), half = shape.size.y();
    return of_frustum(line, -half, half, radius, radius);
}

Interval cone_interval(const Shape& shape, const UnitLine& line) {
    const double half = shape.size.y();
    return of_frustum(line, -half, half, double(shape.size.x()), 0);
}

Interval hull_interval(const Shape& shape, const UnitLine& line) {
    Interval out;
    for (const Face& face : shape.hull->faces) {
        out = intersection(out, of_half_space(line, face.normal.cast<double>(), double(face.offset)));
        if (out.empty()) break;
    }
    return out;
}

// A solid is met where its interval begins, or at once by what starts inside. The line starts at its point nearest to
// the shape, so that a far ray loses no digits.
template <Interval (*interval)(const Shape&, const UnitLine&)>
bool cast_at_solid(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit,
                   Hit& out) {
    const double length = along.norm();
    const Vec3 direction = along / length;
    const Vec3 apart = from - at.position;
    const double start = apart.dot(direction);  // of the ray, as a parameter of the line
    const Mat3 rotation = at.rotation.cast<double>();
    const UnitLine line = {rotation.transpose() * (apart - start * direction),
                           (rotation.transpose() * direction).normalized()};
    const Interval met = interval(shape, line);
    if (met.empty() || met.exit < start || met.enter > start + limit * length) return false;
    out.inside = met.enter < start;
    out.fraction = out.inside ? 0 : std::min((met.enter - start) / length, 1.0);
    out.point = from + out.fraction * along;
    out.normal = out.inside ? Vec3(-direction) : (rotation * met.normal).normalized();
    out.feature = 0;
    return true;
}

using RayFunction = bool (*)(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit,
                             Hit& out);

constexpr std::array<RayFunction, kShapeKinds> kRays = {cast_at_solid<plane_interval>,
                                                        cast_at_solid<box_interval>,
                                                        cast_at_solid<sphere_interval>,
                                                        cast_at_solid<capsule_interval>,
                                                        cast_at_solid<hull_interval>,
                                                        cast_at_solid<cylinder_interval>,
                                                        cast_at_solid<cone_interval>,
                                                        cast_at_solid<tapered_capsule_interval>,
                                                        cast_ray_at_surface};

}  // namespace

bool cast_ray(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit, Hit& out) {
    return kRays[size_t(shape.kind)](shape, at, from, along, limit, out);
}

}  // namespace taut::collision
