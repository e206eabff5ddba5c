// The sweep of joints, base build.
#include "constraints/joint_sweep.inl"

namespace taut {

const JointKernels kJointKernelsBase = JointSweep<BaseLanes>::table("base");

}  // namespace taut
