// Samples of joints between frames, for the tests that loop over the list.
#pragma once

#include "constraints/joint_frames.h"
#include "constraints/random.h"

namespace taut {

// Turn about axis k of three [rad].
inline Mat3 turn_about(int k, double angle) { return rotation_from_vector(angle * Vec3::Unit(k)).toRotationMatrix(); }

// Swing of X away from itself, towards a direction in its Y-Z plane, after a twist about it.
inline Mat3 swing_after_twist(double swing, double direction, double twist) {
    return turn_about(0, direction) * turn_about(2, swing) * turn_about(0, twist - direction);
}

// Random anchors, frames and poses with frame b turned by a_from_b in frame a.
inline void sample_frames(Random& random, const Mat3& a_from_b, void* data, Pose* x) {
    auto& joint = *static_cast<JointFrames*>(data);
    joint.anchor_a = random.vector();
    joint.anchor_b = random.vector();
    joint.frame_a = random.rotation();
    joint.frame_b = random.rotation();
    random.poses(x, 2);
    x[1].R = x[0].R * joint.frame_a.toRotationMatrix() * a_from_b * joint.frame_b.toRotationMatrix().transpose();
}

// The same where the x axes are held together: less than a right angle apart, and short of half a turn of twist.
inline void sample_aligned_frames(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double swing = random.between(0.2, 1.5), direction = random.between(-3, 3), twist = random.between(-2.7, 2.7);
    sample_frames(random, swing_after_twist(swing, direction, twist), data, x);
}

}  // namespace taut
