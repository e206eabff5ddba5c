// The slope of a heap of grains.
#pragma once

#include "scenes/running_scene.h"

namespace lab {

// Slope of the heap's surface [rad]: a line through the highest grain of each ring about the axis, by least squares.
inline double slope_of(const RunningScene& run) {
    constexpr double kRing = 0.1;  // [m]
    std::vector<double> top;
    for (int i : run.scene.roles.pile) {
        const auto x = run.body(static_cast<size_t>(i)).position;
        const size_t ring = static_cast<size_t>(std::hypot(x.x, x.z) / kRing);
        if (ring >= top.size()) top.resize(ring + 1, 0);
        top[ring] = std::max(top[ring], x.y);
    }
    // From the peak, which is round, to where only single grains lie.
    double n = 0, sr = 0, sy = 0, srr = 0, sry = 0;
    for (size_t ring = 1; ring < top.size() && top[ring] > 0.12; ++ring) {
        const double r = (static_cast<double>(ring) + 0.5) * kRing;
        n += 1, sr += r, sy += top[ring], srr += r * r, sry += r * top[ring];
    }
    EXPECT_GE(n, 3) << "no heap";
    return std::atan(-(n * sry - sr * sy) / (n * srr - sr * sr));
}

}  // namespace lab
