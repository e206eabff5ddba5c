// The sweep of joints, avx512 build.
#include "constraints/joint_sweep.inl"

namespace taut {

const JointKernels kJointKernelsAvx512 = JointSweep<Avx512Lanes>::table("avx512");

}  // namespace taut
