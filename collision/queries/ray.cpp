// Rays by the stretch of their line inside a solid, one function a kind.
#include <array>
#include <cmath>

#include "collision/collide.h"
#include "collision/hull.h"
#include "collision/queries/interval.h"
#include "collision/revolution.h"

namespace taut::collision {
namespace {

Interval plane_interval(const Shape& shape, const Line& line) {
    return of_half_space(line, shape.size.cast<double>().normalized(), 0);
}

Interval box_interval(const Shape& shape, const Line& line) {
    Interval out;
    for (int i = 0; i < 3; ++i) {
        const Vec3 side = Vec3::Unit(i);
        const double half = shape.size[i];
        out = intersection(out, intersection(of_half_space(line, side, half), of_half_space(line, -side, half)));
    }
    return out;
}

Interval sphere_interval(const Shape& shape, const Line& line) {
    return of_ball(line, Vec3::Zero(), double(shape.size.x()));
}

// Two balls and what is between the circles where the side touches them. The normal comes from the point of the axis
// that the side's normal passes through, or from the end beyond which that would be.
Interval balls_interval(const Line& line, double half, double low, double high, const TaperedSide& side) {
    const Interval ends = hull_of(of_ball(line, Vec3(0, -half, 0), low), of_ball(line, Vec3(0, half, 0), high));
    Interval out = hull_of(ends, of_frustum(line, side.from, side.to, side.from_radius, side.to_radius));
    if (out.empty()) return out;
    const Vec3 p = line.at(out.enter);
    const double across = std::sqrt(p.x() * p.x() + p.z() * p.z());
    const double y = std::clamp(p.y() - across * side.sine / side.cosine, -half, half);
    out.normal = (p - Vec3(0, y, 0)).normalized();
    return out;
}

Interval capsule_interval(const Shape& shape, const Line& line) {
    const double radius = shape.size.x(), half = shape.size.y();
    return balls_interval(line, half, radius, radius, {-half, half, radius, radius, 0, 1});
}

Interval tapered_capsule_interval(const Shape& shape, const Line& line) {
    const Vec3 size = shape.size.cast<double>();
    return balls_interval(line, size.y(), size.x(), size.z(), tapered_side(shape));
}

Interval cylinder_interval(const Shape& shape, const Line& line) {
    const double radius = shape.size.x(), half = shape.size.y();
    return of_frustum(line, -half, half, radius, radius);
}

Interval cone_interval(const Shape& shape, const Line& line) {
    const double half = shape.size.y();
    return of_frustum(line, -half, half, double(shape.size.x()), 0);
}

Interval hull_interval(const Shape& shape, const Line& line) {
    Interval out;
    for (const Face& face : shape.hull->faces) {
        out = intersection(out, of_half_space(line, face.normal.cast<double>(), double(face.offset)));
        if (out.empty()) break;
    }
    return out;
}

// What part of a ray a kind cares for: parameters of its line [m].
struct Stretch {
    double from, to;
};

// A solid is met where its interval begins, or at once by what starts inside.
template <Interval (*interval)(const Shape&, const Line&)>
bool solid_ray(const Shape& shape, const Line& line, const Stretch& stretch, double& met, Hit& out) {
    const Interval inside = interval(shape, line);
    if (inside.empty() || inside.exit < stretch.from || inside.enter > stretch.to) return false;
    out.inside = inside.enter < stretch.from;
    met = out.inside ? stretch.from : inside.enter;
    out.normal = out.inside ? Vec3(-line.along) : inside.normal;
    out.feature = 0;
    return true;
}

// Fills normal (in the shape's frame), inside and feature; met is where on the line.
using RayFunction = bool (*)(const Shape&, const Line&, const Stretch&, double& met, Hit& out);

constexpr std::array<RayFunction, kShapeKinds> kRays = {
    solid_ray<plane_interval>,  solid_ray<box_interval>,
    solid_ray<sphere_interval>, solid_ray<capsule_interval>,
    solid_ray<hull_interval>,   solid_ray<cylinder_interval>,
    solid_ray<cone_interval>,   solid_ray<tapered_capsule_interval>};

}  // namespace

// The line starts at its point nearest to the shape, so that a far ray loses no digits.
bool cast_ray(const Shape& shape, const Placement& at, const Vec3& from, const Vec3& along, double limit, Hit& out) {
    const double length = along.norm();
    const Vec3 direction = along / length;
    const Vec3 apart = from - at.position;
    const double start = apart.dot(direction);  // of the ray, as a parameter of the line
    const Mat3 to_shape = at.rotation.cast<double>().transpose();
    const Line line = {to_shape * (apart - start * direction), (to_shape * direction).normalized()};
    double met = 0;
    if (!kRays[size_t(shape.kind)](shape, line, {start, start + limit * length}, met, out)) return false;
    out.fraction = std::min((met - start) / length, 1.0);
    out.point = from + out.fraction * along;
    out.normal = out.inside ? Vec3(-direction) : (at.rotation.cast<double>() * out.normal).normalized();
    return true;
}

}  // namespace taut::collision
