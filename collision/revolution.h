// Solids of revolution about y: mass from the square of the radius as a function of y.
#pragma once

#include <span>

#include "collision/collide.h"

namespace taut::collision {

// Between from and to [m] the radius' square is constant + linear y + quadratic y^2 [m^2].
struct Slice {
    double from, to;
    double constant, linear, quadratic;
};

// A ball's slice: r^2 - (y - centre)^2.
Slice ball_slice(double from, double to, double centre, double radius);
// A cone's or cylinder's slice: the radius goes from first to second, linearly.
Slice conical_slice(double from, double to, double first, double second);

MassProperties mass_of_revolution(std::span<const Slice> slices, double density);

// A tapered capsule's side touches the balls at from and to [m along y], where it has the radii given.
struct TaperedSide {
    double from, to, from_radius, to_radius;
    double sine, cosine;  // the side's normal is (cosine, sine) in (radius, y)
};
TaperedSide tapered_side(const Shape& shape);

}  // namespace taut::collision
