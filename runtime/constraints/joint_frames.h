#pragma once

#include "base/math.h"

namespace taut {

// Data of every joint that has axes: a joint frame on each end. Its x axis is the one that the joint is about: hinge,
// slide, twist. The joint's coordinates are 0 where the frames coincide.
struct JointFrames {
    Vec3 anchor_a = Vec3::Zero(), anchor_b = Vec3::Zero();        // relative to the centre of mass, body axes [m]
    Quat frame_a = Quat::Identity(), frame_b = Quat::Identity();  // body from joint frame
};

}  // namespace taut
