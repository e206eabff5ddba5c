#pragma once

#include "base/math.h"

namespace taut {

// Anchors as for the ball joint; length [m].
struct DistanceData {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();
    double length = 0;
};

}  // namespace taut
