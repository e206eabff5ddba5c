// The sweep of joints, sse2 build.
#include "constraints/joint_sweep.inl"

namespace taut {

const JointKernels kJointKernelsSse2 = JointSweep<Sse2Lanes>::table("sse2");

}  // namespace taut
