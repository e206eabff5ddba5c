#pragma once

#include "base/math.h"

namespace taut {

// Three points of a line, anchors as for the ball joint; particles have theirs at 0.
struct BendData {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero(), anchor_c = Vec3::Zero();
};

}  // namespace taut
