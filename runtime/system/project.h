// Projections of impulses onto what they may be: the half line of a push, an interval, and friction's disc, square or
// cone (Frâncu 2016, sections 7.3 to 7.8). Lanes have the disc fused.
#pragma once

#include <algorithm>
#include <cmath>

namespace taut {

// How friction (t1, t2) is bounded by a normal impulse n >= 0 with coefficient mu.
enum class FrictionModel : uint8_t {
    cylinder,  // |t| <= mu n, with n as it is: the disc
    cone,      // nearest point of the cone |t| <= mu n, which moves n too (Tasora and Anitescu 2011)
    box,       // |t1|, |t2| <= mu n each: the square pyramid
};

inline double length_of(const double (&t)[2]) { return std::sqrt(t[0] * t[0] + t[1] * t[1]); }

inline void project_disc(double (&t)[2], double limit) {
    const double size = length_of(t);
    if (size > limit) t[0] *= limit / size, t[1] *= limit / size;
}

inline void project_box(double (&t)[2], double limit) {
    for (double& each : t) each = std::clamp(each, -limit, limit);
}

// n may be negative. Inside the polar cone, |t| mu <= -n, the nearest point is the tip; else
//   n' = (n + mu |t|) / (1 + mu^2),  |t'| = mu n'.
inline void project_cone(double& n, double (&t)[2], double mu) {
    const double size = length_of(t);
    if (size <= mu * n) return;
    n = std::max(0.0, (n + mu * size) / (1 + mu * mu));
    project_disc(t, mu * n);
}

}  // namespace taut
