// Cone and twist: a ball joint that knows how far it swings and twists.
//   0-2  p_b - p_a, world axes                   [m]    locked
//   3    swing: angle between X_a and X_b        [rad]  in [0, pi]; its direction at 0 is Y_a
//   4    twist from A to B about X               [rad]  in (-pi, pi]; swing-twist decomposition
#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    const FramePair f(data, x);
    RowWriter rows(5, error, jacobian);
    rows.anchors(f);
    rows.turn(3, swing(f.xa(), f.xb(), f.ya()));
    rows.turn(4, twist(f));
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    const FramePair f(data, x);
    StiffnessWriter out(k, part);
    out.anchors(f, lambda);
    out.swing(f.xa(), f.xb(), f.ya(), lambda[3]);
    out.twist(f, lambda[4]);
    out.finish();
}

void sample(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double swing = random.between(0.2, 2.4), direction = random.between(-3, 3), twist = random.between(-2.7, 2.7);
    sample_frames(random, swing_after_twist(swing, direction, twist), data, x);
}

}  // namespace

const ConstraintType kConeTwist{"cone_twist", 5,       2,     sizeof(JointFrames), Bound::free, true, 0b11000, evaluate,
                                stiffness,    nullptr, sample};

}  // namespace taut
