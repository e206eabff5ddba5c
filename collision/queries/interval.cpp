#include "collision/queries/interval.h"

#include <cmath>

namespace taut::collision {
namespace {

// Inside the double cone x^2 + z^2 <= (radius + slope y)^2, on the side of its tip where radius + slope y > 0; a
// cylinder where slope is 0. The normal is (x, -slope r, z) / (r sqrt(1 + slope^2)), r the radius there.
Interval of_cone(const UnitLine& line, double radius, double slope) {
    const Vec3 &o = line.from, &d = line.along;
    const double at_start = radius + slope * o.y(), growth = slope * d.y();
    const double a = d.x() * d.x() + d.z() * d.z() - growth * growth;
    const double b = o.x() * d.x() + o.z() * d.z() - at_start * growth;
    const double c = o.x() * o.x() + o.z() * o.z() - at_start * at_start;
    Interval out;
    if (a == 0 && b == 0) return c <= 0 ? out : nowhere();
    const Roots roots = roots_of(a, b, c);
    if (a > 0) {  // flatter than the cone: one stretch between the roots
        if (!roots.real) return nowhere();
        out.enter = roots.first;
        out.exit = roots.second;
    } else if (growth > 0) {  // along the cone: from a root on, or up to one
        if (roots.real) out.enter = a == 0 ? -c / (2 * b) : roots.second;
    } else if (roots.real) {
        out.exit = a == 0 ? -c / (2 * b) : roots.first;
    }
    if (std::isfinite(out.enter)) {
        const Vec3 p = line.at(out.enter);
        const Vec3 steep(p.x(), -slope * (radius + slope * p.y()), p.z());
        const double length = steep.norm();
        out.normal = length > 0 ? Vec3(steep / length) : Vec3(0, slope > 0 ? -1 : 1, 0);  // at the tip: along the axis
    }
    return out;
}

}  // namespace

Roots roots_of(double a, double b, double c) {
    const double square = b * b - a * c;
    if (!(square >= 0)) return {};
    const double q = -(b + std::copysign(std::sqrt(square), b));
    const double one = q / a;
    const double other = q != 0 ? c / q : 0;
    return {true, std::min(one, other), std::max(one, other)};
}

Interval of_ball(const UnitLine& line, const Vec3& centre, double radius) {
    const Vec3 from = line.from - centre;
    const double b = from.dot(line.along);
    // The square of the distance of the line, which |from|^2 - b^2 would cancel.
    const double aside = (from - b * line.along).squaredNorm();
    if (aside > radius * radius) return nowhere();
    const double half = std::sqrt(radius * radius - aside);
    Interval out;
    out.enter = -b - half;
    out.exit = -b + half;
    out.normal = (line.at(out.enter) - centre) / radius;
    return out;
}

Interval of_frustum(const UnitLine& line, double from, double to, double first, double second) {
    const double slope = (second - first) / (to - from);
    const Interval low = of_half_space(line, Vec3(0, -1, 0), -from);
    const Interval slab = intersection(low, of_half_space(line, Vec3(0, 1, 0), to));
    if (slab.empty()) return slab;
    return intersection(slab, of_cone(line, first - slope * from, slope));
}

}  // namespace taut::collision
