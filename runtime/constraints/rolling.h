#pragma once

#include "constraints/constraint.h"
#include "constraints/joint_frames.h"

namespace taut {

// Rolling and spinning friction of a contact between two bodies. The frames coincide, with the contact's axes, at the
// poses at which align() saw the bodies.
struct RollingData {
    JointFrames frames;  // first: what the type reads
    Mat3 basis;          // rows: normal from a to b, tangent 1, tangent 2; world axes

    void align(const Pose* x) {
        frames.frame_a = Quat(Mat3(x[0].R.transpose() * basis.transpose()));
        frames.frame_b = Quat(Mat3(x[1].R.transpose() * basis.transpose()));
    }
};

}  // namespace taut
