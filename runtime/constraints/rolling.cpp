// Relative rotation of two bodies in contact about the contact's axes since the frames were aligned.
//   0    spinning, about the normal                      [rad]
//   1-2  rolling, about the tangents                     [rad]
// 4 tan(angle/4) times the axis of B in A, as the fixed joint's: where the frames coincide, J w is the relative angular
// velocity about the axes. C is not enforced, only J w = 0 within the bound: a torque of at most an arm times the
// normal force (Coulomb's rolling resistance; Johnson, Contact Mechanics, 1985, section 9.1).
#include "constraints/rolling.h"

#include "constraints/frame_joint.h"

namespace taut {
namespace {

struct Rolling {
    template <class Writer>
    static void rows(Writer& out, const FramePair&) {
        out.alignment(0);
    }
};

}  // namespace

const ConstraintType kRolling{"rolling",
                              3,
                              2,
                              sizeof(JointFrames),
                              Bound::load,
                              true,
                              0b111,
                              evaluate_frames<Rolling, 3>,
                              stiffness_of_frames<Rolling>,
                              nullptr,
                              sample_aligned_frames};

}  // namespace taut
