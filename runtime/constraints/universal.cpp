// Universal joint: a cross that turns in a about X_a and in b about Y_b.  A^T B = Rx(first) Rz(c) Ry(last)
//   0-2  p_b - p_a, world axes                        [m]    locked
//   3    asin(X_a . Y_b) = -c                         [rad]  in [-pi/2, pi/2]; locked: the cross's arms stay square
//   4    about X_a: atan2(Z_a . Y_b, Y_a . Y_b)       [rad]  in (-pi, pi]
//   5    about Y_b: atan2(X_a . Z_b, X_a . X_b)       [rad]  in (-pi, pi]
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Universal {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames& f) {
        out.anchors();
        out.rise(3, f.xa(), f.yb(), f.ya());
        out.outer_turns(4, {f.xa(), f.za(), f.ya()}, 5, {f.yb(), f.zb(), f.xb()});
    }
};

void sample_universal(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double first = random.between(-2.7, 2.7), cross = random.between(-1, 1), last = random.between(-2.7, 2.7);
    sample_frames(random, turn_about(0, first) * turn_about(2, cross) * turn_about(1, last), data, x);
}

}  // namespace

const ConstraintType kUniversal = frame_joint<Universal, 6>("universal", sample_universal);

}  // namespace taut
