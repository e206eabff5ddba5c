// Hinge about X.
//   0-2  p_b - p_a, world axes             [m]    locked
//   3,4  X_b . Y_a, X_b . Z_a              [1]    locked; angles about Z_a and -Y_a to first order
//   5    angle from A to B about X         [rad]  in (-pi, pi]
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(6, error, jacobian);
    rows.anchors(f);
    rows.axis_alignment(3, f);
    rows.turn(5, twist(f));
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.anchors(f, lambda);
    out.axis_alignment(f, lambda + 3);
    out.twist(f, lambda[5]);
    out.finish();
}

}  // namespace

const ConstraintType kHinge{"hinge",  6,         2,       sizeof(JointFrames),  Bound::free, true, 0b111000,
                            evaluate, stiffness, nullptr, sample_aligned_frames};

}  // namespace taut
