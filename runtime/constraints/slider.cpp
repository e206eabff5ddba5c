// Slider along X.
//   0    (p_b - p_a) . X_a                                         [m]    slide
//   1,2  (p_b - p_a) . Y_a, (p_b - p_a) . Z_a                      [m]    locked
//   3-5  sin(angle) times the axis of B in A, components of both   [1]    locked, as of a fixed joint
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(6, error, jacobian);
    rows.slides(f);
    rows.alignment(3, f);
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.slides(f, lambda);
    out.alignment(f, lambda + 3);
    out.finish();
}

}  // namespace

const ConstraintType kSlider{"slider", 6,         2,       sizeof(JointFrames),  Bound::free, true, 0b111000,
                             evaluate, stiffness, nullptr, sample_aligned_frames};

}  // namespace taut
