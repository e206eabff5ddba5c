#pragma once

#include "base/math.h"

namespace taut {

// Anchors relative to the centre of mass, body axes [m]; world position where the end is the world.
struct BallData {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();
};

}  // namespace taut
