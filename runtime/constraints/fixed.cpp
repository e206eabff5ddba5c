// Fixed joint.
//   0-2  p_b - p_a, world axes                                     [m]    locked
//   3-5  sin(angle) times the axis of B in A, components of both   [1]    locked; the rotation vector to first order
// Zero at 180 degrees too, nowhere between.
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(6, error, jacobian);
    rows.anchors(f);
    rows.alignment(3, f);
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.anchors(f, lambda);
    out.alignment(f, lambda + 3);
    out.finish();
}

}  // namespace

const ConstraintType kFixed{"fixed",  6,         2,       sizeof(JointFrames),  Bound::free, true, 0b111000,
                            evaluate, stiffness, nullptr, sample_aligned_frames};

}  // namespace taut
