// Universal joint: a cross that turns in a about X_a and in b about Y_b.  A^T B = Rx(first) Rz(c) Ry(last)
//   0-2  p_b - p_a, world axes                        [m]    locked
//   3    X_a . Y_b = -sin c                           [1]    locked: the arms of the cross stay perpendicular
//   4    about X_a: atan2(Z_a . Y_b, Y_a . Y_b)       [rad]  in (-pi, pi]
//   5    about Y_b: atan2(X_a . Z_b, X_a . X_b)       [rad]  in (-pi, pi]
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(6, error, jacobian);
    rows.anchors(f);
    rows.turn(3, misalignment(f.xa(), f.yb()));
    const OuterTurns turns(f.xa(), f.yb());
    rows.turn(4, {angle_of(f.za().dot(f.yb()), f.ya().dot(f.yb())), turns.first});
    rows.turn(5, {angle_of(f.xa().dot(f.zb()), f.xa().dot(f.xb())), turns.last});
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.anchors(f, lambda);
    out.misalignment(f.xa(), f.yb(), lambda[3]);
    out.outer_turns(OuterTurns(f.xa(), f.yb()), lambda[4], lambda[5]);
    out.finish();
}

void sample(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double first = random.between(-2.7, 2.7), cross = random.between(-1, 1), last = random.between(-2.7, 2.7);
    sample_frames(random, turn_about(0, first) * turn_about(2, cross) * turn_about(1, last), data, x);
}

}  // namespace

const ConstraintType kUniversal{"universal", 6,       2,     sizeof(JointFrames), Bound::free, true, 0b111000, evaluate,
                                stiffness,   nullptr, sample};

}  // namespace taut
