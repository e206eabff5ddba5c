// Where the points of a cable start.
#pragma once

#include <span>

#include "base/math.h"
#include "base/memory.h"

namespace taut {

double path_length(std::span<const Vec3> path);

// Cuts the path into segments of equal length along it: segments + 1 points, both ends included.
void cut_path(std::span<const Vec3> path, uint32_t segments, Array<Vec3>& out);

// Points from a to b on a parabola that hangs along `down` (any length; where it says nothing, across), with chords of
// this length in all. segments >= 2, length >= the distance.
void sag_path(const Vec3& a, const Vec3& b, const Vec3& down, double length, uint32_t segments, Array<Vec3>& out);

}  // namespace taut
