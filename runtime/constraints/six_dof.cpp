// Six degrees of freedom between two frames.
//   0-2  A^T (p_b - p_a): position of b's anchor in frame a            [m]
//   3-5  Cardan angles of B in A, A^T B = Rx(3) Ry(4) Rz(5): about X of a, then the turned Y, then Z of b
//          3 = atan2(-Y_a . Z_b, Z_a . Z_b)                            [rad]  in (-pi, pi]
//          4 = asin(X_a . Z_b) = pi/2 - swing from X_a to Z_b          [rad]  in [-pi/2, pi/2]
//          5 = atan2(-X_a . Y_b, X_a . X_b)                            [rad]  in (-pi, pi]
// At 4 = +-pi/2 rows 3 and 5 are about one axis; their values are arbitrary there, all stays finite.
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct SixDof {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames& f) {
        out.slides();
        out.rise(4, f.xa(), f.zb(), -f.ya());
        out.outer_turns(3, {f.xa(), -f.ya(), f.za()}, 5, {f.zb(), -f.yb(), f.xb()});
    }
};

void sample_six_dof(uint64_t seed, void* data, Pose* x) {
    Random random(seed);
    const double first = random.between(-2.7, 2.7), middle = random.between(-1.2, 1.2),
                 last = random.between(-2.7, 2.7);
    sample_frames(random, turn_about(0, first) * turn_about(1, middle) * turn_about(2, last), data, x);
}

}  // namespace

const ConstraintType kSixDof = frame_joint<SixDof, 6>("six_dof", sample_six_dof);

}  // namespace taut
