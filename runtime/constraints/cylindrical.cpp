// Slide along X and turn about it.
//   0    (p_b - p_a) . X_a                      [m]    slide
//   1,2  (p_b - p_a) . Y_a, (p_b - p_a) . Z_a   [m]    locked
//   3,4  X_b . Y_a, X_b . Z_a                   [1]    locked; angles about Z_a and -Y_a to first order
//   5    angle from A to B about X              [rad]  in (-pi, pi]
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(6, error, jacobian);
    rows.slides(f);
    rows.axis_alignment(3, f);
    rows.turn(5, twist(f));
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.slides(f, lambda);
    out.axis_alignment(f, lambda + 3);
    out.twist(f, lambda[5]);
    out.finish();
}

}  // namespace

const ConstraintType kCylindrical{"cylindrical", 6,         2,       sizeof(JointFrames),  Bound::free, true, 0b111000,
                                  evaluate,      stiffness, nullptr, sample_aligned_frames};

}  // namespace taut
