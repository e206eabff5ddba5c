// Cone and twist: a ball joint that knows how far it swings and twists.
//   0-2  p_b - p_a, world axes                   [m]    locked
//   3    swing: angle between X_a and X_b        [rad]  in [0, pi]; its direction at 0 is Y_a
//   4    twist from A to B about X               [rad]  in (-pi, pi]; swing-twist decomposition
//   5    azimuth of X_b about X_a from Y_a       [rad]  in (-pi, pi], any where there is no swing; for friction alone,
//        and not swept: where it swings through 0 its axis turns about (measured: 1 of 200 ragdolls in a heap never
//        rests)
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct ConeTwist {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames& f) {
        out.anchors();
        out.swing(3, f.xa(), f.xb(), f.ya());
        out.twist(4);
        out.outer_turn(5, {f.xa(), f.za(), f.ya()}, f.xb());
    }
};

void sample_cone_twist(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double swing = random.between(0.2, 2.4), direction = random.between(-3, 3), twist = random.between(-2.7, 2.7);
    sample_frames(random, swing_after_twist(swing, direction, twist), data, x);
}

}  // namespace

const ConstraintType kConeTwist = frame_joint<ConeTwist, 6>("cone_twist", sample_cone_twist, 1 << 5);

}  // namespace taut
