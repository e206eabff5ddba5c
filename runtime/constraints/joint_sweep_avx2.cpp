// The sweep of joints, avx2 build.
#include "constraints/joint_sweep.inl"

namespace taut {

const JointKernels kJointKernelsAvx2 = JointSweep<Avx2Lanes>::table("avx2");

}  // namespace taut
