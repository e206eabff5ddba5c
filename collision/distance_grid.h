// Signed distance of a closed mesh, sampled on a grid: the level set of what has none in closed form.
#pragma once

#include <memory>

#include "collision/level_set.h"

namespace taut::collision {

struct DistanceGrid {
    explicit DistanceGrid(Memory& memory) : distance(memory) {}

    Vec3 corner = Vec3::Zero();     // least, in the shape's frame [m]
    double cell = 0;                // [m]
    uint32_t nodes[3] = {0, 0, 0};  // along x, y, z, at least 5
    Array<float> distance;          // [m], x fastest

    // Between the samples, by quadratic B-splines, which have no kinks, with the derivatives of these: off by up to an
    // eighth of a cell squared over the radius of curvature. Beyond them infinitely far.
    LevelSet at(const Vec3& point) const;
};

constexpr uint32_t kMostSamples = 1u << 24;  // of a grid

// The grid of a closed surface that looks outward, two cells wider on each side. Distances are exact at the samples,
// the sign is that of the winding number. Null and a reason (static text) for one that is open, that looks inward, or
// that would take more than kMostSamples.
std::shared_ptr<const DistanceGrid> sample_distance(const Shape& surface, double cell, const char** reason,
                                                    Memory& memory);

}  // namespace taut::collision
