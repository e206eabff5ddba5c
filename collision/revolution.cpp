#include "collision/revolution.h"

#include <cmath>

namespace taut::collision {

Slice ball_slice(double from, double to, double centre, double radius) {
    return {from, to, radius * radius - centre * centre, 2 * centre, -1};
}

Slice conical_slice(double from, double to, double first, double second) {
    const double slope = (second - first) / (to - from);
    const double at_origin = first - slope * from;
    return {from, to, at_origin * at_origin, 2 * at_origin * slope, slope * slope};
}

// With q = radius^2: dm = pi rho q dy; about the axis dI = q/2 dm; across it dI = (q/4 + y^2) dm. All are of degree
// four at most in y, which three Gauss points integrate exactly.
MassProperties mass_of_revolution(std::span<const Slice> slices, double density) {
    constexpr double kPi = 3.14159265358979323846;
    constexpr double kOffset = 0.77459666924148337704;  // sqrt(3/5)
    constexpr double kGauss[3][2] = {{-kOffset, 5.0 / 9}, {0, 8.0 / 9}, {kOffset, 5.0 / 9}};
    double mass = 0, first = 0, along = 0, across = 0;
    for (const Slice& slice : slices) {
        const double half = 0.5 * (slice.to - slice.from);
        for (const auto& [at, weight] : kGauss) {
            const double y = 0.5 * (slice.from + slice.to) + half * at;
            const double q = slice.constant + y * (slice.linear + y * slice.quadratic);
            const double dm = kPi * density * q * weight * half;
            mass += dm;
            first += y * dm;
            along += 0.5 * q * dm;
            across += (0.25 * q + y * y) * dm;
        }
    }
    const double centre = first / mass;
    across -= mass * centre * centre;
    MassProperties out;
    out.mass = mass;
    out.centre = Vec3(0, centre, 0);
    out.inertia = {across, along, across, 0, 0, 0};
    return out;
}

// The side's normal has equal reach on both balls: s (2 h) = r(-h) - r(+h).
TaperedSide tapered_side(const Shape& shape) {
    const double low = shape.size.x();
    const double half = shape.size.y();
    const double high = shape.size.z();
    const double sine = (low - high) / (2 * half);
    const double cosine = std::sqrt(1 - sine * sine);
    return {-half + low * sine, half + high * sine, low * cosine, high * cosine, sine, cosine};
}

}  // namespace taut::collision
