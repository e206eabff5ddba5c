// Fixed joint.
//   0-2  p_b - p_a, world axes                             [m]    locked
//   3-5  4 tan(angle/4) times the axis of B in A, of both  [rad]  locked; the rotation vector to first order
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Fixed {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames&) {
        out.anchors();
        out.alignment(3);
    }
};

}  // namespace

const ConstraintType kFixed = frame_joint<Fixed, 6>("fixed", sample_aligned_frames);

}  // namespace taut
