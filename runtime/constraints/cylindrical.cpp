// Slide along X and turn about it.
//   0    (p_b - p_a) . X_a                                   [m]    slide
//   1,2  (p_b - p_a) . Y_a, (p_b - p_a) . Z_a                [m]    locked
//   3,4  4 tan(swing/4) of X_b from X_a, along Y_a and Z_a   [rad]  locked, as of a hinge
//   5    angle from A to B about X                           [rad]  in (-pi, pi]
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Cylindrical {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames&) {
        out.slides();
        out.axis_alignment(3);
        out.twist(5);
    }
};

}  // namespace

const ConstraintType kCylindrical = frame_joint<Cylindrical, 6>("cylindrical", sample_aligned_frames);

}  // namespace taut
