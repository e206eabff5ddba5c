// Relative rotation of two bodies in contact about the contact's axes since the frames were aligned.
//   0    spinning, about the normal                      [rad]
//   1-2  rolling, about the tangents                     [rad]
// sin(angle) times the axis of B in A, as the fixed joint's: where the frames coincide, J w is the relative angular
// velocity about the axes. C is not enforced, only J w = 0 within the bound: a torque of at most an arm times the
// normal force (Coulomb's rolling resistance; Johnson, Contact Mechanics, 1985, section 9.1).
#include "constraints/rolling.h"

#include "constraints/frame_sample.h"
#include "constraints/frame_stiffness.h"

namespace taut {
namespace {

void evaluate(const void* data, const Pose* x, double* error, double* jacobian) {
    RowWriter(3, error, jacobian).alignment(0, FramePair(data, x));
}

void stiffness(const void* data, const Pose* x, const double* lambda, Curvature part, double* k) {
    StiffnessWriter out(k, part);
    out.alignment(FramePair(data, x), lambda);
    out.finish();
}

void sample(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double swing = random.between(0.2, 1.5), direction = random.between(-3, 3), twist = random.between(-2.7, 2.7);
    sample_frames(random, swing_after_twist(swing, direction, twist), data, x);
}

}  // namespace

const ConstraintType kRolling{"rolling", 3,       2,     sizeof(JointFrames), Bound::load, true, 0b111, evaluate,
                              stiffness, nullptr, sample};

}  // namespace taut
