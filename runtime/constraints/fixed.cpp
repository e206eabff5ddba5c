// Fixed joint.
//   0-2  p_b - p_a, world axes                                     [m]    locked
//   3-5  sin(angle) times the axis of B in A, components of both   [1]    locked; the rotation vector to first order
// Zero at 180 degrees too, nowhere between.
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
