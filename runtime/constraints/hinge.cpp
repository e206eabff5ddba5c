// Hinge about X.
//   0-2  p_b - p_a, world axes                               [m]    locked
//   3,4  4 tan(swing/4) of X_b from X_a, along Y_a and Z_a   [rad]  locked; angles about Z_a and -Y_a to first order
//   5    angle from A to B about X                           [rad]  in (-pi, pi]
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Hinge {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames&) {
        out.anchors();
        out.axis_alignment(3);
        out.twist(5);
    }
};

}  // namespace

const ConstraintType kHinge = frame_joint<Hinge, 6>("hinge", sample_aligned_frames);

}  // namespace taut
