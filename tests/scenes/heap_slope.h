// The slope of a heap of grains.
#pragma once

#include <array>
#include <numbers>
#include <numeric>

#include "scenes/running_scene.h"

namespace lab {

// Slope of the heap's surface [rad]: a line, by least squares, through its height at each distance from the axis, the
// mean over directions of the highest grain there. 0: the grains have run flat.
inline double slope_of(const RunningScene& run) {
    constexpr double kRing = 0.1, kSingleGrain = 0.12;  // [m]
    constexpr size_t kSectors = 8;
    std::vector<std::array<double, kSectors>> top;
    for (int i : run.scene.roles.pile) {
        const auto x = run.body(static_cast<size_t>(i)).position;
        const size_t ring = static_cast<size_t>(std::hypot(x.x, x.z) / kRing);
        const size_t sector =
            static_cast<size_t>((std::atan2(x.z, x.x) / (2 * std::numbers::pi) + 0.5) * kSectors) % kSectors;
        if (ring >= top.size()) top.resize(ring + 1, {});
        top[ring][sector] = std::max(top[ring][sector], x.y);
    }
    // From the peak, which is round, to where only single grains lie.
    double n = 0, sr = 0, sy = 0, srr = 0, sry = 0;
    for (size_t ring = 1; ring < top.size(); ++ring) {
        if (std::ranges::max(top[ring]) <= kSingleGrain) break;
        const double y = std::accumulate(top[ring].begin(), top[ring].end(), 0.0) / kSectors;
        const double r = (static_cast<double>(ring) + 0.5) * kRing;
        n += 1, sr += r, sy += y, srr += r * r, sry += r * y;
    }
    if (n < 3) return 0;
    return std::atan(-(n * sry - sr * sy) / (n * srr - sr * sr));
}

}  // namespace lab
