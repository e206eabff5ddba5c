// Where a line runs inside a convex solid: from enter to exit, both parameters of the line.
#pragma once

#include <algorithm>
#include <limits>

#include "base/math.h"

namespace taut::collision {

struct UnitLine {
    Vec3 from, along;  // [m], unit; a shape's frame

    Vec3 at(double s) const { return from + s * along; }
};

struct Interval {
    double enter = -std::numeric_limits<double>::infinity();  // [m]
    double exit = std::numeric_limits<double>::infinity();
    Vec3 normal = Vec3::Zero();  // of the surface that it enters by, where enter is finite

    bool empty() const { return !(enter <= exit); }
};

inline Interval nowhere() {
    Interval none;
    none.exit = -none.exit;
    none.enter = -none.enter;
    return none;
}

// Of the common part of two solids.
inline Interval intersection(const Interval& a, const Interval& b) {
    Interval both = a.enter >= b.enter ? a : b;
    both.exit = std::min(a.exit, b.exit);
    return both;
}

// Of two solids whose union is convex, or whose union has a hull that the line leaves only where it leaves them.
inline Interval hull_of(const Interval& a, const Interval& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    Interval either = a.enter <= b.enter ? a : b;
    either.exit = std::max(a.exit, b.exit);
    return either;
}

// The half space normal . p <= offset.
inline Interval of_half_space(const UnitLine& line, const Vec3& normal, double offset) {
    const double above = normal.dot(line.from) - offset;
    const double rise = normal.dot(line.along);
    Interval out;
    if (rise == 0) return above <= 0 ? out : nowhere();
    (rise < 0 ? out.enter : out.exit) = -above / rise;
    out.normal = normal;
    return out;
}

// Roots of a s^2 + 2 b s + c, the smaller first, without cancellation: q = -(b +- sqrt(b^2 - a c)), roots q / a, c / q.
struct Roots {
    bool real = false;
    double first = 0, second = 0;
};
Roots roots_of(double a, double b, double c);

Interval of_ball(const UnitLine& line, const Vec3& centre, double radius);
// The frustum about y between from and to [m along y], whose radius goes from first to second [m], at least 0.
Interval of_frustum(const UnitLine& line, double from, double to, double first, double second);

}  // namespace taut::collision
