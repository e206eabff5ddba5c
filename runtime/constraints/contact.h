#pragma once

#include <cstdint>

#include "base/math.h"

namespace taut {

constexpr uint32_t kContactRows = 3;  // a push and two tangents

// A contact point between detections: normal and anchors as found, the anchors turning with their bodies.
struct ContactData {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();  // relative to the centre of mass, body axes [m]
    Vec3 skin_a = Vec3::Zero(), skin_b = Vec3::Zero();      // from there to the surface, along the normal, not turning:
                                                            // the radii of round shapes; world axes [m]
    Vec3 offset = Vec3::Zero();                             // makes C the separation and no slip at detection [m]
    Mat3 basis = Mat3::Identity();  // rows: normal from a to b, tangent 1, tangent 2; world axes
};

}  // namespace taut
