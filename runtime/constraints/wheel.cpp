// Wheel on a strut: it slides along X_a, is steered about X_a and spins about Y_b, which stays square to X_a however
// far it has spun.  A^T B = Rx(steering) Rz(c) Ry(spin)
//   0    (p_b - p_a) . X_a                                   [m]    suspension
//   1,2  (p_b - p_a) . Y_a, (p_b - p_a) . Z_a                [m]    locked
//   3    asin(X_a . Y_b) = -c                                [rad]  in [-pi/2, pi/2]; locked: the axle is square to X_a
//   4    steering, about X_a: atan2(Z_a . Y_b, Y_a . Y_b)    [rad]  in (-pi, pi]
//   5    spin, about Y_b: atan2(X_a . Z_b, X_a . X_b)        [rad]  in (-pi, pi]
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Wheel {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames& f) {
        out.slides();
        out.rise(3, f.xa(), f.yb(), f.ya());
        out.outer_turns(4, {f.xa(), f.za(), f.ya()}, 5, {f.yb(), f.zb(), f.xb()});
    }
};

void sample_wheel(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double steering = random.between(-2.7, 2.7), camber = random.between(-1, 1), spin = random.between(-2.7, 2.7);
    sample_frames(random, turn_about(0, steering) * turn_about(2, camber) * turn_about(1, spin), data, x);
}

}  // namespace

const ConstraintType kWheel = frame_joint<Wheel, 6>("wheel", sample_wheel);

}  // namespace taut
