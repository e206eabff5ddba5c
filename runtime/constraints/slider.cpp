// Slider along X.
//   0    (p_b - p_a) . X_a                                 [m]    slide
//   1,2  (p_b - p_a) . Y_a, (p_b - p_a) . Z_a              [m]    locked
//   3-5  4 tan(angle/4) times the axis of B in A, of both  [rad]  locked, as of a fixed joint
#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Slider {
    template <class Writer, class Frames>
    static void rows(Writer& out, const Frames&) {
        out.slides();
        out.alignment(3);
    }
};

}  // namespace

const ConstraintType kSlider = frame_joint<Slider, 6>("slider", sample_aligned_frames);

}  // namespace taut
